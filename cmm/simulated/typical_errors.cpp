#include "cmm/simulated/machine.h"

namespace rondure::cmm {
namespace {

constexpr double kUm = 1e-3;            // mm
constexpr double kUm_m = 1e-6;          // mm/mm
constexpr double kUm_m2 = 1e-9;         // mm/mm^2
constexpr double kUrad = 1e-6;          // rad
constexpr double kUrad_m = 1e-9;        // rad/mm
constexpr double kStraight_mm = 300.0;  // wave lengths of guides and of their pitch
constexpr double kTilt_mm = 400.0;

ErrorCurve straightness(double quadratic_um_m2, double wave_um, double phase_rad) {
  return {0.0, quadratic_um_m2 * kUm_m2, wave_um * kUm, kStraight_mm, phase_rad};
}

ErrorCurve rotation(double linear_urad_m, double wave_urad, double phase_rad) {
  return {linear_urad_m * kUrad_m, 0.0, wave_urad * kUrad, kTilt_mm, phase_rad};
}

ErrorCurve position(double linear_um_m, double period_mm, double phase_rad) {
  return {linear_um_m * kUm_m, 0.0, 0.4 * kUm, period_mm, phase_rad};
}

}  // namespace

MachineErrors typical_errors() {
  MachineErrors out;
  AxisErrors& x = out.geometry.axes[0];
  AxisErrors& y = out.geometry.axes[1];
  AxisErrors& z = out.geometry.axes[2];
  x.translation = {position(3.0, 120.0, 0.3), straightness(1.5, 0.3, 1.0),
                   straightness(-1.0, 0.2, 2.1)};
  y.translation = {straightness(-1.2, 0.3, 0.4), position(-2.5, 150.0, 1.7),
                   straightness(1.0, 0.25, 2.8)};
  z.translation = {straightness(0.8, 0.2, 0.9), straightness(-0.9, 0.2, 2.4),
                   position(2.0, 90.0, 0.8)};
  x.rotation = {rotation(2.0, 1.0, 0.2), rotation(-3.0, 1.0, 1.4), rotation(2.5, 0.8, 2.6)};
  y.rotation = {rotation(3.0, 1.0, 0.7), rotation(-2.0, 1.0, 1.9), rotation(3.5, 1.0, 3.0)};
  z.rotation = {rotation(-2.0, 0.8, 1.1), rotation(2.0, 0.8, 2.2), rotation(1.5, 0.5, 0.1)};
  out.geometry.squareness_xy_rad = 4.0 * kUrad;
  out.geometry.squareness_xz_rad = -3.0 * kUrad;
  out.geometry.squareness_yz_rad = 3.5 * kUrad;
  out.geometry.tip_offset_mm = {0.0, 0.0, -150.0};
  out.pretravel_mm = 1.0 * kUm;
  out.pretravel_z_mm = 0.5 * kUm;
  out.pretravel_lobes = {{3, 0.6 * kUm, 0.5}};
  out.stylus = {40.0, 2.0, 600e3, 0.08};
  out.backlash_mm = {0.3 * kUm, 0.3 * kUm, 0.2 * kUm};
  out.scale_expansion_1_K = 8e-6;
  out.scale_temperature_degC = 20.3;
  out.drift_mm = {0.5 * kUm, 0.4 * kUm, 0.8 * kUm};
  out.drift_time_s = 3600.0;
  return out;
}

}  // namespace rondure::cmm
