#include "reports/data/qif/report.h"

#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/utc.h"
#include "record/sha256.h"
#include "reports/data/qif/internal/parts.h"
#include "reports/words/internal/facts.h"

namespace rondure::reports {
namespace {

/// A UUID from the inputs of the document, so that the same record gives the same bytes.
std::string document_id(const record::Header& header) {
  const std::string hex = record::sha256_hex(
      fmt::format("{}\n{}\n{}", header.run_id, header.started_utc, header.plan_sha256));
  return fmt::format("{}-{}-8{}-a{}-{}", hex.substr(0, 8), hex.substr(8, 4), hex.substr(13, 3),
                     hex.substr(17, 3), hex.substr(20, 12));
}

pugi::xml_node add_root(QifDraft& draft, const record::Header& header) {
  pugi::xml_node declaration = draft.document.append_child(pugi::node_declaration);
  declaration.append_attribute("version").set_value("1.0");
  declaration.append_attribute("encoding").set_value("UTF-8");
  pugi::xml_node root = draft.document.append_child("QIFDocument");
  set(root, "xmlns", "http://qifstandards.org/xsd/qif3");
  set(root, "xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
  set(root, "xsi:schemaLocation",
      "http://qifstandards.org/xsd/qif3 QIFApplications/QIFDocument.xsd");
  set(root, "versionQIF", "3.0.0");
  root.append_attribute("idMax").set_value(0);
  add(root, "QPId", document_id(header));
  if (core::parse_utc(header.started_utc)) {
    add(add(root, "Version"), "TimeCreated", header.started_utc);
  }
  const pugi::xml_node head = add(root, "Header");
  add(add(head, "Application"), "Name", "rondure " + header.version);
  add(head, "Description",
      fmt::format("Run {} of plan {}, revision {}{}", header.run_id, header.plan_name,
                  header.plan_revision,
                  header.simulated ? "; simulated: no real part was measured" : ""));
  add(head, "Scope", "RESULTS");
  return root;
}

int add_standard(QifDraft& draft, pugi::xml_node list, const char* designator, const char* year,
                 const char* title) {
  const pugi::xml_node node = add_numbered(draft, list, "Standard");
  add(add(node, "Organization"), "StandardsOrganizationEnum", "ISO");
  add(node, "Designator", designator);
  add(node, "Year", year);
  add(node, "Title", title);
  return id_of(node);
}

/// Standards, software, units. Returns the id of the standard that the characteristics follow.
int add_definitions(QifDraft& draft, pugi::xml_node root, const record::Header& header) {
  const pugi::xml_node standards = add_list(root, "StandardsDefinitions");
  const int formal = add_standard(draft, standards, "ISO 1101", "2017", "Geometrical tolerancing");
  add_standard(draft, standards, "ISO 12180-1", "2011", "Cylindricity: vocabulary and parameters");
  add_standard(draft, standards, "ISO 12181-1", "2011", "Roundness: vocabulary and parameters");
  const pugi::xml_node software =
      add_numbered(draft, add_list(root, "SoftwareDefinitions"), "Software");
  draft.software = id_of(software);
  add(software, "VendorName", "Rondure");
  add(software, "ApplicationName", "rondure");
  add(software, "Version", header.version);

  const pugi::xml_node units = add(add(root, "FileUnits"), "PrimaryUnits");
  const auto add_unit = [&](const char* element, const char* si, const char* name,
                            const char* factor) {
    const pugi::xml_node unit = add(units, element);
    add(unit, "SIUnitName", si);
    add(unit, "UnitName", name);
    add(add(unit, "UnitConversion"), "Factor", factor);
  };
  add_unit("AngularUnit", "radian", "degree", "0.017453292519943295");
  add_unit("LinearUnit", "meter", "mm", "0.001");
  return formal;
}

/// Fixture and machine, where the run had any.
void add_resources(QifDraft& draft, pugi::xml_node root, const record::Header& header) {
  if (header.machine.empty() && header.fixture.empty()) return;
  const pugi::xml_node resources = add(root, "MeasurementResources");
  const auto add_resource = [&](const char* list, const char* element, const std::string& name) {
    const pugi::xml_node node = add_numbered(draft, add_list(resources, list), element);
    add(node, "Name", name);
    return id_of(node);
  };
  if (!header.fixture.empty()) (void)add_resource("Fixtures", "Fixture", header.fixture);
  if (!header.machine.empty()) {
    draft.device = add_resource("MeasurementDevices", "CartesianCMM", header.machine);
  }
}

void add_part(QifDraft& draft, pugi::xml_node root, const record::Header& header) {
  const pugi::xml_node product = add(root, "Product");
  const pugi::xml_node part = add_numbered(draft, add_list(product, "PartSet"), "Part");
  add_attributes(part, {{"drawing", header.drawing}});
  add(add(part, "Header"), "Name", header.part_name);
  add(part, "ModelNumber", header.part_id);
}

/// The empty lists in the order of the schema.
pugi::xml_node add_lists(QifDraft& draft, pugi::xml_node root, int formal_standard) {
  QifLists& lists = draft.lists;
  const pugi::xml_node features = add(root, "Features");
  lists.feature_definitions = add_list(features, "FeatureDefinitions");
  lists.feature_nominals = add_list(features, "FeatureNominals");
  lists.feature_items = add_list(features, "FeatureItems");
  const pugi::xml_node characteristics = add(root, "Characteristics");
  add(characteristics, "FormalStandardId", formal_standard);
  lists.characteristic_definitions = add_list(characteristics, "CharacteristicDefinitions");
  lists.characteristic_nominals = add_list(characteristics, "CharacteristicNominals");
  lists.characteristic_items = add_list(characteristics, "CharacteristicItems");
  return add(root, "Results");
}

void add_traceability(const QifDraft& draft, pugi::xml_node results,
                      const record::RunRecord& record) {
  const record::Header& header = record.header;
  const pugi::xml_node node = add(results, "InspectionTraceability");
  add(node, "ReportNumber", header.run_id);
  if (core::parse_utc(header.started_utc)) add(node, "InspectionStart", header.started_utc);
  const pugi::xml_node software = add(node, "InspectionSoftwareItems");
  add_references(software, "InspectionProgramExecutionSoftware", {draft.software});
  add_references(software, "AnalysisSoftware", {draft.software});
  if (!header.operator_name.empty()) {
    add(add(node, "InspectionOperator"), "Name", header.operator_name);
  }
  if (record.failure) add(add_list(node, "Errors"), "Error", core::to_line(*record.failure));
  add_attributes(node, {{"plan", header.plan_name},
                        {"plan_revision", header.plan_revision},
                        {"plan_file", header.plan_file},
                        {"plan_sha256", header.plan_sha256},
                        {"decision_rule", rule_in_words(header)},
                        {"ending", record.ending},
                        {"simulated", header.simulated ? "yes" : "no"}});
}

void add_actual_component(QifDraft& draft, pugi::xml_node root_results,
                          const record::Header& header, evaluation::Verdict verdict) {
  if (header.serial.empty()) return;
  const pugi::xml_node component = add_numbered(
      draft, add_list(add_list(root_results, "ActualComponentSets"), "ActualComponentSet"),
      "ActualComponent");
  add(component, "SerialNumber", header.serial);
  add(add(component, "Status"), "InspectionStatusEnum", status_of(verdict).of_part);
}

}  // namespace

std::string write_qif(const record::RunRecord& record, const evaluation::Evaluation& evaluation) {
  QifDraft draft;
  pugi::xml_node root = add_root(draft, record.header);
  const int formal_standard = add_definitions(draft, root, record.header);
  draft.lists.datum_definitions = add_list(root, "DatumDefinitions");
  draft.lists.datum_frames = add_list(root, "DatumReferenceFrames");
  add_resources(draft, root, record.header);
  add_part(draft, root, record.header);
  const pugi::xml_node all_results = add_lists(draft, root, formal_standard);

  pugi::xml_node results =
      add_numbered(draft, add_list(all_results, "MeasurementResultsSet"), "MeasurementResults");
  add_traceability(draft, results, record);
  draft.lists.measured_features = add_list(results, "MeasuredFeatures");
  draft.lists.point_sets = add_list(results, "MeasuredPointSets");
  const pugi::xml_node characteristics = add(results, "MeasuredCharacteristics");
  draft.lists.measured_characteristics = add_list(characteristics, "CharacteristicMeasurements");
  add(add(results, "InspectionStatus"), "InspectionStatusEnum",
      status_of(evaluation.verdict).of_part);
  std::vector<std::optional<int>> nominals;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    const QifFeature places = add_qif_feature(draft, feature);
    add_qif_characteristics(draft, places, feature);
    nominals.push_back(places.whole ? std::optional(places.whole->nominal) : std::nullopt);
  }
  // A datum may be a feature after the first that refers to it.
  for (const auto& [label, datum] : draft.datums) {
    if (datum.feature >= nominals.size() || !nominals[datum.feature]) continue;
    const pugi::xml_node node = draft.lists.datum_definitions.find_child_by_attribute(
        "id", std::to_string(datum.definition).c_str());
    add_references(node, "FeatureNominalIds", {*nominals[datum.feature]});
  }
  if (!draft.lists.measured_characteristics.first_child()) {  // these two must not be empty
    results.remove_child(characteristics);
    root.remove_child("Characteristics");
  }
  add_actual_component(draft, all_results, record.header, evaluation.verdict);
  finish_lists(root);
  root.attribute("idMax").set_value(draft.ids.last());
  return bytes_of(draft.document);
}

}  // namespace rondure::reports
