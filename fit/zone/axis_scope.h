#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/units.h"
#include "fit/zone/global_search.h"

namespace rondure::fit {

/// Directions that are searched for a better axis.
struct AxisScope {
  enum class Kind { kCone, kHalfSphere };
  Kind kind = Kind::kHalfSphere;
  Eigen::Vector3d nominal = Eigen::Vector3d::UnitZ();  ///< Middle of the cone.
  double cone_rad = 10.0 * core::kDegree;              ///< Half angle of the cone, below 80 deg.
};

/// Extent of the proof of a minimum-zone, circumscribed or inscribed cylinder.
struct CylinderProofOptions {
  /// Scopes to try in order until one is proven. Empty: local proof only, as is enough inside
  /// loops.
  std::vector<AxisScope> scopes;
  GlobalSearchOptions search;
};

}  // namespace rondure::fit
