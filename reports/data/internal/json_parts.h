#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"

namespace rondure::evaluation {
struct FiveAxisResult;
struct RotaryResult;
}  // namespace rondure::evaluation

namespace rondure::reports {

using Json = nlohmann::ordered_json;

/// The one place where lengths become micrometres and angles degrees.
[[nodiscard]] inline double in_um(double length_mm) { return length_mm * 1000.0; }
[[nodiscard]] inline double in_deg(double angle_rad) { return core::stated_degrees(angle_rad); }

[[nodiscard]] inline Json vector_json(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}
[[nodiscard]] inline Json vector_json(const Eigen::Vector2d& v) {
  return Json::array({v.x(), v.y()});
}
[[nodiscard]] inline Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}
[[nodiscard]] inline Json optional_um(const std::optional<double>& length_mm) {
  return length_mm ? Json(in_um(*length_mm)) : Json(nullptr);
}
[[nodiscard]] inline Json error_json(const core::Error& error) {
  return {{"code", core::code_name(error.code)}, {"what", error.what}, {"where", error.where}};
}
[[nodiscard]] inline Json optional_json(const std::optional<core::Error>& error) {
  return error ? error_json(*error) : Json(nullptr);
}
/// What depends on the evaluation alone: "probe" and "features", without the rows of clouds, of
/// which there may be millions.
[[nodiscard]] Json results_json(const evaluation::Evaluation& evaluation);
/// The characteristics of a feature.
[[nodiscard]] Json characteristics_json(const evaluation::FeatureResult& feature);
/// The conditions that were checked, passed or not.
[[nodiscard]] Json gates_json(const std::vector<evaluation::Gate>& gates);
/// How a value came about.
/// @param unit  Of the value: of all its lengths but places.
[[nodiscard]] Json finding_json(const evaluation::Finding& finding, core::ValueUnit unit);
/// JSON of a feature whose shape is an analysis.
[[nodiscard]] Json analysis_json(const evaluation::FeatureResult& feature);
[[nodiscard]] Json rotary_json(const evaluation::RotaryResult& facts);
[[nodiscard]] Json five_axis_json(const evaluation::FiveAxisResult& facts);
/// The decision rule of a run with its parameters and statements; null for an unknown rule.
[[nodiscard]] Json rule_json(const evaluation::Evaluation& evaluation);

template <class Range, class Convert>
[[nodiscard]] Json list_json(const Range& range, const Convert& convert) {
  Json list = Json::array();
  for (const auto& item : range) list.push_back(convert(item));
  return list;
}

}  // namespace rondure::reports
