#pragma once

#include <memory>
#include <string>

#include "wire/usb.h"

// Forward declarations of libusb types; libusb's own header is included only in the .cpp files.
struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

// Shared by the files that implement wire/usb.h.

namespace rondure::wire::usb {

struct ContextEnd {
  void operator()(libusb_context* context) const;
};
using Context = std::unique_ptr<libusb_context, ContextEnd>;

struct HandleEnd {
  void operator()(libusb_device_handle* handle) const;
};
using Handle = std::unique_ptr<libusb_device_handle, HandleEnd>;

/// Frees a list of all plugged-in devices. Each entry holds a reference until then.
struct ListEnd {
  void operator()(libusb_device** list) const;
};
using List = std::unique_ptr<libusb_device*, ListEnd>;

[[nodiscard]] UsbResult<Context> new_context();
[[nodiscard]] UsbResult<List> all_devices(libusb_context& context);

/// Reads vendor, product, bus and address of a device.
[[nodiscard]] UsbResult<UsbDeviceInfo> identity(libusb_device& device);
/// Reads the string descriptors of an open device.
void ask_strings(libusb_device_handle& handle, UsbDeviceInfo& info);
[[nodiscard]] UsbResult<Handle> open_device(libusb_device& device, const UsbDeviceInfo& info);

/// The fault that a libusb code stands for, worded for this device and for the action in `doing`.
[[nodiscard]] UsbFault fault_of(int libusb_code, const UsbDeviceInfo& info,
                                const std::string& doing);

/// The kernel driver of an interface; "" when there is none, or this library itself.
[[nodiscard]] std::string kernel_driver_of(libusb_device& device, int interface);
/// The programs that have a device open, as given by device_holders().
[[nodiscard]] std::string programs_with(const UsbDeviceInfo& info);
/// The holder of an interface of a device: a kernel driver or a program.
[[nodiscard]] std::string holder_of(libusb_device& device, const UsbDeviceInfo& info,
                                    int interface);

}  // namespace rondure::wire::usb
