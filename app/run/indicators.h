#pragma once

#include <memory>
#include <string>

#include "cmm/indicators/displacement_probe.h"
#include "core/result.h"

namespace rondure::app {

/// Opens an indicator by its word on the command line: "itn", "itn:SERIAL" (a Mitutoyo USB-ITN
/// cable), or "KIND:DEVICE" of an indicator on a serial line, "sylvac:/dev/ttyUSB0".
/// @param inches  The indicator shows inches.
/// @return  kBadOption for an unknown word; kMachine when the indicator cannot be opened.
[[nodiscard]] core::Result<std::unique_ptr<cmm::DisplacementProbe>> open_indicator(
    const std::string& word, bool inches);

/// The words that open_indicator() accepts, for help and messages.
[[nodiscard]] std::string indicator_words();

}  // namespace rondure::app
