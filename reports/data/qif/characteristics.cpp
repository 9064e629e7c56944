#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/section.h"
#include "reports/data/qif/internal/parts.h"

namespace rondure::reports {
namespace {

using core::decimal;

using record::Form;
using record::Reference;

/// The family of elements for a characteristic. Form characteristics of QIF must have a tolerance;
/// reported-only values, and those that QIF has no word for, are user-defined lengths.
enum class Family { kCylindricity, kCircularity, kUserDefined };

Family family_of(const record::Characteristic& asked) {
  if (!asked.tolerance_mm) return Family::kUserDefined;
  if (asked.form == Form::kCylindricity) return Family::kCylindricity;
  return asked.form == Form::kRoundness ? Family::kCircularity : Family::kUserDefined;
}

/// "CylindricityCharacteristicItem", ...
std::string element(Family family, const char* kind) {
  constexpr std::array<const char*, 3> kNames = {"Cylindricity", "Circularity",
                                                 "UserDefinedLinear"};
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

void add_definition(QifDraft& draft, PlacedResult& placed) {
  const record::Characteristic& asked = placed.result.characteristic;
  pugi::xml_node node = add_numbered(draft, draft.lists.characteristic_definitions,
                                     element(placed.family, "Definition"));
  const int definition = id_of(node);
  add(node, "Name", asked.id);
  if (placed.family == Family::kUserDefined) {
    if (asked.tolerance_mm) {
      const pugi::xml_node tolerance = add(node, "Tolerance");
      add(tolerance, "MaxValue", decimal(*asked.tolerance_mm));
      add(tolerance, "DefinedAsLimit", "true");
    } else {
      add(node, "NonTolerance", "MEASURED");
    }
    add(node, "WhatToMeasure", symbol_words(asked));
  } else {
    add(node, "ToleranceValue", decimal(*asked.tolerance_mm));
  }

  node =
      add_numbered(draft, draft.lists.characteristic_nominals, element(placed.family, "Nominal"));
  placed.nominal = id_of(node);
  add(node, "CharacteristicDefinitionId", definition);
  if (placed.places.whole) {
    add_references(node, "FeatureNominalIds", {placed.places.whole->nominal});
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

/// Meaning of `combinedUncertainty`, which QIF leaves open; empty without an interval.
std::string uncertainty_words(const evaluation::CharacteristicResult& result) {
  const evaluation::UncertaintyStatement* known =
      result.value ? result.value->statement() : nullptr;
  if (known == nullptr) return {};
  return fmt::format("standard uncertainty in mm (k = 1), {}; {:g} % lie within {} and {} mm",
                     name_of(known->measurand), 100.0 * result.value->uncertainty().coverage_1(),
                     decimal(known->low_mm), decimal(known->high_mm));
}

void add_measured(QifDraft& draft, const PlacedResult& placed) {
  const evaluation::CharacteristicResult& result = placed.result;
  const record::Characteristic& asked = result.characteristic;
  pugi::xml_node node = add_numbered(draft, draft.lists.measured_characteristics,
                                     element(placed.family, "Measurement"));
  add_attributes(node, {{"verdict", std::string(name_of(result.verdict))},
                        {"verification_operator",
                         result.value ? result.value->operator_text() : std::string()},
                        {"stated", result.value ? result.value->sentence() : std::string()},
                        {"combinedUncertainty", uncertainty_words(result)}});
  if (!result.reason.empty()) add(node, "Description", result.reason.english());
  add(add(node, "Status"), "CharacteristicStatusEnum", status_of(result.verdict).of_characteristic);
  add(node, "CharacteristicItemId", placed.item);
  add_references(node, "FeatureMeasurementIds", measured_shapes(placed));
  if (has_reference(asked)) add_algorithm(node, asked.reference);
  if (draft.device) add_references(node, "MeasurementDeviceIds", {*draft.device});
  if (!result.value || !std::isfinite(result.value->value_mm())) return;
  pugi::xml_node value = add(node, "Value", decimal(result.value->quoted_mm()));
  if (const evaluation::UncertaintyStatement* known = result.value->statement()) {
    set(value, "combinedUncertainty", decimal(known->standard_uncertainty_mm));
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
