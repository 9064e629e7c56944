#include "cmm/simulated/internal/machine_map.h"

#include <cmath>

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

Vector3d drift_at(const MachineErrors& errors, double time_s) {
  return -std::expm1(-time_s / errors.drift_time_s) * errors.drift_mm;
}

bool is_zero(const ErrorCurve& curve) {
  return curve.linear_1_mm == 0.0 && curve.quadratic_1_mm2 == 0.0 && curve.wave == 0.0;
}

bool is_zero(const GeometricErrors& errors) {
  for (const AxisErrors& axis : errors.axes) {
    for (const ErrorCurve& curve : axis.translation) {
      if (!is_zero(curve)) return false;
    }
    for (const ErrorCurve& curve : axis.rotation) {
      if (!is_zero(curve)) return false;
    }
  }
  return errors.squareness_xy_rad == 0.0 && errors.squareness_xz_rad == 0.0 &&
         errors.squareness_yz_rad == 0.0;
}

double scale_stretch(const MachineErrors& errors) {
  return errors.scale_expansion_1_K * (errors.scale_temperature_degC - 20.0);
}

}  // namespace

Vector3d true_position(const MachineErrors& errors, const Vector3d& reading_W_mm, double time_s) {
  return reading_W_mm + geometric_error_mm(errors.geometry, reading_W_mm) +
         scale_stretch(errors) * reading_W_mm - drift_at(errors, time_s);
}

Vector3d reading_of(const MachineErrors& errors, const Vector3d& true_W_mm, double time_s) {
  // The errors change by far less than 1e-2 per mm: each pass gains at least two digits.
  Vector3d reading = true_W_mm;
  for (int pass = 0; pass < 20; ++pass) {
    const Vector3d miss = true_W_mm - true_position(errors, reading, time_s);
    reading += miss;
    if (miss.cwiseAbs().maxCoeff() < 1e-13) break;
  }
  return reading;
}

double trigger_delay_mm(const MachineErrors& errors, const Vector3d& direction) {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double across = std::hypot(direction.x(), direction.y());
  double way = errors.pretravel_mm + errors.stylus.deflection_mm();
  for (const PretravelLobe& lobe : errors.pretravel_lobes) {
    way += lobe.amplitude_mm * std::cos(lobe.order * azimuth + lobe.phase_rad);
  }
  return way * across + errors.pretravel_z_mm * std::abs(direction.z());
}

Vector3d backlash_shift_mm(const MachineErrors& errors, const Vector3d& direction) {
  constexpr double kMoves = 1e-9;  // smaller components are zero up to round-off
  Vector3d shift = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) < kMoves) continue;
    shift[k] = std::copysign(0.5 * errors.backlash_mm[k], direction[k]);
  }
  return shift;
}

bool has_map(const MachineErrors& errors) {
  return !is_zero(errors.geometry) || scale_stretch(errors) != 0.0 || !errors.drift_mm.isZero(0.0);
}

}  // namespace rondure::cmm
