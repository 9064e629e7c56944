#pragma once

#include <memory>
#include <string_view>

#include "cmm/indicators/displacement_probe.h"
#include "core/result.h"
#include "wire/clock.h"
#include "wire/usb.h"

namespace rondure::cmm {

inline constexpr double kInch_mm = 25.4;

/// Properties of the gauge that the cable does not report.
struct MitutoyoItnOptions {
  double unit_mm = 1.0;  ///< Unit that the gauge shows: 1, or kInch_mm.
  double resolution_mm = 0.001;
};

/// Opens a Digimatic gauge on a Mitutoyo USB-ITN cable (0fe7:4001) with the vendor protocol of the
/// cable, which leaves its keyboard mode until it is unplugged. A reading sent by the button of the
/// cable is discarded, and a late answer is never taken for the next one.
/// @param clock  Outlives the probe; nullptr: the system clock.
/// @return  kMachine when the device is busy or refuses the requests.
/// Source: protocol of the cable as open drivers use it; message as in Mitutoyo's description of
/// the interface.
[[nodiscard]] core::Result<std::unique_ptr<DisplacementProbe>> open_mitutoyo_itn(
    std::unique_ptr<wire::UsbDevice> device, const MitutoyoItnOptions& options = {},
    wire::Clock* clock = nullptr);

/// Parses the message of a Digimatic gauge at a Mitutoyo interface, without its CR: "01A+0000.123"
/// gives 0.123, in the unit that the gauge shows. kMachine for a status message ("911": no gauge,
/// or no data) and for anything else that is not a reading.
[[nodiscard]] core::Result<double> digimatic_reading(std::string_view message);

}  // namespace rondure::cmm
