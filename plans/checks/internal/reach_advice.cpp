#include "plans/checks/internal/reach_advice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {
namespace {

constexpr int kMostTried = 500;    // targets
constexpr double kMargins = 40.0;  // most margins that are tried
constexpr double kLongest_mm = 300.0;
constexpr double kLengthStep_mm = 5.0;

bool reaches_all(const Plan& plan, const FeaturePlan& feature, const core::Pose& pose) {
  constexpr std::size_t kNoDetours = 0;  // hundreds of poses are tried
  return unreachable_targets(plan, feature, pose, kNoDetours).empty();
}

/// The pose closest to the start on a grid of 15 deg that reaches all targets.
std::optional<core::Pose> other_pose(const Plan& plan, const FeaturePlan& feature) {
  const fixture::FixtureLimits limits = limits_of(*plan.fixture);
  const core::Pose start = start_pose(feature);
  const auto turn = [&](const core::Pose& p) {
    return std::hypot(p.alpha_rad - start.alpha_rad, p.beta_rad - start.beta_rad);
  };
  std::vector<core::Pose> poses;
  for (int a = -6; a <= 6; ++a) {
    for (int b = -6; b <= 6; ++b) {
      const core::Pose pose{a * 15.0 * core::kDegree, b * 15.0 * core::kDegree};
      const bool within =
          pose.alpha_rad >= limits.min_alpha_rad && pose.alpha_rad <= limits.max_alpha_rad &&
          pose.beta_rad >= limits.min_beta_rad && pose.beta_rad <= limits.max_beta_rad;
      if (within && turn(pose) > 1e-9) poses.push_back(pose);
    }
  }
  std::stable_sort(poses.begin(), poses.end(), [&](const core::Pose& a, const core::Pose& b) {
    return turn(a) < turn(b) - 1e-9;
  });
  for (const core::Pose& pose : poses) {
    if (turn(pose) <= 46.0 * core::kDegree && reaches_all(plan, feature, pose)) return pose;
  }
  return std::nullopt;
}

/// The shortest stylus, in steps of 5 mm, that reaches all targets.
std::optional<double> longer_stylus(const Plan& plan, const FeaturePlan& feature) {
  if (plan.probe->stylus_length_mm <= 0.0 || plan.probe->holder_diameter_mm <= 0.0) return {};
  Plan other = plan;
  double& length_mm = other.probe->stylus_length_mm;
  length_mm = kLengthStep_mm * (std::floor(length_mm / kLengthStep_mm) + 1.0);
  for (; length_mm <= kLongest_mm; length_mm += kLengthStep_mm) {
    if (reaches_all(other, feature, start_pose(feature))) return length_mm;
  }
  return std::nullopt;
}

/// The smallest margin, in steps of 1 mm (more on a long surface), that reaches all targets.
std::optional<double> larger_margin(const Plan& plan, const FeaturePlan& feature) {
  if (feature.type == record::Shape::kCircle) return std::nullopt;
  FeaturePlan other = feature;
  const double half_mm = 0.5 * layered_mm(feature);
  double& margin_mm = other.sampling.margin_mm;
  const double step_mm = std::ceil(half_mm / kMargins);
  margin_mm = step_mm * (std::floor(margin_mm / step_mm) + 1.0);
  for (; margin_mm < half_mm; margin_mm += step_mm) {
    if (reaches_all(plan, other, start_pose(feature))) return margin_mm;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Unreachable> unreachable_targets(const Plan& plan, const FeaturePlan& feature,
                                             const core::Pose& pose, std::size_t detour_moves) {
  const auto targets = sampling_targets(feature);
  if (!targets) return {};
  const PathGeometry geometry = path_geometry(plan, feature, plan.part.location_uncertainty_mm);
  const Eigen::Isometry3d X_WN = fixture::body_to_machine(nominal_kinematics(*plan.fixture), pose) *
                                 nominal_seat(*plan.fixture);
  const Scene scene(plan, feature);
  std::vector<std::size_t> own(targets->size());
  std::iota(own.begin(), own.end(), std::size_t{0});
  return CloudPath(scene, {X_WN, X_WN}, geometry, plan.machine->park_mm[2], *targets, own,
                   detour_moves)
      .unreachable();
}

std::string reach_advice(const Plan& plan, const FeaturePlan& feature) {
  const int layers = feature.type == record::Shape::kCircle ? 1 : feature.sampling.layers;
  std::vector<std::string> ways;
  if (layers * feature.sampling.points_per_layer <= kMostTried) {
    if (const auto pose = other_pose(plan, feature)) {
      ways.push_back(fmt::format("turn it to ({:g}, {:g}) deg (start_alpha_deg, start_beta_deg)",
                                 pose->alpha_rad / core::kDegree, pose->beta_rad / core::kDegree));
    }
    if (const auto length_mm = longer_stylus(plan, feature)) {
      ways.push_back(fmt::format("take a stylus of {:g} mm (stylus_length_mm)", *length_mm));
    }
    if (const auto margin_mm = larger_margin(plan, feature)) {
      ways.push_back(fmt::format("give a margin of {:g} mm (margin_mm)", *margin_mm));
    }
  }
  if (ways.empty() && is_fixed(plan))
    return "no stylus or margin that was tried reaches it; stand the part nearer to machine z "
           "(part.axis)";
  if (ways.empty()) return "no other pose, stylus or margin that was tried reaches it";
  std::string out = "to reach all of them: " + ways.front();
  for (std::size_t i = 1; i < ways.size(); ++i) out += ", or " + ways[i];
  return out;
}

}  // namespace rondure::plans
