#include "wire/internal/usb_context.h"

#include <array>
#include <filesystem>

#include <fmt/format.h>
#include <libusb.h>

#include "wire/internal/device_holders.h"

namespace rondure::wire::usb {
namespace {

using Kind = UsbFault::Kind;

constexpr std::size_t kLongestString = 256;

std::string device_file(const UsbDeviceInfo& info) {
  return fmt::format("/dev/bus/usb/{:03}/{:03}", info.bus, info.address);
}

std::string ask_string(libusb_device_handle& handle, std::uint8_t index) {
  if (index == 0) return {};
  std::array<unsigned char, kLongestString> text = {};
  const int length = libusb_get_string_descriptor_ascii(&handle, index, text.data(),
                                                        static_cast<int>(text.size()));
  if (length <= 0) return {};
  return {text.begin(), text.begin() + length};
}

/// "1-4.2", as the kernel names the place of a device.
std::string port_path(libusb_device& device) {
  std::array<std::uint8_t, 8> ports = {};
  const int count = libusb_get_port_numbers(&device, ports.data(), static_cast<int>(ports.size()));
  std::string path = fmt::format("{}", libusb_get_bus_number(&device));
  for (int i = 0; i < count; ++i) {
    path += fmt::format("{}{}", i == 0 ? '-' : '.', ports.at(static_cast<std::size_t>(i)));
  }
  return path;
}

}  // namespace

void ContextEnd::operator()(libusb_context* context) const { libusb_exit(context); }
void HandleEnd::operator()(libusb_device_handle* handle) const { libusb_close(handle); }
void ListEnd::operator()(libusb_device** list) const { libusb_free_device_list(list, 1); }

UsbResult<Context> new_context() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != LIBUSB_SUCCESS) {
    return tl::unexpected(
        UsbFault{Kind::kOther,
                 fmt::format("USB cannot be used on this computer: {}", libusb_strerror(code))});
  }
  return Context(context);
}

UsbResult<List> all_devices(libusb_context& context) {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(&context, &list);
  if (count < 0) {
    return tl::unexpected(
        UsbFault{Kind::kOther, fmt::format("the USB devices cannot be listed: {}",
                                           libusb_strerror(static_cast<int>(count)))});
  }
  return List(list);
}

UsbResult<UsbDeviceInfo> identity(libusb_device& device) {
  libusb_device_descriptor text = {};
  UsbDeviceInfo info;
  info.bus = libusb_get_bus_number(&device);
  info.address = libusb_get_device_address(&device);
  if (const int code = libusb_get_device_descriptor(&device, &text); code != LIBUSB_SUCCESS) {
    return tl::unexpected(fault_of(code, info, "reading its descriptor"));
  }
  info.vendor = text.idVendor;
  info.product = text.idProduct;
  return info;
}

void ask_strings(libusb_device_handle& handle, UsbDeviceInfo& info) {
  libusb_device_descriptor text = {};
  if (libusb_get_device_descriptor(libusb_get_device(&handle), &text) != LIBUSB_SUCCESS) return;
  info.manufacturer = ask_string(handle, text.iManufacturer);
  info.product_name = ask_string(handle, text.iProduct);
  info.serial = ask_string(handle, text.iSerialNumber);
}

UsbResult<Handle> open_device(libusb_device& device, const UsbDeviceInfo& info) {
  libusb_device_handle* handle = nullptr;
  const int code = libusb_open(&device, &handle);
  if (code != LIBUSB_SUCCESS) return tl::unexpected(fault_of(code, info, "opening it"));
  return Handle(handle);
}

UsbFault fault_of(int libusb_code, const UsbDeviceInfo& info, const std::string& doing) {
  const std::string who = info.place();
  switch (libusb_code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return {Kind::kUnplugged,
              fmt::format("the USB device {} was unplugged while {}; plug it in and check the "
                          "cable and its supply",
                          who, doing)};
    case LIBUSB_ERROR_ACCESS:
      return {Kind::kPermission,
              fmt::format("this user may not open the USB device {} ({}); install the udev rules: "
                          "sudo cp wire/60-rondure.rules /etc/udev/rules.d/ && sudo udevadm "
                          "control --reload, then plug it in again",
                          who, device_file(info))};
    case LIBUSB_ERROR_BUSY:
      return {Kind::kBusy, fmt::format("the USB device {} is in use; end the other program", who)};
    case LIBUSB_ERROR_PIPE:
      return {Kind::kStall, fmt::format("the USB device {} refused {} (stall)", who, doing)};
    case LIBUSB_ERROR_TIMEOUT:
      return {Kind::kTimeout,
              fmt::format("the USB device {} did not answer in time while {}", who, doing)};
    case LIBUSB_ERROR_OVERFLOW:
      return {Kind::kBabble,
              fmt::format("the USB device {} sent more than was asked for while {}", who, doing)};
    default:
      return {Kind::kOther, fmt::format("the USB device {} failed while {}: {}", who, doing,
                                        libusb_strerror(libusb_code))};
  }
}

std::string kernel_driver_of(libusb_device& device, int interface) {
  std::error_code none;
  const std::filesystem::path place =
      fmt::format("/sys/bus/usb/devices/{0}:1.{1}/driver", port_path(device), interface);
  std::string driver = std::filesystem::read_symlink(place, none).filename().string();
  return driver == "usbfs" ? std::string() : driver;
}

std::string programs_with(const UsbDeviceInfo& info) { return device_holders(device_file(info)); }

std::string holder_of(libusb_device& device, const UsbDeviceInfo& info, int interface) {
  const std::string driver = kernel_driver_of(device, interface);
  if (!driver.empty()) return fmt::format("the kernel driver {}", driver);
  const std::string programs = programs_with(info);
  return programs.empty() ? "another program" : programs;
}

}  // namespace rondure::wire::usb
