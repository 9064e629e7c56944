#pragma once

#include <string>

#include "core/result.h"
#include "evaluation/wheel/result.h"

namespace rondure::evaluation {

/// The spindle axis that a wheel at speed shows: the centre of the circle it sweeps, by least
/// squares.
/// @param id  Of its feature.
/// @return  The axis; or why the feature gives none: points of its body, another centre, points
///          that do not fix it or whose residuals on an arc are form.
[[nodiscard]] core::Result<MeasuredAxis> measured_axis(const WheelResult& swept,
                                                       const std::string& id);

}  // namespace rondure::evaluation
