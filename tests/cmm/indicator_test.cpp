#include <deque>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmm/indicators/ascii_probe.h"
#include "cmm/indicators/displacement_probe.h"
#include "cmm/indicators/mitutoyo_itn.h"
#include "tests/wire/memory_usb.h"

namespace rondure::cmm {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

TEST(Digimatic, ReadsTheMessageOfTheProtocol) {
  EXPECT_DOUBLE_EQ(digimatic_reading("01A+0000.123").value_or(9.0), 0.123);
  EXPECT_DOUBLE_EQ(digimatic_reading("01A-0012.3456").value_or(9.0), 9.0);  // a digit too many
  EXPECT_DOUBLE_EQ(digimatic_reading("01A-012.3456").value_or(9.0), -12.3456);
  EXPECT_DOUBLE_EQ(digimatic_reading("01A+00000000").value_or(9.0), 0.0);
  EXPECT_DOUBLE_EQ(digimatic_reading("01A-99999.99").value_or(9.0), -99999.99);
}

TEST(Digimatic, RefusesWhatIsNoReading) {
  EXPECT_THAT(digimatic_reading("911").error().what, HasSubstr("no gauge is connected"));
  for (const char* bad : {"", "0", "01A", "01A+0000.12", "01A 0000.123", "02A+0000.123",
                          "01B+0000.123", "01A+00-0.123", "01A+0.00.123", "01A+........",
                          "01A+1e000000", "1USB-ITN", "01A+0000,123"}) {
    EXPECT_FALSE(digimatic_reading(bad)) << bad;
  }
}

wire::MemoryUsbState cable() {
  wire::MemoryUsbState out;
  out.info.vendor = 0x0fe7;
  out.info.product = 0x4001;
  out.info.serial = "0042";
  out.interfaces = {{0, 3, 0, 0, {{0x81, wire::UsbEndpoint::Kind::kInterrupt, 8}}}};
  return out;
}

/// Time passes when it is looked at.
class LookedAtClock final : public wire::Clock {
 public:
  Time now() const override { return now_ += milliseconds(10); }
  void sleep_for(milliseconds time) override { now_ += time; }

