#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/sections.h"
#include "fit/profiles/closed_profile.h"

namespace rondure::fit {

/// Where the material of a feature of size lies, and the ball that touched it.
struct Material {
  bool inside = false;  ///< True for a bore: the material is outside the cylinder.
  /// Of the ball whose centres are evaluated [mm]. Below 0, down to -0.05 mm, as an error alone: of
  /// points of the surface, which were corrected by too large a radius.
  double tip_radius_mm = 0.0;

  /// +1 for a shaft, -1 for a bore: outward is out of the material.
  [[nodiscard]] double sign() const { return inside ? -1.0 : 1.0; }
  /// Radius of the surface, which lies one tip radius closer to the material than the tip centres.
  [[nodiscard]] double surface_radius_mm(double center_radius_mm) const {
    return center_radius_mm - sign() * tip_radius_mm;
  }
  /// Diameter of the surface for the radius of a cylinder of tip centres [mm].
  [[nodiscard]] double diameter_mm(double center_radius_mm) const {
    return 2.0 * surface_radius_mm(center_radius_mm);
  }
};

/// @return kBadOption if the tip radius is negative or not finite.
[[nodiscard]] core::Result<void> check_material(const Material& material);
/// The same; kBadOption also if the surface of a circle or cylinder of tip centres of this radius
/// would have none, which tells of a wrong tip or side.
[[nodiscard]] core::Result<void> check_material(const Material& material, double center_radius_mm);

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

/// Global sizes of a cylinder, of a sphere, or of the circle of one section (ISO 14405-1):
/// diameters [mm].
///
/// GN of a shaft and GX of a bore are those of the surface itself for any tip radius; the others
/// are those of the surface as the tip feels it, which bridges valleys narrower than the tip.
struct GlobalSizes {
  double gg_mm = 0.0;                ///< Least squares.
  double gn_mm = 0.0;                ///< Minimum circumscribed.
  core::Result<double> gx_mm = 0.0;  ///< Maximum inscribed, or why there is none (arcs).
  double gc_mm = 0.0;                ///< Minimax: mean diameter of the minimum zone.
};

/// Computes the global sizes of a cylinder from tip centres. GN, GX and GC are those next to the
/// least-squares axis.
/// @param points_mm       n >= 5 points in at least two sections [mm].
/// @param near_direction  As ls_cylinder().
/// @return as ls_cylinder(), kBadOption (tip radius), kNotConverged; kReferenceAbsent where the
///         points do not surround the axis. Cost: three fits without proof.
/// Source: methods, drawing section 2.2.
[[nodiscard]] core::Result<GlobalSizes> global_sizes(
    SpacePoints points_mm, const Material& material,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

/// Computes the sizes of the circle of one section: ACS and SCS.
/// @return as ls_circle(), kBadOption (tip radius), kNotConverged, kReferenceAbsent.
/// Source: methods, drawing section 2.5.
[[nodiscard]] core::Result<GlobalSizes> global_sizes(PlanePoints points_mm,
                                                     const Material& material);

/// Computes the sizes of a sphere. GX is absent where a cap is open, through which the inscribed
/// sphere would grow.
/// @return as ls_sphere(), kBadOption (tip radius), kNotConverged.
/// Source: methods, drawing section 9.3.
[[nodiscard]] core::Result<GlobalSizes> global_sizes_of_sphere(SpacePoints points_mm,
                                                               const Material& material);

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
