#include "fit/wheel/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/numbers.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kLeastRows = 5;
/// Tolerance at the ends of ranges [mm]: a path of equal steps ends there only to round-off.
constexpr double kEndSlack = 1e-9;
/// Splines through rows of zero depth may be this far below zero [mm].
constexpr double kDepthSlack = 1e-6;

core::Result<SurfacePoint> place_on(const Polynomial& form, double x) {
  SurfacePoint out;
  for (std::size_t j = form.coefficients.size(); j-- > 0;) {
    out.second_per_mm = out.second_per_mm * x + 2.0 * out.slope;
    out.slope = out.slope * x + out.height_mm;
    out.height_mm = out.height_mm * x + form.coefficients[j];
  }
  return out;
}

core::Result<SurfacePoint> place_on(const Asphere& form, double x) {
  const double c = form.curvature_per_mm;
  const double square = 1.0 - (1.0 + form.conic) * c * c * x * x;
  if (!(square > 0.0)) {
    return core::fail_with(
        core::Code::kSurface,
        "the asphere has no height at x = {:.6g} mm: its conic ends at |x| = {:.6g} mm", x,
        1.0 / (std::abs(c) * std::sqrt(1.0 + form.conic)));
  }
  const double g = std::sqrt(square);
  SurfacePoint out{c * x * x / (1.0 + g), c * x / g, c / (g * g * g)};
  double power = 1.0;  // x^(2j-2)
  for (std::size_t i = 0; i < form.even_terms.size(); ++i) {
    const auto n = static_cast<double>(2 * (i + 1));
    const double a = form.even_terms[i];
    out.height_mm += a * power * x * x;
    out.slope += n * a * power * x;
    out.second_per_mm += n * (n - 1.0) * a * power;
    power *= x * x;
  }
  return out;
}

core::Result<SurfacePoint> place_on(const core::OpenSpline& form, double x) {
  const double low = form.x().front();
  const double high = form.x().back();
  if (x < low - kEndSlack || x > high + kEndSlack) {
    return core::fail_with(
        core::Code::kSurface,
        "x = {:.6g} mm is outside the table, which runs from {:.6g} to {:.6g} mm", x, low, high);
  }
  const core::OpenSpline::Place place = form(x);
  return SurfacePoint{place.value, place.slope, place.second};
}

core::Result<core::OpenSpline> spline_of(std::vector<double> x_mm, std::vector<double> z_mm) {
  if (x_mm.size() < kLeastRows || z_mm.size() != x_mm.size()) {
    return core::fail_with(
        core::Code::kTable,
        "a surface table needs at least {} rows of x and z, there are {} x and {} z", kLeastRows,
        x_mm.size(), z_mm.size());
  }
  for (std::size_t i = 0; i < x_mm.size(); ++i) {
    if (!core::is_measurable(x_mm[i]) || !core::is_measurable(z_mm[i])) {
      return core::fail_with(core::Code::kNotFinite,
                             "row {} (counted from 0) of the table is not a finite number", i);
    }
    if (i == 0 || x_mm[i] > x_mm[i - 1]) continue;
    return core::fail_with(
        core::Code::kTable,
        "x of a table must rise: row {} (counted from 0) has {:.6g} mm after {:.6g} mm", i, x_mm[i],
        x_mm[i - 1]);
  }
  core::OpenSpline out(std::move(x_mm), std::move(z_mm));
  for (const double x : out.x()) {
    const core::OpenSpline::Place place = out(x);
    if (std::isfinite(place.value) && std::isfinite(place.slope) && std::isfinite(place.second)) {
      continue;
    }
    return core::fail_with(core::Code::kTable,
                           "the table has no finite curvature at x = {:.6g} mm: its rows stand too "
                           "close together, or too far apart",
                           x);
  }
  return out;
}

bool all_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

}  // namespace

double SurfacePoint::stretch() const { return std::sqrt(1.0 + slope * slope); }

double SurfacePoint::curvature_per_mm() const {
  const double q = stretch();
  return second_per_mm / (q * q * q);
}

core::Result<WheelSurface> WheelSurface::polynomial(Polynomial polynomial) {
  if (polynomial.coefficients.empty() || !all_finite(polynomial.coefficients)) {
    return core::fail(core::Code::kBadOption,
                      "a polynomial surface needs at least one coefficient, all finite");
  }
  return WheelSurface(std::move(polynomial));
}

core::Result<WheelSurface> WheelSurface::asphere(Asphere asphere) {
  const bool finite = std::isfinite(asphere.curvature_per_mm) && std::isfinite(asphere.conic);
  if (!finite || !all_finite(asphere.even_terms)) {
    return core::fail(core::Code::kBadOption,
                      "curvature, conic and even terms of an asphere must be finite");
  }
  return WheelSurface(std::move(asphere));
}

core::Result<WheelSurface> WheelSurface::table(std::vector<double> x_mm, std::vector<double> z_mm) {
  TRY(auto spline, spline_of(std::move(x_mm), std::move(z_mm)));
  return WheelSurface(std::move(spline));
}

core::Result<WheelSurface> WheelSurface::less(std::vector<double> x_mm,
                                              std::vector<double> depth_mm) const {
  for (std::size_t i = 0; i < std::min(x_mm.size(), depth_mm.size()); ++i) {
    if (!(depth_mm[i] < 0.0)) continue;
    return core::fail_with(core::Code::kSurface,
                           "the removal is {:.6g} mm at x = {:.6g} mm; a depth is 0 or more",
                           depth_mm[i], x_mm[i]);
  }
  TRY(auto spline, spline_of(std::move(x_mm), std::move(depth_mm)));
  WheelSurface out = *this;
  out.removal_ = std::move(spline);
  return out;
}

core::Result<SurfacePoint> WheelSurface::at(double x_mm) const {
  auto out = std::visit([&](const auto& form) { return place_on(form, x_mm); }, form_);
  if (!out || !removal_) return out;
  const auto depth = place_on(*removal_, x_mm);
  if (!depth) return depth;
  if (depth->height_mm < -kDepthSlack) {
    return core::fail_with(
        core::Code::kSurface,
        "the removal is {:.3g} mm at x = {:.6g} mm, between rows of its table; give more rows",
        depth->height_mm, x_mm);
  }
  return SurfacePoint{out->height_mm - depth->height_mm, out->slope - depth->slope,
                      out->second_per_mm - depth->second_per_mm};
}

std::vector<double> WheelSurface::rows_mm() const {
  std::vector<double> out;
  const auto add = [&](const core::OpenSpline& spline) {
    out.insert(out.end(), spline.x().begin(), spline.x().end());
  };
  if (const auto* spline = std::get_if<core::OpenSpline>(&form_)) add(*spline);
  if (removal_) add(*removal_);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::optional<std::pair<double, double>> WheelSurface::range_mm() const {
  std::optional<std::pair<double, double>> out;
  const auto narrow = [&](const core::OpenSpline& spline) {
    if (!out) out = {spline.x().front(), spline.x().back()};
    out->first = std::max(out->first, spline.x().front());
    out->second = std::min(out->second, spline.x().back());
  };
  if (const auto* spline = std::get_if<core::OpenSpline>(&form_)) narrow(*spline);
  if (removal_) narrow(*removal_);
  return out;
}

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