 private:
  mutable Time now_ = {};
};

TEST(MitutoyoItn, LeavesTheKeyboardModeAndAsksForAReading) {
  wire::MemoryUsbState state = cable();
  state.reply_to_command = "01A+0000.123\r";  // comes in packets of 8
  const auto probe = open_mitutoyo_itn(std::make_unique<wire::MemoryUsb>(state));
  ASSERT_TRUE(probe) << probe.error().what;
  ASSERT_EQ(state.requests.size(), 2U);
  EXPECT_EQ(state.resets, 1);
  EXPECT_EQ(state.requests[0].request_type, 0x40);
  EXPECT_EQ(state.requests[0].request, 0x01);
  EXPECT_EQ(state.requests[0].value, 0xa5a5);
  EXPECT_EQ(state.requests[1].request_type, 0xc0);
  EXPECT_EQ(state.requests[1].request, 0x02);
  EXPECT_DOUBLE_EQ((*probe)->read_mm().value_or(9.0), 0.123);
  EXPECT_EQ(state.requests[2].request, 0x03);
  EXPECT_EQ(state.control_data.back(), "1\r");
  EXPECT_THAT((*probe)->description(), HasSubstr("0042"));
}

TEST(MitutoyoItn, ThrowsAwayAReadingOfTheButton) {
  wire::MemoryUsbState state = cable();
  state.reply_to_command = "01A+0002.000\r";
  const auto probe = open_mitutoyo_itn(std::make_unique<wire::MemoryUsb>(state));
  ASSERT_TRUE(probe);
  state.packets = {"01A+0001", ".000\r", "01A+0001", ".500\r"};
  EXPECT_DOUBLE_EQ((*probe)->read_mm().value_or(9.0), 2.0);
}

TEST(MitutoyoItn, ReadsInchesWhereTheGaugeShowsThem) {
  wire::MemoryUsbState state = cable();
  state.reply_to_command = "01A-000.5000\r";
  const auto probe = open_mitutoyo_itn(std::make_unique<wire::MemoryUsb>(state), {kInch_mm, 0.001});
  ASSERT_TRUE(probe);
  EXPECT_DOUBLE_EQ((*probe)->read_mm().value_or(9.0), -12.7);
}

TEST(MitutoyoItn, SaysWhatIsWrong) {
  for (const auto& [reply, text] : {std::pair{"911\r", "no gauge is connected"},
                                    {"01A+00", "no reading within"},
                                    {"nonsense\r", "is no reading"}}) {
    wire::MemoryUsbState state = cable();
    state.reply_to_command = reply;
    LookedAtClock clock;
    const auto probe = open_mitutoyo_itn(std::make_unique<wire::MemoryUsb>(state), {}, &clock);
    ASSERT_TRUE(probe);
    const auto reading = (*probe)->read_mm();
    ASSERT_FALSE(reading);
    EXPECT_EQ(reading.error().code, core::Code::kMachine);
    EXPECT_THAT(reading.error().what, HasSubstr(text));
  }
  wire::MemoryUsbState gone = cable();
  const auto probe = open_mitutoyo_itn(std::make_unique<wire::MemoryUsb>(gone));
  gone.gone = true;
  EXPECT_THAT((*probe)->read_mm().error().what, HasSubstr("unplugged"));
  wire::MemoryUsbState keyboard = cable();
  keyboard.busy = true;
  EXPECT_THAT(open_mitutoyo_itn(std::make_unique<wire::MemoryUsb>(keyboard)).error().what,
              HasSubstr("in use"));
}

/// Time passes only when somebody waits.
class BenchClock final : public wire::Clock {
 public:
  Time now() const override { return now_; }
  void sleep_for(milliseconds time) override { now_ += time; }

 private:
  Time now_ = Time{} + std::chrono::hours(1);
};

/// What an instrument on a serial line does.
struct Instrument {
  std::string answer;  ///< To every request.
  bool echoes = false;
  milliseconds delay{20};
  std::size_t piece = 100;  ///< Bytes that come at once.
  std::string asked;
  std::deque<std::pair<wire::Clock::Time, std::string>> out;
};

class InstrumentLine final : public wire::ByteStream {
 public:
  InstrumentLine(Instrument& instrument, BenchClock& clock)
      : instrument_(instrument), clock_(clock) {}
  core::Result<void> write(std::string_view bytes) override {
    instrument_.asked += bytes;
    std::string all = instrument_.echoes ? std::string(bytes) : std::string();
    all += instrument_.answer;
    for (std::size_t at = 0; at < all.size(); at += instrument_.piece) {
      instrument_.out.emplace_back(clock_.now() + instrument_.delay,
                                   all.substr(at, instrument_.piece));
    }
    return {};
  }
  core::Result<std::string> read_some(milliseconds limit) override {
    const auto end = clock_.now() + limit;
    if (instrument_.out.empty() || instrument_.out.front().first > end) {
      clock_.sleep_for(limit);
      return std::string();
    }
    const auto wait = instrument_.out.front().first - clock_.now();
    if (wait > milliseconds(0)) clock_.sleep_for(std::chrono::ceil<milliseconds>(wait));
    std::string bytes = instrument_.out.front().second;
    instrument_.out.pop_front();
    return bytes;
  }
  void close() override {}
  bool is_open() const override { return true; }
  std::string peer() const override { return "/dev/bench"; }

