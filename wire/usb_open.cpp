#include "wire/usb.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <libusb.h>

#include "wire/internal/device_holders.h"

namespace rondure::wire {
namespace {

using Kind = UsbFault::Kind;

struct ContextEnd {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using Context = std::unique_ptr<libusb_context, ContextEnd>;

struct HandleEnd {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using Handle = std::unique_ptr<libusb_device_handle, HandleEnd>;

/// Frees a list of all plugged-in devices. The entries hold references until then.
struct ListEnd {
  void operator()(libusb_device** list) const { libusb_free_device_list(list, 1); }
};
using List = std::unique_ptr<libusb_device*, ListEnd>;

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

/// The fault for a libusb code, worded for this device and for the action in `doing`.
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

/// Reads vendor, product, bus and address of a device.
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

/// Reads the string descriptors of an open device.
void ask_strings(libusb_device_handle& handle, UsbDeviceInfo& info) {
  libusb_device_descriptor text = {};
  if (libusb_get_device_descriptor(libusb_get_device(&handle), &text) != LIBUSB_SUCCESS) return;
  info.product_name = ask_string(handle, text.iProduct);
  info.serial = ask_string(handle, text.iSerialNumber);
}

UsbResult<Handle> open_device(libusb_device& device, const UsbDeviceInfo& info) {
  libusb_device_handle* handle = nullptr;
  const int code = libusb_open(&device, &handle);
  if (code != LIBUSB_SUCCESS) return tl::unexpected(fault_of(code, info, "opening it"));
  return Handle(handle);
}

/// The kernel driver of an interface; "" when there is none, or this library itself.
std::string kernel_driver_of(libusb_device& device, int interface) {
  std::error_code none;
  const std::filesystem::path place =
      fmt::format("/sys/bus/usb/devices/{0}:1.{1}/driver", port_path(device), interface);
  std::string driver = std::filesystem::read_symlink(place, none).filename().string();
  return driver == "usbfs" ? std::string() : driver;
}

/// The programs that have a device open, as given by device_holders().
std::string programs_with(const UsbDeviceInfo& info) { return device_holders(device_file(info)); }

/// The holder of an interface of a device: a kernel driver or a program.
std::string holder_of(libusb_device& device, const UsbDeviceInfo& info, int interface) {
  const std::string driver = kernel_driver_of(device, interface);
  if (!driver.empty()) return fmt::format("the kernel driver {}", driver);
  const std::string programs = programs_with(info);
  return programs.empty() ? "another program" : programs;
}

unsigned int milliseconds_of(UsbDevice::Limit limit) {
  return static_cast<unsigned int>(std::max<UsbDevice::Limit::rep>(1, limit.count()));
}

UsbEndpoint endpoint_of(const libusb_endpoint_descriptor& text) {
  constexpr unsigned kPacketBits = 0x7ff;  // the upper bits count packets per microframe
  constexpr unsigned kKindBits = 0x3;
  return {text.bEndpointAddress, static_cast<UsbEndpoint::Kind>(text.bmAttributes & kKindBits),
          text.wMaxPacketSize & kPacketBits};
}

std::vector<UsbInterface> interfaces_of(libusb_device& device) {
  libusb_config_descriptor* text = nullptr;
  if (libusb_get_active_config_descriptor(&device, &text) != LIBUSB_SUCCESS) return {};
  std::vector<UsbInterface> out;
  for (int i = 0; i < text->bNumInterfaces; ++i) {
    if (text->interface[i].num_altsetting < 1) continue;
    const libusb_interface_descriptor& first = text->interface[i].altsetting[0];
    UsbInterface one = {first.bInterfaceNumber,
                        first.bInterfaceClass,
                        first.bInterfaceSubClass,
                        first.bInterfaceProtocol,
                        {}};
    for (int k = 0; k < first.bNumEndpoints; ++k) {
      one.endpoints.push_back(endpoint_of(first.endpoint[k]));
    }
    out.push_back(std::move(one));
  }
  libusb_free_config_descriptor(text);
  return out;
}

class OpenDevice final : public UsbDevice {
 public:
  OpenDevice(Context context, Handle handle, UsbDeviceInfo info)
      : context_(std::move(context)),
        handle_(std::move(handle)),
        info_(std::move(info)),
        interfaces_(interfaces_of(*libusb_get_device(handle_.get()))) {
    libusb_set_auto_detach_kernel_driver(handle_.get(), 1);  // an error shows up when claiming
  }
  ~OpenDevice() override { close(); }

  [[nodiscard]] const UsbDeviceInfo& info() const override { return info_; }
  [[nodiscard]] const std::vector<UsbInterface>& interfaces() const override { return interfaces_; }

