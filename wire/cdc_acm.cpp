#include "wire/cdc_acm.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace rondure::wire {
namespace {

using std::chrono::milliseconds;

constexpr std::uint8_t kCommunicationClass = 0x02;
constexpr std::uint8_t kAbstractControl = 0x02;
constexpr std::uint8_t kDataClass = 0x0a;
constexpr std::uint8_t kToInterface = 0x21;  // class request, host to device
constexpr std::uint8_t kSetLineCoding = 0x20;
constexpr std::uint8_t kSetControlLineState = 0x22;
constexpr std::uint16_t kDtrAndRts = 0x03;

/// The interfaces and endpoints of a device of this class.
struct Ends {
  int control = 0;
  int data = 0;
  UsbEndpoint in;
  UsbEndpoint out;
};

std::optional<UsbEndpoint> bulk_endpoint(const UsbInterface& interface, bool in) {
  for (const UsbEndpoint& end : interface.endpoints) {
    if (end.kind == UsbEndpoint::Kind::kBulk && end.is_in() == in && end.packet_bytes > 0) {
      return end;
    }
  }
  return std::nullopt;
}

std::optional<Ends> find_ends(const std::vector<UsbInterface>& interfaces) {
  const auto control =
      std::find_if(interfaces.begin(), interfaces.end(), [](const UsbInterface& i) {
        return i.device_class == kCommunicationClass && i.subclass == kAbstractControl;
      });
  if (control == interfaces.end()) return std::nullopt;
  for (auto data = interfaces.begin(); data != interfaces.end(); ++data) {
    if (data->device_class != kDataClass) continue;
    const auto in = bulk_endpoint(*data, true);
    const auto out = bulk_endpoint(*data, false);
    if (in && out) return Ends{control->number, data->number, *in, *out};
  }
  return std::nullopt;
}

/// The seven bytes of a line coding.
std::string line_coding(const SerialSettings& settings) {
  std::string out;
  const auto baud = static_cast<std::uint32_t>(settings.baud);
  for (unsigned shift = 0; shift < 32; shift += 8) out += static_cast<char>(baud >> shift & 0xffU);
  out += settings.stop_bits == 2 ? '\2' : '\0';
  out += static_cast<char>(settings.parity);  // 0 none, 1 odd, 2 even: as the enumeration counts
  out += static_cast<char>(settings.data_bits);
  return out;
}

class CdcAcm final : public ByteStream {
 public:
  CdcAcm(std::unique_ptr<UsbDevice> device, const Ends& ends, milliseconds write_limit)
      : device_(std::move(device)),
        ends_(ends),
        write_limit_(write_limit),
        peer_(device_->info().place()) {}
  ~CdcAcm() override { close(); }

  [[nodiscard]] UsbResult<void> prepare(const SerialSettings& settings) {
    const auto interface = static_cast<std::uint16_t>(ends_.control);
    auto done = device_->claim(ends_.control);
    if (done) done = device_->claim(ends_.data);
    if (done) {
      done = device_->control_out({kToInterface, kSetLineCoding, 0, interface},
                                  line_coding(settings), kControlLimit);
    }
    if (done) {
      done = device_->control_out({kToInterface, kSetControlLineState, kDtrAndRts, interface}, {},
                                  kControlLimit);
    }
    return done;
  }

  [[nodiscard]] core::Result<void> write(std::string_view bytes) override {
    if (!open_) return core::fail(failure_);
    if (auto sent = device_->bulk_out(ends_.out.address, bytes, write_limit_); !sent) {
      return lose(sent.error());
    }
    return {};
  }

  [[nodiscard]] core::Result<std::string> read_some(milliseconds time_limit) override {
    if (!open_) return core::fail(failure_);
    auto came =
        device_->bulk_in(ends_.in.address, kPacketsAtOnce * ends_.in.packet_bytes, time_limit);
    if (!came) return lose(came.error());
    return *std::move(came);
  }

  void close() override {
    if (!open_) return;
    open_ = false;
    failure_ = {core::Code::kMachine, fmt::format("the connection to {} is closed", peer_), {}};
    device_->close();
  }

  [[nodiscard]] bool is_open() const override { return open_; }
  [[nodiscard]] std::string peer() const override { return peer_; }

 private:
  tl::unexpected<core::Error> lose(const UsbFault& fault) {
    close();
    failure_ = fault.error();
    return core::fail(failure_);
  }

  std::unique_ptr<UsbDevice> device_;
  Ends ends_;
  milliseconds write_limit_;
  std::string peer_;
  bool open_ = true;
  core::Error failure_;
};

}  // namespace

core::Result<std::unique_ptr<ByteStream>> open_cdc_acm(std::unique_ptr<UsbDevice> device,
                                                       const SerialSettings& settings) {
  const auto ends = find_ends(device->interfaces());
  if (!ends) {
    return core::fail(core::Code::kMachine,
                      fmt::format("the USB device {} has no serial line (class CDC-ACM)",
                                  device->info().place()));
  }
  auto stream = std::make_unique<CdcAcm>(std::move(device), *ends, settings.write_limit);
  if (auto ready = stream->prepare(settings); !ready) return core::fail(ready.error().error());
  return stream;
}

}  // namespace rondure::wire
