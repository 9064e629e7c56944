#include "cmm/indicators/displacement_probe.h"

#include <fmt/format.h>

namespace rondure::cmm {

core::Error refuse_tracking(const IndicatorTraits& traits, double rate_Hz, int indicators) {
  const double round_s = indicators * traits.reading_time_s;
  return {core::Code::kBadOption,
          fmt::format(
              "{} indicator(s) that are asked one after the other take {:.3g} s for a round, and a "
              "round at {:.4g} Hz has {:.3g} s; their readings would also belong to different "
              "angles of the turning part. Stop the part at each angle, or record with probes that "
              "sample at the same time and read the file",
              indicators, round_s, rate_Hz, 1.0 / rate_Hz),
          {}};
}

}  // namespace rondure::cmm
