#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "evaluation/results/section.h"
#include "reports/data/qif/internal/parts.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"

namespace rondure::reports {
namespace {

using core::decimal;

using record::Form;
using record::Reference;

/// The family of elements for a characteristic. Geometric characteristics of QIF must have a
/// tolerance; reported-only values, and those that QIF has no word for, are user-defined lengths or
/// angles.
enum class Family {
  kUserDefined,
  kUserDefinedAngle,
  kCylindricity,
  kCircularity,
  kDiameter,
  kStraightness,
  kFlatness,
  kCoaxiality,
  kConcentricity,
  kParallelism,
  kPerpendicularity,
  kAngularity,
  kCircularRunout,
  kTotalRunout
};

Family family_of(const record::Characteristic& asked) {
  using Indication = record::Indication;
  if (evaluation::unit_of(asked) == core::ValueUnit::kMm) return Family::kDiameter;
  if (evaluation::unit_of(asked) == core::ValueUnit::kUrad) return Family::kUserDefinedAngle;
  if (!asked.tolerance_mm || asked.lower_mm) return Family::kUserDefined;
  if (asked.indication.parameter != Indication::Parameter::kTotal) return Family::kUserDefined;
  switch (asked.form) {
    case Form::kCylindricity:
      return Family::kCylindricity;
    case Form::kRoundness:
      return Family::kCircularity;
    case Form::kStraightness:
      return Family::kStraightness;
    case Form::kFlatness:
      return Family::kFlatness;
    case Form::kCoaxiality:
      return Family::kCoaxiality;
    case Form::kConcentricity:
      return Family::kConcentricity;
    case Form::kParallelism:
      return Family::kParallelism;
    case Form::kPerpendicularity:
      return Family::kPerpendicularity;
    case Form::kAngularity:
      return Family::kAngularity;
    case Form::kRunOut:  // that of a wheel has no datum, which QIF's has
      return asked.indication.datum.empty() ? Family::kUserDefined : Family::kCircularRunout;
    case Form::kTotalRunOut:
      return Family::kTotalRunout;
    default:
      return Family::kUserDefined;
  }
}

/// "CylindricityCharacteristicItem", ...
std::string element(Family family, const char* kind) {
  constexpr std::array<const char*, 14> kNames = {
      "UserDefinedLinear", "UserDefinedAngular", "Cylindricity",   "Circularity",   "Diameter",
      "Straightness",      "Flatness",           "Coaxiality",     "Concentricity", "Parallelism",
      "Perpendicularity",  "Angularity",         "CircularRunout", "TotalRunout"};
  return fmt::format("{}Characteristic{}", kNames[static_cast<std::size_t>(family)], kind);
}

/// "RONt about LSCI", "dR".
std::string symbol_words(const record::Characteristic& asked) {
  const std::string reference = evaluation::reference_of(asked);
  return evaluation::symbol_of(asked) + (reference.empty() ? "" : " about " + reference);
}

bool has_reference(const record::Characteristic& asked) {
  return !evaluation::reference_of(asked).empty();
}

/// One characteristic, with the ids of its elements after they are written.
struct PlacedResult {
  const evaluation::CharacteristicResult& result;
  const evaluation::FeatureResult& feature;
  const QifFeature& places;
  Family family = Family::kUserDefined;
  int nominal = 0;
  int item = 0;
};

/// A length in mm, or an angle, which is held in mrad, in degrees: the units of the file.
double in_file_unit(const record::Characteristic& asked, double value_mm) {
  constexpr double kMilliradian = 1e-3;  // in rad
  return evaluation::unit_of(asked) == core::ValueUnit::kUrad
             ? core::degrees(kMilliradian * value_mm)
             : value_mm;
}

/// The limits of a length or an angle.
void add_limits(pugi::xml_node node, const record::Characteristic& asked) {
  if (!asked.toleranced()) {
    add(node, "NonTolerance", "MEASURED");
    return;
  }
  const pugi::xml_node tolerance = add(node, "Tolerance");
  if (asked.tolerance_mm) {
    add(tolerance, "MaxValue", decimal(in_file_unit(asked, *asked.tolerance_mm)));
  }
  if (asked.lower_mm) {
    add(tolerance, "MinValue", decimal(in_file_unit(asked, *asked.lower_mm)));
  }
  add(tolerance, "DefinedAsLimit", "true");
}

/// Size operator and section of a diameter.
void add_size(pugi::xml_node node, const record::Indication& indication) {
  using Indication = record::Indication;
  const bool envelope = indication.requirement == Indication::Requirement::kEnvelope;
  if (envelope) add(node, "EnvelopeRequirement", "true");
  const pugi::xml_node modifiers = add(node, "DimensionModifiers");
  if (!envelope) add(modifiers, "DeterminationModifier", record::name_of(indication.size));
  if (indication.section != Indication::Section::kAll) {
    add(modifiers, "SectionModifier", record::name_of(indication.section));
  }
  if (!modifiers.first_child()) node.remove_child(modifiers);
}

/// Definition of a datum feature, once for each label.
int datum_definition(QifDraft& draft, const std::string& label, std::size_t feature) {
  const auto known = draft.datums.find(label);
  if (known != draft.datums.end()) return known->second.definition;
  pugi::xml_node node = add_numbered(draft, draft.lists.datum_definitions, "DatumDefinition");
  add(node, "DatumLabel", label);
  return draft.datums.emplace(label, QifDatum{id_of(node), feature}).first->second.definition;
}

void add_simple_datum(pugi::xml_node parent, int definition) {
  const pugi::xml_node datum = add(parent, "SimpleDatum");
  add(datum, "DatumDefinitionId", definition);
  add(datum, "MaterialModifier", "NONE");
  add(datum, "ReferencedComponent", "ACTUAL");
}

/// The datum system of a characteristic; none before its datums are found.
std::optional<int> datum_frame(QifDraft& draft, const evaluation::CharacteristicResult& result) {
  if (!result.finding || result.finding->datums.empty()) return {};
  std::string system;
  for (const evaluation::DatumResult& datum : result.finding->datums) {
    system += (system.empty() ? "" : ", ") + datum.name;
  }
  const auto known = draft.frames.find(system);
  if (known != draft.frames.end()) return known->second;
  constexpr std::array<const char*, 3> kPrecedence = {"PRIMARY", "SECONDARY", "TERTIARY"};
  pugi::xml_node frame = add_numbered(draft, draft.lists.datum_frames, "DatumReferenceFrame");
  const pugi::xml_node datums = add_list(frame, "Datums");
  for (std::size_t i = 0; i < result.finding->datums.size() && i < kPrecedence.size(); ++i) {
    const evaluation::DatumResult& datum = result.finding->datums[i];
    std::vector<int> definitions;
    for (const std::size_t feature : datum.features) {
      definitions.push_back(datum_definition(draft, fmt::format("F{}", feature + 1), feature));
    }
    const pugi::xml_node one = add(datums, "Datum");
    if (definitions.size() == 1) {
      add_simple_datum(one, definitions.front());
    } else {
      const pugi::xml_node compound = add_list(one, "CompoundDatum");
      for (std::size_t k = 0; k < definitions.size(); ++k) {
        const pugi::xml_node part = add(compound, "Datum");
        add_simple_datum(part, definitions[k]);
        add(part, "SequenceNumber", static_cast<int>(k + 1));
      }
    }
    add(add(one, "Precedence"), "PrecedenceEnum", kPrecedence[i]);
  }
  add(frame, "Name", system);
  return draft.frames.emplace(system, id_of(frame)).first->second;
}

/// Whether the zone of a location or orientation is a cylinder.
bool is_diametral(const PlacedResult& placed) {
  const auto& finding = placed.result.finding;
  return placed.family == Family::kCoaxiality || placed.family == Family::kConcentricity ||
         (finding && !finding->judged.empty() &&
          finding->judged.front().symbol.find("\u00d8") != std::string::npos);
}

/// Datum system and shape of the zone, in the order of the schema.
void add_zone_definition(QifDraft& draft, const PlacedResult& placed, pugi::xml_node node) {
  if (const auto frame = datum_frame(draft, placed.result)) {
    add(node, "DatumReferenceFrameId", *frame);
  }
  const bool diametral = is_diametral(placed);
  switch (placed.family) {
    case Family::kStraightness: {
      const bool line =
          placed.result.characteristic.indication.of == record::Indication::Of::kMedianLine;
      add(add(node, "ZoneShape"), line ? "DiametricalZone" : "NonDiametricalZone");
      break;
    }
    case Family::kCoaxiality:
    case Family::kConcentricity:
      add(add(node, "ZoneShape"), "DiametricalZone");
      break;
    case Family::kParallelism:
    case Family::kPerpendicularity:
    case Family::kAngularity:
      add(node, "MaterialCondition", "NONE");
      add(add(node, "ZoneShape"), diametral ? "DiametricalZone" : "PlanarZone");
      break;
    default:
      break;
  }
}

void add_definition(QifDraft& draft, PlacedResult& placed) {
  const record::Characteristic& asked = placed.result.characteristic;
  pugi::xml_node node = add_numbered(draft, draft.lists.characteristic_definitions,
                                     element(placed.family, "Definition"));
  const int definition = id_of(node);
  add(node, "Name", asked.id);
  if (placed.family == Family::kUserDefined || placed.family == Family::kUserDefinedAngle) {
    add_limits(node, asked);
    add(node, "WhatToMeasure", symbol_words(asked));
  } else if (placed.family == Family::kDiameter) {
    add_size(node, asked.indication);
    add_limits(node, asked);
  } else {
    add(node, "ToleranceValue", decimal(*asked.tolerance_mm));
    add_zone_definition(draft, placed, node);
  }

  node =
      add_numbered(draft, draft.lists.characteristic_nominals, element(placed.family, "Nominal"));
  placed.nominal = id_of(node);
  add(node, "CharacteristicDefinitionId", definition);
  if (placed.places.whole) {
    add_references(node, "FeatureNominalIds", {placed.places.whole->nominal});
  }
  if (placed.family == Family::kAngularity && asked.indication.angle_deg) {
    add(node, "Angle", decimal(*asked.indication.angle_deg));
  }
}

void add_item(QifDraft& draft, PlacedResult& placed) {
  const record::Characteristic& asked = placed.result.characteristic;
  pugi::xml_node node =
      add_numbered(draft, draft.lists.characteristic_items, element(placed.family, "Item"));
  placed.item = id_of(node);
  add_attributes(node,
                 {{"feature", placed.feature.feature.id}, {"drawing_zone", asked.drawing_zone}});
  add(node, "Name", asked.id);
  if (placed.places.whole) add_references(node, "FeatureItemIds", {placed.places.whole->item});
  if (has_reference(asked)) add_algorithm(node, asked.reference);
  if (draft.device) add_references(node, "MeasurementDeviceIds", {*draft.device});
  add(node, "CharacteristicNominalId", placed.nominal);
}

/// The measured shapes that the value was computed from.
std::vector<int> measured_shapes(const PlacedResult& placed) {
  const record::Characteristic& asked = placed.result.characteristic;
  const auto about = static_cast<std::size_t>(asked.reference);
  std::vector<int> ids;
  const auto take = [&](const QifShape& shape) {
    if (shape.measured[about]) ids.push_back(*shape.measured[about]);
  };
  if (asked.form == Form::kRoundness && !placed.places.sections.empty()) {
    for (const QifShape& section : placed.places.sections) take(section);
  } else if (placed.places.whole && has_reference(asked)) {
    take(*placed.places.whole);
  }
  return ids;
}

void add_radii(pugi::xml_node parent, double inner_mm, double outer_mm) {
  const pugi::xml_node radii = add(parent, "ZoneRadii");
  add(radii, "MinRadius", decimal(inner_mm));
  add(radii, "MaxRadius", decimal(outer_mm));
}

/// Whether the value is the uncorrected width of this zone.
bool is_width(const evaluation::CharacteristicResult& result, double width_mm) {
  constexpr double kSame_mm = 1e-12;
  return result.value && std::abs(result.value->quoted_mm() - width_mm) <= kSame_mm;
}

/// ZoneRadii and ZoneAxis: the minimum zone itself.
void add_cylinder_zone(pugi::xml_node node, const PlacedResult& placed) {
  const evaluation::FeatureResult& feature = placed.feature;
  const auto zone = zone_of(feature);
  if (!zone || !feature.mz_cylinder || !is_width(placed.result, zone->deviation_mm)) return;
  add_radii(node, zone->inner_radius_mm, zone->outer_radius_mm);
  const fit::Axis& axis = feature.mz_cylinder->axis;
  const auto [low_mm, high_mm] = heights_of(feature);
  const pugi::xml_node place = add(node, "ZoneAxis");
  add(place, "AxisPoint", text_of(axis.point_mm + low_mm * axis.direction));
  add(place, "Direction", text_of(axis.direction));
  add(place, "Length", decimal(high_mm - low_mm));
}

/// ZoneRadii and ZonePlane of the section that gave the value.
void add_circle_zone(pugi::xml_node node, const PlacedResult& placed) {
  const double offset_mm = surface_offset_mm(placed.feature);
  for (const evaluation::LayerResult& layer : placed.feature.layers) {
    if (!layer.mz || !is_width(placed.result, layer.mz->width_mm())) continue;
    add_radii(node, layer.mz->inner_radius_mm + offset_mm, layer.mz->outer_radius_mm + offset_mm);
    const fit::Axis axis = section_axis(placed.feature, layer, layer.mz->center_mm);
    const pugi::xml_node plane = add(node, "ZonePlane");
    add(plane, "Point", text_of(axis.point_mm));
    add(plane, "Normal", text_of(axis.direction));
    return;
  }
}

/// Meaning of `combinedUncertainty`, which QIF leaves open; without an interval, of an analysis the
/// reason, else empty.
std::string uncertainty_words(const record::Feature& feature,
                              const evaluation::CharacteristicResult& result) {
  const evaluation::UncertaintyStatement* known =
      result.value ? result.value->statement() : nullptr;
  if (known == nullptr) {
    if (!result.value || !record::is_analysis(feature.shape)) return {};
    const core::Phrase& why = result.value->uncertainty().why();
    return why.empty() ? std::string() : "none: " + why.english();
  }
  const bool angle = result.value->unit() == core::ValueUnit::kUrad;
  const char* unit = angle ? "degrees" : "mm";
  const auto number = [&](double value_mm) {
    return decimal(in_file_unit(result.characteristic, value_mm));
  };
  if (is_bound(*result.value) || known->at_most) {
    const bool lower = result.value->bound() == evaluation::StatedValue::Bound::kLower;
    return fmt::format("none: {}{:g} % lie {} {} {}",
                       bound_sign(*result.value, "the value is the upper bound, ",
                                  "the value is the lower bound, "),
                       50.0 * (1.0 + result.value->uncertainty().coverage_1()),
                       lower ? "above" : "below", number(lower ? known->low_mm : known->high_mm),
                       unit);
  }
  return fmt::format("standard uncertainty in {} (k = 1), {}; {:g} % lie within {} and {} {}", unit,
                     name_of(known->measurand), 100.0 * result.value->uncertainty().coverage_1(),
                     number(known->low_mm), number(known->high_mm), unit);
}

void add_measured(QifDraft& draft, const PlacedResult& placed) {
  const evaluation::CharacteristicResult& result = placed.result;
  const record::Characteristic& asked = result.characteristic;
  pugi::xml_node node = add_numbered(draft, draft.lists.measured_characteristics,
                                     element(placed.family, "Measurement"));
  add_attributes(
      node,
      {{"verdict", std::string(name_of(result.verdict))},
       {"verification_operator", result.value ? result.value->operator_text() : std::string()},
       {"stated", result.value ? result.value->sentence() : std::string()},
       {"combinedUncertainty", uncertainty_words(placed.feature.feature, result)},
       {"decision_rule", own_rule_in_words(asked)},
       {"gates", placed.feature.gates.empty() ? std::string() : in_words(placed.feature.gates)}});
  if (!result.reason.empty()) add(node, "Description", result.reason.english());
  add(add(node, "Status"), "CharacteristicStatusEnum", status_of(result.verdict).of_characteristic);
  add(node, "CharacteristicItemId", placed.item);
  add_references(node, "FeatureMeasurementIds", measured_shapes(placed));
  if (has_reference(asked)) add_algorithm(node, asked.reference);
  if (draft.device) add_references(node, "MeasurementDeviceIds", {*draft.device});
  if (!result.value || !std::isfinite(result.value->value_mm())) return;
  pugi::xml_node value =
      add(node, "Value", decimal(in_file_unit(asked, result.value->quoted_mm())));
  const evaluation::UncertaintyStatement* known = result.value->statement();
  if (known != nullptr && !known->at_most && !is_bound(*result.value)) {
    set(value, "combinedUncertainty", decimal(in_file_unit(asked, known->standard_uncertainty_mm)));
  }
  if (asked.reference != Reference::kMinimumZone) return;
  if (placed.family == Family::kCylindricity) add_cylinder_zone(node, placed);
  if (placed.family == Family::kCircularity) add_circle_zone(node, placed);
}

}  // namespace

void add_qif_characteristics(QifDraft& draft, const QifFeature& places,
                             const evaluation::FeatureResult& feature) {
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    PlacedResult placed{result, feature, places, family_of(result.characteristic)};
    add_definition(draft, placed);
    add_item(draft, placed);
    add_measured(draft, placed);
  }
}

}  // namespace rondure::reports
