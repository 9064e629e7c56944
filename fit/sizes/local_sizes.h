#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"
#include "fit/least_squares/sections.h"
#include "fit/profiles/closed_profile.h"
#include "fit/sizes/material.h"

namespace rondure::fit {

/// A two-point size LP and the points that it was taken from.
struct LocalSize {
  double size_mm = 0.0;
  std::size_t section = 0;
  std::size_t first = 0;  ///< Rows in the section.
  std::size_t second = 0;
};

/// Statistics of a set of local sizes (ISO 14405-1: rank-order or statistical size).
struct RankSizes {
  double sx_mm = 0.0;     ///< Maximum.
  double sn_mm = 0.0;     ///< Minimum.
  double sa_mm = 0.0;     ///< Average.
  double sm_mm = 0.0;     ///< Median; of an even count the mean of the two in the middle.
  double sd_mm = 0.0;     ///< Mid-range (SX + SN) / 2, not the standard deviation.
  double sr_mm = 0.0;     ///< Range SX - SN.
  double sq_mm = 0.0;     ///< Standard deviation; the divisor is the number of sizes.
  std::size_t count = 0;  ///< Sizes in the set: maximum and minimum widen with it.
};

/// Finds the two-point sizes of touched sections. Two points are opposite if their angles about the
/// centre of the section circle differ by 180 deg to 0.5 deg, of several partners the nearest;
/// their size is the sum of the radii, because the chord is short by the misalignment. Nothing is
/// interpolated.
/// @param sections  Square to the least-squares axis of the feature, see sections_across().
/// @return The sizes, section by section; kBadOption (tip radius); kSampling if a section has no
///         pair, as with an odd number of points at equal angles. O(n log n) and the pairs.
/// Source: methods, drawing section 2.3.
[[nodiscard]] core::Result<std::vector<LocalSize>> two_point_sizes(
    std::span<const Section> sections, const Material& material);

/// Finds the two-point sizes of a dense section at n uniform angles, n even: of opposite samples.
/// @param profile  Radii about the section circle, filtered or not [mm].
/// @return n / 2 sizes; kSampling (n odd or 0), kBadOption (tip radius).
[[nodiscard]] core::Result<std::vector<LocalSize>> two_point_sizes(const UniformProfile& profile,
                                                                   const Material& material);

/// @pre `sizes` is not empty.
[[nodiscard]] RankSizes rank_sizes(std::span<const LocalSize> sizes);

}  // namespace rondure::fit
