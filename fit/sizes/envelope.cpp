#include "fit/sizes/envelope.h"

namespace rondure::fit {

core::Result<EnvelopeSizes> envelope_sizes(const GlobalSizes& global,
                                           const core::Result<RankSizes>& local, bool inside) {
  if (inside && !global.gx_mm) return core::fail(global.gx_mm.error());
  EnvelopeSizes out;
  out.mating_mm = inside ? *global.gx_mm : global.gn_mm;
  out.local_mm = local.map([&](const RankSizes& s) { return inside ? s.sx_mm : s.sn_mm; });
  return out;
}

EnvelopeAnswer envelope_answer(const EnvelopeSizes& sizes, bool inside, double lower_mm,
                               double upper_mm) {
  // Written so that a number that is none fails.
  const bool mates = inside ? sizes.mating_mm >= lower_mm : sizes.mating_mm <= upper_mm;
  if (!mates) return EnvelopeAnswer::kFails;
  if (!sizes.local_mm) return EnvelopeAnswer::kOpen;
  const bool thick = inside ? *sizes.local_mm <= upper_mm : *sizes.local_mm >= lower_mm;
  return thick ? EnvelopeAnswer::kHolds : EnvelopeAnswer::kFails;
}

}  // namespace rondure::fit
