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

/// A fault on the bus. The kind is for a driver that can react to it, the sentence for the user who
/// must.
struct UsbFault {
  enum class Kind {
    kNotFound,    ///< No such device is plugged in.
    kAmbiguous,   ///< Several are plugged in, and the selector fits more than one.
    kUnplugged,   ///< The device was unplugged while it was in use.
    kBusy,        ///< A program or a kernel driver holds it; the sentence names the holder.
    kPermission,  ///< This user may not open it; the sentence names the udev rules file.
    kStall,       ///< The device refused the request (STALL).
    kTimeout,     ///< Not all bytes were sent, or no answer arrived, within the limit.
    kBabble,      ///< The device sent more than was requested.
    kOther,       ///< Any other fault, in the words of the system.
  };

  Kind kind = Kind::kOther;
  std::string what;  ///< One sentence with the device and the remedy.

  /// The fault as an error of a machine (kMachine).
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
  std::string product_name;         ///< From the device; "" when it cannot be read.
  std::string serial;               ///< From the device; "" when it cannot be read.
  std::optional<UsbFault> refused;  ///< Why it cannot be opened, and the remedy; none: it can.
  /// Driver bound to it, which claim() detaches; "": none. Set in lists only.
  std::string kernel_driver;
  std::string held_by;  ///< Programs that have it open. Set in lists only.

  /// E.g. "2939:49c2 at bus 1, address 2".
  [[nodiscard]] std::string place() const;
};

/// Lists all devices of the computer, by bus and address. Each is opened briefly to read its
/// strings; nothing is claimed and no driver is detached.
[[nodiscard]] UsbResult<std::vector<UsbDeviceInfo>> list_usb_devices();

/// Selects a device.
struct UsbSelector {
  std::uint16_t vendor = 0;
  std::vector<std::uint16_t> products;  ///< Any of these; empty: all of the vendor.
  std::string serial;                   ///< "": the only matching one that is plugged in.
  std::string name;                     ///< For messages, e.g. "Zaber controller".
};

/// An endpoint of an interface, from the descriptors.
struct UsbEndpoint {
  enum class Kind { kControl, kIsochronous, kBulk, kInterrupt };

  std::uint8_t address = 0;  ///< Bit 7 set: IN, from the device to the computer.
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

/// An open USB device: the real one from open_usb(), or a test's own implementation. Every time
/// limit is at least 1 ms; a limit of 0 does not wait. After kUnplugged every call fails. Not for
/// use by two threads at once.
class UsbDevice {
 public:
  using Limit = std::chrono::milliseconds;

  virtual ~UsbDevice() = default;
  UsbDevice() = default;
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;

  [[nodiscard]] virtual const UsbDeviceInfo& info() const = 0;
  [[nodiscard]] virtual const std::vector<UsbInterface>& interfaces() const = 0;
  /// Chooses a configuration; does nothing when that one is active already.
  [[nodiscard]] virtual UsbResult<void> configure(int configuration) = 0;
  /// Resets the device on the bus. Interfaces must be claimed again afterwards.
  [[nodiscard]] virtual UsbResult<void> reset() = 0;
  /// Takes an interface exclusively for this program. A kernel driver that holds it is detached,
  /// and attached again when the device is closed.
  [[nodiscard]] virtual UsbResult<void> claim(int interface) = 0;

  [[nodiscard]] virtual UsbResult<void> control_out(const UsbSetup& setup, std::string_view bytes,
                                                    Limit limit) = 0;
  /// @return  At most `most` bytes; fewer when the device sends fewer.
  [[nodiscard]] virtual UsbResult<std::string> control_in(const UsbSetup& setup, std::size_t most,
                                                          Limit limit) = 0;
  /// Sends all bytes; kTimeout when not all were taken.
  [[nodiscard]] virtual UsbResult<void> bulk_out(std::uint8_t endpoint, std::string_view bytes,
                                                 Limit limit) = 0;
  /// The bytes of one transfer, which a short packet ends; "" when none arrived within the limit.
  /// @param most  A multiple of the packet length of the endpoint; otherwise a device that sends a
  ///              full packet causes kBabble.
  [[nodiscard]] virtual UsbResult<std::string> bulk_in(std::uint8_t endpoint, std::size_t most,
                                                       Limit limit) = 0;
  /// Same as bulk_in(), from an interrupt endpoint.
  [[nodiscard]] virtual UsbResult<std::string> interrupt_in(std::uint8_t endpoint, std::size_t most,
                                                            Limit limit) = 0;
  /// Releases the claimed interfaces and returns them to their kernel drivers. Safe to call twice.
  virtual void close() = 0;
};

/// Opens the selected device. Nothing is claimed.
/// @return  kNotFound, kAmbiguous (the sentence lists the serial numbers), kPermission, kBusy.
[[nodiscard]] UsbResult<std::unique_ptr<UsbDevice>> open_usb(const UsbSelector& selector);

}  // namespace rondure::wire
