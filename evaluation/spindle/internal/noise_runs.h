#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/noise.h"
#include "fit/spindle/separation_model.h"
#include "fit/spindle/three_probe.h"

namespace rondure::evaluation {

/// Number of separations of noise alone, which show what the noise of the readings makes of part
/// and motion: the part's own noise acts in the motion, too.
constexpr int kNoiseEvaluations = 400;

/// Calls `visit` with the curves of each of them.
template <class Visit>
void visit_noise(const fit::SeparationModel& model, const fit::ThreeProbeResult& separation,
                 std::uint64_t seed, Visit visit) {
  constexpr std::uint64_t kNoiseRuns = 0x5b1d20U;
  const std::size_t count = separation.alpha_rad.size();
  // The mean revolution holds all readings of a probe.
  const double sigma = separation.noise_mm * std::sqrt(static_cast<double>(count) /
                                                       static_cast<double>(separation.readings));
  for (int run = 0; run < kNoiseEvaluations; ++run) {
    core::KeyedNoise noise(seed, {kNoiseRuns, static_cast<std::uint64_t>(run)});
    std::array<std::vector<double>, 3> readings;
    for (auto& h : readings) {
      h.resize(count);
      for (double& value : h) value = sigma * noise.normal();
    }
    visit(model.of_readings(readings));
  }
}

}  // namespace rondure::evaluation
