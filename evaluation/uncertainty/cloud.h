#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The form value that a cloud is measured for.
enum class FormKind {
  kCylindricity,  ///< CYLt of all points.
  kRoundness,     ///< RONt of one section.
  kSections,      ///< RONt of several sections: that of the section where it is greatest.
  kFlatness,      ///< Of a plane: heights of the points are distances from its middle.
};

/// A sampled point in the frame of its cylinder.
struct FormPoint {
  double angle_rad = 0.0;  ///< Angle about the axis.
  double height_mm = 0.0;  ///< Height along the axis, from its point; 0 in a section.
  /// Distance from the axis minus the radius; 0 before the measurement.
  double deviation_mm = 0.0;
  int repeats = 1;      ///< Number of touches that the point is the mean of, >= 1.
  int pose = 0;         ///< Fixture pose in which it was touched.
  double time_1 = 0.0;  ///< Time of the touch, from 0 (first touch) to 1 (last touch).
  int section = 0;      ///< Of kSections: which one, from 0 without gaps, ascending.
};

/// Points of a cylinder or a section with all data that the uncertainty engine needs: measured
/// (form_cloud()) or nominal (before the first touch).
struct FormCloud {
  FormKind kind = FormKind::kCylindricity;
  record::Reference reference = record::Reference::kMinimumZone;  ///< Reference of the value.
  fit::Axis axis;  ///< Machine frame, but see `frames`; angles count from the first vector of
                   ///< fit::across().
  double radius_mm = 0.0;  ///< Radius of the tip centres, > 0.
  /// Number of passes over the layers, at places of their own.
  int passes = 1;
  bool outside = true;  ///< A shaft, touched towards the axis; false: a bore.
  std::vector<FormPoint> points;
  /// Pose of the cloud's frame in the machine, by FormPoint::pose: of a cloud in the frame of the
  /// part, touched in several poses. Empty: the cloud stands in the machine frame.
  std::vector<Eigen::Isometry3d> frames;
};

/// The cloud of measured points about their least-squares axis, in the order they were touched:
/// even times, one pose, one touch each (correct them afterwards where that is not so).
///
/// @param points_mm       Tip centres, machine frame. For a section, its plane is fitted to them.
/// @param near_direction  Approximate direction of the axis; for a section, its normal (z if
///                        absent).
/// @return  The errors of fit::ls_cylinder(), fit::ls_circle().
[[nodiscard]] core::Result<FormCloud> form_cloud(
    FormKind kind, std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

/// Several sections as one cloud of kSections, one after another. Each is taken about its own
/// least-squares circle, so that a bend or a taper of the part is no form; what they have in
/// common, such as lobes along the whole part, is learnt from all.
/// @param direction  Of the axis, normal of all sections.
/// @return  The errors of fit::ls_circle().
[[nodiscard]] core::Result<FormCloud> sections_cloud(
    std::span<const std::vector<Eigen::Vector3d>> sections_mm, const Eigen::Vector3d& direction);

/// The unit vector from the axis to a point, in the frame of the cloud.
[[nodiscard]] Eigen::Vector3d outward_normal(const FormCloud& cloud, const FormPoint& point);

/// Where the tip centre is, in the frame of the cloud [mm].
[[nodiscard]] Eigen::Vector3d position_mm(const FormCloud& cloud, const FormPoint& point);

/// Effect of a shift, a tilt (cylinder and plane only) and a change of radius on the deviations, to
/// first order: n x 5, of a plane n x 3, of each section 3 columns more.
[[nodiscard]] Eigen::MatrixXd rigid_motions(const FormCloud& cloud);

/// The same as orthonormal columns (fewer where the points do not determine them).
[[nodiscard]] Eigen::MatrixXd rigid_basis(const FormCloud& cloud);

}  // namespace rondure::evaluation
