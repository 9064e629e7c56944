#pragma once

#include <span>

#include "core/result.h"
#include "fit/profiles/closed_profile.h"
#include "fit/sizes/material.h"

namespace rondure::fit {

/// Calculated sizes of one section (ISO 14405-1): diameters of the circles of equal circumference
/// and of equal area.
struct CalculatedSizes {
  double cc_mm = 0.0;     ///< Circumference / pi. It grows with the bandwidth of the filter.
  double ca_mm = 0.0;     ///< sqrt(4 area / pi).
  double area_mm2 = 0.0;  ///< Of the surface.
};

/// Computes the calculated sizes of a dense section without a gap, from the harmonic series through
/// its samples: a polygon would be short by pi^2 / (6 n^2) of the circumference. The tip centres
/// follow the parallel curve of the surface, whose circumference differs by 2 pi times the tip
/// radius.
///
/// @param profile  Radii of the tip centres about the section circle, filtered, n >= 8 [mm].
/// @return kTooFewPoints, kNotFinite (row), kBadOption (tip radius, or not below every radius).
///         O(3600 n).
/// Source: methods, drawing section 2.7.
[[nodiscard]] core::Result<CalculatedSizes> calculated_sizes(const UniformProfile& profile,
                                                             const Material& material);

/// Size from the volume, CV: diameter of the cylinder with the volume between the first and the
/// last section, by the trapezium rule over the areas [mm].
/// @param heights_mm  Strictly ascending, two or more.
/// @return kNoPoints (different numbers), kRank (fewer than two), kBadOption (not ascending).
[[nodiscard]] core::Result<double> volume_size_mm(std::span<const double> heights_mm,
                                                  std::span<const double> areas_mm2);

}  // namespace rondure::fit
