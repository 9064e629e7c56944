#include "evaluation/results/feature_values.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "record/tasks/form_facts.h"

namespace rondure::evaluation {
namespace {

std::vector<fit::Contact> in_rows(const std::vector<fit::Contact>& contacts,
                                  const std::vector<std::size_t>& rows) {
  std::vector<fit::Contact> result;
  for (const fit::Contact& contact : contacts) {
    if (contact.index < rows.size()) result.push_back({rows[contact.index], contact.multiplier});
  }
  return result;
}

/// Zone of a fit that has radii and contacts, for any shape.
template <class Fit>
Zone zone_from(const Fit& fit, const FeatureResult& feature) {
  const double offset_mm = surface_offset_mm(feature);
  Zone zone;
  zone.deviation_mm = fit.width_mm();
  zone.inner_radius_mm = fit.inner_radius_mm + offset_mm;
  zone.outer_radius_mm = fit.outer_radius_mm + offset_mm;
  zone.mean_radius_mm = 0.5 * (zone.inner_radius_mm + zone.outer_radius_mm);
  zone.of_surface = feature.tip_radius_mm.has_value();
  zone.outer = fit.outer;
  zone.inner = fit.inner;
  zone.certificate = fit.certificate;
  return zone;
}

template <class Fit>
OneSided one_sided_from(const Fit& fit, const FeatureResult& feature) {
  return {fit.deviation_mm, fit.radius_mm + surface_offset_mm(feature), fit.contacts,
          fit.certificate, std::nullopt};
}

/// "MZ", "LS", "MC", "MI".
std::string acronym(record::Reference reference) {
  std::string text;
  for (const char c : record::name_of(reference)) text += static_cast<char>(c - 'a' + 'A');
  return text;
}

}  // namespace

std::optional<Zone> zone_of(const FeatureResult& feature) {
  if (feature.mz_cylinder) return zone_from(*feature.mz_cylinder, feature);
  if (feature.feature.shape != record::Shape::kCircle || feature.layers.empty()) return {};
  const LayerResult& section = feature.layers.front();
  if (!section.mz) return {};
  Zone zone = zone_from(*section.mz, feature);
  zone.outer = in_rows(zone.outer, section.rows);
  zone.inner = in_rows(zone.inner, section.rows);
  return zone;
}

double surface_offset_mm(const FeatureResult& feature) {
  if (!feature.tip_radius_mm) return 0.0;
  const bool outside = feature.feature.side == record::Side::kOutside;
  return outside ? -*feature.tip_radius_mm : *feature.tip_radius_mm;
}

std::optional<LeastSquares> least_squares_of(const FeatureResult& feature) {
  const double offset_mm = surface_offset_mm(feature);
  if (feature.ls_cylinder) {
    const fit::LsCylinder& ls = *feature.ls_cylinder;
    return LeastSquares{ls.deviation_mm, ls.radius_mm + offset_mm, ls.rms_mm};
  }
  if (feature.feature.shape != record::Shape::kCircle || feature.layers.empty()) return {};
  const auto& ls = feature.layers.front().ls;
  if (!ls) return {};
  return LeastSquares{ls->deviation_mm, ls->radius_mm + offset_mm, ls->rms_mm};
}

core::Result<OneSided> one_sided_of(const FeatureResult& feature, record::Reference reference) {
  const bool outside = reference == record::Reference::kMinimumCircumscribed;
  if (!outside && reference != record::Reference::kMaximumInscribed) return not_fitted();
  if (record::is_analysis(feature.feature.shape)) return not_fitted();
  if (feature.feature.shape != record::Shape::kCircle) {
    const auto& cylinder = outside ? feature.mc_cylinder : feature.mi_cylinder;
    if (!cylinder) return core::fail(cylinder.error());
    return one_sided_from(*cylinder, feature);
  }
  if (feature.layers.empty()) return not_fitted();
  const LayerResult& section = feature.layers.front();
  const auto& circle = outside ? section.mc : section.mi;
  if (!circle) return core::fail(circle.error());
  OneSided out = one_sided_from(*circle, feature);
  out.range = circle->range;
  out.contacts = in_rows(out.contacts, section.rows);
  return out;
}

const char* words_of(record::Reference reference, record::Shape shape) {
  const bool circle = shape == record::Shape::kCircle;
  switch (reference) {
    case record::Reference::kLeastSquares:
      return circle ? "least-squares circle" : "least-squares cylinder";
    case record::Reference::kMinimumZone:
      return "minimum zone";
    case record::Reference::kMinimumCircumscribed:
      return circle ? "minimum circumscribed circle" : "minimum circumscribed cylinder";
    case record::Reference::kMaximumInscribed:
      return circle ? "maximum inscribed circle" : "maximum inscribed cylinder";
  }
  return "";
}

std::string_view symbol_of(record::Shape shape) {
  return record::facts_of(shape == record::Shape::kCircle ? record::Form::kRoundness
                                                          : record::Form::kCylindricity)
      .symbol;
}

std::string symbol_of(const record::Characteristic& characteristic) {
  using record::Form;
  using Indication = record::Indication;
  const Indication& asked = characteristic.indication;
  std::string symbol(record::facts_of(characteristic.form).symbol);
  if (characteristic.form == Form::kDiameter) {
    if (asked.requirement == Indication::Requirement::kEnvelope) return symbol + " E";
    symbol += fmt::format(" {}", record::name_of(asked.size));
    if (asked.rank) symbol += fmt::format(" {}", record::name_of(*asked.rank));
  }
  if (characteristic.form == Form::kAxisError && asked.axis && asked.error) {
    constexpr std::array kAxes = {"\u03b1", "\u03b2", "C", "A"};
    return fmt::format("{} {}", record::name_of(*asked.error),
                       kAxes[static_cast<std::size_t>(*asked.axis)]);
  }
  if (characteristic.form == Form::kLocation && asked.error) {
    return std::string(record::name_of(*asked.error));
  }
  if (asked.section != Indication::Section::kAll) {
    symbol += fmt::format(" {}", record::name_of(asked.section));
  }
  if (asked.of == Indication::Of::kMedianLine) return "STRt median line";
  if (!asked.datum.empty()) {  // that of a wheel has no datum and is radial
    constexpr std::array kRunOut = {"Run-out radial", "Run-out axial", "Run-out conical"};
    constexpr std::array kTotal = {"Total run-out radial", "Total run-out axial",
                                   "Total run-out conical"};
    const auto direction = static_cast<std::size_t>(asked.direction);
    if (characteristic.form == Form::kRunOut) return kRunOut[direction];
    if (characteristic.form == Form::kTotalRunOut) return kTotal[direction];
  }
  if (record::takes(characteristic.form, "parameter")) {
    constexpr std::array kLetters = {'t', 'p', 'v', 'q'};
    symbol[symbol.find('t')] = kLetters[static_cast<std::size_t>(asked.parameter)];
  }
  return symbol;
}

std::string reference_of(const record::Characteristic& characteristic) {
  using record::Form;
  if (characteristic.form == Form::kRoundnessRms) return "LSCI";
  if (characteristic.form == Form::kStraightness) return acronym(characteristic.reference) + "LI";
  if (characteristic.form == Form::kFlatness) return acronym(characteristic.reference) + "PL";
  const auto& about = record::facts_of(characteristic.form).about;
  return about ? reference_of(characteristic.reference, *about) : std::string();
}

std::string reference_of(record::Reference reference, record::Shape shape) {
  if (shape == record::Shape::kPlane) return acronym(reference) + "PL";
  return acronym(reference) + (shape == record::Shape::kCylinder ? "CY" : "CI");
}

core::ValueUnit unit_of(const record::Characteristic& characteristic) {
  if (record::is_angle(characteristic.form, characteristic.indication)) {
    return core::ValueUnit::kUrad;
  }
  const bool size = record::limits_of(characteristic.form, characteristic.indication.rank) ==
                    record::LimitKind::kSize;
  return size ? core::ValueUnit::kMm : core::ValueUnit::kUm;
}

std::optional<FeatureResult> outside_windows(const FeatureResult& feature) {
  if (std::ranges::none_of(feature.cloud, &CloudPoint::left_out)) return std::nullopt;
  FeatureResult out = feature;
  out.cloud.clear();
  std::vector<std::size_t> place(feature.cloud.size());  // in the shorter cloud, by row
  for (std::size_t row = 0; row < feature.cloud.size(); ++row) {
    place[row] = out.cloud.size();
    if (!feature.cloud[row].left_out) out.cloud.push_back(feature.cloud[row]);
  }
  const auto renumber = [&](std::vector<fit::Contact>& contacts) {
    for (fit::Contact& contact : contacts) contact.index = place[contact.index];
  };
  if (out.mz_cylinder) {
    renumber(out.mz_cylinder->outer);
    renumber(out.mz_cylinder->inner);
  }
  for (auto* const fit : {&out.mc_cylinder, &out.mi_cylinder}) {
    if (*fit) renumber((*fit)->contacts);
  }
  if (out.mz_plane) {
    renumber(out.mz_plane->top);
    renumber(out.mz_plane->bottom);
  }
  if (out.mz_cone) {
    renumber(out.mz_cone->outer);
    renumber(out.mz_cone->inner);
  }
  if (out.mz_sphere) {
    renumber(out.mz_sphere->outer);
    renumber(out.mz_sphere->inner);
  }
  for (LayerResult& layer : out.layers) {
    for (std::size_t& row : layer.rows) row = place[row];
  }
  return out;
}

const PoseValue* final_pose_of(const FeatureResult& feature) {
  const auto found = std::find_if(feature.poses.begin(), feature.poses.end(),
                                  [](const PoseValue& pose) { return pose.final_pose; });
  return found == feature.poses.end() ? nullptr : &*found;
}

}  // namespace rondure::evaluation
