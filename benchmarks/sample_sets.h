#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/units.h"

namespace rondure::benchmarks {

/// What makes a set hard, one thing at a time.
enum class Variant {
  kScanOrder,     ///< As a machine touches: section by section, round each section.
  kShuffled,      ///< The same points in random order.
  kRounded100nm,  ///< Coordinates rounded to 0.1 um.
  kRounded1um,    ///< Coordinates rounded to 1 um: many equal radii.
  kSpikes,        ///< 0.5 % of the points 12 um in or out.
  kStart5,        ///< The start direction 5 deg off the axis.
  kStart25,       ///< 25 deg off.
  kStart45,       ///< 45 deg off.
  kSmallForm,     ///< Form and noise shrunk 20 x.
};
inline constexpr std::array kVariants = {
    Variant::kScanOrder,  Variant::kShuffled, Variant::kRounded100nm,
    Variant::kRounded1um, Variant::kSpikes,   Variant::kStart5,
    Variant::kStart25,    Variant::kStart45,  Variant::kSmallForm};

/// "scan", "shuffled", "rounded-0.1um", ..., as in the names of the benchmarks.
[[nodiscard]] std::string_view name_of(Variant variant);

/// Names one set: equal keys, equal points to the last bit.
struct SetKey {
  Variant variant = Variant::kScanOrder;
  std::size_t points = 0;  ///< >= 9 of a cylinder, >= 4 of a circle.
  std::uint64_t seed = 0;
  double arc_rad = core::kTwoPi;  ///< Part of the circumference that holds points.

  auto operator<=>(const SetKey&) const = default;
};

/// Nominal size of every set.
inline constexpr double kRadius_mm = 25.0;
inline constexpr double kHalfLength_mm = 30.0;
/// No point of a set without spikes deviates from the ideal shape by more (1 / 20 of it for
/// kSmallForm, 1 um more for rounded coordinates); spikes add 12 um.
inline constexpr double kLargestDeviation_mm = 0.022;

/// Points of a cylinder and where its axis lies.
struct CylinderSet {
  std::vector<Eigen::Vector3d> points_mm;
  Eigen::Vector3d
      start_direction;  ///< What a fit is given; 1 deg off unless the variant says more.
  Eigen::Vector3d axis_point_mm;
  Eigen::Vector3d axis_direction;  ///< Of the ideal cylinder; at most 5 deg off z.
};

/// Points of a circle.
struct CircleSet {
  std::vector<Eigen::Vector2d> points_mm;
  Eigen::Vector2d center_mm;  ///< Of the ideal circle.
};

/// A turned part of radius 25 mm and length 60 mm: lobes of orders 2, 3, 5, 7 of up to 3 um that
/// twist along the axis, taper and barrel of up to 3 um, noise of 1 um (normal, cut at 4 sigma).
/// Sections are spread evenly, about cbrt(n) of them, at least 3; angles evenly with a little
/// jitter. Axis shifted by up to 0.5 mm and tilted by up to 5 deg.
[[nodiscard]] CylinderSet make_cylinder(const SetKey& key);

/// One section of such a part: lobes and noise. The start variants mean nothing here.
[[nodiscard]] CircleSet make_circle(const SetKey& key);

}  // namespace rondure::benchmarks
