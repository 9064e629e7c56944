#include "fit/profiles/open_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/LU>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

/// sqrt(ln 2 / pi) gives 50 % at the cut-off for the plain mean and for the local line.
const double kGaussian = std::sqrt(std::numbers::ln2 / std::numbers::pi);
/// The local parabola transmits exp(-q)(1 + q), q = pi (alpha lambda_c / lambda)^2; q = 1.678347
/// gives 50 %, alpha = sqrt(q / pi) = 0.7309.
const double kWide = std::sqrt(1.6783469900166605 / std::numbers::pi);
/// Beyond this many cut-offs, weights are below 1e-16 of the central one.
constexpr double kNarrowReach = 2.0;
constexpr double kWideReach = 2.6;

core::Result<void> check(std::span<const double> x, std::span<const double> r,
                         const OpenFilterOptions& options) {
  if (x.empty() || x.size() != r.size()) {
    return core::fail_with(core::Code::kNoPoints,
                           "{} positions and {} values; a profile needs as many of both", x.size(),
                           r.size());
  }
  if (x.size() < 3) {
    return core::fail_with(core::Code::kTooFewPoints, "{} points; an open profile needs at least 3",
                           x.size());
  }
  if (!std::isfinite(options.cutoff) || options.cutoff <= 0.0) {
    return core::fail_with(core::Code::kBadOption,
                           "the cut-off is {}; a positive wavelength is needed", options.cutoff);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!core::is_measurable(x[i]) || !core::is_measurable(r[i])) {
      return core::fail_with(core::Code::kNotFinite,
                             "row {} is ({}, {}); finite numbers up to {:g} are needed", i, x[i],
                             r[i], core::kGreatestNumber);
    }
    if (i > 0 && x[i] <= x[i - 1]) {
      return core::fail_with(core::Code::kBadOption,
                             "row {} stands at {}, not after row {} at {}; positions must ascend",
                             i, x[i], i - 1, x[i - 1]);
    }
  }
  return {};
}

/// Limit of the gaps that belong to the profile; larger ones are windows.
constexpr double kWindowGap = 1.5;

std::vector<double> gaps_of(std::span<const double> x) {
  std::vector<double> out;
  for (std::size_t i = 1; i < x.size(); ++i) out.push_back(x[i] - x[i - 1]);
  return out;
}

/// The greatest gap that is not a window.
double profile_gap(const std::vector<double>& gaps, bool windows) {
  const double most = windows ? kWindowGap * core::median(gaps) * (1.0 + 1e-9)
                              : std::numeric_limits<double>::infinity();
  double out = 0.0;
  for (const double gap : gaps) out = std::max(out, gap <= most ? gap : 0.0);
  return out;
}

/// Length that each point represents: half the gaps to its neighbours; at an end, the whole gap.
std::vector<double> cells(std::vector<double> gaps, bool windows) {
  if (windows) {
    const double most = kWindowGap * core::median(gaps);
    for (double& gap : gaps) gap = std::min(gap, most);
  }
  std::vector<double> out;
  for (std::size_t i = 0; i <= gaps.size(); ++i) {
    out.push_back(0.5 * (gaps[i > 0 ? i - 1 : 0] + gaps[std::min(i, gaps.size() - 1)]));
  }
  return out;
}

/// Local polynomial of degree Terms - 1 at one position, by weighted least squares.
template <int Terms>
class LocalMean {
 public:
  LocalMean(std::span<const double> x, std::span<const double> r, const OpenFilterOptions& options,
            double alpha, double reach)
      : x_(x),
        r_(r),
        cells_(cells(gaps_of(x), options.windows)),
        width_(alpha * options.cutoff),
        reach_(reach * options.cutoff) {}

  [[nodiscard]] double at(double position) const {
    Eigen::Matrix<double, Terms, Terms> moments = Eigen::Matrix<double, Terms, Terms>::Zero();
    Eigen::Matrix<double, Terms, 1> right = Eigen::Matrix<double, Terms, 1>::Zero();
    const auto begin = std::ranges::lower_bound(x_, position - reach_);
    for (auto i = static_cast<std::size_t>(begin - x_.begin());
         i < x_.size() && x_[i] <= position + reach_; ++i) {
      const double u = (x_[i] - position) / width_;
      const double weight = cells_[i] * std::exp(-std::numbers::pi * u * u);
      Eigen::Matrix<double, Terms, 1> powers;
      powers(0) = 1.0;
      for (int k = 1; k < Terms; ++k) powers(k) = powers(k - 1) * u;
      moments += weight * powers * powers.transpose();
      right += weight * powers * r_[i];
    }
    return moments.fullPivLu().solve(right)(0);
  }

