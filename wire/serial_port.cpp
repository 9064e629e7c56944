#include "wire/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "wire/internal/device_holders.h"

namespace rondure::wire {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kSerialChunk_bytes = 4096;

std::optional<speed_t> speed_of(int baud) {
  constexpr std::array<std::pair<int, speed_t>, 9> kSpeeds = {{{1200, B1200},
                                                               {2400, B2400},
                                                               {4800, B4800},
                                                               {9600, B9600},
                                                               {19'200, B19200},
                                                               {38'400, B38400},
                                                               {57'600, B57600},
                                                               {115'200, B115200},
                                                               {230'400, B230400}}};
  for (const auto& [known, speed] : kSpeeds) {
    if (known == baud) return speed;
  }
  return std::nullopt;
}

termios with_settings(termios line, const SerialSettings& settings, speed_t speed) {
  cfmakeraw(&line);
  line.c_cflag &= ~static_cast<tcflag_t>(CSIZE | PARENB | PARODD | CSTOPB | CRTSCTS);
  line.c_cflag |= static_cast<tcflag_t>(CLOCAL | CREAD);
  line.c_cflag |= static_cast<tcflag_t>(settings.data_bits == 7 ? CS7 : CS8);
  if (settings.parity != SerialSettings::Parity::kNone) line.c_cflag |= PARENB;
  if (settings.parity == SerialSettings::Parity::kOdd) line.c_cflag |= PARODD;
  if (settings.stop_bits == 2) line.c_cflag |= CSTOPB;
  line.c_cc[VMIN] = 0;
  line.c_cc[VTIME] = 0;
  cfsetispeed(&line, speed);
  cfsetospeed(&line, speed);
  return line;
}

/// The settings that a device supports. A pseudo-terminal has no wire: it carries whole bytes, and
/// the C library reports 7 data bits or parity there as refused.
SerialSettings on(const fs::path& device, SerialSettings settings) {
  if (device.string().starts_with("/dev/pts/")) {
    settings.data_bits = 8;
    settings.parity = SerialSettings::Parity::kNone;
  }
  return settings;
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() { close(); }

  [[nodiscard]] int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

class SerialPort final : public ByteStream {
 public:
  SerialPort(Descriptor file, std::string name, milliseconds write_limit)
      : file_(std::move(file)), name_(std::move(name)), write_limit_(write_limit) {}
  ~SerialPort() override { close(); }

  [[nodiscard]] core::Result<void> write(std::string_view bytes) override {
    if (!open_) return core::fail(failure_);
    const auto deadline = SteadyClock::now() + write_limit_;
    while (!bytes.empty()) {
      const auto sent = ::write(file_.number(), bytes.data(), bytes.size());
      if (sent > 0) {
        bytes.remove_prefix(static_cast<std::size_t>(sent));
        continue;
      }
      if (sent < 0 && errno != EAGAIN && errno != EINTR) return lose(broken());
      TRY_DO(wait(POLLOUT, left_until(deadline)));
      if (!bytes.empty() && SteadyClock::now() >= deadline) {
        return lose(
            fmt::format("{} takes no data for {} ms; check the cable and the supply of the "
                        "device",
                        name_, write_limit_.count()));
      }
    }
    return {};
  }

  [[nodiscard]] core::Result<std::string> read_some(milliseconds time_limit) override {
    if (!open_) return core::fail(failure_);
    TRY(const auto ready, wait(POLLIN, time_limit));
    if (!ready) return std::string{};
    std::string bytes(kSerialChunk_bytes, '\0');
    const auto count = ::read(file_.number(), bytes.data(), bytes.size());
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return std::string{};
    if (count < 0) return lose(broken());
    if (count == 0) return lose(unplugged());  // readable without data: the line was hung up
    bytes.resize(static_cast<std::size_t>(count));
    return bytes;
  }

  void close() override {
    if (!open_) return;
    open_ = false;
    failure_ = {core::Code::kMachine, fmt::format("the connection to {} is closed", name_), {}};
    file_.close();
  }

  [[nodiscard]] bool is_open() const override { return open_; }
  [[nodiscard]] std::string peer() const override { return name_; }

 private:
  static milliseconds left_until(SteadyClock::time_point deadline) {
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - SteadyClock::now());
    return std::max(milliseconds(0), left + milliseconds(1));
  }
  [[nodiscard]] std::string unplugged() const {
    return fmt::format("{} was unplugged; plug it in and check the cable and its supply", name_);
  }
  [[nodiscard]] std::string broken() const {
    if (errno == EIO || errno == ENXIO || errno == ENODEV) return unplugged();
    return fmt::format("the connection to {} broke: {}", name_, std::strerror(errno));
  }

  /// Waits until bytes can be read or written; false at the time limit.
  core::Result<bool> wait(short event, milliseconds limit) {
    pollfd one = {file_.number(), event, 0};
    const int count = ::poll(&one, 1, static_cast<int>(limit.count()));
    if (count < 0 && errno == EINTR) return false;
    if (count < 0) return lose(broken());
    if ((one.revents & event) == 0 && (one.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
      return lose(unplugged());
    }
    return count > 0;
  }

  tl::unexpected<core::Error> lose(std::string what) {
    close();
    failure_ = {core::Code::kMachine, std::move(what), {}};
    return core::fail(failure_);
  }

  Descriptor file_;
  std::string name_;
  milliseconds write_limit_;
  bool open_ = true;
  core::Error failure_;
};

/// The first line of a small file; "" when it cannot be read.
std::string line_of(const fs::path& file) {
  std::string out;
  std::getline(std::ifstream(file) >> std::ws, out);
  return out;
}

std::uint16_t id_of(const fs::path& file) {
  const std::string text = line_of(file);
  std::uint16_t out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out, 16);
  return out;
}

/// The USB device of a serial device, in /sys; "" when it has none.
fs::path plug_of(const fs::path& tty) {
  std::error_code none;
  fs::path place = fs::canonical(tty / "device", none);
  for (; !none && place.has_relative_path(); place = place.parent_path()) {
    if (fs::exists(place / "idVendor", none)) return place;
  }
  return {};
}

}  // namespace

std::string why_not_opened(const fs::path& device, int error) {
  const std::string name = device.string();
  if (error == EACCES || error == EPERM) {
    return fmt::format(
        "this user may not open {}; install the udev rules wire/60-rondure.rules, or "
        "join the group of the device: sudo usermod -aG dialout \"$USER\", then log "
        "in again",
        name);
  }
  if (error == EBUSY || error == EWOULDBLOCK) {
    const std::string who = device_holders(device);
    return fmt::format("{} is in use by {}; end it and start again", name,
                       who.empty() ? "another program" : who);
  }
  if (error == ENOENT || error == ENXIO || error == ENODEV) {
    return fmt::format("there is no {}; plug the device in, or correct the path", name);
  }
  return fmt::format("{} cannot be opened: {}", name, std::strerror(error));
}

core::Result<std::unique_ptr<ByteStream>> open_serial(const fs::path& device,
                                                      const SerialSettings& settings) {
  const auto speed = speed_of(settings.baud);
  if (!speed) {
    return core::fail_with(core::Code::kBadOption,
                           "{} baud is no usual speed of a serial line: 1200..230400",
                           settings.baud);
  }
  Descriptor file(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (file.number() < 0) return core::machine_fault(why_not_opened(device, errno));
  // Two locks: the first keeps out programs that request it too, the second all others except
  // root's.
  if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0)
    return core::machine_fault(why_not_opened(device, errno));
  termios line = {};
  if (::tcgetattr(file.number(), &line) != 0) {
    return core::machine_fault("{} is no serial device", device.string());
  }
  (void)::ioctl(file.number(), TIOCEXCL);
  const termios wanted = with_settings(line, on(device, settings), *speed);
  if (::tcsetattr(file.number(), TCSANOW, &wanted) != 0) {
    return core::machine_fault("{} refuses {} baud, {} data bits: {}", device.string(),
                               settings.baud, settings.data_bits, std::strerror(errno));
  }
  (void)::tcflush(file.number(), TCIOFLUSH);
  return std::make_unique<SerialPort>(std::move(file), device.string(), settings.write_limit);
}

std::vector<SerialPortInfo> list_serial_ports() {
  std::vector<SerialPortInfo> out;
  std::error_code none;
  for (fs::directory_iterator entry("/sys/class/tty", none), end; !none && entry != end;
       entry.increment(none)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with("ttyUSB") && !name.starts_with("ttyACM")) continue;
    SerialPortInfo port;
    port.device = "/dev/" + name;
    const fs::path plug = plug_of(entry->path());
    if (!plug.empty()) {
      port.vendor = id_of(plug / "idVendor");
      port.product = id_of(plug / "idProduct");
      port.product_name = line_of(plug / "product");
      port.serial = line_of(plug / "serial");
    }
    std::error_code unbound;
    port.kernel_driver =
        fs::read_symlink(entry->path() / "device" / "driver", unbound).filename().string();
    if (::access(port.device.c_str(), R_OK | W_OK) != 0) {
      port.refused = why_not_opened(port.device, errno);
    }
    port.held_by = device_holders(port.device);
    out.push_back(std::move(port));
  }
  std::sort(out.begin(), out.end(),
            [](const SerialPortInfo& a, const SerialPortInfo& b) { return a.device < b.device; });
  return out;
}

}  // namespace rondure::wire
