#include <algorithm>

#include <fmt/format.h>

#include "wire/internal/usb_context.h"
#include "wire/usb.h"

namespace rondure::wire {

std::string UsbDeviceInfo::place() const {
  return fmt::format("{:04x}:{:04x} at bus {}, address {}", vendor, product, bus, address);
}

UsbResult<std::vector<UsbDeviceInfo>> list_usb_devices() {
  auto context = usb::new_context();
  if (!context) return tl::unexpected(context.error());
  auto list = usb::all_devices(**context);
  if (!list) return tl::unexpected(list.error());
  std::vector<UsbDeviceInfo> out;
  for (libusb_device** device = list->get(); *device != nullptr; ++device) {
    auto info = usb::identity(**device);
    if (!info) continue;  // unplugged in the meantime
    info->kernel_driver = usb::kernel_driver_of(**device, 0);
    info->held_by = usb::programs_with(*info);  // asked before this program opens it
    if (const auto handle = usb::open_device(**device, *info)) {
      usb::ask_strings(**handle, *info);
    } else {
      info->refused = handle.error();
    }
    out.push_back(*std::move(info));
  }
  std::sort(out.begin(), out.end(), [](const UsbDeviceInfo& a, const UsbDeviceInfo& b) {
    return std::pair(a.bus, a.address) < std::pair(b.bus, b.address);
  });
  return out;
}

}  // namespace rondure::wire
