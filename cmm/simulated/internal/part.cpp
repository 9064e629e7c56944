#include "cmm/simulated/part.h"

#include <complex>

namespace rondure::cmm {
namespace {

/// (u_x + i u_y)^n with the phase of a lobe, and n times the power below it: its derivative.
struct LobeTerm {
  std::complex<double> value;
  std::complex<double> derivative;
};

LobeTerm term_of(const Lobe& lobe, const Eigen::Vector3d& u) {
  const std::complex<double> w(u.x(), u.y());
  const std::complex<double> turned = std::polar(lobe.amplitude_mm, lobe.phase_rad);
  const std::complex<double> below = std::pow(w, lobe.order - 1);
  return {turned * below * w, turned * below * static_cast<double>(lobe.order)};
}

}  // namespace

double FaceSurface::height_at(double x_mm, double y_mm) const {
  const double q = std::hypot(x_mm, y_mm);
  const double theta = std::atan2(mirrored ? -y_mm : y_mm, x_mm);
  const double t = q / outer_mm;
  return tilt_rad * q * std::cos(theta - toward_rad) +
         t * t * (saucer_mm + wave_mm * std::cos(wave_order * theta));
}

Eigen::Vector2d FaceSurface::slope_at(double x_mm, double y_mm) const {
  const double side = mirrored ? -1.0 : 1.0;
  const double q = std::hypot(x_mm, y_mm);
  const double theta = std::atan2(side * y_mm, x_mm);
  const double t = q / outer_mm;
  const double wave = wave_mm * std::cos(wave_order * theta);
  const double along = 2.0 * t / outer_mm * (saucer_mm + wave);  // dh/dq without the tilt
  const double around =                                          // dh/dtheta / q without it
      -t / outer_mm * wave_order * wave_mm * std::sin(wave_order * theta);
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  return {tilt_rad * std::cos(toward_rad) + along * c - around * s,
          side * (tilt_rad * std::sin(toward_rad) + along * s + around * c)};
}

FaceSurface FaceSurface::scaled(double factor) const {
  FaceSurface out = *this;
  for (double* length : {&out.inner_mm, &out.outer_mm, &out.saucer_mm, &out.wave_mm}) {
    *length *= factor;
  }
  return out;
}

double BallSurface::radius_at(const Eigen::Vector3d& u) const {
  double r_mm = radius_mm;
  for (const Lobe& lobe : lobes) r_mm += term_of(lobe, u).value.real();
  return r_mm;
}

Eigen::Vector3d BallSurface::normal_at(const Eigen::Vector3d& u) const {
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (const Lobe& lobe : lobes) {
    const std::complex<double> d = term_of(lobe, u).derivative;
    slope += Eigen::Vector3d(d.real(), -d.imag(), 0.0);
  }
  slope -= u.dot(slope) * u;
  return (radius_at(u) * u - slope).normalized();
}

BallSurface BallSurface::scaled(double factor) const {
  BallSurface out = *this;
  out.radius_mm *= factor;
  for (Lobe& lobe : out.lobes) lobe.amplitude_mm *= factor;
  return out;
}

SimulatedPart SimulatedPart::scaled(double factor) const {
  SimulatedPart out = *this;
  for (Placed& placed : out.surfaces) {
    placed.X_PS.translation() *= factor;
    std::visit([&](auto& surface) { surface = surface.scaled(factor); }, placed.surface);
  }
  return out;
}

}  // namespace rondure::cmm
