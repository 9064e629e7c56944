#include "fit/min_zone_circle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "fit/bisectors.h"
#include "fit/center_search.h"
#include "fit/local_certificate.h"
#include "fit/ls_circle.h"
#include "fit/points.h"
#include "fit/zone_program.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kEnumerated = 40;  // points up to which all bisector crossings are tried
constexpr int kProgrammeLimit = 100;

using Points = std::span<const Eigen::Vector2d>;

struct Zone {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  [[nodiscard]] double width() const { return high - low; }
};

Zone zone_at(Points points, const Eigen::Vector2d& center) {
  Zone out;
  for (const Eigen::Vector2d& p : points) {
    const double r = (p - center).norm();
    out.low = std::min(out.low, r);
    out.high = std::max(out.high, r);
  }
  return out;
}

/// Completion of section 9.3: linear programmes inside a trust region, re-linearised.
Eigen::Vector2d complete(Points points, Eigen::Vector2d center, double round_off) {
  Zone zone = zone_at(points, center);
  double box = 10.0 * zone.width();
  std::vector<ZoneRow<2>> rows(points.size());
  for (int i = 0; i < kProgrammeLimit && box > round_off; ++i) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector2d v = points[k] - center;
      const double r = v.norm();
      rows[k] = {r - zone.low, r > 0.0 ? Eigen::Vector2d(-v / r) : Eigen::Vector2d::Zero()};
    }
    const auto step = solve_zone_program<2>(rows, box);
    const double promised = zone.width() - step.width;
    if (promised <= round_off) break;
    const Zone next = zone_at(points, center + step.step);
    if (zone.width() - next.width() < 0.1 * promised) {
      box *= 0.5;
      continue;
    }
    center += step.step;
    zone = next;
  }
  return center;
}

double round_off_of(Points points_mm) {
  double size = 1e-3;
  for (const Eigen::Vector2d& p : points_mm) size = std::max(size, p.cwiseAbs().maxCoeff());
  return 2.0 * std::numeric_limits<double>::epsilon() * size;
}

ContactRow<2> contact_row(Points points, const Eigen::Vector2d& center, std::size_t i) {
  const Eigen::Vector2d v = points[i] - center;
  const double r = v.norm();
  const Eigen::Vector2d n = v / r;
  const Eigen::Vector2d m(-n.y(), n.x());
  return {i, r, -n, m * m.transpose() / r};
}

/// Contacts, multipliers and the local grade of the certificate at a centre.
void certify(Points points, double round_off, MinZoneCircle& out) {
  const Zone zone = zone_at(points, out.center_mm);
  out.inner_radius_mm = zone.low;
  out.outer_radius_mm = zone.high;
  const double tolerance = 16.0 * round_off;
  std::vector<ContactRow<2>> outer;
  std::vector<ContactRow<2>> inner;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double r = (points[i] - out.center_mm).norm();
    if (r >= zone.high - tolerance) outer.push_back(contact_row(points, out.center_mm, i));
    if (r <= zone.low + tolerance) inner.push_back(contact_row(points, out.center_mm, i));
  }
  const auto proof = prove_local<2>(outer, inner, zone.width());
  out.outer = proof.outer;
  out.inner = proof.inner;
  out.certificate =
      certify_local<2>(proof, zone.width(), round_off, "next to the least-squares centre");
}

/// Three different points lie on one circle: nothing is left to minimise.
MinZoneCircle exact_fit(const LsCircle& circle) {
  MinZoneCircle out;
  out.center_mm = circle.center_mm;
  out.inner_radius_mm = out.outer_radius_mm = circle.radius_mm;
  out.exact_fit = true;
  out.certificate = {Certificate::Kind::kGlobal, "all centres", 0.0, ""};
  return out;
}

}  // namespace

core::Result<MinZoneCircle> min_zone_circle(Points points_mm) {
  const auto start = algebraic_circle(points_mm);
  if (!start) return core::fail(start.error());
  if (distinct_points(points_mm, 4) < 4) return exact_fit(*start);
  const auto search = center_search(points_mm);
  if (!search) return core::fail(search.error());

  const double round_off = round_off_of(points_mm);
  MinZoneCircle out;
  out.center_mm = search->center_mm;
  if (search->ending == CenterSearch::Ending::kCoCircular) {
    certify(points_mm, round_off, out);
    out.certificate = {Certificate::Kind::kGlobal, "all centres", out.width_mm(), ""};
    return out;
  }
  if (search->ending != CenterSearch::Ending::kCross) {
    out.center_mm = complete(points_mm, search->center_mm, round_off);
  }
  if (points_mm.size() > kEnumerated) {
    certify(points_mm, round_off, out);
    return out;
  }
  const BisectorSearch all = search_bisectors(points_mm, out.center_mm);
  // A crossing that is better by more than round-off is another minimum; keep the polished one
  // else.
  if (all.width_mm < zone_at(points_mm, out.center_mm).width() - round_off) {
    out.center_mm = all.center_mm;
  }
  certify(points_mm, round_off, out);
  if (all.complete) {
    out.certificate = {Certificate::Kind::kGlobal, "all centres", out.certificate.gap_mm, ""};
  }
  return out;
}

}  // namespace rondure::fit
