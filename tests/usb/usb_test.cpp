#include "wire/usb.h"

#include <unistd.h>

#include <deque>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/usb/usb_testbed.h"
#include "wire/usb_stream.h"

namespace rondure::wire {
namespace {

using rondure::testing::DescribedInterface;
using rondure::testing::EmulatedUsb;
using rondure::testing::UsbAnswer;
using rondure::testing::UsbTestbed;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = UsbFault::Kind;

constexpr milliseconds kPatience(2000);
constexpr milliseconds kShort(50);

/// Sends back what it is sent, in upper case, and answers control requests as it is told.
class Parrot final : public EmulatedUsb {
 public:
  explicit Parrot(std::string serial = "P-1") : serial_(std::move(serial)) {}

  std::string descriptors() const override {
    const auto bulk = UsbEndpoint::Kind::kBulk;
    return rondure::testing::usb_descriptors(
        0x2939, 0x49c2,
        {DescribedInterface{0x02, 0x02, 0x01, {{0x83, UsbEndpoint::Kind::kInterrupt, 8}}},
         DescribedInterface{0x0a, 0x00, 0x00, {{0x81, bulk, 64}, {0x02, bulk, 64}}}});
  }
  std::string string(int index) const override {
    return index == 1 ? "Maker" : index == 2 ? "Parrot" : serial_;
  }
  UsbAnswer control(const UsbSetup& setup, std::string_view bytes, std::size_t) override {
    requests.push_back(setup);
    data.emplace_back(bytes);
    return setup.request == 0x77 ? UsbAnswer::stall() : UsbAnswer::data("abc");
  }
  UsbAnswer out(std::uint8_t, std::string_view bytes) override {
    for (const char c : bytes) said += static_cast<char>(std::toupper(c));
    return deaf ? UsbAnswer::wait() : UsbAnswer::data("");
  }
  UsbAnswer in(std::uint8_t, std::size_t most) override {
    if (babbles) return UsbAnswer::babble();
    if (said.empty()) return UsbAnswer::wait();
    const std::string part = said.substr(0, std::min(most, packet));
    said.erase(0, part.size());
    return UsbAnswer::data(part);
  }

  std::vector<UsbSetup> requests;
  std::vector<std::string> data;
  std::string said;
  std::size_t packet = 64;
  bool deaf = false;
  bool babbles = false;

 private:
  std::string serial_;
};

const UsbSelector kParrot = {0x2939, {0x49c2}, "", "parrot"};

TEST(UsbDevices, AreListedWithTheirStrings) {
  Parrot parrot("4711");
  std::mutex lock;
  UsbTestbed bed(lock);
  bed.plug_in(parrot);
  const auto found = list_usb_devices();
  ASSERT_TRUE(found) << found.error().what;
  ASSERT_EQ(found->size(), 1U);
  EXPECT_EQ(found->front().vendor, 0x2939);
  EXPECT_EQ(found->front().product, 0x49c2);
  EXPECT_EQ(found->front().product_name, "Parrot");
  EXPECT_EQ(found->front().serial, "4711");
  EXPECT_FALSE(found->front().refused);
  EXPECT_EQ(found->front().place(), "2939:49c2 at bus 1, address 2");
}

TEST(UsbDevices, AreChosenByTheirSerialNumber) {
  Parrot one("A1");
  Parrot two("B2");
  std::mutex lock;
  UsbTestbed bed(lock);
  bed.plug_in(one);
  bed.plug_in(two);
  const auto any = open_usb(kParrot);
  ASSERT_FALSE(any);
  EXPECT_EQ(any.error().kind, Kind::kAmbiguous);
  EXPECT_THAT(any.error().what, HasSubstr("A1, B2"));
  UsbSelector second = kParrot;
  second.serial = "B2";
  const auto chosen = open_usb(second);
  ASSERT_TRUE(chosen) << chosen.error().what;
  EXPECT_EQ((*chosen)->info().address, 3);
  second.serial = "C3";
  const auto none = open_usb(second);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, Kind::kNotFound);
  EXPECT_THAT(none.error().what, AllOf(HasSubstr("C3"), HasSubstr("A1, B2")));
}

TEST(UsbDevice, CarriesControlAndBulkTransfers) {
  Parrot parrot;
  std::mutex lock;
  UsbTestbed bed(lock);
  bed.plug_in(parrot);
  const auto device = open_usb(kParrot);
  ASSERT_TRUE(device) << device.error().what;
  ASSERT_EQ((*device)->interfaces().size(), 2U);
  EXPECT_EQ((*device)->interfaces()[1].endpoints[0].address, 0x81);
  EXPECT_EQ((*device)->interfaces()[1].endpoints[0].packet_bytes, 64U);
  ASSERT_TRUE((*device)->configure(1));
  ASSERT_TRUE((*device)->claim(1));
  ASSERT_TRUE((*device)->control_out({0x40, 0x09, 0x0102, 0x0304}, "xy", kPatience));
  EXPECT_EQ(parrot.data.back(), "xy");
  EXPECT_EQ(parrot.requests.back().value, 0x0102);
  EXPECT_EQ(parrot.requests.back().index, 0x0304);
  EXPECT_EQ((*device)->control_in({0xc0, 0x02, 0, 0}, 8, kPatience).value_or(""), "abc");
  ASSERT_TRUE((*device)->bulk_out(0x02, "hello", kPatience));
  EXPECT_EQ((*device)->bulk_in(0x81, 64, kPatience).value_or(""), "HELLO");
  EXPECT_EQ((*device)->bulk_in(0x81, 64, kShort).value_or("?"), "");
}

TEST(UsbDevice, NamesEachFaultOfTheBus) {
  Parrot parrot;
  std::mutex lock;
  UsbTestbed bed(lock);
  const int address = bed.plug_in(parrot);
  const auto device = open_usb(kParrot);
  ASSERT_TRUE(device && (*device)->claim(1));
  EXPECT_EQ((*device)->control_in({0xc0, 0x77, 0, 0}, 8, kPatience).error().kind, Kind::kStall);
  EXPECT_EQ((*device)->claim(7).error().kind, Kind::kOther);
  parrot.deaf = true;
  EXPECT_EQ((*device)->bulk_out(0x02, "hello", kShort).error().kind, Kind::kTimeout);
  parrot.babbles = true;
  EXPECT_EQ((*device)->bulk_in(0x81, 64, kPatience).error().kind, Kind::kBabble);
  bed.unplug(address);
  const auto gone = (*device)->bulk_in(0x81, 64, kPatience);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().kind, Kind::kUnplugged);
  EXPECT_THAT(gone.error().what, HasSubstr("unplugged"));
  EXPECT_EQ(gone.error().error().code, core::Code::kMachine);
}

