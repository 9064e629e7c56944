#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "reports/facts.h"
#include "reports/text.h"
#include "reports/writers.h"
#include "reports/data/xml_parts.h"

namespace rondure::reports {
namespace {

/// Sums of a suite, as readers show them without looking at its cases.
struct Tally {
  int tests = 0;
  int failures = 0;
  int errors = 0;
  int skipped = 0;
};

pugi::xml_node add_case(pugi::xml_node suite, Tally& tally, const std::string& feature,
                        const std::string& name) {
  pugi::xml_node node = add(suite, "testcase");
  set(node, "classname", feature);
  set(node, "name", name);
  ++tally.tests;
  return node;
}

void add_outcome(pugi::xml_node node, const char* element, const std::string& type,
                 const std::string& message) {
  pugi::xml_node outcome = add(node, element);
  set(outcome, "type", type);
  set(outcome, "message", message);
}

/// "CYLt = 8.31 um [7.60, 9.40] (MZCY; unfiltered; ...), tolerance 10.000 um".
std::string value_in_words(const CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  std::string text = result.value ? result.value->sentence() : symbol_of(asked) + ": no value";
  if (asked.tolerance_mm) text += fmt::format(", tolerance {} um", um(*asked.tolerance_mm));
  return text;
}

void add_characteristic(pugi::xml_node suite, Tally& tally, const std::string& feature,
                        const CharacteristicResult& result) {
  const pugi::xml_node node = add_case(suite, tally, feature, result.characteristic.id);
  const std::string verdict(name_of(result.verdict));
  switch (result.verdict) {
    case Verdict::kConforms:
      break;
    case Verdict::kNotToleranced:
      add_outcome(node, "skipped", verdict, result.reason);
      ++tally.skipped;
      break;
    case Verdict::kDoesNotConform:
    case Verdict::kUndecided:
      add_outcome(node, "failure", verdict, result.reason);
      ++tally.failures;
      break;
    case Verdict::kVoid:
      add_outcome(node, "error", verdict, result.reason);
      ++tally.errors;
      break;
  }
  add(node, "system-out", value_in_words(result));
}

/// Cases that are no characteristic: what must hold before any value counts.
void add_error(pugi::xml_node suite, Tally& tally, const std::string& feature, const char* name,
               const std::string& message) {
  add_outcome(add_case(suite, tally, feature, name), "error", "void", message);
  ++tally.errors;
}

void add_cases(pugi::xml_node suite, Tally& tally, const record::RunRecord& record,
               const Evaluation& evaluation) {
  if (record.ending != "finished") {
    const std::string ending =
        record.ending.empty() ? "the run has no end on record" : record.ending;
    add_error(suite, tally, "run", "finished",
              record.failure ? core::to_line(*record.failure) : ending);
  }
  for (const FeatureResult& feature : evaluation.features) {
    if (feature.failure) {
      add_error(suite, tally, feature.feature.id, "has a result", core::to_line(*feature.failure));
    }
    for (const CharacteristicResult& result : feature.characteristics) {
      add_characteristic(suite, tally, feature.feature.id, result);
    }
  }
}

/// Duration of the run by the machine's clock [s].
double duration_s(const record::RunRecord& record) {
  double last = 0.0;
  for (const record::Touch& touch : record.touches) {
    if (std::isfinite(touch.time_s)) last = std::max(last, touch.time_s);
  }
  return last;
}

}  // namespace

std::string write_junit(const record::RunRecord& record, const Evaluation& evaluation) {
  const record::Header& header = record.header;
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version").set_value("1.0");
  declaration.append_attribute("encoding").set_value("UTF-8");
  pugi::xml_node suites = document.append_child("testsuites");
  pugi::xml_node suite = add(suites, "testsuite");
  set(suite, "name", header.plan_name.empty() ? header.run_id : header.plan_name);
  const pugi::xml_node properties = add(suite, "properties");
  const auto add_property = [&](const char* name, std::string_view value) {
    pugi::xml_node property = add(properties, "property");
    set(property, "name", name);
    set(property, "value", value);
  };
  add_property("run", header.run_id);
  add_property("verdict", name_of(evaluation.verdict));
  add_property("part", header.part_id);
  add_property("serial", header.serial);
  add_property("operator", header.operator_name);
  add_property("decision rule", rule_in_words(header));
  add_property("version", header.version);
  if (header.simulated) add_property("simulated", "no real part was measured");
  Tally tally;
  add_cases(suite, tally, record, evaluation);
  for (pugi::xml_node node : {suites, suite}) {
    node.append_attribute("tests").set_value(tally.tests);
    node.append_attribute("failures").set_value(tally.failures);
    node.append_attribute("errors").set_value(tally.errors);
    node.append_attribute("skipped").set_value(tally.skipped);
    set(node, "time", fixed(duration_s(record), 3));
  }
  set(suite, "timestamp", header.started_utc);
  return bytes_of(document);
}

}  // namespace rondure::reports
