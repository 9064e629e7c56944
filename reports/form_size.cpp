#include <algorithm>
#include <cmath>

#include "reports/form_draw.h"

namespace rondure::reports {
namespace {

constexpr int kSizeSteps = 256;

}  // namespace

FormSize::FormSize(const std::vector<NoiseLevel>& levels) : FormSize(0.0) {
  double square = 0.0;
  double noise = 0.0;
  double count = 0.0;
  for (const NoiseLevel& level : levels) {
    square += level.square_mm2;
    noise += level.noise_mm2 * level.count;
    count += level.count;
  }
  if (!(square + noise > 0.0)) return;  // a perfect part, measured without error
  const double mean_noise = noise / count;
  const double scale = (square + noise) / count;
  std::vector<double> log_density;
  for (int k = 0; k <= kSizeSteps; ++k) {
    const double s2 = scale * std::pow(10.0, -5.0 + 9.0 * k / kSizeSteps);
    double value = std::log(s2 / (s2 + mean_noise));
    for (const NoiseLevel& level : levels) {
      const double variance = s2 + level.noise_mm2;
      value -= 0.5 * (level.count * std::log(variance) + level.square_mm2 / variance);
    }
    log_density.push_back(value);
  }
  const double highest = *std::max_element(log_density.begin(), log_density.end());
  sizes_.clear();
  below_.clear();
  double sum = 0.0;
  for (int k = 0; k <= kSizeSteps; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double here = std::exp(log_density[at] - highest);
    if (k > 0) sum += 0.5 * (here + std::exp(log_density[at - 1] - highest));
    sizes_.push_back(std::sqrt(scale * std::pow(10.0, -5.0 + 9.0 * k / kSizeSteps)));
    below_.push_back(sum);
  }
  for (double& value : below_) value /= sum;
}

double FormSize::quantile(double share) const {
  const auto above = std::upper_bound(below_.begin(), below_.end(), share);
  if (above == below_.begin()) return sizes_.front();
  if (above == below_.end()) return sizes_.back();
  const auto k = static_cast<std::size_t>(above - below_.begin());
  const double part = (share - below_[k - 1]) / (below_[k] - below_[k - 1]);
  return sizes_[k - 1] + part * (sizes_[k] - sizes_[k - 1]);
}

}  // namespace rondure::reports
