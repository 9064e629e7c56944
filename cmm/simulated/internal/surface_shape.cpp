#include "cmm/simulated/internal/surface_shape.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/units.h"

namespace rondure::cmm {

namespace {

/// A window of the given width about 0 with C2 flanks, and its derivatives.
struct Window {
  double value = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
};

Window window(double x_mm, double width_mm, double flank_mm) {
  // 0 at the edge, 1 at the inner end.
  const double t = (0.5 * width_mm - std::abs(x_mm)) / flank_mm;
  if (t <= 0.0) return {};
  if (t >= 1.0) return {1.0, 0.0, 0.0};
  const double down = x_mm < 0.0 ? 1.0 / flank_mm : -1.0 / flank_mm;  // dt/dx
  return {t * t * t * (10.0 + t * (6.0 * t - 15.0)), 30.0 * t * t * (1.0 - t) * (1.0 - t) * down,
          60.0 * t * (1.0 - t) * (1.0 - 2.0 * t) / (flank_mm * flank_mm)};
}

void add_mark(const PartSurface& surface, const SurfaceMark& mark, double theta_rad, double z_mm,
              RadiusDerivatives& d) {
  const double radius = surface.radius_mm;
  const Window along = window(z_mm - mark.z_mm, mark.length_mm, mark.flank_mm);
  if (along.value == 0.0) return;
  const double apart = std::remainder(theta_rad - mark.theta_rad, core::kTwoPi);
  const Window around = window(radius * apart, mark.width_mm, mark.flank_mm);
  const double height = surface.inside ? -mark.height_mm : mark.height_mm;
  d.r_mm += height * around.value * along.value;
  d.t += height * radius * around.slope * along.value;
  d.z += height * around.value * along.slope;
  d.tt += height * radius * radius * around.curvature * along.value;
  d.tz += height * radius * around.slope * along.slope;
  d.zz += height * around.value * along.curvature;
}

constexpr double kSlope = 1.875;  // largest derivative of a flank of height and width 1

double wavelength_of(const SurfaceMark& mark) { return 4.0 * mark.flank_mm; }

/// Adds the contribution of a mark to the bounds of the absolute values.
void bound_mark(const PartSurface& surface, const SurfaceMark& mark, RadiusDerivatives& b) {
  constexpr double kCurvature = 5.7736;  // largest derivative of that
  const double height = std::abs(mark.height_mm);
  const double radius = surface.radius_mm;
  const double slope = height * kSlope / mark.flank_mm;
  const double curvature = height * kCurvature / (mark.flank_mm * mark.flank_mm);
  b.r_mm += height;
  b.t += radius * slope;
  b.z += slope;
  b.tt += radius * radius * curvature;
  b.tz += radius * slope * kSlope / mark.flank_mm;
  b.zz += curvature;
}

}  // namespace

RadiusDerivatives radius_derivatives(const PartSurface& surface, double theta_rad, double z_mm) {
  const PartForm& form = surface.form;
  const double scale = 1.0 / surface.half_length_mm;  // dq/dz
  const double q = z_mm * scale;
  RadiusDerivatives d;
  d.r_mm = surface.radius_mm;
  for (const Lobe& lobe : form.lobes) {
    const double n = lobe.order;
    const double twist = lobe.twist_rad * scale;
    const double angle = n * theta_rad + lobe.phase_rad + lobe.twist_rad * q;
    const double cosine = lobe.amplitude_mm * std::cos(angle);
    const double sine = lobe.amplitude_mm * std::sin(angle);
    d.r_mm += cosine;
    d.t -= n * sine;
    d.z -= twist * sine;
    d.tt -= n * n * cosine;
    d.tz -= n * twist * cosine;
    d.zz -= twist * twist * cosine;
  }
  const double parabola = q * q - 1.0 / 3.0;
  const double bend_cos = form.bend_mm * std::cos(theta_rad + form.bend_phase_rad);
  const double bend_sin = form.bend_mm * std::sin(theta_rad + form.bend_phase_rad);
  d.r_mm += form.taper_mm * q + (form.barrel_mm + bend_cos) * parabola;
  d.t -= bend_sin * parabola;
  d.z += (form.taper_mm + 2.0 * q * (form.barrel_mm + bend_cos)) * scale;
  d.tt -= bend_cos * parabola;
  d.tz -= 2.0 * q * bend_sin * scale;
  d.zz += 2.0 * (form.barrel_mm + bend_cos) * scale * scale;
  for (const SurfaceMark& mark : surface.marks) add_mark(surface, mark, theta_rad, z_mm, d);
  return d;
}

SurfaceJet surface_jet(const PartSurface& surface, double u_mm, double z_mm) {
  const double per_u = 1.0 / surface.radius_mm;  // d theta / du
  const double theta = u_mm * per_u;
  const RadiusDerivatives d = radius_derivatives(surface, theta, z_mm);
  const Eigen::Vector3d radial(std::cos(theta), std::sin(theta), 0.0);
  const Eigen::Vector3d tangent(-radial.y(), radial.x(), 0.0);
  SurfaceJet jet;
  jet.x_mm = d.r_mm * radial + z_mm * Eigen::Vector3d::UnitZ();
  jet.u = per_u * (d.t * radial + d.r_mm * tangent);
  jet.z = d.z * radial + Eigen::Vector3d::UnitZ();
  jet.uu = per_u * per_u * ((d.tt - d.r_mm) * radial + 2.0 * d.t * tangent);
  jet.uz = per_u * (d.tz * radial + d.z * tangent);
  jet.zz = d.zz * radial;
  return jet;
}

namespace {

ShapeBounds bounds_with(const PartSurface& surface, std::span<const SurfaceMark> marks) {
  const PartForm& form = surface.form;
  const double scale = 1.0 / surface.half_length_mm;
  const double barrel = std::abs(form.barrel_mm);
  const double bend = std::abs(form.bend_mm);
  const double parabola = 2.0 / 3.0;  // largest |q^2 - 1/3|
  // greatest gradient of a phase along the surface [rad/mm]
  double fastest_1_mm = 1.0 / surface.radius_mm;
  RadiusDerivatives b;  // bounds of the absolute values
  b.r_mm = std::abs(form.taper_mm) + (barrel + bend) * parabola;
  b.t = bend * parabola;
  b.z = (std::abs(form.taper_mm) + 2.0 * (barrel + bend)) * scale;
  b.tt = bend * parabola;
  b.tz = 2.0 * bend * scale;
  b.zz = 2.0 * (barrel + bend) * scale * scale;
  for (const Lobe& lobe : form.lobes) {
    const double a = std::abs(lobe.amplitude_mm);
    const double n = std::abs(lobe.order);
    const double twist = std::abs(lobe.twist_rad) * scale;
    b.r_mm += a;
    b.t += a * n;
    b.z += a * twist;
    b.tt += a * n * n;
    b.tz += a * n * twist;
    b.zz += a * twist * twist;
    if (a > 0.0) fastest_1_mm = std::max({fastest_1_mm, n / surface.radius_mm, twist});
  }
  ShapeBounds bounds;
  bounds.toward_free_mm = b.r_mm;
  for (const SurfaceMark& mark : marks) {
    bound_mark(surface, mark, b);
    bounds.toward_free_mm += std::max(0.0, mark.height_mm);
    fastest_1_mm = std::max(fastest_1_mm, core::kTwoPi / wavelength_of(mark));
  }
  const double per_u = 1.0 / surface.radius_mm;
  bounds.deviation_mm = b.r_mm;
  bounds.stretch_u = per_u * std::hypot(surface.radius_mm + b.r_mm, b.t);
  bounds.stretch_z = std::hypot(1.0, b.z);
  bounds.form_curvature_1_mm = per_u * per_u * b.tt + 2.0 * per_u * b.tz + b.zz;
  bounds.wavelength_mm = core::kTwoPi / fastest_1_mm;
  return bounds;
}

}  // namespace

ShapeBounds shape_bounds(const PartSurface& surface) { return bounds_with(surface, surface.marks); }

ShapeBounds bounds_beside_marks(const PartSurface& surface) { return bounds_with(surface, {}); }

BoxBounds bounds_in_box(const PartSurface& surface, const ShapeBounds& beside,
                        const Eigen::Vector2d& center_mm, const Eigen::Vector2d& half_mm) {
  BoxBounds out{beside.stretch_u, beside.stretch_z, beside.wavelength_mm};
  const double turn_mm = core::kTwoPi * surface.radius_mm;
  for (const SurfaceMark& mark : surface.marks) {
    // Points of the box are not nearer to the middle of the mark than this less half the box, and
    // not farther than this and half the box.
    const Eigen::Vector2d apart(
        std::abs(std::remainder(center_mm.x() - surface.radius_mm * mark.theta_rad, turn_mm)),
        std::abs(center_mm.y() - mark.z_mm));
    const Eigen::Vector2d edge(0.5 * mark.width_mm, 0.5 * mark.length_mm);
    if (((apart - half_mm).array() >= edge.array()).any()) continue;
    const double height = std::abs(mark.height_mm);
    out.stretch_u += height / surface.radius_mm;
    const auto flank =
        ((apart + half_mm).array() > (edge.array() - mark.flank_mm)).cast<double>().eval();
    const double slope = height * kSlope / mark.flank_mm;
    out.stretch_u += slope * flank.x();
    out.stretch_z += slope * flank.y();
    if (flank.sum() > 0.0) out.wavelength_mm = std::min(out.wavelength_mm, wavelength_of(mark));
  }
  return out;
}

double PartSurface::radius_at(double theta_rad, double z_mm) const {
  return radius_derivatives(*this, theta_rad, z_mm).r_mm;
}

PartSurface PartSurface::scaled(double factor) const {
  PartSurface out = *this;
  for (double* length : {&out.radius_mm, &out.half_length_mm, &out.form.taper_mm,
                         &out.form.barrel_mm, &out.form.bend_mm}) {
    *length *= factor;
  }
  for (Lobe& lobe : out.form.lobes) lobe.amplitude_mm *= factor;
  for (SurfaceMark& mark : out.marks) {
    for (double* length :
         {&mark.z_mm, &mark.width_mm, &mark.length_mm, &mark.height_mm, &mark.flank_mm}) {
      *length *= factor;
    }
  }
  return out;
}

}  // namespace rondure::cmm
