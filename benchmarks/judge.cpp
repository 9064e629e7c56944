#include "benchmarks/judge.h"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "fit/certificate_check.h"

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
  if (key.points > 1000) return best_mm;
  const auto zone = reported_zone(set);
  return zone ? std::min(best_mm, zone->width_mm()) : best_mm;
}

double find_best_mm(const SetKey& key, const CircleSet& set) {
  const auto zone =
      fit::min_zone_circle(set.points_mm, {.global = key.points <= 1000, .search = {}});
  return zone ? zone->width_mm() : std::numeric_limits<double>::infinity();
}

template <class Set>
double best_known_mm(const SetKey& key, const Set& set, double width_mm) {
  static std::map<SetKey, double> known;
  auto it = known.find(key);
  if (it == known.end()) it = known.emplace(key, find_best_mm(key, set)).first;
  it->second = std::min(it->second, width_mm);
  return it->second;
}

/// The gap of a global certificate is that of its search, which has its own tolerance.
std::string fault_of(const fit::ZoneCheck& check, double width_mm,
                     const fit::Certificate& certificate) {
  const double gap_mm = certificate.gap_mm;
  if (!check.fault.empty()) return check.fault;
  if (certificate.kind == fit::Certificate::Kind::kGlobal) return {};
  if (certificate.kind == fit::Certificate::Kind::kNone) return certificate.reason;
  if (gap_mm <= kLargestGap * width_mm) return {};
  return fmt::format("gap {:.3g} mm, more than {:g} of the width {:.3g} mm", gap_mm, kLargestGap,
                     width_mm);
}

template <class Set, class Zone>
Judgement judged(const SetKey& key, const Set& set, const Zone& zone, const fit::ZoneCheck& check) {
  const double width_mm = zone.width_mm();
  const double best_mm = best_known_mm(key, set, width_mm);
  return {1e3 * width_mm, std::max(0.0, (width_mm - best_mm) / best_mm),
          fault_of(check, width_mm, zone.certificate)};
}

template <class Zone>
fit::StatedZone stated(const Zone& zone) {
  return {zone.inner_radius_mm, zone.outer_radius_mm, zone.outer, zone.inner};
}

}  // namespace

Judgement judge(const SetKey& key, const CylinderSet& set, const OwnCylinder& zone) {
  return judged(key, set, zone, fit::check_zone(set.points_mm, zone.axis, stated(zone)));
}

Judgement judge(const SetKey& key, const CircleSet& set, const OwnCircle& zone) {
  return judged(key, set, zone, fit::check_zone(set.points_mm, zone.center_mm, stated(zone)));
}

}  // namespace rondure::benchmarks
