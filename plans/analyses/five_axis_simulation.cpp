#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/noise.h"
#include "core/numbers.h"
#include "core/units.h"
#include "fit/rotary/head.h"
#include "plans/analyses/internal/kinds.h"

namespace rondure::plans {
namespace {

using core::kDegree;
using core::kMicrometre;
using core::kMicroradian;
using Eigen::Vector3d;
using fit::HeadPose;
using fit::HeadStep;
using record::FiveAxisTask;

constexpr std::uint64_t kNestStream = 0x5ea7u;
constexpr double kCurveStep_deg = 2.5;
constexpr double kLeastU_mm = 1e-5;  // of readings without noise, which still have digits

fit::RotaryErrors errors_of(const fit::Vector6& values) {
  fit::RotaryErrors out;
  out.t_mm = values.head<3>();
  out.w_rad = values.tail<3>();
  return out;
}

/// The true errors of one axis: those of its location, and its motion.
fit::Vector6 true_errors(const SimulatedFiveAxisPlan& hidden, bool of_c, double angle_rad) {
  const HeadLocationPlan& l = hidden.location;
  const Eigen::Matrix3d away = Eigen::Matrix3d::Identity() -
                               (of_c ? fit::head_axis_c() : fit::head_axis_a()).turn(angle_rad);
  fit::Vector6 out;
  out.head<3>() = kMicrometre * (away * (of_c ? Vector3d(l.XOC_um, l.YOC_um, 0.0)
                                              : Vector3d(0.0, l.YOA_um, l.ZOA_um)));
  out.tail<3>() = kMicroradian * (away * (of_c ? Vector3d(l.AOC_urad, l.BOC_urad, 0.0)
                                               : Vector3d(0.0, l.BOA_urad, l.COA_urad)));
  constexpr std::string_view kNames = "XYZABC";
  for (const HeadMotionPlan& one : hidden.errors) {
    if ((one.error[2] == 'C') != of_c) continue;
    const auto place = kNames.find(one.error[1]);
    const double size =
        place < 3 ? one.amplitude_um * kMicrometre : one.amplitude_urad * kMicroradian;
    const double phase = one.phase_deg * kDegree;
    out(static_cast<Eigen::Index>(place)) +=
        size * (std::cos(one.order * angle_rad - phase) - std::cos(phase));
  }
  return out;
}

/// A table as a control holds it.
struct LoadedTable {
  std::vector<fit::HeadTableRow> c;
  std::vector<fit::HeadTableRow> a;
};

/// The head and its control.
struct HeadWorld {
  const FiveAxisTask& asked;
  const SimulatedFiveAxisPlan& hidden;
  std::optional<LoadedTable> table = std::nullopt;

