#include "wire/ftdi_stream.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace rondure::wire {
namespace {

using std::chrono::duration_cast;
using std::chrono::milliseconds;

constexpr std::size_t kStatus_bytes = 2;
constexpr std::uint8_t kVendorOut = 0x40;
constexpr milliseconds kWriteLimit(1000);
constexpr milliseconds kPause(50);

struct Request {
  std::uint8_t request;
  std::uint16_t value;
  std::uint16_t index;
  bool pause_behind;
};

/// The opening, in this order. Sources disagree on which purge is which: both are sent.
constexpr std::array<Request, 9> kOpening = {{{0, 0, 0, false},         // reset
                                              {3, 0x001a, 0, false},    // 3 MHz / 26 = 115200
                                              {4, 0x0008, 0, false},    // 8N1
                                              {9, 16, 0, false},        // latency timer [ms]
                                              {1, 0x0202, 0, true},     // RTS on
                                              {0, 1, 0, false},         // purge
                                              {0, 2, 0, true},          // purge
                                              {2, 0, 0x0100, false},    // RTS/CTS
                                              {1, 0x0101, 0, false}}};  // DTR on

std::optional<UsbEndpoint> bulk_end(const UsbDevice& device, bool in) {
  for (const UsbInterface& interface : device.interfaces()) {
    if (interface.number != 0) continue;
    for (const UsbEndpoint& end : interface.endpoints) {
      if (end.kind == UsbEndpoint::Kind::kBulk && end.is_in() == in &&
          end.packet_bytes > kStatus_bytes) {
        return end;
      }
    }
  }
  return std::nullopt;
}

class FtdiStream final : public ByteStream {
 public:
  FtdiStream(std::unique_ptr<UsbDevice> device, const UsbEndpoint& in, const UsbEndpoint& out,
             Clock& clock)
      : device_(std::move(device)),
        in_(in),
        out_(out),
        clock_(clock),
        peer_(device_->info().place()) {}
  ~FtdiStream() override { close(); }

  [[nodiscard]] UsbResult<void> prepare() {
    if (auto taken = device_->claim(0); !taken) return taken;
    for (const Request& step : kOpening) {
      auto set = device_->control_out({kVendorOut, step.request, step.value, step.index}, {},
                                      kControlLimit);
      if (!set) return set;
      if (step.pause_behind) clock_.sleep_for(kPause);
    }
    return {};
  }

  [[nodiscard]] core::Result<void> write(std::string_view bytes) override {
    if (!open_) return core::fail(failure_);
    if (auto sent = device_->bulk_out(out_.address, bytes, kWriteLimit); !sent) {
      return lose(sent.error());
    }
    return {};
  }

  [[nodiscard]] core::Result<std::string> read_some(milliseconds time_limit) override {
    if (!open_) return core::fail(failure_);
    const Clock::Time end = clock_.now() + time_limit;
    for (;;) {
      const auto left = duration_cast<milliseconds>(end - clock_.now());
      const auto came = device_->bulk_in(in_.address, kPacketsAtOnce * in_.packet_bytes,
                                         std::max(left, milliseconds(0)));
      if (!came) return lose(came.error());
      std::string data = without_ftdi_status(*came, in_.packet_bytes);
      if (!data.empty() || came->empty() || clock_.now() >= end) return data;
    }
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
  UsbEndpoint in_;
  UsbEndpoint out_;
  Clock& clock_;
  std::string peer_;
  bool open_ = true;
  core::Error failure_;
};

}  // namespace

std::string without_ftdi_status(std::string_view transfer, std::size_t packet_bytes) {
  std::string out;
  for (std::size_t at = 0; at < transfer.size(); at += packet_bytes) {
    const std::string_view packet = transfer.substr(at, packet_bytes);
    if (packet.size() > kStatus_bytes) out += packet.substr(kStatus_bytes);
  }
  return out;
}

core::Result<std::unique_ptr<ByteStream>> open_ftdi(std::unique_ptr<UsbDevice> device,
                                                    Clock* clock) {
  const auto in = bulk_end(*device, true);
  const auto out = bulk_end(*device, false);
  if (!in || !out) {
    return core::fail(core::Code::kMachine,
                      fmt::format("the USB device {} has no serial line of an FTDI bridge",
                                  device->info().place()));
  }
  auto stream = std::make_unique<FtdiStream>(std::move(device), *in, *out,
                                             clock != nullptr ? *clock : system_clock());
  if (auto ready = stream->prepare(); !ready) return core::fail(ready.error().error());
  return stream;
}

}  // namespace rondure::wire
