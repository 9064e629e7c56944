#include "tests/usb/usb_testbed.h"

#include <sys/ioctl.h>  // before usbdevice_fs.h, which needs it

#include <linux/usbdevice_fs.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <list>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <umockdev.h>

namespace rondure::testing {
namespace {

constexpr std::size_t kSetup_bytes = 8;
constexpr std::uint8_t kEndpointIn = 0x80;

std::string text_of(UMockdevIoctlData* data, std::size_t from, std::size_t length) {
  guint8* bytes = nullptr;
  gint count = 0;
  umockdev_ioctl_data_retrieve(data, &bytes, &count);
  const auto end = std::min(static_cast<std::size_t>(count), from + length);
  std::string out(reinterpret_cast<const char*>(bytes) + from, end - from);
  g_free(bytes);
  return out;
}

template <class T>
T field(UMockdevIoctlData* data, std::size_t offset) {
  const std::string bytes = text_of(data, offset, sizeof(T));
  T out = {};
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(&out));
  return out;
}

template <class T>
void put(UMockdevIoctlData* data, std::size_t offset, T value) {
  umockdev_ioctl_data_update(data, offset, reinterpret_cast<guint8*>(&value), sizeof value);
}

/// UTF-16, as a string descriptor holds it.
std::string string_descriptor(int index, const std::string& text) {
  if (index == 0) return std::string("\x04\x03\x09\x04", 4);  // the languages: English
  std::string out = {static_cast<char>(2 + 2 * text.size()), '\x03'};
  for (const char c : text) out += {c, '\0'};
  return out;
}

std::string hex(const std::string& bytes) {
  std::string out;
  for (const char c : bytes) out += fmt::format("{:02X}", static_cast<unsigned char>(c));
  return out;
}

}  // namespace

/// A transfer that was submitted and not reaped yet.
struct UsbTransfer {
  UMockdevIoctlData* urb = nullptr;     ///< struct usbdevfs_urb of the client.
  UMockdevIoctlData* buffer = nullptr;  ///< Its data.
  unsigned char type = 0;               ///< USBDEVFS_URB_TYPE_...
  unsigned char endpoint = 0;
  int length = 0;
  bool done = false;
  int status = 0;
  int actual = 0;
};

/// One device with its transfers; answers the calls that libusb makes to the kernel.
class UsbSocket {
 public:
  UsbSocket(EmulatedUsb& device, const UsbRefusals& refusals, std::mutex& lock)
      : device_(device), refusals_(refusals), lock_(lock) {}
  ~UsbSocket() {
    for (const UsbTransfer& transfer : transfers_) drop(transfer);
  }
  UsbSocket(const UsbSocket&) = delete;
  UsbSocket& operator=(const UsbSocket&) = delete;

  static gboolean call(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer socket) {
    return static_cast<UsbSocket*>(socket)->answer(client) ? TRUE : FALSE;
  }
  void unplug() { gone_ = true; }
  [[nodiscard]] int detached() const { return detached_; }

 private:
  static void drop(const UsbTransfer& transfer) {
    if (transfer.buffer != nullptr) umockdev_ioctl_data_unref(transfer.buffer);
    umockdev_ioctl_data_unref(transfer.urb);
  }

  static bool complete(UMockdevIoctlClient* client, int error) {
    umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
    return true;
  }