  /// Deviation of a ball that the control holds at its place.
  [[nodiscard]] Vector3d deviation_mm(const HeadPose& pose, const Vector3d& ball) const {
    const Vector3d target = Vector3d::Map(asked.target_mm.data());
    HeadPose real = pose;
    fit::RotaryErrors known_c;
    fit::RotaryErrors known_a;
    if (table) {  // the turns by the axes themselves, then the rest by the slides
      real.c_rad -= fit::table_error(table->c, pose.c_rad).w_rad.z();
      real.a_rad -= fit::table_error(table->a, pose.a_rad).w_rad.x();
      known_c = fit::table_error(table->c, real.c_rad);
      known_a = fit::table_error(table->a, real.a_rad);
    }
    const Vector3d pivot = target - fit::head_motion(real, known_c, known_a) * ball;
    const Vector3d slides(-hidden.xy_squareness_urad * kMicroradian * pivot.y(), 0.0, 0.0);
    fit::Vector6 c = true_errors(hidden, true, real.c_rad);
    c(3) += hidden.sag_urad * kMicroradian * std::sin(real.a_rad) * std::sin(real.c_rad);
    const auto motion =
        fit::head_motion(real, errors_of(c), errors_of(true_errors(hidden, false, real.a_rad)));
    return pivot + slides + motion * ball - target;
  }
};

/// The poses of one ball, in the order in which they are read.
std::vector<std::pair<HeadStep, HeadPose>> poses_of(const FiveAxisTask& asked) {
  std::vector<std::pair<HeadStep, HeadPose>> out;
  const auto add = [&](HeadStep step, double c_deg, double a_deg) {
    out.push_back({step, {c_deg, a_deg}});
  };
  const int between = std::min(2, asked.references - 2);
  for (int i = 0; i < asked.references - 1 - between; ++i) add(HeadStep::kReference, 0.0, 0.0);
  for (const double c : asked.c_stations_deg) add(HeadStep::kC, c, 0.0);
  if (between > 0) add(HeadStep::kReference, 0.0, 0.0);
  for (const double a : asked.a_stations_deg) add(HeadStep::kA, 0.0, a);
  if (between > 1) add(HeadStep::kReference, 0.0, 0.0);
  for (const auto& pose : asked.verification) add(HeadStep::kVerification, pose.c_deg, pose.a_deg);
  add(HeadStep::kReference, 0.0, 0.0);
  return out;
}

/// What the nest reads, with or without its noise. The angles of `out` are those of the control.
fit::HeadMeasurement readings_of(const HeadWorld& world, std::size_t index, std::uint64_t seed,
                                 bool noisy) {
  const FiveAxisTask& asked = world.asked;
  const auto poses = poses_of(asked);
  const auto last = static_cast<double>(poses.size() * asked.balls.size() - 1);
  fit::HeadMeasurement out;
  out.u_mm = std::max(kLeastU_mm, world.hidden.noise_um * kMicrometre);
  for (std::size_t k = 0; k < asked.balls.size(); ++k) {
    const Vector3d ball = Vector3d::Map(asked.balls[k].place_mm().data());
    out.balls.push_back({asked.balls[k].id, ball, Vector3d::Zero()});
    for (const auto& [step, at] : poses) {
      const std::size_t number = out.readings.size();
      const HeadPose pose = {asked.c_sign() * at.c_rad * kDegree,
                             asked.a_sign() * at.a_rad * kDegree};
      Vector3d d = world.deviation_mm(pose, ball);
      if (noisy) {
        core::KeyedNoise noise(seed, {kNestStream, index, number});
        for (double& one : d) one += world.hidden.noise_um * kMicrometre * noise.normal();
        d.x() += world.hidden.drift_um * kMicrometre * static_cast<double>(number) / last;
      }
      out.readings.push_back({step, pose, k, d});
    }
  }
  return out;
}

record::Series data_of(const fit::HeadMeasurement& read, const FiveAxisTask& asked, int feature) {
  record::Series out;
  out.feature = feature;
  out.columns = {{"step", ""},    {"c_deg", "deg"}, {"a_deg", "deg"}, {"setup", ""},
                 {"dx_um", "um"}, {"dy_um", "um"},  {"dz_um", "um"}};
  for (const fit::HeadReading& r : read.readings) {
    out.values.insert(
        out.values.end(),
        {static_cast<double>(r.step), asked.c_sign() * core::stated_degrees(r.pose.c_rad),
         asked.a_sign() * core::stated_degrees(r.pose.a_rad), static_cast<double>(r.ball + 1),
         r.d_mm.x() / kMicrometre, r.d_mm.y() / kMicrometre, r.d_mm.z() / kMicrometre});
  }
  return out;
}

/// The true errors of one axis over its stations, for the charts.
record::Series curve_of(const SimulatedFiveAxisPlan& hidden, bool of_c,
                        const std::vector<double>& stations_deg, double sense, int feature) {
  record::Series out;
  out.feature = feature;
  out.name = of_c ? "c" : "a";
  out.role = record::Series::Role::kTruth;
  out.columns = {{"angle_deg", "deg"},   {"shift_x_um", "um"},    {"shift_y_um", "um"},
                 {"shift_z_um", "um"},   {"tilt_x_urad", "urad"}, {"tilt_y_urad", "urad"},
                 {"tilt_z_urad", "urad"}};
  const auto [low, high] = std::ranges::minmax(stations_deg);
  const double from = std::min(0.0, low);
  const double arc = std::max(0.0, high) - from;
  const int steps = std::max(1, static_cast<int>(std::ceil(arc / kCurveStep_deg)));
  for (int i = 0; i <= steps; ++i) {
    const double deg = from + arc * i / steps;
    const fit::Vector6 errors = true_errors(hidden, of_c, sense * deg * kDegree);
    out.values.push_back(deg);
    for (Eigen::Index k = 0; k < 6; ++k) {
      out.values.push_back(errors(k) / (k < 3 ? kMicrometre : kMicroradian));
    }
  }
  return out;
}

/// The table that an earlier feature gives, with the errors of its readings.
core::Result<LoadedTable> table_of(const Plan& plan, const std::string& id, std::uint64_t seed) {
  const auto found = std::ranges::find(plan.features, id, &FeaturePlan::id);
  const auto index = static_cast<std::size_t>(found - plan.features.begin());
  const FiveAxisTask& asked = *found->five_axis;
  const HeadWorld world{asked, *plan.simulation->five_axis};
  TRY(const auto study, fit::identify_head(readings_of(world, index, seed, true)));
  LoadedTable out;
  TRY(out.c, fit::head_table(study, study.c, asked.compensation.c_step_deg * kDegree));
  TRY(out.a, fit::head_table(study, study.a, asked.compensation.a_step_deg * kDegree));
  fit::round_table(asked.compensation.resolution_um * kMicrometre,
                   asked.compensation.resolution_urad * kMicroradian, out.c);
  fit::round_table(asked.compensation.resolution_um * kMicrometre,
                   asked.compensation.resolution_urad * kMicroradian, out.a);
  return out;
}

}  // namespace

core::Result<AnalysisData> simulate_five_axis(const Plan& plan, std::size_t index,
                                              std::uint64_t seed, bool errors) {
  const FiveAxisTask& asked = *plan.features[index].five_axis;
  HeadWorld world{asked, *plan.simulation->five_axis};
  if (asked.repeat) {
    TRY(world.table, table_of(plan, asked.repeat->with.feature, seed));
  }
  const auto feature = static_cast<int>(index);
  AnalysisData out;
  out.series.push_back(data_of(readings_of(world, index, seed, errors), asked, feature));
  if (asked.repeat) return out;  // its errors are those that the table left
  out.series.push_back(curve_of(world.hidden, true, asked.c_stations_deg, asked.c_sign(), feature));
  out.series.push_back(
      curve_of(world.hidden, false, asked.a_stations_deg, asked.a_sign(), feature));
  return out;
}

}  // namespace rondure::plans
