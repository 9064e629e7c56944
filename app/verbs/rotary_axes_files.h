#pragma once

#include <string>
#include <vector>

#include "app/verbs/rotary_axes_command.h"
#include "core/result.h"
#include "fit/rotary/axes.h"

namespace rondure::app {

/// One axis of the files.
struct NamedAxis {
  std::string name;
  fit::RotaryMeasurement measurement;
};

/// Reads the files and sorts their rows by axis and station, in the order of measurement. A ball
/// that recurs in the reference pose starts its next measurement.
/// @return The errors of parse_ball_csv(); kBadOption when the direction of an axis is unknown, is
/// not three numbers, or is given for several axes.
[[nodiscard]] core::Result<std::vector<NamedAxis>> read_rotary_axes(
    const RotaryAxesArguments& arguments);

}  // namespace rondure::app
