#pragma once

#include <numbers>

namespace rondure::core {

/// The program calculates in mm, rad and s. Degrees and micrometres appear only in JSON keys,
/// report columns and messages; these factors convert them: `30.0 * kDegree` is an angle in rad.
inline constexpr double kDegree = std::numbers::pi / 180.0;
inline constexpr double kMicrometre = 1e-3;   ///< in mm
inline constexpr double kMicroradian = 1e-6;  ///< in rad
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kSameAngle = 1e-9;  ///< Angles this close or closer count as equal [rad].

/// Unit in which a value is written: deviations in um, sizes in mm, angles in urad. Values and
/// limits are held in mm, those that are angles in mrad: one thousandth is a um or a urad, so that
/// whatever counts in um counts in urad as well.
enum class ValueUnit { kUm, kMm, kUrad };

/// Unit of a difference of values or of an uncertainty: urad of angles, um of lengths.
[[nodiscard]] constexpr ValueUnit unit_of_difference(ValueUnit unit) {
  return unit == ValueUnit::kUrad ? unit : ValueUnit::kUm;
}

/// A length in um and an angle in degrees, for a key, a column or a message.
[[nodiscard]] constexpr double micrometres(double length_mm) { return length_mm / kMicrometre; }
[[nodiscard]] constexpr double degrees(double angle_rad) { return angle_rad / kDegree; }

}  // namespace rondure::core
