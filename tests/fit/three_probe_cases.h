#pragma once

#include <cmath>
#include <vector>

#include "core/noise.h"
#include "core/units.h"
#include "fit/spindle/three_probe.h"

// Simulated parts and motions and the readings of three probes, by the measurement equations of
// methods, roundness A.3, independent of the code under test.

namespace rondure::fit {

struct Wave {
  int order = 0;
  double amplitude_um = 0.0;
  double phase_rad = 0.0;
};

inline double sum_of(const std::vector<Wave>& waves, double angle) {
  double sum = 0.0;
  for (const Wave& w : waves) sum += w.amplitude_um * std::cos(w.order * angle - w.phase_rad);
  return sum;
}

/// The dynamic case of A.11. Lengths in um.
struct SpindleCase {
  SwingArm arm = {49.0, 299.88, 24.56};
  std::vector<Wave> profile = {{2, 3.0, 20.0 * core::kDegree},  {3, 2.0, -45.0 * core::kDegree},
                               {5, 0.8, 100.0 * core::kDegree}, {7, 0.6, -10.0 * core::kDegree},
                               {11, 0.4, 75.0 * core::kDegree}, {16, 0.5, 0.0},
                               {23, 0.3, 33.0 * core::kDegree}, {40, 0.2, -60.0 * core::kDegree}};

  [[nodiscard]] static double x_um(double a) {
    return 1.5 * std::cos(a - 0.3) + 0.7 * std::cos(2 * a + 1) + 0.4 * std::cos(5 * a - 0.5) +
           0.3 * std::sin(9 * a);
  }
  [[nodiscard]] static double y_um(double a) {
    return -std::sin(a + 0.2) + 0.9 * std::cos(3 * a) + 0.5 * std::sin(4 * a + 0.7) +
           0.25 * std::cos(13 * a);
  }
};

/// Reading of probe i at a work angle [um], to first order.
inline double reading_um(const SpindleCase& c, const ProbeLayout& layout, std::size_t i,
                         double alpha) {
  const double beta = c.arm.beta_rad(alpha);
  const double place = layout.angles_rad()[i];
  return sum_of(c.profile, alpha + beta + place) +
         SpindleCase::y_um(alpha) * std::cos(place + beta) +
         SpindleCase::x_um(alpha) * std::sin(place + beta);
}

/// Readings at given work angles.
inline ProbeReadings readings_at(const SpindleCase& c, const ProbeLayout& layout,
                                 std::vector<double> alpha) {
  ProbeReadings out;
  out.alpha_rad = std::move(alpha);
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double a : out.alpha_rad)
      out.h_mm[i].push_back(reading_um(c, layout, i, a) * core::kMicrometre);
  }
  return out;
}

/// Work angles at which theta is uniform.
inline std::vector<double> uniform_theta(const SwingArm& arm, int count) {
  std::vector<double> alpha;
  for (int n = 0; n < count; ++n) alpha.push_back(arm.alpha_of_theta_rad(core::kTwoPi * n / count));
  return alpha;
}

inline std::vector<double> uniform_alpha(int count, int turns = 1) {
  std::vector<double> alpha;
  for (int n = 0; n < count * turns; ++n) alpha.push_back(core::kTwoPi * n / count);
  return alpha;
}

inline double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace rondure::fit
