#include "evaluation/part/outliers.h"

#include <algorithm>
#include <cmath>

#include "core/phrase.h"
#include "core/statistics.h"

namespace rondure::evaluation {
namespace {

constexpr double kMedianScales = 5.0;
constexpr double kLeastScaleMm = 1e-4;

}  // namespace

std::vector<bool> beyond_five_scales(std::span<const double> deviations_mm) {
  const double middle = core::median({deviations_mm.begin(), deviations_mm.end()});
  std::vector<double> apart;
  for (const double d : deviations_mm) apart.push_back(std::abs(d - middle));
  const double limit =
      kMedianScales * std::max(core::kSigmaPerMedianDeviation * core::median(apart), kLeastScaleMm);
  std::vector<bool> out;
  for (const double d : apart) out.push_back(d > limit);
  return out;
}

core::Result<std::size_t> count_of_outliers(const std::vector<bool>& out) {
  const auto gone = static_cast<std::size_t>(std::count(out.begin(), out.end(), true));
  if (4 * gone > out.size()) {
    return core::fail(core::Code::kOutliers,
                      core::phrase("{} of {} points would be left out, more than a quarter: that "
                                   "is form",
                                   gone, out.size()));
  }
  return gone;
}

std::size_t longest_run(const std::vector<bool>& out) {
  std::size_t longest = 0;
  std::size_t run = 0;
  // Twice round: a run may hold the first and the last point.
  for (std::size_t i = 0; i < 2 * out.size(); ++i) {
    run = out[i % out.size()] ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return std::min(longest, out.size());
}

}  // namespace rondure::evaluation
