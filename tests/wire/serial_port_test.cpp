#include "wire/serial_port.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wire/byte_lines.h"

namespace rondure::wire {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr milliseconds kSerialPatience(60'000);

/// The other end of a serial device: a pseudo-terminal.
class FarEnd {
 public:
  FarEnd() : master_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    std::array<char, 128> name = {};
    EXPECT_TRUE(::grantpt(master_) == 0 && ::unlockpt(master_) == 0 &&
                ::ptsname_r(master_, name.data(), name.size()) == 0);
    path_ = name.data();
  }
  ~FarEnd() { unplug(); }
  FarEnd(const FarEnd&) = delete;
  FarEnd& operator=(const FarEnd&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  void say(const std::string& bytes) const {
    EXPECT_EQ(::write(master_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  [[nodiscard]] std::string hear(std::size_t count) const {
    std::string out;
    while (out.size() < count) {
      std::array<char, 256> bytes = {};
      const auto came = ::read(master_, bytes.data(), bytes.size());
      if (came <= 0) break;
      out.append(bytes.data(), static_cast<std::size_t>(came));
    }
    return out;
  }
  void unplug() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }

 private:
  int master_;
  std::string path_;
};

TEST(SerialPort, CarriesBytesAsTheyAre) {
  FarEnd far;
  const auto port = open_serial(far.path());
  ASSERT_TRUE(port) << port.error().what;
  std::string all;
  for (int c = 0; c < 256; ++c) all += static_cast<char>(c);  // nothing is echoed or translated
  ASSERT_TRUE((*port)->write(all));
  EXPECT_EQ(far.hear(256), all);
  far.say(all);
  std::string came;
  while (came.size() < 256) {
    const auto more = (*port)->read_some(kSerialPatience);
    ASSERT_TRUE(more && !more->empty());
    came += *more;
  }
  EXPECT_EQ(came, all);
  EXPECT_EQ((*port)->read_some(milliseconds(10)).value_or("?"), "");
  EXPECT_EQ((*port)->peer(), far.path());
}

TEST(SerialPort, SetsItsLine) {
  FarEnd far;
  SerialSettings settings;
  settings.baud = 4800;
  settings.data_bits = 7;
  settings.parity = SerialSettings::Parity::kEven;
  settings.stop_bits = 2;
  const auto port = open_serial(far.path(), settings);
  ASSERT_TRUE(port) << port.error().what;
  const int watch = ::open(far.path().c_str(), O_RDWR | O_NOCTTY);
  if (watch < 0) GTEST_SKIP() << "the device is locked against this user";
  termios line = {};
  ASSERT_EQ(::tcgetattr(watch, &line), 0);
  ::close(watch);
  EXPECT_EQ(cfgetospeed(&line), static_cast<speed_t>(B4800));
  EXPECT_NE(line.c_cflag & CSTOPB, 0U);
  EXPECT_EQ(line.c_lflag & (ICANON | ECHO), 0U);
}

TEST(SerialPort, BelongsToOneAndSaysWhoHasIt) {
  FarEnd far;
  const auto first = open_serial(far.path());
  ASSERT_TRUE(first);
  const auto second = open_serial(far.path());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, core::Code::kMachine);
  EXPECT_THAT(second.error().what, HasSubstr("is in use by wire_tests (process "));
  (*first)->close();
  EXPECT_TRUE(open_serial(far.path()));
}

TEST(SerialPort, TellsThatItWasUnplugged) {
  FarEnd far;
  const auto port = open_serial(far.path());
  ASSERT_TRUE(port);
  far.unplug();
  const auto gone = (*port)->read_some(kSerialPatience);
  ASSERT_FALSE(gone);
  EXPECT_THAT(gone.error().what, HasSubstr("was unplugged"));
  EXPECT_FALSE((*port)->is_open());
  EXPECT_EQ((*port)->write("x").error(), gone.error());
}

TEST(SerialPort, RefusesWhatIsNone) {
  EXPECT_THAT(open_serial("/dev/ttyNOTHERE7").error().what, HasSubstr("there is no /dev/ttyNOT"));
  EXPECT_THAT(open_serial("/dev/null").error().what, HasSubstr("no serial device"));
  FarEnd far;
  SerialSettings odd;
  odd.baud = 115'000;
  EXPECT_EQ(open_serial(far.path(), odd).error().code, core::Code::kBadOption);
}

TEST(ByteLines, PutsALineTogetherFromItsPieces) {
  FarEnd far;
  auto port = open_serial(far.path());
  ASSERT_TRUE(port);
  const auto lines = lines_over(*std::move(port));
  far.say("@01 1 OK ");
  EXPECT_FALSE(*lines->read_line(milliseconds(20)));
  EXPECT_EQ(lines->unfinished(), "@01 1 OK ");
  far.say("IDLE -- 0\r\nnext\n");
  EXPECT_EQ((*lines->read_line(kSerialPatience))->text, "@01 1 OK IDLE -- 0");
  const auto next = *lines->read_line(kSerialPatience);
  EXPECT_EQ(next->text, "next");
  EXPECT_FALSE(next->crlf);
  ASSERT_TRUE(lines->write_line("/1 1"));
  EXPECT_EQ(far.hear(6), "/1 1\r\n");
}

TEST(ByteLines, EndsAtALineWithoutEnd) {
  FarEnd far;
  auto port = open_serial(far.path());
  ASSERT_TRUE(port);
  const auto lines = lines_over(*std::move(port), {.max_line_bytes = 64, .clock = nullptr});
  far.say(std::string(200, 'x'));
  const auto wild = lines->read_line(kSerialPatience);
  ASSERT_FALSE(wild);
  EXPECT_THAT(wild.error().what, HasSubstr("more than 64 bytes"));
  EXPECT_FALSE(lines->is_open());
}

}  // namespace
}  // namespace rondure::wire
