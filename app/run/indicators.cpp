#include "app/run/indicators.h"

#include <utility>

#include <fmt/format.h>

#include "cmm/indicators/ascii_probe.h"
#include "cmm/indicators/mitutoyo_itn.h"
#include "wire/serial_port.h"
#include "wire/usb.h"

namespace rondure::app {
namespace {

using OpenProbe = core::Result<std::unique_ptr<cmm::DisplacementProbe>>;

constexpr std::uint16_t kMitutoyo = 0x0fe7;
constexpr std::uint16_t kItn = 0x4001;

OpenProbe open_itn(const std::string& serial, bool inches) {
  auto device = wire::open_usb({kMitutoyo, {kItn}, serial, "Mitutoyo USB-ITN cable"});
  if (!device) return core::fail(device.error().error());
  cmm::MitutoyoItnOptions options;
  if (inches) options.unit_mm = cmm::kInch_mm;
  return cmm::open_mitutoyo_itn(std::move(*device), options);
}

}  // namespace

std::string indicator_words() {
  return fmt::format("itn, itn:SERIAL, or KIND:DEVICE with the kinds {}", cmm::ascii_probe_names());
}

OpenProbe open_indicator(const std::string& word, bool inches) {
  const std::size_t colon = word.find(':');
  const std::string kind = word.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : word.substr(colon + 1);
  if (kind == "itn") return open_itn(rest, inches);
  auto settings = cmm::ascii_probe_settings(kind);
  if (!settings || rest.empty()) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("\"{}\" is no indicator; give {}", word, indicator_words()));
  }
  if (inches) settings->unit_mm = cmm::kInch_mm;
  auto line = wire::open_serial(rest, settings->line);
  if (!line) return core::fail(line.error());
  return cmm::open_ascii_probe(std::move(*line), *settings);
}

}  // namespace rondure::app
