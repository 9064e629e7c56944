#include "wire/usb_stream.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace rondure::wire {
namespace {

using std::chrono::duration_cast;
using std::chrono::milliseconds;

constexpr milliseconds kControlLimit(1000);  // for a setup request
constexpr std::size_t kPacketsAtOnce = 8;    // packets read by one transfer

/// A serial line over the two bulk endpoints of a device.
class UsbStream : public ByteStream {
 public:
  ~UsbStream() override { UsbStream::close(); }

  [[nodiscard]] core::Result<void> write(std::string_view bytes) override {
    if (!open_) return core::fail(failure_);
    if (auto sent = device_->bulk_out(out_.address, bytes, write_limit_); !sent) {
      return lose(sent.error());
    }
    return {};
  }

  [[nodiscard]] core::Result<std::string> read_some(milliseconds time_limit) override {
    if (!open_) return core::fail(failure_);
    auto came = device_->bulk_in(in_.address, kPacketsAtOnce * in_.packet_bytes, time_limit);
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

 protected:
  UsbStream(std::unique_ptr<UsbDevice> device, const UsbEndpoint& in, const UsbEndpoint& out,
            milliseconds write_limit)
      : device_(std::move(device)),
        in_(in),
        out_(out),
        write_limit_(write_limit),
        peer_(device_->info().place()) {}

  [[nodiscard]] UsbDevice& device() { return *device_; }
  [[nodiscard]] const UsbEndpoint& in() const { return in_; }

 private:
  tl::unexpected<core::Error> lose(const UsbFault& fault) {
    close();
    failure_ = fault.error();
    return core::fail(failure_);
  }

  std::unique_ptr<UsbDevice> device_;
  UsbEndpoint in_;
  UsbEndpoint out_;
  milliseconds write_limit_;
  std::string peer_;
  bool open_ = true;
  core::Error failure_;
};

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

/// The bulk endpoint of an interface in one direction whose packets exceed `overhead_bytes`.
std::optional<UsbEndpoint> bulk_endpoint(const UsbInterface& interface, bool in,
                                         std::size_t overhead_bytes = 0) {
  for (const UsbEndpoint& end : interface.endpoints) {
    if (end.kind == UsbEndpoint::Kind::kBulk && end.is_in() == in &&
        end.packet_bytes > overhead_bytes) {
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

class CdcAcm final : public UsbStream {
 public:
  CdcAcm(std::unique_ptr<UsbDevice> device, const Ends& ends, milliseconds write_limit)
      : UsbStream(std::move(device), ends.in, ends.out, write_limit),
        control_(ends.control),
        data_(ends.data) {}

  [[nodiscard]] UsbResult<void> prepare(const SerialSettings& settings) {
    const auto interface = static_cast<std::uint16_t>(control_);
    auto done = device().claim(control_);
    if (done) done = device().claim(data_);
    if (done) {
      done = device().control_out({kToInterface, kSetLineCoding, 0, interface},
                                  line_coding(settings), kControlLimit);
    }
    if (done) {
      done = device().control_out({kToInterface, kSetControlLineState, kDtrAndRts, interface}, {},
                                  kControlLimit);
    }
    return done;
  }

 private:
  int control_;
  int data_;
};

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

/// The requests of the opening, in order. Sources disagree on which purge is which, so both are
/// sent.
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
    if (const auto end = bulk_endpoint(interface, in, kStatus_bytes)) return end;
  }
  return std::nullopt;
}

class FtdiStream final : public UsbStream {
 public:
  FtdiStream(std::unique_ptr<UsbDevice> device, const UsbEndpoint& in, const UsbEndpoint& out,
             Clock& clock)
      : UsbStream(std::move(device), in, out, kWriteLimit), clock_(clock) {}

  [[nodiscard]] UsbResult<void> prepare() {
    if (auto taken = device().claim(0); !taken) return taken;
    for (const Request& step : kOpening) {
      auto set = device().control_out({kVendorOut, step.request, step.value, step.index}, {},
                                      kControlLimit);
      if (!set) return set;
      if (step.pause_behind) clock_.sleep_for(kPause);
    }
    return {};
  }

  /// Returns data without status bytes: a transfer of only these does not end the wait.
  [[nodiscard]] core::Result<std::string> read_some(milliseconds time_limit) override {
    const Clock::Time end = clock_.now() + time_limit;
    for (;;) {
      const auto left = duration_cast<milliseconds>(end - clock_.now());
      const auto came = UsbStream::read_some(std::max(left, milliseconds(0)));
      if (!came) return came;
      std::string data = without_ftdi_status(*came, in().packet_bytes);
      if (!data.empty() || came->empty() || clock_.now() >= end) return data;
    }
  }

 private:
  Clock& clock_;
};

}  // namespace

core::Result<std::unique_ptr<ByteStream>> open_cdc_acm(std::unique_ptr<UsbDevice> device,
                                                       const SerialSettings& settings) {
  const auto ends = find_ends(device->interfaces());
  if (!ends) {
    return core::machine_fault("the USB device {} has no serial line (class CDC-ACM)",
                               device->info().place());
  }
  auto stream = std::make_unique<CdcAcm>(std::move(device), *ends, settings.write_limit);
  if (auto ready = stream->prepare(settings); !ready) return core::fail(ready.error().error());
  return stream;
}

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
    return core::machine_fault("the USB device {} has no serial line of an FTDI bridge",
                               device->info().place());
  }
  auto stream = std::make_unique<FtdiStream>(std::move(device), *in, *out,
                                             clock != nullptr ? *clock : system_clock());
  if (auto ready = stream->prepare(); !ready) return core::fail(ready.error().error());
  return stream;
}

}  // namespace rondure::wire
