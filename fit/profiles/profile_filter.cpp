#include "fit/profiles/profile_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

constexpr double kPointsPerUndulation = 7.0;

// Limit for the robust filter.
constexpr int kIterationLimit = 3000;
/// After this many iterations only half of each step is taken, then a quarter, then an eighth. With
/// strong undulations next to the cut-off, full steps would overshoot without end. The share of the
/// step does not change the line to which the iteration converges.
constexpr int kIterationsPerDamping = 100;
constexpr int kDampings = 3;
constexpr double kStandardised = 4.4478;  // 3 standard deviations: median|e| = 0.67449 sigma
constexpr double kSettledStep = 1e-9;
/// If the weight of a neighbourhood is below this, its mean is round-off of the transform.
constexpr double kLeastWeight = 1e-6;
/// Floor of the scale, as a multiple of the largest change of the mean line by a second filtering.
/// A spike lifts the first line by a bump b, of which the second filtering removes
/// (1 - 1/sqrt(2)) b. With a floor of twice b the points beside the spike stay inside, and the
/// parts that the filter removes from smooth undulations have a weight above 0.95.
constexpr double kFloor = 2.0 / (1.0 - 1.0 / std::numbers::sqrt2);

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

Complex low_pass(ProfileFilter filter, double n, double cutoff, double samples) {
  switch (filter) {
    case ProfileFilter::kNone:
      return 1.0;
    case ProfileFilter::kGaussian:
    case ProfileFilter::kRobustGaussian:
      return gaussian_transmission(n, cutoff);
    case ProfileFilter::kTwoRc: {
      const Complex stage = 1.0 / Complex(1.0, n / (std::numbers::sqrt3 * cutoff));
      return stage * stage;
    }
    case ProfileFilter::kSpline: {
      const double ratio =
          std::sin(std::numbers::pi * n / samples) / std::sin(std::numbers::pi * cutoff / samples);
      return 1.0 / (1.0 + ratio * ratio * ratio * ratio);
    }
  }
  return 1.0;
}

Complex high_pass(ProfileFilter filter, double n, double cutoff, double samples) {
  if (filter != ProfileFilter::kTwoRc) return 1.0 - low_pass(filter, n, cutoff, samples);
  if (n == 0.0) return 0.0;
  const Complex stage = 1.0 / Complex(1.0, -cutoff / (std::numbers::sqrt3 * n));
  return stage * stage;
}

std::vector<double> linear(std::span<const double> r, const FilterOptions& options) {
  auto f = spectrum(r);
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] *= transmission(options, static_cast<double>(k), r.size());
  }
  return series_of(f, r.size());
}

std::vector<double> difference(std::span<const double> a, const std::vector<double>& b) {
  std::vector<double> out(b.size());
  std::ranges::transform(a, b, out.begin(), std::minus<>());
  return out;
}

/// Mean line of the robust Gaussian filter.
struct RobustMeanLine {
  std::vector<double> r_mm;
  int iterations = 0;
  bool scale_floored = false;  ///< c was raised to its floor, see robust_mean_line().
};

/// Source of the scale of the residuals.
enum class Scale {
  kMedian,   ///< From their median, as in the standard.
  kFloored,  ///< The same, but not below the floor.
};

std::vector<double> gaussian_mean(std::span<const double> r, double cutoff) {
  auto f = spectrum(r);
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] *= gaussian_transmission(static_cast<double>(k), cutoff);
  }
  return series_of(f, r.size());
}

double median_distance(std::span<const double> r, std::span<const double> w) {
  std::vector<double> distance(r.size());
  for (std::size_t i = 0; i < r.size(); ++i) distance[i] = std::abs(r[i] - w[i]);
  return core::median(std::move(distance));
}

/// Tukey's weights of the residuals.
std::vector<double> weights(std::span<const double> r, std::span<const double> w, double c) {
  std::vector<double> out(r.size(), 0.0);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double ratio = (r[i] - w[i]) / c;
    if (std::abs(ratio) <= 1.0) out[i] = (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
  }
  return out;
}

