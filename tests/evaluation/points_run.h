#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// Layers of `points_per_layer` points, 15 mm apart, radius 25 mm, axis near z through (10, -4);
/// two and three lobes, a taper and noise, some 10 um together. The points cover `arc_rad` of the
/// circumference.
[[nodiscard]] std::vector<Eigen::Vector3d> rough_part(std::uint64_t seed, int layers,
                                                      int points_per_layer, double arc_rad);

/// A finished run over such points as a file of known layers: a cylinder, or a circle of one layer.
/// The characteristics cover every form and reference, with a tolerance of 1 mm.
[[nodiscard]] record::RunRecord points_run(const std::vector<Eigen::Vector3d>& points, int layers);

/// Adds a feature of a points file: its layers, the lowest first, with a tip of 1.5 mm radius.
/// Returns it for its characteristics and settings.
record::Feature& add_to_points_run(record::RunRecord& run, const std::string& id,
                                   record::Shape shape,
                                   const std::vector<std::vector<Eigen::Vector3d>>& layers,
                                   record::Side side = record::Side::kOutside);

/// The evaluation of a run; fails the test when there is none.
[[nodiscard]] evaluation::Evaluation evaluated(const record::RunRecord& run);

}  // namespace rondure::reports
