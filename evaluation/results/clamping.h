#pragma once

#include <optional>
#include <string>

#include "core/pose.h"

namespace rondure::evaluation {

/// The frame in which the cloud of a feature stands. Touches stand in the machine frame, in which
/// every pose of the fixture and every clamping puts the part at another place.
struct Clamping {
  std::optional<std::string> file;  ///< Checksum of the points file; none: touched.
  std::string name;                 ///< SurfaceSettings::clamping.
  core::Pose reached;               ///< Of touches: pose in which the evaluated cloud was measured.
  int located_again = 0;            ///< How often the part had been located again before.
  bool merged = false;              ///< The cloud is of several poses, in a body frame of its own.
};

}  // namespace rondure::evaluation
