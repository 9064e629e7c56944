#include "evaluation/contour/internal/curves.h"

#include <algorithm>
#include <cmath>

#include "fit/profiles/profile_filter.h"

namespace rondure::evaluation::contour_trials {

namespace {

constexpr double kLeastTransmission = 0.01;
/// Points on which a peak to valley is read, where the contour has more.
constexpr std::size_t kMostPoints = 2880;

}  // namespace

Basis::Basis(const fit::ContourStudyOptions& options) {
  const auto most = static_cast<int>((options.samples - 1) / 2);
  for (int k = 2; k <= std::min(most, kHighestOrder); ++k) {
    const double left = options.error.filter.filter == fit::ProfileFilter::kNone
                            ? 1.0
                            : std::abs(fit::transmission(options.error.filter, k, options.samples));
    if (left < kLeastTransmission) break;
    highest = k;
    transmission.insert(transmission.end(), 2, left);
  }
  points = options.samples;
  if (points <= kMostPoints) return;
  points = 1;
  while (points < 8 * static_cast<std::size_t>(highest)) points *= 2;
}

double rms_of(std::span<const double> curve) {
  double sum = 0.0;
  for (const double c : curve) sum += c * c;
  return std::sqrt(0.5 * sum);
}

Spread spread_of(const Curves& curves) {
  Spread out;
  out.parts = static_cast<double>(curves.size());
  for (std::size_t j = 0; j < curves.front().size(); ++j) {
    double mean = 0.0;
    for (const auto& curve : curves) mean += curve[j] / out.parts;
    out.mean2 += 0.5 * mean * mean;
    for (const auto& curve : curves) {
      out.spread2 += 0.5 * std::pow(curve[j] - mean, 2) / (out.parts - 1.0);
    }
  }
  return out;
}

std::vector<double> mean_curve(const Curves& curves) {
  std::vector<double> out(curves.front().size(), 0.0);
  for (const auto& curve : curves) {
    for (std::size_t j = 0; j < out.size(); ++j) {
      out[j] += curve[j] / static_cast<double>(curves.size());
    }
  }
  return out;
}

double greatest_range(const Basis& basis, const Curves& curves) {
  double out = 0.0;
  for (const auto& curve : curves) out = std::max(out, basis.range(curve));
  return out;
}

}  // namespace rondure::evaluation::contour_trials
