#pragma once

#include <memory>
#include <string>

#include "wire/usb.h"

// The types of libusb, which its header leaves open; the header itself stays in the .cpp files.
struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

// What the files behind usb.h share; nobody else includes it.

namespace rondure::wire::usb {

struct ContextEnd {
  void operator()(libusb_context* context) const;
};
using Context = std::unique_ptr<libusb_context, ContextEnd>;

struct HandleEnd {
  void operator()(libusb_device_handle* handle) const;
};
using Handle = std::unique_ptr<libusb_device_handle, HandleEnd>;

/// Of all devices that are plugged in; each holds a reference until the list goes.
struct ListEnd {
  void operator()(libusb_device** list) const;
};
using List = std::unique_ptr<libusb_device*, ListEnd>;

[[nodiscard]] UsbResult<Context> new_context();
[[nodiscard]] UsbResult<List> all_devices(libusb_context& context);

/// Vendor, product, bus and address.
[[nodiscard]] UsbResult<UsbDeviceInfo> identity(libusb_device& device);
/// Asks an open device for its strings.
void ask_strings(libusb_device_handle& handle, UsbDeviceInfo& info);
[[nodiscard]] UsbResult<Handle> open_device(libusb_device& device, const UsbDeviceInfo& info);

/// The fault that a code of libusb stands for, of this device while it did this.
[[nodiscard]] UsbFault fault_of(int libusb_code, const UsbDeviceInfo& info,
                                const std::string& doing);

/// The kernel driver of an interface; "" when there is none, or this library itself.
[[nodiscard]] std::string kernel_driver_of(libusb_device& device, int interface);
/// The programs that have a device open, as device_holders() tells them.
[[nodiscard]] std::string programs_with(const UsbDeviceInfo& info);
/// Who has an interface of a device: a kernel driver, or a program.
[[nodiscard]] std::string holder_of(libusb_device& device, const UsbDeviceInfo& info,
                                    int interface);

}  // namespace rondure::wire::usb
