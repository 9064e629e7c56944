#include "fit/profiles/profile_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/numbers.h"
#include "fit/profiles/internal/dft.h"
#include "fit/profiles/internal/robust_filter.h"

namespace rondure::fit {
namespace {

constexpr double kPointsPerUndulation = 7.0;

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
  std::transform(a.begin(), a.end(), b.begin(), out.begin(), std::minus<>());
  return out;
}

core::Result<FilteredProfile> robust(std::span<const double> r, const FilterOptions& options) {
  FilteredProfile out;
  if (options.pass == PassBand::kLow || options.pass == PassBand::kHigh) {
    auto line = robust_mean_line(r, options.cutoff_upr);
    if (!line) return core::fail(line.error());
    out.iterations = line->iterations;
    out.scale_floored = line->scale_floored;
    out.r_mm = options.pass == PassBand::kLow ? std::move(line->r_mm) : difference(r, line->r_mm);
    return out;
  }
  const auto upper = robust_mean_line(r, options.upper_cutoff_upr);
  if (!upper) return core::fail(upper.error());
  const auto lower = robust_mean_line(upper->r_mm, options.cutoff_upr);
  if (!lower) return core::fail(lower.error());
  out.iterations = upper->iterations + lower->iterations;
  out.scale_floored = upper->scale_floored || lower->scale_floored;
  out.r_mm = difference(upper->r_mm, lower->r_mm);
  return out;
}

}  // namespace

std::string_view name_of(ProfileFilter filter) {
  constexpr std::array<std::string_view, 5> kNames = {"none", "gaussian", "2rc", "robust",
                                                      "spline"};
  return kNames[static_cast<std::size_t>(filter)];
}

std::string_view name_of(PassBand pass) {
  constexpr std::array<std::string_view, 3> kNames = {"low", "high", "band"};
  return kNames[static_cast<std::size_t>(pass)];
}

double FilterOptions::highest_cutoff_upr() const {
  return pass == PassBand::kBand ? upper_cutoff_upr : cutoff_upr;
}

core::Result<Sampling> check_sampling(std::size_t points, const FilterOptions& options) {
  if (options.filter == ProfileFilter::kNone) {
    if (options.pass == PassBand::kLow) return Sampling{};
    return core::fail(core::Code::kBadOption,
                      fmt::format("a {} pass without a filter: nothing would be taken away; name a "
                                  "filter, e.g. gaussian, or leave the pass at low",
                                  name_of(options.pass)));
  }
  const double highest = options.highest_cutoff_upr();
  for (const double cutoff : {options.cutoff_upr, highest}) {
    if (positive(cutoff)) continue;
    return core::fail(core::Code::kBadOption,
                      fmt::format("the cut-off is {} UPR; a positive number is needed, commonly "
                                  "15, 50, 150, 500 or 1500",
                                  cutoff));
  }
  if (options.pass == PassBand::kBand && options.cutoff_upr >= highest) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("the band from {} to {} UPR is empty; the lower cut-off comes "
                                  "first",
                                  options.cutoff_upr, highest));
  }
  const auto n = static_cast<double>(points);
  if (highest >= n / 2.0) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("a cut-off of {} UPR cannot be told from lower ones with {} "
                                  "points; it must stay below half their number, {}",
                                  highest, points, n / 2.0));
  }
  const Sampling sampling{n / highest, n / highest < kPointsPerUndulation};
  if (sampling.overridden && !options.override_sampling) {
    return core::fail(
        core::Code::kSampling,
        fmt::format("{} points are {:.2f} per undulation at {} UPR, at least 7 are needed: {:.0f} "
                    "points, or a cut-off of at most {:.4g} UPR, or no filter; the check can be "
                    "overridden, which the result records",
                    points, sampling.points_per_undulation, highest,
                    std::ceil(kPointsPerUndulation * highest), n / kPointsPerUndulation));
  }
  return sampling;
}

Complex transmission(const FilterOptions& options, double harmonic, std::size_t samples) {
  const auto n = static_cast<double>(samples);
  if (options.filter == ProfileFilter::kNone) return 1.0;
  switch (options.pass) {
    case PassBand::kLow:
      return low_pass(options.filter, harmonic, options.cutoff_upr, n);
    case PassBand::kHigh:
      return high_pass(options.filter, harmonic, options.cutoff_upr, n);
    case PassBand::kBand:
      break;
  }
  return low_pass(options.filter, harmonic, options.upper_cutoff_upr, n) *
         high_pass(options.filter, harmonic, options.cutoff_upr, n);
}

core::Result<FilteredProfile> filter_closed(std::span<const double> r_mm,
                                            const FilterOptions& options) {
  if (r_mm.empty()) {
    return core::fail(core::Code::kNoPoints, "the profile is empty; there is nothing to filter");
  }
  for (std::size_t i = 0; i < r_mm.size(); ++i) {
    if (core::is_measurable(r_mm[i])) continue;
    return core::fail(core::Code::kNotFinite,
                      fmt::format("row {} is {} mm; a finite number up to {:g} is needed", i,
                                  r_mm[i], core::kGreatestNumber));
  }
  const auto sampling = check_sampling(r_mm.size(), options);
  if (!sampling) return core::fail(sampling.error());
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
  out.sampling = *sampling;
  return out;
}

}  // namespace rondure::fit
