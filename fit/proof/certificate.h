#pragma once

#include <array>
#include <string_view>

#include "core/phrase.h"
#include "core/words.h"
#include "fit/geometry/contacts.h"

namespace rondure::fit {

/// The extent to which a minimum zone, or a one-sided reference, is proven to be optimal.
struct Certificate {
  enum class Kind {
    kNone,  ///< Nothing is proven; `reason` explains why.
    /// A strict local minimum: multipliers >= 0, no point outside, growth in all directions.
    kLocal,
    kGlobal,  ///< No better zone exists within `scope`.
  };
  Kind kind = Kind::kNone;
  core::Phrase scope;   ///< "all centres", "all directions", "next to the least-squares axis".
  double gap_mm = 0.0;  ///< Reported value minus proven lower bound [mm].
  core::Phrase reason;  ///< Why the kind is not higher; empty for kGlobal.
};

/// What an optimum is needed for. A trial of the uncertainty takes the one next to the
/// least-squares feature, without its proof.
enum class Proof { kFull, kNone };

RONDURE_WORDS(Certificate::Kind, {kNone, "none"}, {kLocal, "local"}, {kGlobal, "global"});

}  // namespace rondure::fit
