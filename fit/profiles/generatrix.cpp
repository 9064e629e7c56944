#include "fit/profiles/generatrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

/// Slope of the least-squares line r = mean + slope (z - mean z); nothing if all z are equal.
std::optional<double> ls_slope(PlanePoints points, const Eigen::Vector2d& mean) {
  double zz = 0.0;
  double zr = 0.0;
  double size = 0.0;
  for (const Eigen::Vector2d& p : points) {
    zz += (p.x() - mean.x()) * (p.x() - mean.x());
    zr += (p.x() - mean.x()) * (p.y() - mean.y());
    size = std::max(size, std::abs(p.x()));
  }
  const double round_off = 16.0 * std::numeric_limits<double>::epsilon() * size;
  if (zz <= static_cast<double>(points.size()) * round_off * round_off) return std::nullopt;
  return zr / zz;
}

/// The points about `mean` in a frame whose first axis has the given slope.
std::vector<Eigen::Vector2d> turned(PlanePoints points, const Eigen::Vector2d& mean, double slope) {
  const double scale = 1.0 / std::hypot(1.0, slope);
  std::vector<Eigen::Vector2d> out;
  out.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d v = p - mean;
    out.emplace_back((v.x() + slope * v.y()) * scale, (v.y() - slope * v.x()) * scale);
  }
  return out;
}

core::Error no_length() {
  return {core::Code::kRank,
          "all points stand at one position along the axis; straightness and "
          "taper need at least two sections"};
}

constexpr double kSameGeneratrix = 0.5 * core::kDegree;

std::optional<double> slope_of(const Generatrix& line) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < line.heights_mm.size(); ++i) {
    points.emplace_back(line.heights_mm[i], line.distances_mm[i]);
  }
  if (points.empty()) return std::nullopt;
  return ls_slope(points, mean_point(points));
}

/// Range of the distances of a generatrix from a line on the opposite side, whose distances grow
/// with `slope`: there its own distances count as negative.
double range_from_line(const Generatrix& line, double slope) {
  Extremes out;
  for (std::size_t i = 0; i < line.heights_mm.size(); ++i) {
    out.take(line.distances_mm[i] + slope * line.heights_mm[i]);
  }
  return out.width() / std::hypot(1.0, slope);
}

/// The harmonic series through the samples of a section, about the centre of its circle.
class SectionSeries {
 public:
  explicit SectionSeries(const DenseSection& section)
      : center_(section.center_mm),
        start_(section.profile.start_rad),
        harmonics_(spectrum(section.profile.r_mm)) {
    const double count = static_cast<double>(section.profile.r_mm.size());
    for (Complex& value : harmonics_) value *= 2.0 / count;
    // The mean appears once in the sum, and so does the last harmonic of an even number of samples.
    harmonics_.front() *= 0.5;
    if (section.profile.r_mm.size() % 2 == 0) harmonics_.back() *= 0.5;
  }

  /// Distance from the axis, at the origin, of the surface at an angle about the axis.
  [[nodiscard]] double distance_at(double angle) const {
    constexpr int kRounds = 30;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const double beside = along.y() * center_.x() - along.x() * center_.y();
    // The point at the angle t about the centre lies beside the ray by r sin(t - angle) - beside.
    double turn = 0.0;
    for (int i = 0; i < kRounds; ++i) {
      const double next = std::asin(std::clamp(beside / radius(angle + turn), -1.0, 1.0));
      const bool rests = std::abs(next - turn) <= 1e-15;
      turn = next;
      if (rests) break;
    }
    return along.dot(center_) + radius(angle + turn) * std::cos(turn);
  }

 private:
  /// Sums four series, of every fourth harmonic each: their turns do not wait for one another.
  [[nodiscard]] double radius(double angle) const {
    constexpr std::size_t kSeries = 4;
    const auto turned_by = [&](double times) { return std::polar(1.0, times * (angle - start_)); };
    const Complex step = turned_by(kSeries);
    std::array<double, kSeries> x{};
    std::array<double, kSeries> y{};
    for (std::size_t j = 0; j < kSeries; ++j) {
      x[j] = turned_by(static_cast<double>(j)).real();
      y[j] = turned_by(static_cast<double>(j)).imag();
    }
    std::array<double, kSeries> sums{};
    for (std::size_t k = 0; k < harmonics_.size(); k += kSeries) {
      for (std::size_t j = 0; j < kSeries && k + j < harmonics_.size(); ++j) {
        sums[j] += harmonics_[k + j].real() * x[j] - harmonics_[k + j].imag() * y[j];
        const double turned = x[j] * step.real() - y[j] * step.imag();
        y[j] = x[j] * step.imag() + y[j] * step.real();
        x[j] = turned;
      }
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }

  Eigen::Vector2d center_;
  double start_;
  Spectrum harmonics_;
};

}  // namespace

