#include "fit/sizes/local_sizes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/statistics.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

constexpr double kOpposite = 0.5 * core::kDegree;

/// A point of a section in polar coordinates about the section circle.
struct PolarPoint {
  double angle = 0.0;  // in [-pi, pi]
  double radius = 0.0;
  std::size_t row = 0;
};

std::vector<PolarPoint> by_angle(const Section& section) {
  std::vector<PolarPoint> out;
  for (std::size_t i = 0; i < section.points_mm.size(); ++i) {
    const Eigen::Vector2d v = section.points_mm[i] - section.circle.center_mm;
    out.push_back({std::atan2(v.y(), v.x()), v.norm(), i});
  }
  std::ranges::sort(out, {}, &PolarPoint::angle);
  return out;
}

/// The place among the points of the one that lies opposite each, to 0.5 deg and most nearly; that
/// of the point itself where there is none. The seam of the angles is no place of its own.
std::vector<std::size_t> opposite_points(const Section& section,
                                         std::span<const PolarPoint> points) {
  const double half_turn = 0.5 * core::kTwoPi;
  const auto misaligned = [&](const PolarPoint& p, const PolarPoint& q) {
    const Eigen::Vector2d a = section.points_mm[p.row] - section.circle.center_mm;
    const Eigen::Vector2d b = section.points_mm[q.row] - section.circle.center_mm;
    return std::abs(a.x() * b.y() - a.y() * b.x()) / (a.norm() * b.norm());
  };
  std::vector<std::size_t> out(points.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PolarPoint& p = points[i];
    const auto take = [&](double from, double to) {
      for (auto q = std::ranges::lower_bound(points, from, {}, &PolarPoint::angle);
           q != points.end() && q->angle <= to; ++q) {
        if (out[i] == i || misaligned(p, *q) < misaligned(p, points[out[i]])) {
          out[i] = static_cast<std::size_t>(q - points.begin());
        }
      }
    };
    for (const double opposite : {p.angle - half_turn, p.angle + half_turn}) {
      take(opposite - kOpposite, opposite + kOpposite);
    }
  }
  return out;
}

/// Appends the pairs of a section: each point with its opposite one, and no pair twice.
/// @return false if it has none.
bool append_pairs(const Section& section, std::size_t number, const Material& material,
                  std::vector<LocalSize>& out) {
  const std::size_t before = out.size();
  const auto points = by_angle(section);
  const auto opposite = opposite_points(section, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t k = opposite[i];
    if (k == i || (k < i && opposite[k] == i)) continue;
    out.push_back(
        {points[i].radius + points[k].radius - 2.0 * material.sign() * material.tip_radius_mm,
         number, points[i].row, points[k].row});
  }
  return out.size() > before;
}

}  // namespace

core::Result<std::vector<LocalSize>> two_point_sizes(std::span<const Section> sections,
                                                     const Material& material) {
  TRY_DO(check_material(material));
  if (sections.empty()) {
    return core::fail(core::Code::kSampling, "there is no section to take two-point sizes from");
  }
  std::vector<LocalSize> out;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    TRY_DO(check_material(material, sections[i].circle.radius_mm));
    if (append_pairs(sections[i], i, material, out)) continue;
    return core::fail_with(
        core::Code::kSampling,
        "section {} of {}, of {} points, has no two points opposite each other to 0.5 deg: measure "
        "an even number of points at equal angles, or a scan",
        i + 1, sections.size(), sections[i].points_mm.size());
  }
  return out;
}

core::Result<std::vector<LocalSize>> two_point_sizes(const UniformProfile& profile,
                                                     const Material& material) {
  TRY_DO(check_material(material));
  const std::size_t half = profile.r_mm.size() / 2;
  if (half == 0 || profile.r_mm.size() % 2 != 0) {
    return core::fail_with(
        core::Code::kSampling,
        "{} points at uniform angles have no opposite ones: an even number is needed",
        profile.r_mm.size());
  }
  std::vector<LocalSize> out;
  for (std::size_t i = 0; i < half; ++i) {
    out.push_back(
        {profile.r_mm[i] + profile.r_mm[i + half] - 2.0 * material.sign() * material.tip_radius_mm,
         0, i, i + half});
  }
  return out;
}

RankSizes rank_sizes(std::span<const LocalSize> sizes) {
  assert(!sizes.empty());
  std::vector<double> values;
  for (const LocalSize& size : sizes) values.push_back(size.size_mm);
  const auto [least, greatest] = std::ranges::minmax(values);
  RankSizes out;
  out.sx_mm = greatest;
  out.sn_mm = least;
  out.sd_mm = 0.5 * (greatest + least);
  out.sr_mm = greatest - least;
  out.count = values.size();
  out.sm_mm = core::median(values);
  // Relative to one of them, so that the sum keeps the digits of their differences.
  for (double& value : values) value -= least;
  const double mean = core::mean(values);
  for (double& value : values) value -= mean;
  out.sa_mm = least + mean;
  out.sq_mm = core::root_mean_square(values);
  return out;
}

}  // namespace rondure::fit
