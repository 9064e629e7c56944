#include "evaluation/part/internal/sections.h"

#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "core/units.h"
#include "fit/least_squares/circle.h"

namespace rondure::evaluation {
namespace {

constexpr double kLowestCutoffUpr = 15.0;
constexpr double kPointsRoundOff = 1e-9;

}  // namespace

core::Result<RoundProfile> round_profile(std::span<const Eigen::Vector2d> points) {
  TRY(const auto circle, fit::ls_circle(points));
  RoundProfile out;
  out.center_mm = circle.center_mm;
  out.outward.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d v = p - circle.center_mm;
    const double r = v.norm();
    out.outward.emplace_back(v / r);
    out.theta_rad.push_back(std::atan2(v.y(), v.x()));
    out.r_mm.push_back(r - circle.radius_mm);
  }
  TRY(out.by_angle, fit::ordered_profile(out.theta_rad, out.r_mm));
  return out;
}

Spacing spacing_of(const RoundProfile& profile, std::span<const Eigen::Vector2d> left_out) {
  const fit::AngularProfile& seen = profile.by_angle;
  if (left_out.empty()) {
    return {static_cast<double>(seen.theta_rad.size()), seen.largest_gap_rad};
  }
  const auto gaps_of = [](const std::vector<double>& theta_rad) {
    std::vector<double> gaps = {theta_rad.front() + core::kTwoPi - theta_rad.back()};
    for (std::size_t i = 1; i < theta_rad.size(); ++i) {
      gaps.push_back(theta_rad[i] - theta_rad[i - 1]);
    }
    return gaps;
  };
  std::vector<double> all_rad = seen.theta_rad;
  for (const Eigen::Vector2d& place : left_out) {
    const Eigen::Vector2d v = place - profile.center_mm;
    const double angle = std::atan2(v.y(), v.x());
    all_rad.push_back(angle < seen.theta_rad.front() ? angle + core::kTwoPi : angle);
  }
  std::ranges::sort(all_rad);
  return {core::kTwoPi / core::median(gaps_of(seen.theta_rad)), std::ranges::max(gaps_of(all_rad))};
}

bool carries(const Spacing& spacing, double cutoff_upr) {
  return spacing.points * (1.0 + kPointsRoundOff) >= kProfilePointsPerUndulation * cutoff_upr &&
         spacing.gap_rad < 0.25 * core::kTwoPi / cutoff_upr;
}

bool carries_lowest_cutoff(std::span<const Eigen::Vector3d> points_mm, const fit::Axis& axis,
                           std::span<const Eigen::Vector3d> left_out_mm) {
  const auto frame = fit::across(axis.direction);
  const auto flat = [&](std::span<const Eigen::Vector3d> places_mm) {
    std::vector<Eigen::Vector2d> out;
    for (const Eigen::Vector3d& p : places_mm) {
      out.emplace_back(frame.transpose() * (p - axis.point_mm));
    }
    return out;
  };
  const auto profile = round_profile(flat(points_mm));
  return profile && carries(spacing_of(*profile, flat(left_out_mm)), kLowestCutoffUpr);
}

}  // namespace rondure::evaluation
