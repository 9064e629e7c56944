#pragma once

// The profile of the method specification, roundness A.11 and B.9, and seeded rough profiles.

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::test {

struct Undulation {
  int number;
  double amplitude_um;
  double phase_deg;
};

/// Form of A.11 with the two high undulations of B.9.
inline const std::vector<Undulation>& spec_undulations() {
  static const std::vector<Undulation> all = {
      {2, 3.0, 20.0}, {3, 2.0, -45.0}, {5, 0.8, 100.0},  {7, 0.6, -10.0}, {11, 0.4, 75.0},
      {16, 0.5, 0.0}, {23, 0.3, 33.0}, {40, 0.2, -60.0}, {60, 0.4, 15.0}, {150, 0.3, -120.0}};
  return all;
}

inline double spec_form_um(double theta) {
  double sum = 0.0;
  for (const auto& u : spec_undulations()) {
    sum += u.amplitude_um * std::cos(u.number * theta - u.phase_deg * core::kDegree);
  }
  return sum;
}

/// B.9: centre (10, -5) um, limacon, deviations [mm].
inline double spec_profile_mm(double theta) {
  return (spec_form_um(theta) + 10.0 * std::cos(theta) - 5.0 * std::sin(theta)) * core::kMicrometre;
}

inline std::vector<double> uniform_angles(std::size_t count) {
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = core::kTwoPi * static_cast<double>(i) / static_cast<double>(count);
  }
  return out;
}

inline std::vector<double> spec_profile(const std::vector<double>& theta) {
  std::vector<double> out;
  for (const double t : theta) out.push_back(spec_profile_mm(t));
  return out;
}

/// White noise of 1 um on the spec's profile.
inline std::vector<double> rough_profile(std::uint64_t seed, std::size_t count) {
  core::KeyedNoise noise(seed, {16});
  auto out = spec_profile(uniform_angles(count));
  for (double& r : out) r += 1e-3 * noise.normal();
  return out;
}

}  // namespace rondure::test
