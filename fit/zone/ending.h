#pragma once

namespace rondure::fit {

/// Why a descent ended.
enum class ZoneEnding {
  kConverged,  ///< It reached a local minimum of all points, to round-off.
  kLimit,      ///< Too many linear programs or passes; the zone is that of the last place.
  kStrayed,    ///< It went beyond the caller's limit; the reference may not exist.
  kNotFinite,  ///< A coordinate is not a finite number.
};

}  // namespace rondure::fit