core::Result<GeneratrixStraightness> generatrix_straightness(std::span<const double> z_mm,
                                                             std::span<const double> r_mm) {
  if (z_mm.size() != r_mm.size()) {
    return core::fail_with(core::Code::kNoPoints,
                           "{} positions and {} radii; as many of both are needed", z_mm.size(),
                           r_mm.size());
  }
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < z_mm.size(); ++i) points.emplace_back(z_mm[i], r_mm[i]);
  TRY_DO(check_points(points));
  if (points.size() < 3) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} points on a generatrix; straightness needs at least 3",
                           points.size());
  }
  const Eigen::Vector2d mean = mean_point(points);
  const auto slope = ls_slope(points, mean);
  if (!slope) return core::fail(no_length());
  GeneratrixStraightness out;
  out.ls_slope = *slope;
  const auto frame = turned(points, mean, *slope);
  std::vector<double> deviations;
  for (const Eigen::Vector2d& p : frame) deviations.push_back(p.y());
  out.ls = form_parameters(deviations);
  out.zone_mm = least_width(frame);
  return out;
}

core::Result<Taper> taper(SpacePoints points_mm, const Axis& axis) {
  TRY_DO(check_points(points_mm));
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& p : points_mm) {
    points.emplace_back((p - axis.point_mm).dot(axis.direction), distance_mm(axis, p));
  }
  const auto slope = ls_slope(points, mean_point(points));
  if (!slope) return core::fail(no_length());
  const double length = extremes_of(points, [](const auto& p) { return p.x(); }).width();
  return Taper{*slope, 2.0 * *slope * length, 2.0 * std::atan(*slope)};
}

core::Result<std::vector<Generatrix>> generatrices(Layers layers_mm, const Axis& axis) {
  if (layers_mm.empty()) return core::fail(core::Code::kNoPoints, "there is no layer");
  for (const auto& layer : layers_mm) {
    TRY_DO(check_points(layer));
  }
  const auto frame = across(axis.direction);
  const auto angle_of = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector2d q = frame.transpose() * (p - axis.point_mm);
    return std::atan2(q.y(), q.x());
  };
  std::vector<Generatrix> out;
  std::string missing;
  for (const Eigen::Vector3d& first : layers_mm.front()) {
    Generatrix line;
    line.angle_rad = angle_of(first);
    for (std::size_t j = 0; j < layers_mm.size(); ++j) {
      const auto& layer = layers_mm[j];
      const auto apart = [&](const Eigen::Vector3d& p) {
        return std::abs(std::remainder(angle_of(p) - line.angle_rad, core::kTwoPi));
      };
      const auto nearest = std::ranges::min_element(layer, {}, apart);
      if (apart(*nearest) > kSameGeneratrix) {
        missing = fmt::format(
            "no generatrix has a point in every layer: layer {} has none within 0.5 deg of {:.3f} "
            "deg, the nearest is {:.3f} deg off: begin all layers at one angle (stagger 0), or "
            "scan",
            j, core::degrees(line.angle_rad), core::degrees(apart(*nearest)));
        break;
      }
      line.heights_mm.push_back((*nearest - axis.point_mm).dot(axis.direction));
      line.distances_mm.push_back(distance_mm(axis, *nearest));
    }
    if (line.heights_mm.size() == layers_mm.size()) out.push_back(std::move(line));
  }
  if (out.empty()) return core::fail(core::Code::kSampling, missing);
  return out;
}

core::Result<std::vector<Generatrix>> dense_generatrices(std::span<const DenseSection> sections,
                                                         int count) {
  constexpr std::size_t kFewestSamples = 8;
  if (sections.empty()) return core::fail(core::Code::kNoPoints, "there is no section");
  if (count < 1) {
    return core::fail_with(core::Code::kBadOption, "{} generatrices; at least 1 is needed", count);
  }
  std::vector<Generatrix> out(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].angle_rad = core::kTwoPi * static_cast<double>(k) / count;
  }
  for (std::size_t j = 0; j < sections.size(); ++j) {
    if (sections[j].profile.r_mm.size() < kFewestSamples) {
      return core::fail_with(core::Code::kSampling,
                             "section {} has {} samples; a generatrix between points needs at "
                             "least {}: scan the section",
                             j, sections[j].profile.r_mm.size(), kFewestSamples);
    }
    const SectionSeries series(sections[j]);
    for (Generatrix& line : out) {
      line.heights_mm.push_back(sections[j].height_mm);
      line.distances_mm.push_back(series.distance_at(line.angle_rad));
    }
  }
  return out;
}

core::Result<std::vector<OppositeGeneratrices>> opposite_generatrices(
    std::span<const Generatrix> lines, double length_mm) {
  std::vector<OppositeGeneratrices> out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const Generatrix& first = lines[i];
      const Generatrix& second = lines[j];
      const double turn =
          std::remainder(second.angle_rad - first.angle_rad - 0.5 * core::kTwoPi, core::kTwoPi);
      if (std::abs(turn) > kSameGeneratrix) continue;
      const auto slope = slope_of(first);
      const auto opposite = slope_of(second);
      if (!slope || !opposite) return core::fail(no_length());
      out.push_back({first.angle_rad, 0.5 * std::abs(*slope + *opposite) * length_mm,
                     std::max(range_from_line(second, *slope), range_from_line(first, *opposite))});
    }
  }
  if (!out.empty()) return out;
  return core::fail_with(core::Code::kSampling,
                         "no two of the {} generatrices are opposite each other to 0.5 deg: touch "
                         "an even number of points a layer",
                         lines.size());
}

}  // namespace rondure::fit