  bool answer(UMockdevIoctlClient* client) {
    const std::lock_guard guard(lock_);
    const auto request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
    if (request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY) {
      return reap(client, argument);
    }
    if (request == USBDEVFS_DISCARDURB) return discard(client, argument);
    if (gone_) return complete(client, ENODEV);
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES:
        return capabilities(client, argument);
      case USBDEVFS_CLAIMINTERFACE:
        return claim(client, argument, false);
      case USBDEVFS_DISCONNECT_CLAIM:
        return claim(client, argument, true);
      case USBDEVFS_GETDRIVER:
        return complete(client, ENODATA);
      case USBDEVFS_RELEASEINTERFACE:
      case USBDEVFS_SETCONFIGURATION:
      case USBDEVFS_SETINTERFACE:
      case USBDEVFS_CLEAR_HALT:
      case USBDEVFS_RESET:
      case USBDEVFS_IOCTL:
        return complete(client, 0);
      case USBDEVFS_SUBMITURB:
        return submit(client, argument);
      default:
        return complete(client, ENOTTY);
    }
  }

  bool claim(UMockdevIoctlClient* client, UMockdevIoctlData* argument, bool detach) {
    UMockdevIoctlData* place = umockdev_ioctl_data_resolve(argument, 0, sizeof(unsigned), nullptr);
    const auto interface = field<unsigned>(place, 0);  // the first member of both arguments
    umockdev_ioctl_data_unref(place);
    constexpr std::size_t kInterfaceCount = 18 + 4;
    const auto count = static_cast<unsigned char>(device_.descriptors().at(kInterfaceCount));
    if (interface >= count) return complete(client, ENOENT);
    if (refusals_.claim) return complete(client, EBUSY);
    if (!refusals_.kernel_driver.empty() && detach) ++detached_;
    const bool held = !refusals_.kernel_driver.empty() && detached_ == 0;
    return complete(client, held ? EBUSY : 0);
  }

  static bool capabilities(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    const guint32 known = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
                          USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_BULK_SCATTER_GATHER |
                          USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    UMockdevIoctlData* target = umockdev_ioctl_data_resolve(argument, 0, sizeof known, nullptr);
    put(target, 0, known);
    umockdev_ioctl_data_unref(target);
    return complete(client, 0);
  }

  bool submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    UsbTransfer transfer;
    transfer.urb = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
    if (transfer.urb == nullptr) return complete(client, EFAULT);
    transfer.type = field<unsigned char>(transfer.urb, offsetof(usbdevfs_urb, type));
    transfer.endpoint = field<unsigned char>(transfer.urb, offsetof(usbdevfs_urb, endpoint));
    transfer.length = field<int>(transfer.urb, offsetof(usbdevfs_urb, buffer_length));
    if (transfer.length > 0) {
      transfer.buffer = umockdev_ioctl_data_resolve(transfer.urb, offsetof(usbdevfs_urb, buffer),
                                                    static_cast<gsize>(transfer.length), nullptr);
    }
    if (!is_in(transfer) || transfer.type == USBDEVFS_URB_TYPE_CONTROL) advance(transfer);
    transfers_.push_back(transfer);
    return complete(client, 0);
  }

  static bool is_in(const UsbTransfer& transfer) { return (transfer.endpoint & kEndpointIn) != 0; }

  /// Lets the device answer a transfer, if it will.
  void advance(UsbTransfer& transfer) {
    if (transfer.type == USBDEVFS_URB_TYPE_CONTROL) {
      control(transfer);
      return;
    }
    const auto most = static_cast<std::size_t>(transfer.length);
    if (is_in(transfer)) {
      settle(transfer, device_.in(transfer.endpoint, most), 0, true);
      return;
    }
    const std::string bytes = transfer.buffer == nullptr ? "" : text_of(transfer.buffer, 0, most);
    settle(transfer, device_.out(transfer.endpoint, bytes), 0, false);
  }

  void control(UsbTransfer& transfer) {
    const std::string setup = text_of(transfer.buffer, 0, kSetup_bytes);
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(setup[i]); };
    const auto word = [&](std::size_t i) {
      return static_cast<std::uint16_t>(at(i) | static_cast<unsigned>(at(i + 1)) << 8U);
    };
    const wire::UsbSetup head = {at(0), at(1), word(2), word(4)};
    const std::size_t length = word(6);
    const bool in = (head.request_type & kEndpointIn) != 0;
    constexpr std::uint8_t kGetDescriptor = 6;
    constexpr unsigned kStringDescriptor = 3;
    UsbAnswer answer;
    if (head.request_type == kEndpointIn && head.request == kGetDescriptor &&
        head.value >> 8U == kStringDescriptor) {
      const int index = head.value & 0xff;
      answer = UsbAnswer::data(string_descriptor(index, index == 0 ? "" : device_.string(index)));
    } else {
      answer =
          device_.control(head, in ? "" : text_of(transfer.buffer, kSetup_bytes, length), length);
    }
    if (answer.bytes.size() > length) answer.bytes.resize(length);
    settle(transfer, answer, kSetup_bytes, in);
  }

  /// Ends a transfer as the device answered.
  static void settle(UsbTransfer& transfer, const UsbAnswer& answer, std::size_t offset, bool in) {
    if (answer.kind == UsbAnswer::Kind::kWait) return;
    transfer.done = true;
    if (answer.kind == UsbAnswer::Kind::kStall) transfer.status = -EPIPE;
    if (answer.kind == UsbAnswer::Kind::kBabble) transfer.status = -EOVERFLOW;
    if (answer.kind != UsbAnswer::Kind::kData) return;
    if (!in) {
      transfer.actual = transfer.length - static_cast<int>(offset);
      return;
    }
    std::string bytes = answer.bytes;
    transfer.actual = static_cast<int>(bytes.size());
    if (bytes.empty()) return;
    umockdev_ioctl_data_update(transfer.buffer, offset, reinterpret_cast<guint8*>(bytes.data()),
                               static_cast<gint>(bytes.size()));
  }

  bool reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    for (UsbTransfer& transfer : transfers_) {
      if (!transfer.done && gone_) {
        transfer.done = true;
        transfer.status = -ENODEV;
      }
      if (!transfer.done) advance(transfer);
    }
    const auto done = std::find_if(transfers_.begin(), transfers_.end(),
                                   [](const UsbTransfer& t) { return t.done; });
    if (done == transfers_.end()) {
      // libusb asks without a pause (its descriptor is always ready): leave the others some time
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      return complete(client, gone_ ? ENODEV : EAGAIN);
    }
    put(done->urb, offsetof(usbdevfs_urb, status), done->status);
    put(done->urb, offsetof(usbdevfs_urb, actual_length), done->actual);
    UMockdevIoctlData* place = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr);
    umockdev_ioctl_data_set_ptr(place, 0, done->urb);
    umockdev_ioctl_data_unref(place);
    complete(client, 0);
    drop(*done);
    transfers_.erase(done);
    return true;
  }

  bool discard(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    const gulong address = *reinterpret_cast<gulong*>(argument->data);
    for (UsbTransfer& transfer : transfers_) {
      if (transfer.urb->client_addr != address) continue;
      if (!transfer.done) {
        transfer.done = true;
        transfer.status = -ENOENT;
      }
      return complete(client, 0);
    }
    return complete(client, EINVAL);
  }

  EmulatedUsb& device_;
  UsbRefusals refusals_;
  std::mutex& lock_;
  std::list<UsbTransfer> transfers_;
  bool gone_ = false;
  int detached_ = 0;
};

