#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "fit/least_squares/probe_tip.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// A sphere on the table or on the fixture.
struct SphereToTouch {
  Eigen::Vector3d center_W_mm = Eigen::Vector3d::Zero();  ///< Nominal centre.
  double radius_mm = 0.0;
  int points = 13;
  /// Largest offset; approach and search are longer by this distance.
  double uncertainty_mm = 0.0;
  /// Purpose of its touches.
  record::Touch::Purpose purpose = record::Touch::Purpose::kQualification;
  int layer = 0;  ///< Layer of its touches: the number of the sphere.
};

/// Steps that touch a sphere: from park height down to its pole, then around it. kSampling when
/// there are too few or too many points.
[[nodiscard]] core::Result<std::vector<TouchStep>> sphere_steps(const Plan& plan,
                                                                const SphereToTouch& sphere);

/// An upright column, dowel or bolt head, or a hole.
struct RoundToTouch {
  Eigen::Vector3d foot_W_mm = Eigen::Vector3d::Zero();  ///< A point of its axis.
  double radius_mm = 0.0;
  bool inside = false;             ///< true: a hole, touched from its axis.
  std::vector<double> heights_mm;  ///< From the foot, falling.
  int points = 8;                  ///< Of each height.
  double uncertainty_mm = 0.0;     ///< As of a sphere.
  record::Touch::Purpose purpose = record::Touch::Purpose::kQualification;
  int layer = -1;  ///< Layer of its touches; -1: one a height, counted from the lowest.
};

/// Steps from park height down to the upper height and around, then the same at the next one.
/// Around a column they keep to a polygon at the distance of the pre-touch points.
/// @pre A hole has room for the ball.
[[nodiscard]] std::vector<TouchStep> round_steps(const Plan& plan, const RoundToTouch& round);

/// Checks that the tool is clear of all known obstacles, other spheres among them, on its path to
/// and around a sphere.
/// @param feature    The feature in the clamping ring meanwhile.
/// @param X_WB       The clamping ring (body frame) in the machine.
/// @param center_mm  Centre of the sphere, as it stands in `plan`.
/// @param off_mm     Largest distance of ring and part from their place.
/// @param name       Name of the sphere, for messages.
/// @return kUnreachable with the point and the obstacle.
[[nodiscard]] core::Result<void> check_sphere_steps(const Plan& plan, const FeaturePlan& feature,
                                                    const Eigen::Isometry3d& X_WB,
                                                    const std::array<double, 3>& center_mm,
                                                    double off_mm,
                                                    const std::vector<TouchStep>& steps,
                                                    const std::string& name);

/// Makes the touches of one sphere and rises. Returns the tip centres.
/// @param name  Name of the sphere, for messages.
[[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> touch_sphere_steps(
    RunContext& context, const std::vector<TouchStep>& steps, const std::string& name);

/// Touches several spheres, one after the other; the steps of one sphere have the same `row.layer`.
/// Returns one list of tip centres per sphere, in the order of the steps.
/// @param name  Name of one of them by its number from 0, for messages.
[[nodiscard]] core::Result<std::vector<std::vector<Eigen::Vector3d>>> touch_spheres(
    RunContext& context, const std::vector<TouchStep>& steps,
    const std::function<std::string(std::size_t)>& name);

/// The centre of a sphere from its tip centres. kCalibration when it has more form than probing
/// allows (probe.qualification.form_limit_um).
/// @param name  Name of the sphere, for messages.
[[nodiscard]] core::Result<Eigen::Vector3d> sphere_center(const Plan& plan,
                                                          const std::vector<Eigen::Vector3d>& tips,
                                                          const std::string& name);

/// Steps that touch the reference sphere or column of the plan. kUnreachable where a body of the
/// plan is in the way.
[[nodiscard]] core::Result<std::vector<TouchStep>> qualification_steps(const Plan& plan);

/// Touches the reference sphere or column, journals the touches, and checks the effective tip
/// radius, the probing form and the lean of a column against their limits.
/// @return kCalibration with value and limit when one is exceeded.
[[nodiscard]] core::Result<fit::ProbeTip> qualify_probe(RunContext& context);

}  // namespace rondure::plans
