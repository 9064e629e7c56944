#include "fit/sizes/sizes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <span>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/least_squares/sphere.h"
#include "fit/profiles/internal/dft.h"
#include "fit/zone/fit.h"

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

namespace {

/// A radius of a zone, if its search converged.
template <class Place>
core::Result<double> settled(const core::Result<ZoneFit<Place>>& zone, double radius_mm) {
  if (!zone) return core::fail(zone.error());
  if (zone->ending != ZoneEnding::kConverged) {
    return core::fail(core::Code::kNotConverged,
                      "the search for a global size did not reach its optimum");
  }
  return radius_mm;
}

/// @param fit  Fits the zone with the given weights.
template <class Fit>
core::Result<GlobalSizes> sizes_of(double ls_radius_mm, const Material& material, const Fit& fit) {
  TRY_DO(check_material(material, ls_radius_mm));
  const auto least = fit(kMinimumCircumscribed);
  TRY(const auto outer, settled(least, least ? least->outer_radius_mm : 0.0));
  const auto zone = fit(kMinimumZone);
  TRY(const auto middle,
      settled(zone, zone ? 0.5 * (zone->outer_radius_mm + zone->inner_radius_mm) : 0.0));
  GlobalSizes out;
  out.gg_mm = material.diameter_mm(ls_radius_mm);
  out.gn_mm = material.diameter_mm(outer);
  out.gc_mm = material.diameter_mm(middle);
  const auto largest = fit(kMaximumInscribed);
  out.gx_mm = settled(largest, largest ? largest->inner_radius_mm : 0.0).map([&](double radius) {
    return material.diameter_mm(radius);
  });
  return out;
}

template <int D>
core::Result<GlobalSizes> sizes_about_center(std::span<const Eigen::Matrix<double, D, 1>> points_mm,
                                             const Material& material,
                                             const core::Result<LsCenter<D>>& ls) {
  TRY_DO(check_material(material));
  if (!ls) return core::fail(ls.error());
  CenterZoneFitter<D> fitter;
  return sizes_of(ls->radius_mm, material,
                  [&](const ZoneWeights& weights) { return fitter.fit(points_mm, weights); });
}

}  // namespace

core::Result<void> check_material(const Material& material) {
  constexpr double kGreatestError_mm = 0.05;  // beyond it somebody has mistaken the sign
  if (std::isfinite(material.tip_radius_mm) && material.tip_radius_mm >= -kGreatestError_mm) {
    return {};
  }
  return core::fail_with(core::Code::kBadOption,
                         "the tip radius is {} mm; a finite number not below 0 is needed",
                         material.tip_radius_mm);
}

core::Result<void> check_material(const Material& material, double center_radius_mm) {
  if (auto checked = check_material(material); !checked) return checked;
  const double radius_mm = material.surface_radius_mm(center_radius_mm);
  if (!(radius_mm <= 0.0)) return {};
  return core::fail_with(core::Code::kBadOption,
                         "the tip centres lie on a radius of {:.4f} mm, and a tip radius of {:.4f} "
                         "mm leaves a surface radius of {:.4f} mm, which must be above 0: correct "
                         "the tip diameter or the side of the feature",
                         center_radius_mm, material.tip_radius_mm, radius_mm);
}

core::Result<GlobalSizes> global_sizes(SpacePoints points_mm, const Material& material,
                                       const std::optional<Eigen::Vector3d>& near_direction) {
  TRY_DO(check_material(material));
  TRY(const auto ls, ls_cylinder(points_mm, near_direction));
  CylinderZoneFitter fitter;
  return sizes_of(ls.radius_mm, material, [&](const ZoneWeights& weights) {
    return fitter.fit(points_mm, ls.axis.direction, weights);
  });
}

core::Result<GlobalSizes> global_sizes(PlanePoints points_mm, const Material& material) {
  return sizes_about_center<2>(points_mm, material, ls_circle(points_mm));
}

core::Result<GlobalSizes> global_sizes_of_sphere(SpacePoints points_mm, const Material& material) {
  return sizes_about_center<3>(points_mm, material, ls_sphere(points_mm));
}

