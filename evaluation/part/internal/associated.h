#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/zone/deviation_range.h"
#include "record/run_record.h"

// Private to the room: the cylinder, circle or sphere that a size or a form deviation is of.

namespace rondure::evaluation {

/// A cylinder, circle or sphere associated with points.
struct Associated {
  double radius_mm = 0.0;     ///< Of the tip centres; of a minimum zone the mean of both [mm].
  double deviation_mm = 0.0;  ///< Greatest less least distance of the points from it.
  fit::Axis axis = {};        ///< Of a cylinder.
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< Of a circle.
  std::vector<std::size_t> contacts;  ///< Rows of the points that carry it; empty of LS.
  bool certified = true;              ///< Least squares needs no certificate.
  bool exact_fit = false;             ///< The deviation is 0 by construction.
  int pivots = 0;                     ///< Of a search without proof: the measure of its time.
  std::optional<fit::DeviationRange> range = {};  ///< Where several circles are equally good.
};

/// The cylinder of all points of a surface.
/// @return as the fit of the reference; kTooFewPoints below 6 points, kRank for one section,
///         kReferenceAbsent if half a turn or more is open.
[[nodiscard]] core::Result<Associated> associated_cylinder(const PreparedSurface& surface,
                                                           record::Reference reference,
                                                           Proof proof);

/// The circle of a section.
/// @return as the fit of the reference.
[[nodiscard]] core::Result<Associated> associated_circle(fit::PlanePoints points_mm,
                                                         record::Reference reference, Proof proof);

/// The sphere of all points of a surface.
/// @return as the fit of the reference.
[[nodiscard]] core::Result<Associated> associated_sphere(fit::SpacePoints points_mm,
                                                         record::Reference reference);

}  // namespace rondure::evaluation
