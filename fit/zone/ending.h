#pragma once

namespace rondure::fit {

/// Why a descent ended.
enum class ZoneEnding {
  kConverged,  ///< At a local minimum of all points, to round-off.
  kLimit,      ///< Too many linear programs or passes; the zone is that of the last place.
  kStrayed,    ///< It went past the limit of the caller: the reference may not exist.
  kNotFinite,  ///< A coordinate is not a finite number.
};

}  // namespace rondure::fit
