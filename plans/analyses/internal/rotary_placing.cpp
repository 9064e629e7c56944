#include "plans/analyses/internal/kinds.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/rotary/errors.h"

namespace rondure::plans {
namespace {

using core::kDegree;
using core::kMicroradian;

double station_gate_rad(const Plan& plan, const record::RotaryTask& rotary) {
  std::vector<Eigen::Vector3d> balls;
  for (const record::BallTask& ball : rotary.balls)
    balls.emplace_back(Eigen::Vector3d::Map(ball.center_mm.data()));
  return fit::station_gate_rad(
      fit::largest_lever_mm(balls, Eigen::Vector3d::Map(plan.fixture->axis_offset_mm.data())));
}

double repeatability_rad(const record::RotaryTask& rotary) {
  return rotary.uncertainty ? record::u_of(rotary.uncertainty->repeat_urad) * kMicroradian : 0.0;
}

std::string angles_text(const core::Pose& pose) {
  return fmt::format("({:.4f}, {:.4f}) deg", pose.alpha_rad / kDegree, pose.beta_rad / kDegree);
}

core::Result<void> check_zero(double reads_rad, double limit_rad, const char* axis,
                              const core::Pose& commanded) {
  if (std::abs(reads_rad) <= limit_rad) return {};
  return core::machine_fault(
      "in pose {} {} reads {:.4f} deg and must be 0 within {:.4f} deg, or its own errors enter "
      "those of the other axis; set it closer to 0, then resume",
      angles_text(commanded), axis, reads_rad / kDegree, limit_rad / kDegree);
}

}  // namespace

core::Result<void> check_zero_is_held(const Plan& plan, std::size_t feature,
                                      double resolution_rad) {
  const auto& rotary = plan.features[feature].rotary_axes;
  if (!rotary || !plan.fixture) return {};
  const double limit_rad = station_gate_rad(plan, *rotary);
  if (const auto& by_hand = plan.fixture->reached_pose) {
    const double off_rad = by_hand->setting_uncertainty_deg * kDegree;
    if (off_rad <= limit_rad) return {};
    return core::fail(
        core::Code::kMeaning,
        fmt::format("a pose may be off by {:.4g} deg; the axis that is not measured must be at 0 "
                    "within {:.4f} deg, or its own errors enter those of the other; state at most "
                    "that, and set the fixture so closely",
                    by_hand->setting_uncertainty_deg, limit_rad / kDegree),
        "/fixture/reached_pose/setting_uncertainty_deg");
  }
  if (resolution_rad <= limit_rad) return {};
  return core::fail(
      core::Code::kMeaning,
      fmt::format("the fixture holds an angle within {:.4g} deg; the axis that is not measured "
                  "must be at 0 within {:.4f} deg, or its own errors enter those of the other; use "
                  "a finer drive, or balls closer to the axes",
                  resolution_rad / kDegree, limit_rad / kDegree),
      "/fixture/resolution_deg");
}

core::Result<void> check_station_reached(const Plan& plan, std::size_t feature,
                                         const core::Pose& commanded, const core::Pose& reached,
                                         double resolution_rad) {
  const auto& rotary = plan.features[feature].rotary_axes;
  if (!rotary || !plan.fixture) return {};
  const double dead_band_rad = plan.fixture->reached_pose
                                   ? plan.fixture->reached_pose->setting_uncertainty_deg * kDegree
                                   : 0.0;
  const double drive_rad =
      fit::drive_gate_rad(resolution_rad, repeatability_rad(*rotary), dead_band_rad);
  const double missed_rad = std::max(std::abs(reached.alpha_rad - commanded.alpha_rad),
                                     std::abs(reached.beta_rad - commanded.beta_rad));
  // A fixture without a stated resolution still rounds its readings to their digits.
  constexpr double kRoundOff_rad = 1e-9;
  if (missed_rad > drive_rad + kRoundOff_rad) {
    return core::machine_fault(
        "the fixture was sent to {} and reads {}: {:.4g} deg apart, the limit is {:.4g} deg; the "
        "drive missed its target; check it, then resume",
        angles_text(commanded), angles_text(reached), missed_rad / kDegree, drive_rad / kDegree);
  }
  constexpr double kZero_rad = 1e-9;
  const double limit_rad = station_gate_rad(plan, *rotary);
  if (std::abs(commanded.alpha_rad) <= kZero_rad) {
    if (auto zero = check_zero(reached.alpha_rad, limit_rad, "alpha", commanded); !zero) {
      return zero;
    }
  }
  if (std::abs(commanded.beta_rad) > kZero_rad) return {};
  return check_zero(reached.beta_rad, limit_rad, "beta", commanded);
}

}  // namespace rondure::plans