 private:
  std::span<const double> x_;
  std::span<const double> r_;
  std::vector<double> cells_;
  double width_;
  double reach_;
};

template <int Terms>
void fill(std::span<const double> x, std::span<const double> r, const OpenFilterOptions& options,
          OpenProfile& out) {
  const bool wide = Terms == 3;
  const LocalMean<Terms> mean(x, r, options, wide ? kWide : kGaussian,
                              wide ? kWideReach : kNarrowReach);
  for (const double position : out.position) out.r_mm.push_back(mean.at(position));
}

}  // namespace

core::Result<OpenProfile> filter_open(std::span<const double> position,
                                      std::span<const double> r_mm,
                                      const OpenFilterOptions& options) {
  TRY_DO(check(position, r_mm, options));
  OpenProfile out;
  const double gap = profile_gap(gaps_of(position), options.windows);
  out.sampling_overridden = 7.0 * gap > options.cutoff * (1.0 + 1e-9);
  if (out.sampling_overridden && !options.override_sampling) {
    return core::fail_with(core::Code::kSampling,
                           "neighbouring points are up to {:.6g} apart, a cut-off of {:.6g} allows "
                           "{:.6g} (7 points per undulation): measure more densely or take a "
                           "longer cut-off; the check can be overridden",
                           gap, options.cutoff, options.cutoff / 7.0);
  }
  const double margin = options.ends == OpenEnds::kDiscard ? 0.5 * options.cutoff : 0.0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (position[i] < position.front() + margin || position[i] > position.back() - margin) continue;
    if (out.position.empty()) out.first = i;
    out.position.push_back(position[i]);
  }
  if (out.position.empty()) {
    return core::fail_with(core::Code::kBadOption,
                           "the profile is {:.6g} long; half a cut-off of {:.6g} discarded at both "
                           "ends leaves nothing",
                           position.back() - position.front(), options.cutoff);
  }
  switch (options.ends) {
    case OpenEnds::kLine:
      fill<2>(position, r_mm, options, out);
      break;
    case OpenEnds::kParabola:
      fill<3>(position, r_mm, options, out);
      break;
    case OpenEnds::kDiscard:
      fill<1>(position, r_mm, options, out);
      break;
  }
  return out;
}

core::Result<std::vector<double>> filter_with_windows(const AngularProfile& profile,
                                                      double cutoff_upr) {
  if (!std::isfinite(cutoff_upr) || cutoff_upr < 1.0) {
    return core::fail_with(core::Code::kBadOption, "the cut-off is {} UPR; at least 1 is needed",
                           cutoff_upr);
  }
  OpenFilterOptions options;
  options.cutoff = core::kTwoPi / cutoff_upr;
  options.windows = true;
  // The profile once more on both sides, as far as the weights reach, and at least the neighbour
  // across the seam, which bounds the length that the first and the last point represent.
  const double reach = kNarrowReach * options.cutoff;
  const std::size_t n = profile.theta_rad.size();
  std::vector<double> x;
  std::vector<double> r;
  const auto append = [&](std::size_t i, double turn) {
    x.push_back(profile.theta_rad[i] + turn);
    r.push_back(profile.r_mm[i]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double at = profile.theta_rad[i] - core::kTwoPi;
    if (i + 1 == n || at >= profile.theta_rad.front() - reach) append(i, -core::kTwoPi);
  }
  const std::size_t first = x.size();
  for (std::size_t i = 0; i < n; ++i) append(i, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double at = profile.theta_rad[i] + core::kTwoPi;
    if (i == 0 || at <= profile.theta_rad.back() + reach) append(i, core::kTwoPi);
  }
  TRY(const auto mean, filter_open(x, r, options));
  const auto begin = mean.r_mm.begin() + static_cast<std::ptrdiff_t>(first);
  return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(n));
}

}  // namespace rondure::fit
