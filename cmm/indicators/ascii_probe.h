#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "cmm/indicators/displacement_probe.h"
#include "wire/clock.h"
#include "wire/serial_port.h"
#include "wire/transport.h"

namespace rondure::cmm {

/// Settings of an indicator that exchanges lines of text.
struct AsciiProbeSettings {
  std::string name;
  wire::SerialSettings line;
  std::string request;  ///< Request, with its line end.
  /// Extended regular expression of a reply without its line end. Group 1: the number, with sign;
  /// group 2, where there is one: its unit, "mm", "um" or "in".
  std::string reply;
  double unit_mm = 1.0;  ///< Unit of the number when the reply names none.
  double resolution_mm = 0.001;
  std::chrono::milliseconds answer_limit{1000};
};

/// The settings of an indicator by its name; nothing for an unknown one:
///   sylvac     Sylvac and Bowers, also OPTO-RS and their USB cables: 4800 7E2, "?"
///   tesa       TESA TT80, TT90: 4800 7E2 (set the instrument so), "?"
///   mahr       Mahr Millimar C1202, first input: 9600 7E2, "M1?"
///   qm-height  Mitutoyo QM-Height, and Digimatic cables as a serial port: 9600 8N1, "1"
[[nodiscard]] std::optional<AsciiProbeSettings> ascii_probe_settings(std::string_view name);
/// "sylvac, tesa, mahr, qm-height".
[[nodiscard]] std::string ascii_probe_names();

/// Opens an indicator on a serial line. An echo of the request is skipped, unrequested bytes are
/// discarded, and a late answer is never taken for the next one.
/// @param clock  Outlives the probe; nullptr: the system clock.
/// @return kBadOption when `reply` is not a regular expression, or has no group.
[[nodiscard]] core::Result<std::unique_ptr<DisplacementProbe>> open_ascii_probe(
    std::unique_ptr<wire::ByteStream> stream, const AsciiProbeSettings& settings,
    wire::Clock* clock = nullptr);

}  // namespace rondure::cmm
