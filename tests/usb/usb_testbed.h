#pragma once

#include <filesystem>
#include <memory>
#include <mutex>

#include "tests/usb/emulated_usb.h"

namespace rondure::testing {

/// Calls that the operating system refuses.
struct UsbRefusals {
  bool open = false;          ///< No user but root may open the device file.
  bool claim = false;         ///< Another program has claimed it.
  std::string kernel_driver;  ///< Bound to its interfaces until it is detached; "": none.
};

/// Emulated USB devices that this program, and every program it starts, sees as plugged in
/// (umockdev). Only one test bed at a time.
class UsbTestbed {
 public:
  /// @param lock  Held while a device is called; a test takes it to access its devices. It must
  ///              outlive the test bed.
  explicit UsbTestbed(std::mutex& lock);
  ~UsbTestbed();
  UsbTestbed(const UsbTestbed&) = delete;
  UsbTestbed& operator=(const UsbTestbed&) = delete;

  /// Plugs in a device at the next address of bus 1, from 2 on. It must outlive the test bed.
  /// @return  Its address.
  int plug_in(EmulatedUsb& device, const UsbRefusals& refusals = {});
  /// Pulls the plug: every transfer fails from now on.
  void unplug(int address);
  /// Kernel drivers that were detached from a device so far.
  [[nodiscard]] int detached(int address) const;

 private:
  struct Bed;
  std::unique_ptr<Bed> bed_;
};

}  // namespace rondure::testing
