#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/results/finding.h"
#include "reports/data/internal/json_parts.h"
#include "reports/words/internal/facts.h"

namespace rondure::reports {
namespace {

using evaluation::LocalValue;

/// Writes lengths in the unit of their value, which ends the key.
class Lengths {
 public:
  explicit Lengths(core::ValueUnit unit) : unit_(unit) {}

  [[nodiscard]] std::string key(std::string_view name) const {
    return fmt::format("{}_{}", name, name_of(unit_));
  }
  [[nodiscard]] Json number(const std::optional<double>& length_mm) const {
    return unit_ == core::ValueUnit::kMm ? optional_json(length_mm) : optional_um(length_mm);
  }
  [[nodiscard]] Json limit(const std::optional<double>& length_mm) const {
    return optional_json(limit_in(unit_, length_mm));
  }

 private:
  core::ValueUnit unit_;
};

Json judged_json(const evaluation::JudgedValue& value, const Lengths& lengths) {
  return {{"symbol", value.symbol},
          {lengths.key("value"), lengths.number(value.value_mm)},
          {lengths.key("lower_limit"), lengths.limit(value.limits.lower_mm)},
          {lengths.key("upper_limit"), lengths.limit(value.limits.upper_mm)}};
}

Json local_json(const LocalValue& local, const Lengths& lengths) {
  Json json;
  switch (local.place) {
    case LocalValue::Place::kLayer:
      json = {{"layer", local.layer}, {"height_mm", local.position}};
      break;
    case LocalValue::Place::kAngle:
      json = {{"angle_deg", in_deg(local.position)}};
      break;
    case LocalValue::Place::kRadius:
      json = {{"radius_mm", local.position}};
      break;
  }
  const bool known = !local.none;
  json[lengths.key("value")] = known ? lengths.number(local.value_mm) : Json(nullptr);
  if (local.least_mm) json[lengths.key("least")] = lengths.number(local.least_mm);
  if (local.none) json["none"] = error_json(*local.none);
  return json;
}

Json number_json(const evaluation::NamedNumber& number, const Lengths& lengths) {
  if (!number.length) return {{"name", number.name}, {"value", number.value}};
  return {{"name", number.name}, {lengths.key("value"), lengths.number(number.value)}};
}

Json line_json(const evaluation::ProfileLine& line) {
  return {{"angle_deg", in_deg(line.angle_rad)},
          {"position_mm", line.position_mm},
          {"deviation_um", list_json(line.deviation_mm, in_um)}};
}

Json place_json(const fit::Axis& place) {
  return {{"point_mm", vector_json(place.point_mm)}, {"direction", vector_json(place.direction)}};
}

Json datum_json(const evaluation::DatumResult& datum) {
  return {{"name", datum.name},
          {"association", record::name_of(datum.association)},
          {"kind", datum.plane ? "plane" : "axis"},
          {"place", place_json(datum.place)},
          {"radii_mm", datum.radii_mm},
          {"features", datum.features},
          {"length_mm", datum.length_mm},
          {"play_um", in_um(datum.play_mm)},
          {"equalised", datum.equalised ? place_json(*datum.equalised) : Json(nullptr)}};
}

Json left_out_json(const evaluation::LeftOut& left_out) {
  return {{"row", left_out.row},
          {"because", left_out.window.empty() ? "outlier rule" : "window"},
          {"window", left_out.window}};
}

}  // namespace

Json finding_json(const evaluation::Finding& finding, core::ValueUnit unit) {
  const Lengths lengths(unit);
  const bool local = finding.worst < finding.local.size();
  return {
      {"reference", finding.reference},
      {"filter", finding.filter},
      {"judged",
       list_json(finding.judged, [&](const auto& value) { return judged_json(value, lengths); })},
      {"local",
       list_json(finding.local, [&](const auto& value) { return local_json(value, lengths); })},
      {"worst", local ? Json(finding.worst) : Json(nullptr)},
      {"numbers", list_json(finding.numbers,
                            [&](const auto& number) { return number_json(number, lengths); })},
      {"datums", list_json(finding.datums, datum_json)},
      {lengths.key("about_equalised"),
       list_json(finding.about_equalised_mm,
                 [&](double value_mm) { return lengths.number(value_mm); })},
      {"left_out", list_json(finding.left_out, left_out_json)},
      {"rows", finding.rows},
      {"centers_mm", list_json(finding.centers_mm,
                               [](const Eigen::Vector3d& center) { return vector_json(center); })},
      {"lines", list_json(finding.lines, line_json)},
      {"warnings", list_json(finding.warnings, error_json)}};
}

}  // namespace rondure::reports