  [[nodiscard]] UsbResult<void> configure(int configuration) override {
    if (auto open = check_open(); !open) return open;
    int active = 0;
    int code = libusb_get_configuration(handle_.get(), &active);
    if (code == LIBUSB_SUCCESS && active != configuration) {
      code = libusb_set_configuration(handle_.get(), configuration);
      interfaces_ = interfaces_of(*libusb_get_device(handle_.get()));
    }
    return outcome(code, "choosing its configuration");
  }

  [[nodiscard]] UsbResult<void> reset() override {
    if (auto open = check_open(); !open) return open;
    release_all();
    return outcome(libusb_reset_device(handle_.get()), "being reset");
  }

  [[nodiscard]] UsbResult<void> claim(int interface) override {
    if (auto open = check_open(); !open) return open;
    const int code = libusb_claim_interface(handle_.get(), interface);
    if (code == LIBUSB_ERROR_NOT_FOUND) {
      return tl::unexpected(
          UsbFault{Kind::kOther,
                   fmt::format("the USB device {} has no interface {}", info_.place(), interface)});
    }
    if (code == LIBUSB_ERROR_BUSY) {
      return tl::unexpected(UsbFault{
          Kind::kBusy,
          fmt::format("the USB device {} is in use by {}; end it and start again", info_.place(),
                      holder_of(*libusb_get_device(handle_.get()), info_, interface))});
    }
    if (code == LIBUSB_SUCCESS) claimed_.push_back(interface);
    return outcome(code, fmt::format("claiming interface {}", interface));
  }

  [[nodiscard]] UsbResult<void> control_out(const UsbSetup& setup, std::string_view bytes,
                                            Limit limit) override {
    std::string copy(bytes);  // libusb takes no const data
    TRY(const auto count, control(setup, copy, limit));
    if (count == bytes.size()) return {};
    return tl::unexpected(fault_of(LIBUSB_ERROR_TIMEOUT, info_, request_name(setup)));
  }

  [[nodiscard]] UsbResult<std::string> control_in(const UsbSetup& setup, std::size_t most,
                                                  Limit limit) override {
    std::string bytes(most, '\0');
    TRY(const auto count, control(setup, bytes, limit));
    bytes.resize(count);
    return bytes;
  }

  [[nodiscard]] UsbResult<void> bulk_out(std::uint8_t endpoint, std::string_view bytes,
                                         Limit limit) override {
    if (auto open = check_open(); !open) return open;
    std::string copy(bytes);
    int sent = 0;
    int code = libusb_bulk_transfer(handle_.get(), endpoint, data(copy),
                                    static_cast<int>(copy.size()), &sent, milliseconds_of(limit));
    if (code == LIBUSB_SUCCESS && static_cast<std::size_t>(sent) < bytes.size()) {
      code = LIBUSB_ERROR_TIMEOUT;
    }
    return outcome(code, fmt::format("taking {} bytes", bytes.size()));
  }

  [[nodiscard]] UsbResult<std::string> bulk_in(std::uint8_t endpoint, std::size_t most,
                                               Limit limit) override {
    return in_transfer(libusb_bulk_transfer, endpoint, most, limit);
  }

  [[nodiscard]] UsbResult<std::string> interrupt_in(std::uint8_t endpoint, std::size_t most,
                                                    Limit limit) override {
    return in_transfer(libusb_interrupt_transfer, endpoint, most, limit);
  }

  void close() override {
    if (!handle_) return;
    release_all();
    handle_.reset();
  }

 private:
  static unsigned char* data(std::string& bytes) {
    return reinterpret_cast<unsigned char*>(bytes.data());
  }
  static std::string request_name(const UsbSetup& setup) {
    return fmt::format("the request {:#04x} {:#04x}", setup.request_type, setup.request);
  }

  [[nodiscard]] UsbResult<void> check_open() const {
    if (handle_) return {};
    return tl::unexpected(
        UsbFault{Kind::kOther, fmt::format("the USB device {} is closed", info_.place())});
  }

  [[nodiscard]] UsbResult<void> outcome(int code, const std::string& doing) const {
    if (code == LIBUSB_SUCCESS) return {};
    return tl::unexpected(fault_of(code, info_, doing));
  }

  void release_all() {
    for (const int interface : claimed_) libusb_release_interface(handle_.get(), interface);
    claimed_.clear();
  }

  UsbResult<std::size_t> control(const UsbSetup& setup, std::string& bytes, Limit limit) {
    TRY_DO(check_open());
    const int count = libusb_control_transfer(
        handle_.get(), setup.request_type, setup.request, setup.value, setup.index, data(bytes),
        static_cast<std::uint16_t>(bytes.size()), milliseconds_of(limit));
    if (count < 0) return tl::unexpected(fault_of(count, info_, request_name(setup)));
    return static_cast<std::size_t>(count);
  }

