#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "cmm/simulated/part.h"
#include "core/noise.h"
#include "core/units.h"

namespace rondure::cmm {

inline double between(core::KeyedNoise& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// A part with twisted lobes, taper, barrel and bend; `size` scales the form, 1: about 20 um.
inline PartSurface random_part(core::KeyedNoise& random, bool inside, double size = 1.0) {
  PartSurface part;
  part.radius_mm = between(random, 8.0, 40.0);
  part.half_length_mm = between(random, 15.0, 50.0);
  part.inside = inside;
  for (const int order : {2, 3, 5, 7, 15}) {
    part.form.lobes.push_back({order, size * between(random, 0.0, 0.004),
                               between(random, 0.0, core::kTwoPi), between(random, -1.0, 1.0)});
  }
  part.form.taper_mm = size * between(random, -0.005, 0.005);
  part.form.barrel_mm = size * between(random, -0.005, 0.005);
  part.form.bend_mm = size * between(random, 0.0, 0.005);
  part.form.bend_phase_rad = between(random, 0.0, core::kTwoPi);
  return part;
}

/// A direction at most `tilt_rad` away from `axis`.
inline Eigen::Vector3d random_tilted(core::KeyedNoise& random, const Eigen::Vector3d& axis,
                                     double tilt_rad) {
  const Eigen::Vector3d side = axis.unitOrthogonal();
  const Eigen::AngleAxisd spin(between(random, 0.0, core::kTwoPi), axis);
  return Eigen::AngleAxisd(between(random, 0.0, tilt_rad), spin * side) * axis;
}

}  // namespace rondure::cmm