struct UsbTestbed::Bed {
  UMockdevTestbed* testbed = umockdev_testbed_new();
  std::mutex& lock;
  std::list<UsbSocket> sockets;
  std::vector<UMockdevIoctlBase*> handlers;

  explicit Bed(std::mutex& shared) : lock(shared) {}
  Bed(const Bed&) = delete;
  Bed& operator=(const Bed&) = delete;
  ~Bed() {
    for (UMockdevIoctlBase* handler : handlers) g_object_unref(handler);
    g_object_unref(testbed);
  }
  UsbSocket& at(int address) { return *std::next(sockets.begin(), address - 2); }
};

UsbTestbed::UsbTestbed(std::mutex& lock) : bed_(std::make_unique<Bed>(lock)) {}
UsbTestbed::~UsbTestbed() = default;

int UsbTestbed::plug_in(EmulatedUsb& device, const UsbRefusals& refusals) {
  const int address = 2 + static_cast<int>(bed_->sockets.size());
  UsbSocket& socket = bed_->sockets.emplace_back(device, refusals, bed_->lock);
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  bed_->handlers.push_back(handler);
  g_signal_connect(handler, "handle-ioctl", G_CALLBACK(UsbSocket::call), &socket);
  const std::string file = fmt::format("/dev/bus/usb/001/{:03}", address);
  GError* error = nullptr;
  if (umockdev_testbed_attach_ioctl(bed_->testbed, file.c_str(), handler, &error) == FALSE) {
    throw std::runtime_error(error->message);
  }
  const std::string text = fmt::format(
      "P: /devices/usb1/1-{0}\nN: bus/usb/001/{1:03}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\n"
      "E: BUSNUM=001\nE: DEVNUM={1:03}\nE: DEVNAME=/dev/bus/usb/001/{1:03}\n"
      "E: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum={1}\\n\n"
      "A: speed=480\\n\nH: descriptors={2}\n",
      address - 1, address, hex(device.descriptors()));
  if (umockdev_testbed_add_from_string(bed_->testbed, text.c_str(), &error) == FALSE) {
    throw std::runtime_error(error->message);
  }
  namespace fs = std::filesystem;
  gchar* root_text = umockdev_testbed_get_root_dir(bed_->testbed);
  const fs::path root = root_text;
  g_free(root_text);
  using fs::perms;
  // Other users, too, put a socket for events there, and reach the sockets of the devices.
  fs::permissions(root, perms::all);
  for (const auto& entry : fs::recursive_directory_iterator(root / "ioctl")) {
    fs::permissions(entry.path(), perms::all);
  }
  fs::permissions(root / file.substr(1), refusals.open ? perms::none : perms::all);
  return address;
}

void UsbTestbed::unplug(int address) {
  {
    const std::lock_guard guard(bed_->lock);
    bed_->at(address).unplug();
  }
  umockdev_testbed_uevent(bed_->testbed, fmt::format("/sys/devices/usb1/1-{}", address - 1).c_str(),
                          "remove");
}

int UsbTestbed::detached(int address) const {
  const std::lock_guard guard(bed_->lock);
  return bed_->at(address).detached();
}

}  // namespace rondure::testing
