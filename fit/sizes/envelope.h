#pragma once

#include "core/result.h"
#include "fit/sizes/global_sizes.h"
#include "fit/sizes/local_sizes.h"

namespace rondure::fit {

/// Sizes that the envelope requirement limits (ISO 14405-1): two results, one verdict.
struct EnvelopeSizes {
  /// Shaft: GN, which must not exceed the upper limit; bore: GX, not below the lower limit [mm].
  double mating_mm = 0.0;
  /// Shaft: least two-point size, not below the lower limit; bore: greatest, not above the upper
  /// limit [mm]; or why there is none.
  core::Result<double> local_mm = 0.0;
};

enum class EnvelopeAnswer {
  kHolds,
  kFails,
  kOpen,  ///< The envelope side holds, but two-point sizes are not known.
};

/// @return The sizes; an error of GX for a bore that has none.
[[nodiscard]] core::Result<EnvelopeSizes> envelope_sizes(const GlobalSizes& global,
                                                         const core::Result<RankSizes>& local,
                                                         bool inside);

/// Compares the sizes with their limits, without uncertainty. A failing envelope side decides
/// whatever the two-point sizes are.
/// @pre lower_mm <= upper_mm.
/// Source: methods, drawing section 2.6.
[[nodiscard]] EnvelopeAnswer envelope_answer(const EnvelopeSizes& sizes, bool inside,
                                             double lower_mm, double upper_mm);

}  // namespace rondure::fit