double greatest_step(std::span<const double> a, std::span<const double> b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

/// Iterates the mean line of a profile whose mean is 0.
core::Result<RobustMeanLine> settled_line(const std::vector<double>& r, double cutoff_upr,
                                          Scale scale) {
  RobustMeanLine out{gaussian_mean(r, cutoff_upr), 0, scale == Scale::kFloored};
  const double round_off =
      64.0 * std::numeric_limits<double>::epsilon() * column_extremes(r).width();
  std::vector<double> weighted(r.size());
  while (out.iterations < kIterationLimit) {
    ++out.iterations;
    double c = kStandardised * median_distance(r, out.r_mm);
    if (scale == Scale::kFloored) {
      c = std::max(c, kFloor * greatest_step(out.r_mm, gaussian_mean(out.r_mm, cutoff_upr)));
    }
    if (c <= round_off) return out;  // half of the profile is its own mean line
    const auto delta = weights(r, out.r_mm, c);
    for (std::size_t i = 0; i < delta.size(); ++i) weighted[i] = delta[i] * r[i];
    auto line = gaussian_mean(weighted, cutoff_upr);
    const auto weight = gaussian_mean(delta, cutoff_upr);
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (weight[i] < kLeastWeight) {
        return core::fail_with(core::Code::kNotConverged,
                               "the robust filter at {} UPR finds only outliers round row {}; take "
                               "a lower cut-off or the linear filter",
                               cutoff_upr, i);
      }
      line[i] /= weight[i];
    }
    const double step = greatest_step(line, out.r_mm);
    const double share = std::exp2(-std::min(out.iterations / kIterationsPerDamping, kDampings));
    for (std::size_t i = 0; i < line.size(); ++i) out.r_mm[i] += share * (line[i] - out.r_mm[i]);
    if (step <= kSettledStep * c + round_off) return out;
  }
  return core::fail_with(core::Code::kNotConverged,
                         "the robust filter at {} UPR still moves after {} iterations; take "
                         "another cut-off or the linear filter",
                         cutoff_upr, kIterationLimit);
}

/// Robust Gaussian regression of order 0 (ISO 16610-31): minimises sum_i rho(r_i - w_k) s_ik at
/// every k, s the Gaussian weight, rho Tukey's function, by repeated weighting: w = conv(s, delta
/// r) / conv(s, delta), delta = (1 - ((r - w)/c)^2)^2 where |r - w| <= c and 0 beyond, c = 4.4478
/// median|r - w|. The convolutions are products of spectra and so have no end effects.
///
/// This c does not suit a smooth profile: the residuals are then the parts of its undulations that
/// the filter removes, and whole undulations count as outliers. If the iteration does not converge
/// for that reason, it is repeated with c >= 6.83 max|w - conv(s, w)|.
core::Result<RobustMeanLine> robust_mean_line(std::span<const double> r_mm, double cutoff_upr) {
  // The profile is taken relative to its mean, so that a radius of many mm costs no digits.
  const double mean = core::mean(r_mm);
  std::vector<double> r(r_mm.begin(), r_mm.end());
  for (double& value : r) value -= mean;
  auto line = settled_line(r, cutoff_upr, Scale::kMedian);
  // The residuals of a smooth profile are not noise, but the parts of its undulations that the
  // filter removes; their median is no measure of the largest ones.
  if (!line) line = settled_line(r, cutoff_upr, Scale::kFloored);
  if (!line) return line;
  for (double& value : line->r_mm) value += mean;
  return line;
}

core::Result<FilteredProfile> robust(std::span<const double> r, const FilterOptions& options) {
  FilteredProfile out;
  if (options.pass == PassBand::kLow || options.pass == PassBand::kHigh) {
    TRY(auto line, robust_mean_line(r, options.cutoff_upr));
    out.iterations = line.iterations;
    out.scale_floored = line.scale_floored;
    out.r_mm = options.pass == PassBand::kLow ? std::move(line.r_mm) : difference(r, line.r_mm);
    return out;
  }
  TRY(const auto upper, robust_mean_line(r, options.upper_cutoff_upr));
  TRY(const auto lower, robust_mean_line(upper.r_mm, options.cutoff_upr));
  out.iterations = upper.iterations + lower.iterations;
  out.scale_floored = upper.scale_floored || lower.scale_floored;
  out.r_mm = difference(upper.r_mm, lower.r_mm);
  return out;
}

/// Value of a smooth periodic series between its samples, by the polynomial through the next eight:
/// for 14 samples per undulation its error is 2e-6 of the amplitude.
double between_samples(const std::vector<double>& r, double position) {
  constexpr std::array<double, 8> kBinomial = {-1.0, 7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0};
  constexpr double kBefore = 3.0;  // samples before the interval
  const double floor = std::floor(position);
  const double within = position - floor;
  const auto n = static_cast<std::ptrdiff_t>(r.size());
  std::ptrdiff_t at = (static_cast<std::ptrdiff_t>(floor) - 3) % n;
  if (at < 0) at += n;
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t k = 0; k < kBinomial.size(); ++k) {
    const double apart = within + kBefore - static_cast<double>(k);
    const double value = r[static_cast<std::size_t>(at)];
    if (apart == 0.0) return value;
    const double weight = kBinomial[k] / apart;
    sum += weight * value;
    weights += weight;
    if (++at == n) at = 0;
  }
  return sum / weights;
}

}  // namespace