 private:
  Instrument& instrument_;
  BenchClock& clock_;
};

struct Bench {
  explicit Bench(const char* kind, std::string answer) : settings(*ascii_probe_settings(kind)) {
    instrument.answer = std::move(answer);
    probe =
        *open_ascii_probe(std::make_unique<InstrumentLine>(instrument, clock), settings, &clock);
  }
  BenchClock clock;
  Instrument instrument;
  AsciiProbeSettings settings;
  std::unique_ptr<DisplacementProbe> probe;
};

TEST(AsciiProbe, ReadsEachKnownInstrument) {
  for (const auto& [kind, answer, value_mm, request] :
       {std::tuple{"sylvac", "+012.345\r", 12.345, "?\r"},
        {"sylvac", "-0.001\r", -0.001, "?\r"},
        {"tesa", " 1.25\r\n", 1.25, "?\r"},
        {"mahr", "1 +000.125 mm\r", 0.125, "M1?\r"},
        {"mahr", "1 -125.0 um\r", -0.125, "M1?\r"},
        {"mahr", "1 +0.5 in\r", 12.7, "M1?\r"},
        {"qm-height", "01A+0123.456\r", 123.456, "1\r"}}) {
    SCOPED_TRACE(answer);
    Bench bench(kind, answer);
    EXPECT_NEAR(bench.probe->read_mm().value_or(99.0), value_mm, 1e-12);
    EXPECT_EQ(bench.instrument.asked, request);
  }
  EXPECT_FALSE(ascii_probe_settings("unknown"));
  EXPECT_EQ(ascii_probe_names(), "sylvac, tesa, mahr, qm-height");
  EXPECT_EQ(ascii_probe_settings("sylvac")->line.data_bits, 7);
}

TEST(AsciiProbe, PassesOverItsEchoAndTakesAReplyInPieces) {
  Bench bench("sylvac", "+1.000\r");
  bench.instrument.echoes = true;
  bench.instrument.piece = 2;
  for (int i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(bench.probe->read_mm().value_or(9.0), 1.0);
}

TEST(AsciiProbe, NeverTakesALateAnswerForTheNextReading) {
  Bench bench("sylvac", "+1.000\r");
  bench.instrument.delay = milliseconds(1500);
  EXPECT_THAT(bench.probe->read_mm().error().what, HasSubstr("no reading within 1000 ms"));
  bench.instrument.delay = milliseconds(20);
  bench.instrument.answer = "+2.000\r";
  EXPECT_DOUBLE_EQ(bench.probe->read_mm().value_or(9.0), 2.0);
}

TEST(AsciiProbe, SaysWhatTheInstrumentSaid) {
  Bench error("sylvac", "ERR3\r");
  EXPECT_THAT(error.probe->read_mm().error().what, HasSubstr("\"ERR3\", an error of"));
  Bench noise("sylvac", "\x80\x11zz\r");
  EXPECT_THAT(noise.probe->read_mm().error().what, HasSubstr("is no reading"));
  Bench flood("sylvac", std::string(5000, '1'));
  EXPECT_THAT(flood.probe->read_mm().error().what, HasSubstr("no reading within"));
  Bench other("mahr", "2 +1.000 mm\r");
  EXPECT_FALSE(other.probe->read_mm());
}

TEST(AsciiProbe, RefusesAPatternThatCannotGiveANumber) {
  Instrument instrument;
  BenchClock clock;
  for (const char* pattern : {"(", "[0-9]+"}) {
    AsciiProbeSettings settings = *ascii_probe_settings("tesa");
    settings.reply = pattern;
    const auto probe =
        open_ascii_probe(std::make_unique<InstrumentLine>(instrument, clock), settings, &clock);
    ASSERT_FALSE(probe);
    EXPECT_EQ(probe.error().code, core::Code::kBadOption);
  }
}

TEST(DisplacementProbe, IsRefusedForTrackingWithTheReason) {
  const core::Error error = refuse_tracking({0.001, 0.05}, 100.0, 3);
  EXPECT_EQ(error.code, core::Code::kBadOption);
  EXPECT_THAT(error.what, HasSubstr("take 0.15 s for a round"));
  EXPECT_THAT(error.what, HasSubstr("100 Hz has 0.01 s"));
}

}  // namespace
}  // namespace rondure::cmm
