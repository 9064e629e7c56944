#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/words.h"
#include "fit/profiles/closed_profile.h"

namespace rondure::fit {

/// Filters of closed profiles.
enum class ProfileFilter {
  kNone,            ///< The unfiltered profile.
  kGaussian,        ///< ISO 16610-21: 50 % at the cut-off, no phase.
  kTwoRc,           ///< Two RC stages (ISO 4291): 75 % at the cut-off, with phase shift.
  kRobustGaussian,  ///< ISO 16610-31, order 0: outliers do not shift the mean line.
  kSpline,          ///< ISO 16610-22, periodic: 50 % at the cut-off, no phase.
};

/// The undulations that a filter passes.
enum class PassBand {
  kLow,   ///< Up to the cut-off: the mean line.
  kHigh,  ///< From the cut-off on: the profile minus the mean line.
  kBand,  ///< Between two cut-offs.
};

RONDURE_WORDS(ProfileFilter, {kNone, "none"}, {kGaussian, "gaussian"}, {kTwoRc, "2rc"},
              {kRobustGaussian, "robust"}, {kSpline, "spline"});
RONDURE_WORDS(PassBand, {kLow, "low"}, {kHigh, "high"}, {kBand, "band"});

/// Settings of filter_closed(). Cut-offs are undulations per revolution (UPR), commonly 15, 50,
/// 150, 500 or 1500; any positive number is taken.
struct FilterOptions {
  ProfileFilter filter = ProfileFilter::kGaussian;
  PassBand pass = PassBand::kLow;
  double cutoff_upr = 50.0;         ///< Cut-off of low and high pass; lower limit of a band.
  double upper_cutoff_upr = 500.0;  ///< Upper limit of a band; otherwise ignored.
  /// Filter also with fewer than 7 points per undulation; the result records it.
  bool override_sampling = false;

  /// The cut-off that the sampling must resolve: the highest one.
  [[nodiscard]] double highest_cutoff_upr() const;
};

/// Number of points per undulation at the cut-off, and whether the limit was overridden.
struct Sampling {
  double points_per_undulation = 0.0;
  bool overridden = false;  ///< Fewer than 7 points, filtered by option.
};

/// Checks the cut-offs of a filter against the number of points measured.
///
/// @return kBadOption for a high pass or a band without a filter, a cut-off that is not a positive
///         number, a band whose limits are not in order, and a cut-off at or above half the number
///         of points (which could not be resolved); kSampling for fewer than 7 points per
///         undulation, unless overridden.
[[nodiscard]] core::Result<Sampling> check_sampling(std::size_t points,
                                                    const FilterOptions& options);

/// A filtered profile, at the angles of the input.
struct FilteredProfile {
  std::vector<double> r_mm;
  Sampling sampling;
  int iterations = 0;          ///< Iterations of the robust filter; 0 for the linear ones.
  bool scale_floored = false;  ///< Robust filter: c was raised to a floor, see docs/filters.md.
};

/// Complex transmission of a linear filter at harmonic n: the output is the input times its
/// magnitude, turned by its argument (0 for all but 2RC). kRobustGaussian has none; the function
/// returns that of the Gaussian filter, which it equals without outliers.
///
///   low pass   Gaussian  2^-(n/fc)^2
///              spline    1 / (1 + (sin(pi n/N) / sin(pi fc/N))^4)
///              2RC       1 / (1 + j n / (sqrt(3) fc))^2
///   high pass  1 - low pass; 2RC: 1 / (1 - j fc / (sqrt(3) n))^2
///   band       low pass of the upper cut-off times high pass of the lower one
///
/// @param samples  N of the profile, on which the spline of sampled data depends.
[[nodiscard]] std::complex<double> transmission(const FilterOptions& options, double harmonic,
                                                std::size_t samples);

/// Filters a closed profile at uniform angles.
///
/// The linear filters multiply the spectrum, which for a closed profile is the convolution of the
/// standards without truncation and without end effects. The robust filter iterates: Tukey weights
/// with c = 4.4478 median|r - w| (three standard deviations of normal residuals), then the weighted
/// Gaussian mean w, until w changes by less than 1e-9 c. Its high pass is r - w; its band is the
/// robust low pass at the upper cut-off, minus the robust low pass of that result at the lower one.
///
/// @param r_mm  N values at uniform angles [mm]; not changed.
/// @return kNoPoints, kNotFinite (row), the errors of check_sampling(), kNotConverged (robust
///         filter). O(N log N), for the robust filter per iteration, of which it needs 40 to 700.
/// Sources: ISO 16610-21, -22, -31; ISO 4291 (2RC); methods, roundness B.2.
[[nodiscard]] core::Result<FilteredProfile> filter_closed(std::span<const double> r_mm,
                                                          const FilterOptions& options);

/// Filters a closed profile at any angles: resampled() to uniform ones where they are uneven,
/// filter_closed(), and back at the angles of the profile.
/// @return r_mm at theta_rad of the profile; the errors of filter_closed(), check_gaps() and
///         resampled().
[[nodiscard]] core::Result<FilteredProfile> filter_at_angles(const AngularProfile& profile,
                                                             const FilterOptions& options);

/// A Gaussian low pass that values have passed before they came here.
struct PassedFilter {
  double cutoff_upr = 0.0;
  double steepness = 0.0;  ///< 1 / cutoff^2.
  double u_steepness = 0.0;

  /// Whether the cut-off surely lies below, or above, `upr`: by a factor of 1.5 at least, and by
  /// more than the scatter of the amplitudes explains.
  [[nodiscard]] bool below(double upr) const;
  [[nodiscard]] bool above(double upr) const;
};

/// Finds the low pass from the fall of noise and roughness: log2 of the amplitudes over k^2 is then
/// a line of slope -1/cutoff^2 that leads from 0.8 of the cut-off down to what the file itself adds
/// (digits, noise after the filter), which the last quarter of the orders shows. Surfaces fall by
/// themselves, as a power 0.75 +- 0.5 of the order; single orders that stand out are form and left
/// out.
///
/// @param amplitude_mm  By order, from 0, as far as the points resolve them.
/// @return  Nothing where the amplitudes do not fall so: no filter, form down to the digits, fewer
///          than 15 orders in the fall.
[[nodiscard]] std::optional<PassedFilter> passed_filter(std::span<const double> amplitude_mm);

}  // namespace rondure::fit
