#include "fit/profiles/passed_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Dense>

#include "core/statistics.h"

namespace rondure::fit {
namespace {

constexpr double kFactor = 1.5;
constexpr double kSurely = 3.0;     ///< Standard uncertainties of a steepness.
constexpr double kScatter = 0.925;  ///< Standard deviation of log2 of an amplitude of noise.
constexpr double kPower = 0.75;     ///< Of the order, by which the amplitudes of a surface fall.
constexpr double kPowerU = 0.5;
constexpr std::size_t kLeastOrders = 15;

/// Fits  log2 A = a - p log2(k / start) - (k / cutoff)^2  from `first` to `last`; nothing where the
/// amplitudes scatter by more than noise, or bend.
std::optional<PassedFilter> fitted(std::span<const double> amplitude_mm, std::size_t first,
                                   std::size_t last, double start) {
  std::vector<std::size_t> orders(last + 1 - first);
  std::iota(orders.begin(), orders.end(), first);
  const std::size_t least = std::max(kLeastOrders, 4 * orders.size() / 5);
  const auto row = [&](std::size_t k) {
    const double place = static_cast<double>(k) / start;
    return Eigen::Vector3d(1.0, -std::log2(place), -place * place);
  };
  while (orders.size() >= least) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    normal(1, 1) = std::pow(kScatter / kPowerU, 2);
    Eigen::Vector3d right(0.0, normal(1, 1) * kPower, 0.0);
    for (const std::size_t k : orders) {
      normal += row(k) * row(k).transpose();
      right += std::log2(amplitude_mm[k]) * row(k);
    }
    const Eigen::Matrix3d cofactor = normal.inverse();
    const Eigen::Vector3d found = cofactor * right;
    const auto rest = [&](std::size_t k) { return std::log2(amplitude_mm[k]) - row(k).dot(found); };
    // Form stands out, and so does an order that noise happens to cancel.
    constexpr double kMostAbove = 2.5;
    constexpr double kMostBelow = 4.5;
    const auto stands_out = [&](std::size_t k) {
      return !(rest(k) < kMostAbove && rest(k) > -kMostBelow);
    };
    if (std::erase_if(orders, stands_out) > 0) continue;
    const auto count = static_cast<double>(orders.size());
    double squares = 0.0;
    std::array<double, 5> blocks = {};
    for (std::size_t i = 0; i < orders.size(); ++i) {
      squares += rest(orders[i]) * rest(orders[i]);
      blocks[blocks.size() * i / orders.size()] += rest(orders[i]) / kScatter;
    }
    const double bend = std::inner_product(blocks.begin(), blocks.end(), blocks.begin(), 0.0) *
                        static_cast<double>(blocks.size()) / count;
    constexpr double kMostScatter = 1.3;
    constexpr double kMostBend = 8.0;  // chi2 of the means of the blocks
    if (std::sqrt(squares / (count - 3.0)) > kMostScatter || bend > kMostBend || found(2) <= 0.0) {
      return std::nullopt;
    }
    return PassedFilter{start / std::sqrt(found(2)), found(2) / (start * start),
                        kScatter * std::sqrt(cofactor(2, 2)) / (start * start)};
  }
  return std::nullopt;
}

/// The last order at which the amplitudes stand above those of the last quarter, which the file
/// itself adds; 0: nowhere.
std::size_t end_of_fall(std::span<const double> amplitude_mm) {
  const std::size_t n = amplitude_mm.size();
  if (n < 4 * kLeastOrders) return 0;
  const auto median = [](std::span<const double> of) {
    return core::median({of.begin(), of.end()});
  };
  constexpr double kAbove = 2.5;
  constexpr double kRoundOff = 1e-8;  // what rounding to 0.001 um leaves [mm]
  const double floor_mm = std::max(kRoundOff, kAbove * median(amplitude_mm.last(n / 4)));
  for (std::size_t k = n - 4; k > kLeastOrders; --k) {
    if (median(amplitude_mm.subspan(k - 2, 5)) > floor_mm) return k - 2;
  }
  return 0;
}

}  // namespace

bool PassedFilter::below(double upr) const {
  return kFactor * cutoff_upr < upr && steepness - 1.0 / (upr * upr) > kSurely * u_steepness;
}

bool PassedFilter::above(double upr) const {
  return cutoff_upr > kFactor * upr && 1.0 / (upr * upr) - steepness > kSurely * u_steepness;
}

std::optional<PassedFilter> passed_filter(std::span<const double> amplitude_mm) {
  constexpr double kLeastCutoff = 10.0;  // below it the fall is one of form
  constexpr double kLongest = 3.6;       // cut-offs to the end of the fall: 13 bits
  constexpr double kShortest = 1.5;      // 2 bits
  constexpr double kStep = 1.04;
  constexpr double kFrom = 0.8;   // of the cut-off, where the fall begins
  constexpr double kSame = 0.12;  // within which a start confirms itself
  const std::size_t last = end_of_fall(amplitude_mm);
  const auto end = static_cast<double>(last);
  std::optional<PassedFilter> out;
  double least = 1.0 / 3.0;  // relative uncertainty
  for (double start = std::max(kLeastCutoff, end / kLongest); start * kShortest < end;
       start *= kStep) {
    const auto first = static_cast<std::size_t>(std::ceil(kFrom * start));
    const auto found = fitted(amplitude_mm, first, last, start);
    if (!found || found->u_steepness >= least * found->steepness ||
        std::abs(std::log(found->cutoff_upr / start)) > kSame) {
      continue;
    }
    least = found->u_steepness / found->steepness;
    out = found;
  }
  return out;
}

}  // namespace rondure::fit
