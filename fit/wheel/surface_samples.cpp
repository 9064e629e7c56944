#include "fit/wheel/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace rondure::fit {
namespace {

constexpr std::size_t kGrid = 2000;
constexpr int kPiecesPerRow = 4;
constexpr std::size_t kBoxedSamples = 64;

/// Returns the place of the least `cost` between two x, by golden section.
/// @pre `cost` has a single minimum there.
template <class Cost>
double least_between(double low, double high, const Cost& cost) {
  constexpr double kGolden = 0.6180339887498949;
  double x1 = high - kGolden * (high - low);
  double x2 = low + kGolden * (high - low);
  double c1 = cost(x1);
  double c2 = cost(x2);
  for (int i = 0; i < 60 && high - low > 1e-10; ++i) {
    if (c1 <= c2) {
      high = x2;
      x2 = x1;
      c2 = c1;
      x1 = high - kGolden * (high - low);
      c1 = cost(x1);
    } else {
      low = x1;
      x1 = x2;
      c1 = c2;
      x2 = low + kGolden * (high - low);
      c2 = cost(x2);
    }
  }
  return c1 <= c2 ? x1 : x2;
}

/// Equally spaced places, and those between the rows of a table.
std::vector<double> places_of(const WheelSurface& surface, double from, double to) {
  std::vector<double> out;
  for (std::size_t i = 0; i <= kGrid; ++i) {
    out.push_back(from + (to - from) * static_cast<double>(i) / kGrid);
  }
  const std::vector<double> rows = surface.rows_mm();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (int k = 0; k <= kPiecesPerRow; ++k) {
      const double x = rows[i - 1] + (rows[i] - rows[i - 1]) * k / kPiecesPerRow;
      if (x >= from && x <= to) out.push_back(x);
    }
  }
  std::ranges::sort(out);
  // Places that differ only by rounding would leave no interval between neighbours to refine in.
  const double same = 1e-9 * (to - from);
  out.erase(std::unique(out.begin(), out.end(), [&](double a, double b) { return b - a <= same; }),
            out.end());
  return out;
}

}  // namespace

core::Result<SurfaceSamples> SurfaceSamples::over(const WheelSurface& surface, double from_mm,
                                                  double to_mm) {
  SurfaceSamples out(surface);
  for (const double x : places_of(surface, from_mm, to_mm)) {
    TRY(const auto point, surface.at(x));
    out.samples_.push_back({x, point});
  }
  out.make_boxes();
  return out;
}

void SurfaceSamples::make_boxes() {
  for (std::size_t first = 0; first < samples_.size(); first += kBoxedSamples) {
    Eigen::Array2d low(samples_[first].x, samples_[first].surface.height_mm);
    Eigen::Array2d high = low;
    for (std::size_t i = first; i < std::min(first + kBoxedSamples, samples_.size()); ++i) {
      const Eigen::Array2d p(samples_[i].x, samples_[i].surface.height_mm);
      low = low.min(p);
      high = high.max(p);
    }
    boxes_.push_back({low, high});
  }
}

/// Returns the least of `cost` at sample i and between its two neighbours.
template <class Cost>
SurfaceSamples::Place SurfaceSamples::refined(std::size_t i, const Cost& cost) const {
  const double low = samples_[i > 0 ? i - 1 : 0].x;
  const double high = samples_[std::min(i + 1, samples_.size() - 1)].x;
  const double x = least_between(low, high, cost);
  const double found = cost(x);
  const double there = cost(samples_[i].x);
  return found < there ? Place{x, found} : Place{samples_[i].x, there};
}

SurfaceSamples::Place SurfaceSamples::greatest_curvature() const {
  const auto worst = std::ranges::max_element(
      samples_, {}, [](const Sample& s) { return s.surface.curvature_per_mm(); });
  Place out = refined(static_cast<std::size_t>(worst - samples_.begin()), [&](double x) {
    const auto point = surface_->at(x);
    return point ? -point->curvature_per_mm() : std::numeric_limits<double>::infinity();
  });
  out.value = -out.value;
  return out;
}

double SurfaceSamples::least_curvature_per_mm() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Sample& s : samples_) least = std::min(least, s.surface.curvature_per_mm());
  return least;
}

SurfaceSamples::Place SurfaceSamples::nearest(const Eigen::Vector2d& from_mm,
                                              double beyond_mm) const {
  double best = beyond_mm * beyond_mm;
  std::optional<std::size_t> place;
  const Eigen::Array2d c = from_mm.array();
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const Eigen::Array2d off = (boxes_[b].low - c).max(c - boxes_[b].high).max(0.0);
    if (off.square().sum() >= best) continue;
    for (std::size_t i = b * kBoxedSamples; i < std::min((b + 1) * kBoxedSamples, samples_.size());
         ++i) {
      const double dx = samples_[i].x - c.x();
      const double dz = samples_[i].surface.height_mm - c.y();
      if (dx * dx + dz * dz >= best) continue;
      best = dx * dx + dz * dz;
      place = i;
    }
  }
  if (!place) return {from_mm.x(), beyond_mm};
  return refined(*place, [&](double x) {
    const auto point = surface_->at(x);
    return point ? std::hypot(x - c.x(), point->height_mm - c.y())
                 : std::numeric_limits<double>::infinity();
  });
}

}  // namespace rondure::fit
