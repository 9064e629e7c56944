#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/rotary/result.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Columns of AxisCurve::common_mm that are one line of the budget.
struct CommonNoise {
  std::string name;
  Eigen::Index columns = 0;
};

/// One error of one axis over its stations: a shift, or a tilt in mrad, here and below. The
/// reference pose is no station: its errors are 0 by definition.
struct AxisCurve {
  std::vector<double> angle_rad;
  std::vector<double> found_mm;
  std::vector<double> u_mm;  ///< Standard uncertainty of the station alone.
  /// What is common to all stations adds at each per standard uncertainty, in independent columns.
  std::vector<Eigen::VectorXd> common_mm;
  std::vector<CommonNoise> noises;  ///< Of these columns, in order.
  std::vector<double> redundancy;   ///< Least of the coordinates of the balls at each station.
};

/// The curve that a characteristic of the form axis-error asks for; axis and error are given.
[[nodiscard]] AxisCurve axis_curve(const RotaryResult& result,
                                   const record::Characteristic& characteristic);

/// The least redundancy of a coordinate of a ball at the station of this angle.
[[nodiscard]] double least_redundancy(const fit::RotaryStudy& study, double angle_rad);

/// The error that decides: the one farthest from the middle of the limits.
struct AxisExtreme {
  std::size_t station = 0;
  double from_middle_mm = 0.0;  ///< Its distance from the middle, >= 0.
  bool above = true;            ///< Of the middle.
};

/// @param errors_mm  At least one.
[[nodiscard]] AxisExtreme axis_extreme(std::span<const double> errors_mm, double middle_mm);

/// Middle of the limits of a value with a sign; 0 of an amount.
[[nodiscard]] double middle_of(const record::Characteristic& characteristic);

/// The value: with two limits the error that decides, with its sign, else its amount.
[[nodiscard]] double axis_value_mm(const record::Characteristic& characteristic,
                                   const AxisExtreme& extreme);

/// The interval of that value, by trials of all stations together.
[[nodiscard]] UncertaintyStatus axis_error_interval(const AxisCurve& curve,
                                                    const record::Characteristic& characteristic,
                                                    std::vector<InfluenceStatement> declaration,
                                                    const UncertaintyOptions& options);

}  // namespace rondure::evaluation
