#include "evaluation/part/internal/sections.h"

#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "core/units.h"
#include "fit/least_squares/circle.h"

namespace rondure::evaluation {
namespace {

constexpr double kLowestCutoffUpr = 15.0;
/// Gaps above this many median ones are windows, as fit::filter_with_windows() has it.
constexpr double kWindowGap = 1.5;
constexpr double kPointsRoundOff = 1e-9;

}  // namespace

core::Result<RoundProfile> round_profile(std::span<const Eigen::Vector2d> points) {
  const auto circle = fit::ls_circle(points);
  if (!circle) return core::fail(circle.error());
  RoundProfile out;
  out.outward.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d v = p - circle->center_mm;
    const double r = v.norm();
    out.outward.emplace_back(v / r);
    out.theta_rad.push_back(std::atan2(v.y(), v.x()));
    out.r_mm.push_back(r - circle->radius_mm);
  }
  auto sorted = fit::ordered_profile(out.theta_rad, out.r_mm);
  if (!sorted) return core::fail(sorted.error());
  out.by_angle = *std::move(sorted);
  return out;
}

Spacing spacing_of(const fit::AngularProfile& profile, bool windows) {
  if (!windows) {
    return {static_cast<double>(profile.theta_rad.size()), profile.largest_gap_rad};
  }
  std::vector<double> gaps = {profile.theta_rad.front() + core::kTwoPi - profile.theta_rad.back()};
  for (std::size_t i = 1; i < profile.theta_rad.size(); ++i) {
    gaps.push_back(profile.theta_rad[i] - profile.theta_rad[i - 1]);
  }
  const double usual = core::median(gaps);
  Spacing out{core::kTwoPi / usual, 0.0};
  for (const double gap : gaps) {
    if (gap <= kWindowGap * usual) out.gap_rad = std::max(out.gap_rad, gap);
  }
  return out;
}

bool carries(const Spacing& spacing, double cutoff_upr) {
  return spacing.points * (1.0 + kPointsRoundOff) >= kProfilePointsPerUndulation * cutoff_upr &&
         spacing.gap_rad < 0.25 * core::kTwoPi / cutoff_upr;
}

bool carries_lowest_cutoff(std::span<const Eigen::Vector3d> points_mm, const fit::Axis& axis,
                           bool gap) {
  const auto frame = fit::across(axis.direction);
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& p : points_mm) {
    points.emplace_back(frame.transpose() * (p - axis.point_mm));
  }
  const auto profile = round_profile(points);
  return profile && carries(spacing_of(profile->by_angle, gap), kLowestCutoffUpr);
}

}  // namespace rondure::evaluation
