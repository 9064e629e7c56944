#include "fit/wheel/surface.h"

#include <algorithm>
#include <cmath>

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

}  // namespace rondure::fit
