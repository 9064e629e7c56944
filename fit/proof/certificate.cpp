#include "fit/proof/certificate.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace rondure::fit {
namespace {

constexpr double kWeightTolerance = 1e-9;
/// Step of the central differences as a part of the radius; leaves errors of some 1e-9.
constexpr double kDifferenceShare = 1e-5;
constexpr double kImbalanceTolerance = 1e-6;

/// Distance of a point from the axis or centre moved by `by` along unknown `k`.
using MovedDistance = std::function<double(std::size_t row, int k, double by)>;

/// Raises `worst` to `by`. A NaN is kept, so that it fails every limit.
void raise(double& worst, double by) {
  if (!std::isnan(worst) && !(by <= worst)) worst = by;
}

/// Checks the points against the sides that the zone claims: those with contacts, or both.
void check_sides(std::size_t count, const MovedDistance& distance, const StatedZone& zone,
                 ZoneCheck& out) {
  const bool outer = !zone.outer.empty() || zone.inner.empty();
  const bool inner = !zone.inner.empty() || zone.outer.empty();
  for (std::size_t i = 0; i < count; ++i) {
    const double r = distance(i, 0, 0.0);
    if (outer) raise(out.outside_mm, r - zone.outer_radius_mm);
    if (inner) raise(out.outside_mm, zone.inner_radius_mm - r);
  }
}

/// Adds the gradients of one side to `balance`. A side without contacts claims nothing.
/// @return Weighted mean distance of the contacts minus the radius of the side.
double weigh(std::span<const Contact> side, double radius, double sign, int unknowns, double step,
             const MovedDistance& distance, Eigen::Vector4d& balance, ZoneCheck& out) {
  if (side.empty()) return 0.0;
  double sum = 0.0;
  double mean_excess = 0.0;
  for (const Contact& c : side) {
    const double excess = distance(c.index, 0, 0.0) - radius;
    raise(out.off_contact_mm, std::abs(excess));
    raise(out.weight_error, -c.multiplier);
    sum += c.multiplier;
    mean_excess += c.multiplier * excess;
    for (int k = 0; k < unknowns; ++k) {
      const double slope =
          (distance(c.index, k, step) - distance(c.index, k, -step)) / (2.0 * step);
      balance(k) += sign * c.multiplier * slope;
    }
  }
  raise(out.weight_error, std::abs(sum - 1.0));
  return mean_excess;
}

ZoneCheck check(std::size_t count, int unknowns, const MovedDistance& distance,
                const StatedZone& zone, double tolerance) {
  ZoneCheck out;
  for (const auto& side : {zone.outer, zone.inner}) {
    for (const Contact& c : side) {
      if (c.index < count) continue;
      out.fault = fmt::format("a contact names row {} of {} points", c.index, count);
      return out;
    }
  }
  check_sides(count, distance, zone, out);
  if (!zone.outer.empty() || !zone.inner.empty()) {
    Eigen::Vector4d balance = Eigen::Vector4d::Zero();
    const double step = kDifferenceShare * zone.outer_radius_mm;
    const double high =
        weigh(zone.outer, zone.outer_radius_mm, 1.0, unknowns, step, distance, balance, out);
    const double low =
        weigh(zone.inner, zone.inner_radius_mm, -1.0, unknowns, step, distance, balance, out);
    for (const double unknown : balance) raise(out.imbalance, std::abs(unknown));
    const double width = zone.outer_radius_mm - zone.inner_radius_mm;
    out.gap_mm = low - high + balance.lpNorm<1>() * width;
  }
  const auto fault = [&](bool broken, std::string text) {
    if (broken && out.fault.empty()) out.fault = std::move(text);
  };
  fault(!(out.outside_mm <= tolerance),
        fmt::format("a point lies {:.3g} mm outside the zone", out.outside_mm));
  fault(!(out.off_contact_mm <= tolerance),
        fmt::format("a contact lies {:.3g} mm off its radius", out.off_contact_mm));
  fault(!(out.weight_error <= kWeightTolerance),
        fmt::format("the multipliers are {:.3g} away from >= 0 with sum 1", out.weight_error));
  fault(!(out.imbalance <= kImbalanceTolerance),
        fmt::format("the contacts are out of balance by {:.3g}", out.imbalance));
  return out;
}

}  // namespace

ZoneCheck check_zone(SpacePoints points_mm, const Axis& axis, const StatedZone& zone,
                     double tolerance_mm) {
  const Eigen::Vector3d z = axis.direction.normalized();
  const Eigen::Vector3d x = z.unitOrthogonal();
  const Eigen::Vector3d y = z.cross(x);
  double low = 0.0;
  double high = 0.0;
  if (!points_mm.empty()) low = high = (points_mm.front() - axis.point_mm).dot(z);
  for (const Eigen::Vector3d& p : points_mm) {
    low = std::min(low, (p - axis.point_mm).dot(z));
    high = std::max(high, (p - axis.point_mm).dot(z));
  }
  const double half_length = std::max(0.5 * (high - low), 1e-9);
  const Eigen::Vector3d middle = axis.point_mm + 0.5 * (low + high) * z;
  const auto distance = [&](std::size_t row, int k, double by) {
    const Eigen::Vector3d& side = k % 2 == 0 ? x : y;
    const Eigen::Vector3d shift = k < 2 ? Eigen::Vector3d(by * side) : Eigen::Vector3d::Zero();
    const Eigen::Vector3d turned = k < 2 ? z : Eigen::Vector3d(z + by / half_length * side);
    return (points_mm[row] - middle - shift).cross(turned).norm() / turned.norm();
  };
  return check(points_mm.size(), 4, distance, zone, tolerance_mm);
}

ZoneCheck check_zone(PlanePoints points_mm, const Eigen::Vector2d& center_mm,
                     const StatedZone& zone, double tolerance_mm) {
  const auto distance = [&](std::size_t row, int k, double by) {
    const Eigen::Vector2d v = points_mm[row] - center_mm - by * Eigen::Vector2d::Unit(k);
    return std::hypot(v.x(), v.y());
  };
  return check(points_mm.size(), 2, distance, zone, tolerance_mm);
}

}  // namespace rondure::fit