double FilterOptions::highest_cutoff_upr() const {
  return pass == PassBand::kBand ? upper_cutoff_upr : cutoff_upr;
}

core::Result<Sampling> check_sampling(std::size_t points, const FilterOptions& options) {
  if (options.filter == ProfileFilter::kNone) {
    if (options.pass == PassBand::kLow) return Sampling{};
    return core::fail_with(core::Code::kBadOption,
                           "a {} pass without a filter: nothing would be taken away; name a "
                           "filter, e.g. gaussian, or leave the pass at low",
                           name_of(options.pass));
  }
  const double highest = options.highest_cutoff_upr();
  for (const double cutoff : {options.cutoff_upr, highest}) {
    if (positive(cutoff)) continue;
    return core::fail_with(
        core::Code::kBadOption,
        "the cut-off is {} UPR; a positive number is needed, commonly 15, 50, 150, 500 or 1500",
        cutoff);
  }
  if (options.pass == PassBand::kBand && options.cutoff_upr >= highest) {
    return core::fail_with(core::Code::kBadOption,
                           "the band from {} to {} UPR is empty; the lower cut-off comes first",
                           options.cutoff_upr, highest);
  }
  const auto n = static_cast<double>(points);
  if (highest >= n / 2.0) {
    return core::fail_with(core::Code::kBadOption,
                           "a cut-off of {} UPR cannot be told from lower ones with {} points; it "
                           "must stay below half their number, {}",
                           highest, points, n / 2.0);
  }
  const Sampling sampling{n / highest, n / highest < kPointsPerUndulation};
  if (sampling.overridden && !options.override_sampling) {
    return core::fail_with(core::Code::kSampling,
                           "{} points are {:.2f} per undulation at {} UPR, at least 7 are needed: "
                           "{:.0f} points, or a cut-off of at most {:.4g} UPR, or no filter; the "
                           "check can be overridden, which the result records",
                           points, sampling.points_per_undulation, highest,
                           std::ceil(kPointsPerUndulation * highest), n / kPointsPerUndulation);
  }
  return sampling;
}

Complex transmission(const FilterOptions& options, double harmonic, std::size_t samples) {
  const auto n = static_cast<double>(samples);
  if (options.filter == ProfileFilter::kNone) return 1.0;
  const auto high = [&] { return high_pass(options.filter, harmonic, options.cutoff_upr, n); };
  if (options.pass == PassBand::kHigh) return high();
  const Complex low = low_pass(options.filter, harmonic, options.highest_cutoff_upr(), n);
  return options.pass == PassBand::kLow ? low : low * high();
}

core::Result<FilteredProfile> filter_closed(std::span<const double> r_mm,
                                            const FilterOptions& options) {
  if (r_mm.empty()) {
    return core::fail(core::Code::kNoPoints, "the profile is empty; there is nothing to filter");
  }
  for (std::size_t i = 0; i < r_mm.size(); ++i) {
    if (core::is_measurable(r_mm[i])) continue;
    return core::fail_with(core::Code::kNotFinite,
                           "row {} is {} mm; a finite number up to {:g} is needed", i, r_mm[i],
                           core::kGreatestNumber);
  }
  TRY(const auto sampling, check_sampling(r_mm.size(), options));
  FilteredProfile out;
  if (options.filter == ProfileFilter::kNone) {
    out.r_mm.assign(r_mm.begin(), r_mm.end());
    return out;
  }
  if (options.filter == ProfileFilter::kRobustGaussian) {
    auto filtered = robust(r_mm, options);
    if (!filtered) return filtered;
    out = *std::move(filtered);
  } else {
    out.r_mm = linear(r_mm, options);
  }
  out.sampling = sampling;
  return out;
}

core::Result<FilteredProfile> filter_at_angles(const AngularProfile& profile,
                                               const FilterOptions& options) {
  if (profile.uniform() || options.filter == ProfileFilter::kNone) {
    return filter_closed(profile.r_mm, options);
  }
  TRY(const auto sampling, check_sampling(profile.r_mm.size(), options));
  if (!options.override_sampling) {
    TRY_DO(check_gaps(profile, options.highest_cutoff_upr()));
  }
  TRY(const auto even, resampled(profile));
  auto out = filter_closed(even.profile.r_mm, options);
  if (!out) return out;
  const double per_rad = static_cast<double>(out->r_mm.size()) / core::kTwoPi;
  std::vector<double> r;
  r.reserve(profile.theta_rad.size());
  for (const double theta : profile.theta_rad) {
    r.push_back(between_samples(out->r_mm, (theta - even.profile.start_rad) * per_rad));
  }
  out->r_mm = std::move(r);
  out->sampling = sampling;
  return out;
}

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