namespace {

constexpr double kPi = 0.5 * core::kTwoPi;
/// Steps of the trapezium rule, which converges faster than any power for a periodic function.
constexpr std::size_t kSteps = 3600;
constexpr std::size_t kFewestSamples = 8;

core::Result<void> check(const UniformProfile& profile, const Material& material) {
  if (auto checked = check_material(material); !checked) return checked;
  if (profile.r_mm.size() < kFewestSamples) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} points; circumference and area need at least {}",
                           profile.r_mm.size(), kFewestSamples);
  }
  for (std::size_t i = 0; i < profile.r_mm.size(); ++i) {
    if (!core::is_measurable(profile.r_mm[i])) {
      return core::fail_with(core::Code::kNotFinite, "the radius of row {} is {}", i,
                             profile.r_mm[i]);
    }
    if (!(profile.r_mm[i] > material.tip_radius_mm)) {
      return core::fail_with(core::Code::kBadOption,
                             "the radius of row {} is {:g} mm, not above the tip radius of {:g} mm",
                             i, profile.r_mm[i], material.tip_radius_mm);
    }
  }
  return {};
}

/// Circumference of the harmonic series with this half spectrum, divided by the number of samples
/// already. The angle of the start does not matter.
double circumference(const Spectrum& harmonics) {
  double sum = 0.0;
  for (std::size_t m = 0; m < kSteps; ++m) {
    double r = harmonics[0].real();
    double slope = 0.0;
    for (std::size_t k = 1; k < harmonics.size(); ++k) {
      const double angle = core::kTwoPi * static_cast<double>(k * m % kSteps) / kSteps;
      const Complex turned = harmonics[k] * std::polar(2.0, angle);
      r += turned.real();
      slope -= static_cast<double>(k) * turned.imag();
    }
    sum += std::hypot(r, slope);
  }
  return core::kTwoPi * sum / kSteps;
}

}  // namespace

core::Result<CalculatedSizes> calculated_sizes(const UniformProfile& profile,
                                               const Material& material) {
  TRY_DO(check(profile, material));
  const std::size_t n = profile.r_mm.size();
  Spectrum harmonics = spectrum(profile.r_mm);
  for (Complex& value : harmonics) value /= static_cast<double>(n);
  // Of an even number of samples, the last harmonic appears once in the sum, not twice.
  if (n % 2 == 0) harmonics.back() *= 0.5;
  double squares = 0.0;
  for (std::size_t k = 1; k < harmonics.size(); ++k) squares += std::norm(harmonics[k]);
  const double mean = harmonics[0].real();
  const double length = circumference(harmonics);
  const double area = kPi * (mean * mean + 2.0 * squares);
  const double tip = material.sign() * material.tip_radius_mm;
  CalculatedSizes out;
  out.cc_mm = (length - core::kTwoPi * tip) / kPi;
  out.area_mm2 = area - tip * length + kPi * tip * tip;
  out.ca_mm = std::sqrt(4.0 * out.area_mm2 / kPi);
  return out;
}

core::Result<double> volume_size_mm(std::span<const double> heights_mm,
                                    std::span<const double> areas_mm2) {
  if (heights_mm.size() != areas_mm2.size()) {
    return core::fail_with(core::Code::kNoPoints,
                           "{} heights and {} areas; as many of both are needed", heights_mm.size(),
                           areas_mm2.size());
  }
  if (heights_mm.size() < 2) {
    return core::fail_with(core::Code::kRank, "{} sections; a volume needs at least 2",
                           heights_mm.size());
  }
  double volume = 0.0;
  for (std::size_t i = 1; i < heights_mm.size(); ++i) {
    const double step = heights_mm[i] - heights_mm[i - 1];
    if (!(step > 0.0)) {
      return core::fail_with(core::Code::kBadOption,
                             "section {} stands at {:g} mm, not above section {} at {:g} mm", i,
                             heights_mm[i], i - 1, heights_mm[i - 1]);
    }
    volume += 0.5 * step * (areas_mm2[i] + areas_mm2[i - 1]);
  }
  return std::sqrt(4.0 * volume / (kPi * (heights_mm.back() - heights_mm.front())));
}

}  // namespace rondure::fit
