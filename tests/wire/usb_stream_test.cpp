#include "wire/usb_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "memory_usb.h"

namespace rondure::wire {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Time passes only when somebody waits.
class QuickClock final : public Clock {
 public:
  Time now() const override {
    now_ += milliseconds(1);
    return now_;
  }
  void sleep_for(milliseconds time) override { now_ += time; }

 private:
  mutable Time now_ = {};
};

MemoryUsbState bridge() {
  const auto bulk = UsbEndpoint::Kind::kBulk;
  MemoryUsbState out;
  out.info.vendor = 0x0403;
  out.info.product = 0xfaf0;
  out.interfaces = {{0, 0xff, 0xff, 0xff, {{0x81, bulk, 64}, {0x02, bulk, 64}}}};
  return out;
}

std::string packet(std::string_view data) { return "\x01\x60" + std::string(data); }

TEST(FtdiStream, StripsTheStatusOfEveryPacketNotOfEveryTransfer) {
  EXPECT_EQ(without_ftdi_status("", 64), "");
  EXPECT_EQ(without_ftdi_status("\x01", 64), "");
  EXPECT_EQ(without_ftdi_status("\x01\x60", 64), "");
  EXPECT_EQ(without_ftdi_status("\x01\x60"
                                "abc",
                                64),
            "abc");
  const std::string full(62, 'x');
  EXPECT_EQ(without_ftdi_status(packet(full) + packet("y"), 64), full + "y");
  EXPECT_EQ(without_ftdi_status(packet(full) + packet(full) + packet(""), 64), full + full);
  EXPECT_EQ(without_ftdi_status(packet(std::string(510, 'z')) + packet("y"), 512),
            std::string(510, 'z') + "y");
}

TEST(FtdiStream, OpensTheLineInTheOrderOfThePractice) {
  MemoryUsbState state = bridge();
  QuickClock clock;
  const auto stream = open_ftdi(std::make_unique<MemoryUsb>(state), &clock);
  ASSERT_TRUE(stream) << stream.error().what;
  std::vector<std::string> said;
  for (const UsbSetup& r : state.requests) {
    EXPECT_EQ(r.request_type, 0x40);
    said.push_back(std::to_string(r.request) + " " + std::to_string(r.value) + " " +
                   std::to_string(r.index));
  }
  EXPECT_THAT(said, ElementsAre("0 0 0", "3 26 0", "4 8 0", "9 16 0", "1 514 0", "0 1 0", "0 2 0",
                                "2 0 256", "1 257 0"));
}

TEST(FtdiStream, CarriesBytesAndPassesOverIdlePackets) {
  MemoryUsbState state = bridge();
  QuickClock clock;
  const auto stream = open_ftdi(std::make_unique<MemoryUsb>(state), &clock);
  ASSERT_TRUE(stream);
  ASSERT_TRUE((*stream)->write("hello"));
  EXPECT_EQ(state.sent, "hello");
  state.packets = {packet(""), packet(""), packet("abc"), packet(""), packet("de")};
  EXPECT_EQ((*stream)->read_some(milliseconds(100)).value_or("?"), "abc");
  EXPECT_EQ((*stream)->read_some(milliseconds(100)).value_or("?"), "de");
  EXPECT_EQ((*stream)->read_some(milliseconds(100)).value_or("?"), "");
  state.packets.assign(1000, packet(""));  // idle packets do not hold a time limit up
  EXPECT_EQ((*stream)->read_some(milliseconds(50)).value_or("?"), "");
  EXPECT_GT(state.packets.size(), 900U);
}

TEST(FtdiStream, SaysWhenItIsBusyRefusedOrGone) {
  QuickClock clock;
  MemoryUsbState busy = bridge();
  busy.busy = true;
  EXPECT_THAT(open_ftdi(std::make_unique<MemoryUsb>(busy), &clock).error().what,
              HasSubstr("in use"));
  for (int request = 0; request < 9; ++request) {
    MemoryUsbState refusing = bridge();
    refusing.stalls_at_request = request;
    EXPECT_THAT(open_ftdi(std::make_unique<MemoryUsb>(refusing), &clock).error().what,
                HasSubstr("refused"));
    EXPECT_EQ(refusing.closes, 1);
  }
  MemoryUsbState bare = bridge();
  bare.interfaces[0].endpoints.pop_back();
  EXPECT_THAT(open_ftdi(std::make_unique<MemoryUsb>(bare), &clock).error().what,
              HasSubstr("no serial line"));
  MemoryUsbState state = bridge();
  const auto stream = open_ftdi(std::make_unique<MemoryUsb>(state), &clock);
  ASSERT_TRUE(stream);
  state.gone = true;
  EXPECT_THAT((*stream)->read_some(milliseconds(1)).error().what, HasSubstr("unplugged"));
  EXPECT_FALSE((*stream)->is_open());
  EXPECT_THAT((*stream)->write("x").error().what, HasSubstr("unplugged"));
}

}  // namespace
}  // namespace rondure::wire
