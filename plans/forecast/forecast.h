#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/pose.h"
#include "core/result.h"
#include "plans/path/sampling.h"
#include "plans/path/scene.h"
#include "plans/path/travel.h"
#include "plans/plan.h"
#include "record/run_record.h"

namespace rondure::plans {

/// A touch of a cloud, or a point of a scan.
struct ForecastTouch {
  Target target;
  Eigen::Vector3d tip_W_mm = {0.0, 0.0, 0.0};  ///< Tip at the expected contact.
  double time_s = 0.0;                         ///< Time from the first move of its stage.
};

/// One stage of a run: the touches of the reference sphere, of the spheres on the base of the
/// fixture or on its ring, or a cloud in a pose.
struct ForecastStage {
  enum class Kind { kQualification, kBase, kRing, kLocation, kCloud };
  Kind kind = Kind::kCloud;
  int feature = -1;          ///< Index; -1 for spheres.
  core::Pose pose;           ///< Pose as the fixture would read it.
  bool final_cloud = false;  ///< Its touches would be evaluated.
  int times = 1;             ///< Number of times that the cloud is touched.
  int touches = 0;           ///< Touches per time.
  /// Path length over all times: moves, and the strokes of the touches in both directions.
  double path_mm = 0.0;
  double time_s = 0.0;  ///< Total over all times.
  Polyline moves_W;     ///< Ends of the moves of the first time, in order.
  Polyline contacts_W;  ///< Tip centres at the expected contacts, in the order of touching.
  /// For a cloud: touches of the first time, in the order of touching.
  std::vector<ForecastTouch> measured;
  Placement placement;  ///< For a cloud.
};

/// Forecast of a run whose part, fixture and probe are as stated in the plan.
struct Forecast {
  std::vector<ForecastStage> stages;
  int touches = 0;
  int poses = 0;  ///< Number of turns of the fixture.
  double path_mm = 0.0;
  double time_s = 0.0;  ///< By the machine clock, without turns of the fixture.
  Questions questions;  ///< Of its paths: the same in every forecast of this plan.
};

/// Simulates the steps of a run, with the same pose search and the same planner, on a part without
/// form error at its nominal place. Nothing moves, nothing is written. A real part is displaced:
/// `guided` then needs one or two more poses, each with one more cloud.
/// @return  kUnreachable or kSampling with the pointer of the feature; a forecast without stages
///          for a plan whose points all come from files.
[[nodiscard]] core::Result<Forecast> forecast(const Plan& plan);

/// The record of a run whose part, fixture and probe are as stated in the plan: settings, features,
/// the touches of the qualification, and those of the final clouds with their repeats, positions
/// and times. The touches have no errors, and the part is at 20 degC. Omitted are touches that
/// enter no result (location, search) and header fields known only to a run.
/// @param forecast  Forecast of this plan.
[[nodiscard]] record::RunRecord expected_record(const Plan& plan, const Forecast& forecast);

/// Seed of the simulated readings of a forecast: another than that of the plan, whose run therefore
/// sees other noise.
[[nodiscard]] std::uint64_t forecast_seed(const Plan& plan);

/// The same record with the series of all analyses, simulated as in a run with `seed`, or read from
/// their files.
/// @return  The record; errors of files and tables name their place.
[[nodiscard]] core::Result<record::RunRecord> with_series(record::RunRecord expected,
                                                          const Plan& plan, std::uint64_t seed);

}  // namespace rondure::plans
