#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/noise.h"
#include "evaluation/results/evaluation.h"
#include "plans/plan.h"
#include "plans/run_options.h"
#include "record/run_record.h"

namespace rondure::test {

/// A random number from low to high.
inline double between(core::KeyedNoise& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// A plan with a random part of method specification section 12.1: form 5 to 20 um of lobes 2, 3,
/// 4, 5, 7 with twist, taper, barrel and bend; tilt to 20 deg; 4 x 7 points; probe noise off.
[[nodiscard]] plans::Plan random_plan(std::uint64_t seed, const std::string& strategy,
                                      double resolution_deg);

/// What the program makes of a calibration for the features after it.
[[nodiscard]] plans::FoundCalibration calibrated(const record::RunRecord& so_far, int feature);

/// The record and evaluation of a run, from its journal.
struct Inspection {
  record::RunRecord record;
  evaluation::Evaluation evaluation;
};

/// Runs the plan in a temporary directory, which is removed. Fails the test when the run fails.
[[nodiscard]] Inspection inspect(const plans::Plan& plan);

/// Tip centres of the final cloud.
[[nodiscard]] std::vector<Eigen::Vector3d> final_cloud(const record::RunRecord& record);

/// Least zone of many directions of the axis: a pattern search with random directions, which starts
/// from `near` and takes the program's plane centre search (fit/zone/center_search.h) in each. It
/// shares nothing with the search in space, but begins where that ended: it shows that no neighbour
/// is better, not that the zone is the least of all (tests/fit/oracles does). Never below the true
/// minimum.
[[nodiscard]] double searched_zone_mm(const std::vector<Eigen::Vector3d>& points,
                                      const Eigen::Vector3d& near, std::uint64_t seed);

}  // namespace rondure::test