  template <class Transfer>
  UsbResult<std::string> in_transfer(Transfer transfer, std::uint8_t endpoint, std::size_t most,
                                     Limit limit) {
    TRY_DO(check_open());
    std::string bytes(most, '\0');
    int count = 0;
    const int code = transfer(handle_.get(), endpoint, data(bytes), static_cast<int>(most), &count,
                              milliseconds_of(limit));
    if (code != LIBUSB_SUCCESS && code != LIBUSB_ERROR_TIMEOUT) {
      return tl::unexpected(
          fault_of(code, info_, fmt::format("sending on endpoint {:#04x}", endpoint)));
    }
    // after a timeout: the bytes received until then
    bytes.resize(static_cast<std::size_t>(count));
    return bytes;
  }

  Context context_;  // outlives the handle
  Handle handle_;
  UsbDeviceInfo info_;
  std::vector<UsbInterface> interfaces_;
  std::vector<int> claimed_;
};

bool is_meant(const UsbSelector& selector, const UsbDeviceInfo& info) {
  const auto& products = selector.products;
  return info.vendor == selector.vendor &&
         (products.empty() ||
          std::find(products.begin(), products.end(), info.product) != products.end());
}

/// An opened device that matches the selector.
struct Candidate {
  Handle handle;
  UsbDeviceInfo info;
};

UsbFault not_found(const UsbSelector& selector, const std::string& others) {
  const std::string serial =
      selector.serial.empty() ? "" : fmt::format(" with the serial number {}", selector.serial);
  const std::string found =
      others.empty() ? "" : fmt::format("; plugged in are those with the numbers {}", others);
  return {Kind::kNotFound,
          fmt::format("no {}{} (USB vendor {:04x}) is plugged in{}; check cable and supply",
                      selector.name, serial, selector.vendor, found)};
}

UsbFault ambiguous(const UsbSelector& selector, const std::string& serials) {
  return {Kind::kAmbiguous, fmt::format("several of the kind {} are plugged in; say which by its "
                                        "serial number, one of {}",
                                        selector.name, serials)};
}

std::string serials_of(const std::vector<Candidate>& candidates) {
  std::vector<std::string> serials;
  for (const Candidate& c : candidates) {
    serials.push_back(c.info.serial.empty() ? "(none)" : c.info.serial);
  }
  std::sort(serials.begin(), serials.end());
  std::string out;
  for (const std::string& serial : serials) out += (out.empty() ? "" : ", ") + serial;
  return out;
}

}  // namespace

UsbResult<std::unique_ptr<UsbDevice>> open_usb(const UsbSelector& selector) {
  TRY(auto context, new_context());
  TRY(auto list, all_devices(*context));
  std::vector<Candidate> fitting;
  std::optional<UsbFault> refused;
  for (libusb_device** device = list.get(); *device != nullptr; ++device) {
    auto info = identity(**device);
    if (!info || !is_meant(selector, *info)) continue;
    auto handle = open_device(**device, *info);
    if (!handle) {
      refused = handle.error();
      continue;
    }
    ask_strings(**handle, *info);
    fitting.push_back({*std::move(handle), *std::move(info)});
  }
  const std::string serials = serials_of(fitting);
  if (!selector.serial.empty()) {
    std::erase_if(fitting, [&](const Candidate& c) { return c.info.serial != selector.serial; });
  }
  if (fitting.size() > 1) return tl::unexpected(ambiguous(selector, serials));
  if (fitting.empty() && refused) return tl::unexpected(*refused);
  if (fitting.empty()) return tl::unexpected(not_found(selector, serials));
  return std::make_unique<OpenDevice>(std::move(context), std::move(fitting.front().handle),
                                      std::move(fitting.front().info));
}

std::string UsbDeviceInfo::place() const {
  return fmt::format("{:04x}:{:04x} at bus {}, address {}", vendor, product, bus, address);
}

UsbResult<std::vector<UsbDeviceInfo>> list_usb_devices() {
  TRY(auto context, new_context());
  TRY(auto list, all_devices(*context));
  std::vector<UsbDeviceInfo> out;
  for (libusb_device** device = list.get(); *device != nullptr; ++device) {
    auto info = identity(**device);
    if (!info) continue;  // unplugged in the meantime
    info->kernel_driver = kernel_driver_of(**device, 0);
    info->held_by = programs_with(*info);  // queried before this program opens it
    if (const auto handle = open_device(**device, *info)) {
      ask_strings(**handle, *info);
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
