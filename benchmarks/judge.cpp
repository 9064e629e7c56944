#include "benchmarks/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "benchmarks/own_fits.h"
#include "benchmarks/peers/nlopt_peer.h"
#include "core/noise.h"

namespace rondure::benchmarks {
namespace {

constexpr std::uint64_t kStartStream = 101;
constexpr double kLargestGap = 1e-10;  ///< of the width: gate A4

double best_of_starts_mm(const SetKey& key, const CylinderSet& set) {
  const bool large = key.points >= 1'000'000;
  const int starts = large && key.seed >= 6 ? 1 : 10;
  core::KeyedNoise random(key.seed, {kStartStream, key.points});
  double best_mm = std::numeric_limits<double>::infinity();
  for (int i = 0; i < starts; ++i) {
    const Eigen::Vector3d side =
        Eigen::AngleAxisd(core::kTwoPi * random.uniform(), set.start_direction) *
        set.start_direction.unitOrthogonal();
    const double angle_rad = 10.0 * core::kDegree * random.uniform();
    const auto zone = fit::min_zone_cylinder(
        set.points_mm, Eigen::AngleAxisd(angle_rad, side) * set.start_direction);
    if (zone) best_mm = std::min(best_mm, zone->width_mm());
  }
  return best_mm;
}

double find_best_mm(const SetKey& key, const CylinderSet& set) {
  double best_mm = best_of_starts_mm(key, set);
  if (key.points <= 10'000) {
    best_mm = std::min(
        best_mm, nlopt_nelder_mead_zone([&](const fit::Axis& a) { return width_about_mm(set, a); },
                                        {set.axis_point_mm, set.axis_direction}, kHalfLength_mm)
                     .width_mm);
  }
  if (key.points > 1000) return best_mm;
  const auto zone = reported_zone(set);
  return zone ? std::min(best_mm, zone->width_mm()) : best_mm;
}

double find_best_mm(const SetKey& key, const CircleSet& set) {
  const auto zone =
      fit::min_zone_circle(set.points_mm, {.global = key.points <= 1000, .search = {}});
  double best_mm = zone ? zone->width_mm() : std::numeric_limits<double>::infinity();
  core::KeyedNoise random(key.seed, {kStartStream, key.points});
  fit::CircleZoneFitter fitter;
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector2d start =
        set.center_mm + Eigen::Vector2d(random.uniform() - 0.5, random.uniform() - 0.5);
    best_mm = std::min(best_mm, fitter.fit_from(set.points_mm, start).width_mm());
  }
  return best_mm;
}

template <class Set>
double& best_known_mm(const SetKey& key, const Set& set) {
  static std::map<SetKey, double> known;
  auto it = known.find(key);
  if (it == known.end()) it = known.emplace(key, find_best_mm(key, set)).first;
  return it->second;
}

/// Derivatives of the distance of a point by the unknowns that move a cylinder: two shifts, two
/// tilts times half the length.
struct CylinderDistance {
  fit::Axis axis;
  Eigen::Matrix<double, 3, 2> across = fit::across(axis.direction);

  [[nodiscard]] Eigen::Vector4d gradient(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d n = (across.transpose() * (p - axis.point_mm)).normalized();
    const double z = (p - axis.point_mm).dot(axis.direction) / kHalfLength_mm;
    return {-n.x(), -n.y(), -z * n.x(), -z * n.y()};
  }
  [[nodiscard]] double at(const Eigen::Vector3d& p) const { return fit::distance_mm(axis, p); }
};

struct CircleDistance {
  Eigen::Vector2d center_mm;

  [[nodiscard]] Eigen::Vector2d gradient(const Eigen::Vector2d& p) const {
    return (center_mm - p).normalized();
  }
  [[nodiscard]] double at(const Eigen::Vector2d& p) const { return (p - center_mm).norm(); }
};

/// Width less the bound the multipliers prove, to first order, for every place that moves no point
/// by more than the width [mm].
template <class Set, class Distance>
double gap_mm(const Set& set, const Distance& distance, const fit::StatedZone& zone) {
  const double width_mm = zone.outer_radius_mm - zone.inner_radius_mm;
  double bound_mm = 0.0;
  auto imbalance = (0.0 * distance.gradient(set.points_mm.front())).eval();
  for (const fit::Contact& c : zone.outer) {
    bound_mm += c.multiplier * distance.at(set.points_mm[c.index]);
    imbalance += c.multiplier * distance.gradient(set.points_mm[c.index]);
  }
  for (const fit::Contact& c : zone.inner) {
    bound_mm -= c.multiplier * distance.at(set.points_mm[c.index]);
    imbalance -= c.multiplier * distance.gradient(set.points_mm[c.index]);
  }
  return std::abs(width_mm - bound_mm) + imbalance.norm() * width_mm;
}

/// A gap cannot be told below the round-off of a distance between points 64 mm from the origin.
constexpr double kRoundOff_mm = 16.0 * 64.0 * std::numeric_limits<double>::epsilon();

std::string fault_of(const fit::ZoneCheck& check, double width_mm, double gap_mm) {
  if (!check.fault.empty()) return check.fault;
  if (gap_mm <= std::max(kLargestGap * width_mm, kRoundOff_mm)) return {};
  return fmt::format("gap {:.3g} mm, more than {:g} of the width {:.3g} mm", gap_mm, kLargestGap,
                     width_mm);
}

template <class Set>
Judgement judged(const SetKey& key, const Set& set, double width_mm, const std::string& fault) {
  if (!std::isfinite(width_mm)) return {width_mm, width_mm, "the width is not a number"};
  double& best_mm = best_known_mm(key, set);
  best_mm = std::min(best_mm, width_mm);
  return {1e3 * width_mm, (width_mm - best_mm) / best_mm, fault};
}

}  // namespace

Judgement judge(const SetKey& key, const CylinderSet& set, const fit::Axis& axis,
                const fit::StatedZone& zone) {
  const double width_mm = zone.outer_radius_mm - zone.inner_radius_mm;
  const auto check = fit::check_zone(set.points_mm, axis, zone);
  const double gap = gap_mm(set, CylinderDistance{axis}, zone);
  return judged(key, set, width_mm, fault_of(check, width_mm, gap));
}

Judgement judge(const SetKey& key, const CircleSet& set, const Eigen::Vector2d& center_mm,
                const fit::StatedZone& zone) {
  const double width_mm = zone.outer_radius_mm - zone.inner_radius_mm;
  const auto check = fit::check_zone(set.points_mm, center_mm, zone);
  const double gap = gap_mm(set, CircleDistance{center_mm}, zone);
  return judged(key, set, width_mm, fault_of(check, width_mm, gap));
}

double excess_of(const SetKey& key, const CylinderSet& set, double width_mm) {
  return width_mm / best_known_mm(key, set) - 1.0;
}

double excess_of(const SetKey& key, const CircleSet& set, double width_mm) {
  return width_mm / best_known_mm(key, set) - 1.0;
}

}  // namespace rondure::benchmarks
