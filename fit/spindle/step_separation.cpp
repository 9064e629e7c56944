#include "fit/spindle/step_separation.h"

#include <cmath>
#include <complex>
#include <limits>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

using core::Code;

core::Result<void> check_trace(std::span<const double> trace, std::size_t count) {
  if (trace.size() != count) {
    return core::fail(Code::kSampling, fmt::format("a trace has {} readings, the first one {}; all "
                                                   "need the same length",
                                                   trace.size(), count));
  }
  for (std::size_t n = 0; n < count; ++n) {
    if (!core::is_measurable(trace[n])) {
      return core::fail(Code::kNotFinite, fmt::format("row {} holds no finite number up to {:g}", n,
                                                      core::kGreatestNumber));
    }
  }
  return {};
}

core::Result<void> check(std::size_t count, const StepOptions& options) {
  if (options.highest < 2 || !(options.noise_mm >= 0.0) || !(options.greatest_gain > 0.0)) {
    return core::fail(Code::kBadOption,
                      "the highest harmonic must be at least 2, noise and gain not negative");
  }
  const auto needed = static_cast<std::size_t>(2 * options.highest + 2);
  if (count >= needed) return {};
  return core::fail(Code::kSampling,
                    fmt::format("{} readings do not carry {} undulations; at least {} are needed",
                                count, options.highest, needed));
}

/// Entry of the table for one harmonic. `gain` is the noise gain of the complex amplitude of the
/// part relative to one trace.
RecoveredHarmonic harmonic_of(int order, double gain, const Complex& value, std::size_t count,
                              const StepOptions& options) {
  RecoveredHarmonic out;
  out.order = order;
  out.gain = gain;
  out.transfer = 1.0 / gain;
  out.recovered = gain <= options.greatest_gain;
  out.sigma_mm = gain * options.noise_mm * std::sqrt(2.0 / static_cast<double>(count));
  if (!out.recovered) return out;
  out.amplitude_mm = 2.0 * std::abs(value) / static_cast<double>(count);
  if (out.amplitude_mm > 3.0 * out.sigma_mm)
    out.phase_rad = std::remainder(-std::arg(value), core::kTwoPi);
  return out;
}

/// One harmonic solved from all traces: r, S and the gain of r.
struct SolvedHarmonic {
  Complex part;
  Complex motion;
  double gain = std::numeric_limits<double>::infinity();
};

SolvedHarmonic solve(int order, std::span<const double> steps, std::span<const Spectrum> traces) {
  const auto k = static_cast<std::size_t>(order);
  const auto count = static_cast<double>(steps.size());
  Complex turns;   // sum of e_j
  Complex turned;  // sum of conj(e_j) m_j
  Complex sum;
  for (std::size_t j = 0; j < steps.size(); ++j) {
    const Complex e = std::polar(1.0, order * steps[j]);
    turns += e;
    turned += std::conj(e) * traces[j][k];
    sum += traces[j][k];
  }
  const double determinant = count * count - std::norm(turns);
  SolvedHarmonic out;
  if (determinant < 1e-12 * count * count) {
    out.motion = sum / count;
    return out;
  }
  out.part = (count * turned - std::conj(turns) * sum) / determinant;
  out.motion = (count * sum - turns * turned) / determinant;
  out.gain = std::sqrt(count / determinant);
  return out;
}

}  // namespace

core::Result<StepSeparation> separate_multi_step(std::span<const double> steps_rad,
                                                 std::span<const std::vector<double>> traces_mm,
                                                 const StepOptions& options) {
  if (steps_rad.size() != traces_mm.size() || steps_rad.size() < 2) {
    return core::fail(Code::kSampling,
                      fmt::format("{} steps and {} traces; one trace a step and at least 2 are "
                                  "needed",
                                  steps_rad.size(), traces_mm.size()));
  }
  const std::size_t count = traces_mm.front().size();
  if (auto sound = check(count, options); !sound) return core::fail(sound.error());
  if (auto sound = check_trace(steps_rad, steps_rad.size()); !sound)
    return core::fail(sound.error());
  std::vector<Spectrum> traces;
  for (const auto& trace : traces_mm) {
    if (auto sound = check_trace(trace, count); !sound) return core::fail(sound.error());
    traces.push_back(spectrum(trace));
  }
  Spectrum part(traces.front().size());
  Spectrum motion(part.size());
  StepSeparation out;
  for (int order = 2; 2 * static_cast<std::size_t>(order) < count; ++order) {
    const auto k = static_cast<std::size_t>(order);
    const SolvedHarmonic solved = solve(order, steps_rad, traces);
    const bool asked = order <= options.highest;
    const bool kept = asked && solved.gain <= options.greatest_gain;
    if (kept) part[k] = solved.part;
    Complex mean;  // a harmonic that is not recovered remains in the motion, as the mean trace
    for (const Spectrum& trace : traces) mean += trace[k] / static_cast<double>(traces.size());
    motion[k] = kept ? solved.motion : mean;
    if (!asked) continue;
    out.harmonics.push_back(harmonic_of(order, solved.gain, solved.part, count, options));
    if (!kept) out.unrecovered.push_back(order);
  }
  if (out.unrecovered.size() == out.harmonics.size()) {
    return core::fail(Code::kRank,
                      "all steps are alike: the part was never turned against the "
                      "spindle");
  }
  out.part = {0.0, series_of(part, count)};
  out.motion_mm = series_of(motion, count);
  return out;
}

core::Result<StepSeparation> separate_reversal(std::span<const double> first_mm,
                                               std::span<const double> reversed_mm,
                                               const StepOptions& options) {
  const std::size_t count = first_mm.size();
  if (auto sound = check(count, options); !sound) return core::fail(sound.error());
  if (auto sound = check_trace(first_mm, count); !sound) return core::fail(sound.error());
  if (auto sound = check_trace(reversed_mm, count); !sound) return core::fail(sound.error());
  const Spectrum first = spectrum(first_mm);
  const Spectrum other = spectrum(reversed_mm);
  Spectrum part(first.size());
  Spectrum motion(first.size());
  StepSeparation out;
  for (int order = 2; 2 * static_cast<std::size_t>(order) < count; ++order) {
    const auto k = static_cast<std::size_t>(order);
    motion[k] = 0.5 * (first[k] - other[k]);
    if (order > options.highest) continue;
    part[k] = 0.5 * (first[k] + other[k]);
    out.harmonics.push_back(harmonic_of(order, std::sqrt(0.5), part[k], count, options));
  }
  out.part = {0.0, series_of(part, count)};
  out.motion_mm = series_of(motion, count);
  return out;
}

}  // namespace rondure::fit
