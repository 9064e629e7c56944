#include "fit/contour/repeatability.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/statistics.h"
#include "fit/contour/error.h"
#include "fit/contour/separation.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kLeastValues = 16;
constexpr std::size_t kPartsForAWord = 4;

core::Result<void> check_curves(std::span<const std::vector<double>> curves) {
  if (curves.size() < 2 || curves.front().size() < kLeastValues) {
    return core::fail_with(
        core::Code::kTooFewPoints,
        "{} curves of {} values; at least 2 curves of {} values show how they repeat",
        curves.size(), curves.empty() ? 0 : curves.front().size(), kLeastValues);
  }
  for (std::size_t i = 1; i < curves.size(); ++i) {
    if (curves[i].size() == curves.front().size()) continue;
    return core::fail_with(core::Code::kMeaning,
                           "curve {} has {} values and the first one {}; all parts need the same",
                           i, curves[i].size(), curves.front().size());
  }
  return {};
}

/// Fills in mean and spread of the curves, place by place and in total.
void compare_places(std::span<const std::vector<double>> curves, Repeatability& out) {
  const std::size_t places = curves.front().size();
  const auto parts = static_cast<double>(curves.size());
  out.mean_curve.assign(places, 0.0);
  double sum = 0.0;
  for (std::size_t m = 0; m < places; ++m) {
    for (const auto& curve : curves) out.mean_curve[m] += curve[m] / parts;
    double squares = 0.0;
    for (const auto& curve : curves) squares += std::pow(curve[m] - out.mean_curve[m], 2);
    sum += squares;
  }
  out.mean_rms = core::root_mean_square(out.mean_curve);
  out.spread = std::sqrt(sum / ((parts - 1.0) * static_cast<double>(places)));
  const double repeating = out.mean_rms * out.mean_rms - out.spread * out.spread / parts;
  const double all = repeating + out.spread * out.spread;
  if (all > 0.0) out.index = repeating / all;
}

void compare_sizes(std::span<const std::vector<double>> curves, Repeatability& out) {
  for (const auto& curve : curves) {
    out.peak_to_valley.push_back(peak_to_valley(curve));
    out.rms.push_back(core::root_mean_square(curve));
  }
  const double mean = core::mean(out.peak_to_valley);
  if (mean <= 0.0) return;
  out.variation = core::standard_deviation(out.peak_to_valley, mean) / mean;
}

void correlate(std::span<const std::vector<double>> curves, Repeatability& out) {
  const auto parts = static_cast<Eigen::Index>(curves.size());
  out.correlation = Eigen::MatrixXd::Identity(parts, parts);
  out.least_correlation = 1.0;
  double sum = 0.0;
  for (Eigen::Index i = 0; i < parts; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double value =
          correlation_of(curves[static_cast<std::size_t>(i)], curves[static_cast<std::size_t>(j)]);
      out.correlation(i, j) = out.correlation(j, i) = value;
      out.least_correlation = std::min(out.least_correlation, value);
      sum += value;
    }
  }
  out.mean_correlation = sum / (0.5 * static_cast<double>(parts * (parts - 1)));
}

}  // namespace

std::optional<StabilityWord> Repeatability::word() const {
  if (!index || no_word || rms.size() < kPartsForAWord) return std::nullopt;
  if (std::min(*index, index_low.value_or(*index)) >= kStableFrom) return StabilityWord::kStable;
  return *index >= kPartlyFrom ? StabilityWord::kPartly : StabilityWord::kUnstable;
}

core::Result<Repeatability> repeatability(std::span<const std::vector<double>> curves) {
  TRY_DO(check_curves(curves));
  Repeatability out;
  compare_places(curves, out);
  compare_sizes(curves, out);
  correlate(curves, out);
  return out;
}

}  // namespace rondure::fit
