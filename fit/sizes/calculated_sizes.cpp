#include "fit/sizes/calculated_sizes.h"

#include <cmath>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

constexpr double kPi = 0.5 * core::kTwoPi;
/// Steps of the trapezium rule, which converges faster than any power for a periodic function.
constexpr std::size_t kSteps = 3600;
constexpr std::size_t kFewestSamples = 8;

core::Result<void> check(const UniformProfile& profile, const Material& material) {
  if (auto checked = check_material(material); !checked) return checked;
  if (profile.r_mm.size() < kFewestSamples) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} points; circumference and area need at least {}",
                           profile.r_mm.size(), kFewestSamples);
  }
  for (std::size_t i = 0; i < profile.r_mm.size(); ++i) {
    if (!core::is_measurable(profile.r_mm[i])) {
      return core::fail_with(core::Code::kNotFinite, "the radius of row {} is {}", i,
                             profile.r_mm[i]);
    }
    if (!(profile.r_mm[i] > material.tip_radius_mm)) {
      return core::fail_with(core::Code::kBadOption,
                             "the radius of row {} is {:g} mm, not above the tip radius of {:g} mm",
                             i, profile.r_mm[i], material.tip_radius_mm);
    }
  }
  return {};
}

/// Circumference of the harmonic series with this half spectrum, divided by the number of samples
/// already. The angle of the start does not matter.
double circumference(const Spectrum& harmonics) {
  double sum = 0.0;
  for (std::size_t m = 0; m < kSteps; ++m) {
    double r = harmonics[0].real();
    double slope = 0.0;
    for (std::size_t k = 1; k < harmonics.size(); ++k) {
      const double angle = core::kTwoPi * static_cast<double>(k * m % kSteps) / kSteps;
      const Complex turned = harmonics[k] * std::polar(2.0, angle);
      r += turned.real();
      slope -= static_cast<double>(k) * turned.imag();
    }
    sum += std::hypot(r, slope);
  }
  return core::kTwoPi * sum / kSteps;
}

}  // namespace

core::Result<CalculatedSizes> calculated_sizes(const UniformProfile& profile,
                                               const Material& material) {
  TRY_DO(check(profile, material));
  const std::size_t n = profile.r_mm.size();
  Spectrum harmonics = spectrum(profile.r_mm);
  for (Complex& value : harmonics) value /= static_cast<double>(n);
  // Of an even number of samples, the last harmonic appears once in the sum, not twice.
  if (n % 2 == 0) harmonics.back() *= 0.5;
  double squares = 0.0;
  for (std::size_t k = 1; k < harmonics.size(); ++k) squares += std::norm(harmonics[k]);
  const double mean = harmonics[0].real();
  const double length = circumference(harmonics);
  const double area = kPi * (mean * mean + 2.0 * squares);
  const double tip = material.sign() * material.tip_radius_mm;
  CalculatedSizes out;
  out.cc_mm = (length - core::kTwoPi * tip) / kPi;
  out.area_mm2 = area - tip * length + kPi * tip * tip;
  out.ca_mm = std::sqrt(4.0 * out.area_mm2 / kPi);
  return out;
}

core::Result<double> volume_size_mm(std::span<const double> heights_mm,
                                    std::span<const double> areas_mm2) {
  if (heights_mm.size() != areas_mm2.size()) {
    return core::fail_with(core::Code::kNoPoints,
                           "{} heights and {} areas; as many of both are needed", heights_mm.size(),
                           areas_mm2.size());
  }
  if (heights_mm.size() < 2) {
    return core::fail_with(core::Code::kRank, "{} sections; a volume needs at least 2",
                           heights_mm.size());
  }
  double volume = 0.0;
  for (std::size_t i = 1; i < heights_mm.size(); ++i) {
    const double step = heights_mm[i] - heights_mm[i - 1];
    if (!(step > 0.0)) {
      return core::fail_with(core::Code::kBadOption,
                             "section {} stands at {:g} mm, not above section {} at {:g} mm", i,
                             heights_mm[i], i - 1, heights_mm[i - 1]);
    }
    volume += 0.5 * step * (areas_mm2[i] + areas_mm2[i - 1]);
  }
  return std::sqrt(4.0 * volume / (kPi * (heights_mm.back() - heights_mm.front())));
}

}  // namespace rondure::fit
