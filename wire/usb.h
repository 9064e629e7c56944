#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "core/error.h"

namespace rondure::wire {

/// What went wrong on the bus. The kind is for a driver that can do something about it, the
/// sentence for the person who has to.
struct UsbFault {
  enum class Kind {
    kNotFound,    ///< No such device is plugged in.
    kAmbiguous,   ///< Several are, and nothing says which.
    kUnplugged,   ///< It was there and is gone.
    kBusy,        ///< Another program or a kernel driver has it; the sentence says who.
    kPermission,  ///< This user may not open it; the sentence names the udev rules file.
    kStall,       ///< The device refused the request (STALL).
    kTimeout,     ///< Not everything was sent, or nothing answered, within the limit.
    kBabble,      ///< The device sent more than was asked for.
    kOther,       ///< Anything else, as the system calls it.
  };

  Kind kind = Kind::kOther;
  std::string what;  ///< One sentence with the device and what to do.

  /// The same as every other fault of a machine (kMachine).
  [[nodiscard]] core::Error error() const { return {core::Code::kMachine, what, {}}; }
};

template <class T>
using UsbResult = tl::expected<T, UsbFault>;

/// A device that is plugged in.
struct UsbDeviceInfo {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  int bus = 0;
  int address = 0;
  std::string manufacturer;         ///< As the device says; "" when it cannot be asked.
  std::string product_name;         ///< The same.
  std::string serial;               ///< The same.
  std::optional<UsbFault> refused;  ///< Why it cannot be opened, with what to do; none: it can.
  std::string kernel_driver;        ///< Bound to it; claim() detaches it. "": none. Of lists only.
  std::string held_by;  ///< Programs that have it open, device_holders(). Of lists only.

  /// E.g. "2939:49c2 at bus 1, address 2".
  [[nodiscard]] std::string place() const;
};

/// All devices of the computer, by bus and address. Each is opened for a moment to ask its strings;
/// nothing is claimed, no driver detached.
[[nodiscard]] UsbResult<std::vector<UsbDeviceInfo>> list_usb_devices();

/// Which device is meant.
struct UsbSelector {
  std::uint16_t vendor = 0;
  std::vector<std::uint16_t> products;  ///< Any of these; empty: all of the vendor.
  std::string serial;                   ///< "": the only one of them that is plugged in.
  std::string name;                     ///< For messages, e.g. "Zaber controller".
};

/// An endpoint of an interface, from the descriptors.
struct UsbEndpoint {
  enum class Kind { kControl, kIsochronous, kBulk, kInterrupt };

  std::uint8_t address = 0;  ///< Bit 7: IN, from the device to us.
  Kind kind = Kind::kBulk;
  std::size_t packet_bytes = 0;  ///< Longest packet.

  [[nodiscard]] bool is_in() const { return (address & 0x80U) != 0; }
};

/// An interface of the active configuration in its first setting.
struct UsbInterface {
  int number = 0;
  std::uint8_t device_class = 0;
  std::uint8_t subclass = 0;
  std::uint8_t protocol = 0;
  std::vector<UsbEndpoint> endpoints;
};

/// The first four fields of a control transfer.
struct UsbSetup {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

/// An open USB device. open_usb() gives the real one; a test may put its own in its place. Every
/// time limit is at least 1 ms: 0 only looks at what is there. After kUnplugged nothing works any
/// more. Not for use by two threads at once.
class UsbDevice {
 public:
  using Limit = std::chrono::milliseconds;

  virtual ~UsbDevice() = default;
  UsbDevice() = default;
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;

  [[nodiscard]] virtual const UsbDeviceInfo& info() const = 0;
  [[nodiscard]] virtual const std::vector<UsbInterface>& interfaces() const = 0;
  /// Chooses a configuration; nothing happens when it is the active one already.
  [[nodiscard]] virtual UsbResult<void> configure(int configuration) = 0;
  /// Resets the device on the bus. Interfaces are to be claimed again.
  [[nodiscard]] virtual UsbResult<void> reset() = 0;
  /// Takes an interface for this program alone. A kernel driver that holds it is detached, and
  /// comes back when the device is closed.
  [[nodiscard]] virtual UsbResult<void> claim(int interface) = 0;

  [[nodiscard]] virtual UsbResult<void> control_out(const UsbSetup& setup, std::string_view bytes,
                                                    Limit limit) = 0;
  /// @return  At most `most` bytes; fewer when the device sends fewer.
  [[nodiscard]] virtual UsbResult<std::string> control_in(const UsbSetup& setup, std::size_t most,
                                                          Limit limit) = 0;
  /// Sends all bytes; kTimeout when not all were taken.
  [[nodiscard]] virtual UsbResult<void> bulk_out(std::uint8_t endpoint, std::string_view bytes,
                                                 Limit limit) = 0;
  /// What came in one transfer, which a short packet ends; "" when nothing came within the limit.
  /// @param most  A multiple of the packet length of the endpoint, or a device that sends a full
  ///              packet gives kBabble.
  [[nodiscard]] virtual UsbResult<std::string> bulk_in(std::uint8_t endpoint, std::size_t most,
                                                       Limit limit) = 0;
  /// The same from an interrupt endpoint.
  [[nodiscard]] virtual UsbResult<std::string> interrupt_in(std::uint8_t endpoint, std::size_t most,
                                                            Limit limit) = 0;
  /// Releases what was claimed and gives kernel drivers their interfaces back. Safe to call twice.
  virtual void close() = 0;
};

/// Of a serial line over USB: the limit of a request that sets it up, and the packets that one
/// transfer reads at most.
inline constexpr UsbDevice::Limit kControlLimit(1000);
inline constexpr std::size_t kPacketsAtOnce = 8;

/// Opens the device that is meant. Nothing is claimed.
/// @return  kNotFound, kAmbiguous (the sentence lists the serial numbers), kPermission, kBusy.
[[nodiscard]] UsbResult<std::unique_ptr<UsbDevice>> open_usb(const UsbSelector& selector);

}  // namespace rondure::wire
