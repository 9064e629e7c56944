#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rondure::fit {

/// A point that the zone touches, with its multiplier in the stationarity condition.
struct Contact {
  std::size_t index = 0;    ///< Row of the point in the input.
  double multiplier = 0.0;  ///< >= 0; the multipliers of each side sum to 1.
};

/// What is proven about a minimum zone.
struct Certificate {
  enum class Kind {
    kNone,    ///< Nothing; `reason` says why.
    kLocal,   ///< A strict local minimum: multipliers >= 0, no point outside, growth in all
              ///< directions.
    kGlobal,  ///< No narrower zone exists within `scope`.
  };
  Kind kind = Kind::kNone;
  std::string scope;    ///< "all centres", "all directions", "next to the least-squares axis".
  double gap_mm = 0.0;  ///< Reported zone minus proven lower bound [mm].
  std::string reason;   ///< Why the kind is not higher; empty for kGlobal.
};

/// "none", "local", "global".
[[nodiscard]] std::string_view name_of(Certificate::Kind kind);

}  // namespace rondure::fit