TEST(UsbDevice, SaysWhoHasIt) {
  Parrot parrot;
  std::mutex lock;
  UsbTestbed bed(lock);
  bed.plug_in(parrot, {.open = false, .claim = true, .kernel_driver = ""});
  const auto device = open_usb(kParrot);
  ASSERT_TRUE(device) << device.error().what;
  const auto claimed = (*device)->claim(1);
  ASSERT_FALSE(claimed);
  EXPECT_EQ(claimed.error().kind, Kind::kBusy);
  EXPECT_THAT(claimed.error().what, HasSubstr("is in use by"));
}

TEST(UsbDevice, TakesItsInterfaceFromAKernelDriver) {
  Parrot parrot;
  std::mutex lock;
  UsbTestbed bed(lock);
  const int address = bed.plug_in(parrot, {.open = false, .claim = false, .kernel_driver = "x"});
  const auto device = open_usb(kParrot);
  ASSERT_TRUE(device && (*device)->claim(1));
  EXPECT_EQ(bed.detached(address), 1);
}

TEST(UsbDevice, NamesTheRulesToInstallWhenItMayNotBeOpened) {
  Parrot parrot;
  std::mutex lock;
  UsbTestbed bed(lock);
  bed.plug_in(parrot, {.open = true, .claim = false, .kernel_driver = ""});
  constexpr uid_t kNobody = 65534;
  const uid_t me = ::geteuid();
  if (me == 0) {
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  const auto device = open_usb(kParrot);
  const auto listed = list_usb_devices();
  if (me == 0) {
    ASSERT_EQ(::seteuid(me), 0);
  }
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, Kind::kPermission);
  EXPECT_THAT(device.error().what, HasSubstr("60-rondure.rules"));
  ASSERT_TRUE(listed && listed->size() == 1);
  ASSERT_TRUE(listed->front().refused);
  EXPECT_EQ(listed->front().refused->kind, Kind::kPermission);
}

TEST(CdcAcm, SetsTheLineAndCarriesBytes) {
  Parrot parrot;
  std::mutex lock;
  UsbTestbed bed(lock);
  const int address = bed.plug_in(parrot);
  auto device = open_usb(kParrot);
  ASSERT_TRUE(device);
  const auto stream = open_cdc_acm(*std::move(device));
  ASSERT_TRUE(stream) << stream.error().what;
  ASSERT_EQ(parrot.requests.size(), 2U);
  EXPECT_EQ(parrot.requests[0].request_type, 0x21);
  EXPECT_EQ(parrot.requests[0].request, 0x20);
  EXPECT_EQ(parrot.data[0], std::string("\x00\xc2\x01\x00\x00\x00\x08", 7));  // 115200 8N1
  EXPECT_EQ(parrot.requests[1].request, 0x22);
  EXPECT_EQ(parrot.requests[1].value, 3);
  parrot.packet = 3;
  ASSERT_TRUE((*stream)->write("/1 home\r\n"));
  std::string came;
  while (came.size() < 9) came += (*stream)->read_some(kPatience).value_or("timeout");
  EXPECT_EQ(came, "/1 HOME\r\n");
  EXPECT_EQ((*stream)->read_some(kShort).value_or("?"), "");
  bed.unplug(address);
  const auto gone = (*stream)->read_some(kPatience);
  ASSERT_FALSE(gone);
  EXPECT_THAT(gone.error().what, HasSubstr("unplugged"));
  EXPECT_FALSE((*stream)->is_open());
}

}  // namespace
}  // namespace rondure::wire
