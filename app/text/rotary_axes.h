#pragma once

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "fit/rotary/axes.h"
#include "fit/rotary/model.h"

namespace rondure::app {

/// Results of `rondure fit rotary-axes` for one axis.
struct RotaryFacts {
  std::string name;
  std::string method;
  fit::RotaryStudy study;
  std::optional<fit::RotaryModel> model;  ///< Absent with too few stations; a warning says so.
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();  ///< Point whose uncertainty is stated.
};

/// As JSON (docs/rotary-axes.md), and as a table within 80 columns.
[[nodiscard]] nlohmann::ordered_json rotary_axes_json(std::span<const RotaryFacts> axes);
[[nodiscard]] std::string rotary_axes_table(std::span<const RotaryFacts> axes);

}  // namespace rondure::app
