#pragma once

// The worked example of the method specification, contour section 10, and seeded axis errors.

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/noise.h"
#include "core/units.h"
#include "fit/contour/study.h"

namespace rondure::test {

/// One cosine: amplitude cos(number a + phase).
struct Wave {
  double number;
  double amplitude;
  double phase_rad;
};

inline double sum_of(const std::vector<Wave>& waves, double constant, double angle) {
  double out = constant;
  for (const Wave& w : waves) out += w.amplitude * std::cos(w.number * angle + w.phase_rad);
  return out;
}

/// Error of the X axis, dd of section 10 [um].
inline double spec_x_um(double alpha) {
  return sum_of({{2, 1.8, -0.4},
                 {3, 1.1, 0.9},
                 {5, 0.6, -1.2},
                 {9, 0.35, 0.3},
                 {17, 0.15, -2.0},
                 {31, 0.08, 1.0}},
                0.7, alpha);
}

/// Error of the C axis, dalpha of section 10 [mdeg].
inline double spec_c_mdeg(double alpha) {
  return sum_of({{1, 1.2, 0.5}, {2, 0.9, 1.4}, {4, 0.5, -0.6}, {8, 0.2, 2.0}}, 0.6, alpha);
}

inline double turn_angle(std::size_t i, std::size_t count) {
  return core::kTwoPi * static_cast<double>(i) / static_cast<double>(count);
}

inline fit::AxisErrors spec_errors(std::size_t count = 300, double c_scale = 1.0) {
  fit::AxisErrors out;
  for (std::size_t i = 0; i < count; ++i) {
    const double alpha = turn_angle(i, count);
    out.c_rad.push_back(c_scale * spec_c_mdeg(alpha) * 1e-3 * core::kDegree);
    out.x_mm.push_back(spec_x_um(alpha) * core::kMicrometre);
  }
  return out;
}

inline constexpr double kSpecCScale[4] = {1.00, 1.05, 0.95, 1.02};

/// Non-following part i = 0..3 of section 10 at the angles 2 pi m / count [mm].
inline std::vector<double> spec_rest(std::size_t part, std::size_t count = 1440) {
  struct Term {
    int number;
    double amplitude_um;
    double phase_deg;
  };
  static const std::vector<Term> kTerms[4] = {{{2, 1.0, 30}, {3, 0.5, 200}, {6, 0.3, 90}},
                                              {{2, 0.8, -40}, {4, 0.6, 10}, {5, 0.2, 0}},
                                              {{3, 0.9, 120}, {4, 0.4, -75}, {7, 0.2, 45}},
                                              {{2, 1.6, 195}, {3, 0.6, -60}, {6, 0.2, 10}}};
  std::vector<double> out(count);
  for (std::size_t m = 0; m < count; ++m) {
    for (const Term& t : kTerms[part]) {
      out[m] += t.amplitude_um * core::kMicrometre *
                std::cos(t.number * turn_angle(m, count) - t.phase_deg * core::kDegree);
    }
  }
  return out;
}

/// f of section 10: the contour error that follows from the axis errors of the specification, with
/// its spline.
inline fit::ContourError spec_following(double c_scale = 1.0, std::size_t path = 300,
                                        const fit::GroundContourOptions& options = {
                                            .refine = false}) {
  const fit::CrankGeometry geometry;
  auto ground = fit::ground_contour(geometry, spec_errors(path, c_scale), options).value();
  for (double& r : ground.r_mm) r -= geometry.pin_radius_mm;
  return fit::contour_error(ground.r_mm, geometry.pin_radius_mm).value();
}

/// The trace of a control: `turns` turns from `start` on, samples at equal steps, wrapped to
/// 0..360.
inline fit::AxisTrace spec_trace(std::size_t samples_a_turn = 300, double turns = 1.0,
                                 double start_rad = 0.0, double c_scale = 1.0) {
  fit::AxisTrace out;
  const auto count =
      static_cast<std::size_t>(std::llround(turns * static_cast<double>(samples_a_turn)));
  for (std::size_t i = 0; i < count; ++i) {
    const double alpha = start_rad + turn_angle(i, samples_a_turn);
    out.c_rad.push_back(std::fmod(alpha, core::kTwoPi));
    out.c_error_rad.push_back(c_scale * spec_c_mdeg(alpha) * 1e-3 * core::kDegree);
    out.x_error_mm.push_back(spec_x_um(alpha) * core::kMicrometre);
  }
  return out;
}

/// Seeded axis errors of some micrometres up to 20 undulations.
inline fit::AxisErrors random_errors(std::uint64_t seed, std::size_t count) {
  core::KeyedNoise noise(seed, {47});
  fit::AxisErrors out;
  out.c_rad.assign(count, 0.0);
  out.x_mm.assign(count, 0.0);
  for (int k = 0; k <= 20; ++k) {
    const double size = 2.0 / (1.0 + k);
    const double c = size * noise.normal() * 1e-3 * core::kDegree;
    const double x = size * noise.normal() * core::kMicrometre;
    const double phase = 3.0 * noise.normal();
    for (std::size_t i = 0; i < count; ++i) {
      const double alpha = turn_angle(i, count);
      out.c_rad[i] += c * std::cos(k * alpha + phase);
      out.x_mm[i] += x * std::cos(k * alpha - phase);
    }
  }
  return out;
}

}  // namespace rondure::test
