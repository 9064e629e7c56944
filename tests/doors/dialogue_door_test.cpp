// Damaged lines, frames and packets of machines, fixtures and indicators, and requests that end too
// early.

#include <deque>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cmm/indicators/ascii_probe.h"
#include "cmm/indicators/mitutoyo_itn.h"
#include "cmm/ipp/grammar.h"
#include "cmm/ipp/numbers.h"
#include "core/encodings.h"
#include "fixture/thorlabs_messages.h"
#include "fixture/thorlabs_unit.h"
#include "fixture/zaber_grammar.h"
#include "fixture/zaber_link.h"
#include "tests/doors/exact.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/ipp_entries.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/wrong_text.h"
#include "tests/wire/memory_usb.h"
#include "wire/byte_lines.h"
#include "wire/usb_stream.h"

namespace rondure::doors {
namespace {

using std::chrono::milliseconds;

/// Time passes when somebody looks at it or waits.
class QuickClock final : public wire::Clock {
 public:
  [[nodiscard]] Time now() const override { return now_ += milliseconds(1); }
  void sleep_for(milliseconds time) override { now_ += time; }

 private:
  mutable Time now_ = Time{} + std::chrono::hours(1);
};

/// A device that sends some bytes after every write, in pieces of any size, then is silent.
class Babbler final : public wire::ByteStream {
 public:
  Babbler(QuickClock& clock, std::function<std::string()> answer, unsigned seed)
      : clock_(clock), answer_(std::move(answer)), random_(seed) {}

  [[nodiscard]] core::Result<void> write(std::string_view /*bytes*/) override {
    if (writes_++ > 200) return core::machine_fault("the device was unplugged");
    out_ += answer_();
    return {};
  }
  [[nodiscard]] core::Result<std::string> read_some(milliseconds limit) override {
    if (out_.empty() || random_() % 8 == 0) clock_.sleep_for(limit);
    const std::size_t count = std::min<std::size_t>(out_.size(), 1 + random_() % 40);
    std::string piece = out_.substr(0, count);
    out_.erase(0, count);
    return piece;
  }
  void close() override {}
  [[nodiscard]] bool is_open() const override { return true; }
  [[nodiscard]] std::string peer() const override { return "the test"; }

 private:
  QuickClock& clock_;
  std::function<std::string()> answer_;
  std::mt19937 random_;
  std::string out_;
  int writes_ = 0;
};

/// Lines of the recorded dialogue without the side that said them.
std::vector<std::string> recorded_lines() {
  std::ifstream file(RONDURE_SOURCE_DIR "/tests/data/ipp_dme_dialogue/dialogue.txt");
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("C: ") || line.starts_with("S: ")) out.push_back(line.substr(3));
  }
  return out;
}

TEST(IppDoor, StandsLinesThatEndTooEarly) {
  const auto lines = recorded_lines();
  ASSERT_GT(lines.size(), 50U);
  for (const std::string& line : lines) {
    for (std::size_t size = 0; size <= line.size(); ++size) {
      for (const std::string_view half : half_words()) {
        const Exact exact(line.substr(0, size).append(half));
        ASSERT_EQ(fuzz::try_ipp_grammar(exact.view()), "") << exact.view();
      }
    }
  }
}

TEST(IppDoor, StandsNumbersThatEndTooEarly) {
  for (const std::string_view number : {"-123.456e-12", "+0.5E+300", ".5", "1e", "1e999", "--1"}) {
    for (std::size_t first = 0; first <= number.size(); ++first) {
      for (std::size_t size = 0; first + size <= number.size(); ++size) {
        const Exact exact(number.substr(first, size));
        const auto value = cmm::ipp::read_number(exact.view());
        EXPECT_TRUE(!value || std::isfinite(*value)) << exact.view();
      }
    }
  }
}

TEST(IppDoor, StandsDialoguesThatEndTooEarly) {
  std::string text = "\x01";
  for (const std::string& line : recorded_lines()) {
    if (text.size() < 1500) text += line + "\r\n";
  }
  for (const std::size_t size : cuts_of(text.size(), 100)) {
    const Exact exact(std::string_view(text).substr(0, size));
    ASSERT_EQ(fuzz::try_ipp_server(exact.view()), "") << size;
  }
}

fixture::AptMessage apt_data(fixture::AptId id, std::size_t size) {
  fixture::AptMessage out;
  out.id = static_cast<std::uint16_t>(id);
  out.destination = fixture::kAptHost;
  out.source = fixture::kAptUnit;
  out.data = std::string(size, '\0');
  return out;
}

/// What a unit says of itself, of its speed and of its motions.
std::vector<std::string> apt_answers() {
  using fixture::AptId;
  auto info = apt_data(AptId::kHwGetInfo, 84);
  info.data.replace(0, 12, std::string("\x70\x88\x9e\x03KDC101\0\0", 12));
  auto velocity = apt_data(AptId::kGetVelocity, 14);
  auto status = apt_data(AptId::kGetDcStatus, 14);
  status.data[11] = '\x04';  // homed
  auto moved = status;
  moved.id = static_cast<std::uint16_t>(AptId::kMoveCompleted);
  auto homed = apt_data(AptId::kMoveHomed, 0);
  std::vector<std::string> out;
  for (const auto& message : {info, velocity, status, moved, homed}) {
    out.push_back(fixture::encode(message));
  }
  return out;
}

TEST(ThorlabsDoor, StandsDamagedFrames) {
  const fuzz::Mutation mutation(apt_answers(), {"\x81\x50", "\x01\x50", std::string(90, '\xff'),
                                                std::string(3, '\0'), "\x06\x00"});
  fuzz::try_cases({20'000}, [&](unsigned seed) -> std::string {
    QuickClock clock;
    unsigned number = seed;
    const auto answers = apt_answers();
    // A third of the answers is damaged, so that a unit is used beyond its first answer.
    const auto answer = [&] {
      number += 7919;
      std::string all;
      for (const std::string& good : answers) {
        all += number % 3 == 0 ? mutation.input(number) : good;
        number += 13;
      }
      return all;
    };
    fixture::ThorlabsAxis axis;
    axis.stage = fixture::thorlabs_stage("PRM1-Z8").value();
    axis.direction = seed % 2 == 0 ? 1 : -1;
    axis.speed_rad_s = 0.1;
    axis.acceleration_rad_s2 = 0.1;
    axis.tolerance_rad = 1e-3;
    fixture::ThorlabsUnit unit("alpha", std::make_unique<Babbler>(clock, answer, seed), axis, {},
                               clock);
    const auto started = unit.start();
    if (!started) return fuzz::wrong_with_refusal(started.error());
    for (const bool home : {true, false}) {
      const auto begun = home ? unit.begin_homing() : unit.begin_move(0.2);
      if (!begun) return fuzz::wrong_with_refusal(begun.error());
      for (int looks = 0; looks < 20; ++looks) {
        const auto ended = unit.look();
        if (!ended) return fuzz::wrong_with_refusal(ended.error());
        if (*ended) break;
      }
    }
    unit.stop();
    return fuzz::wrong_with_text(core::printable(unit.description()));
  });
}

TEST(ThorlabsDoor, StandsMessagesOfAnyLength) {
  for (unsigned id : {0x0006U, 0x0415U, 0x0464U, 0x0466U, 0x0481U, 0x0491U}) {
    for (std::size_t size = 0; size < 100; ++size) {
      fixture::AptMessage message = apt_data(static_cast<fixture::AptId>(id), size);
      message.data.shrink_to_fit();
      (void)fixture::apt_info(message);
      (void)fixture::apt_status(message);
      (void)fixture::apt_velocity_of(message);
      fixture::AptFramer framer;
      const std::string bytes = fixture::encode(message);
      for (std::size_t at = 0; at < bytes.size(); at += 5) {
        const Exact piece(std::string_view(bytes).substr(at, 5));
        framer.take(piece.view(), {});
        (void)framer.next();
      }
    }
  }
}

const std::vector<std::string>& zaber_lines() {
  static const std::vector<std::string> lines = {
      "@01 0 00 OK IDLE -- 0",        "@01 1 00 OK BUSY WR 384012 -5",
      "@01 0 00 RJ IDLE -- BADDATA",  "@01 0 00 OK IDLE -- 1\\",
      "#01 0 00 cont 2 more",         "!01 1 IDLE FS",
      "@01 0 00 OK IDLE NC 121007:8D"};
  return lines;
}

std::string wrong_with_zaber_line(std::string_view line) {
  const Exact exact(line);
  const auto message = fixture::parse_zaber(exact.view());
  if (!message) return fuzz::wrong_with_refusal(message.error());
  const Exact data(message->data);
  if (const auto values = fixture::zaber_values(data.view()); !values) {
    if (auto wrong = fuzz::wrong_with_refusal(values.error()); !wrong.empty()) return wrong;
  }
  (void)fixture::is_zaber_fault(Exact(message->warning).view());
  (void)fixture::lacks_zaber_reference(Exact(message->warning).view());
  return fuzz::wrong_with_text(
      core::printable(fixture::zaber_meaning(Exact(message->warning).view())));
}

TEST(ZaberDoor, StandsDamagedLines) {
  const fuzz::Mutation mutation(
      zaber_lines(), {"\n", "\r\n", ":", ":8D", "\\", "cont", "AGAIN", "99999999999999999999", "FF",
                      "@", "#", "!", " ", "\xff", std::string(5000, 'x')});
  fuzz::try_cases({20'000}, [&](unsigned seed) -> std::string {
    if (auto wrong = wrong_with_zaber_line(mutation.input(seed)); !wrong.empty()) return wrong;
    QuickClock clock;
    unsigned number = seed;
    const auto answer = [&] {
      return mutation.input(++number) + "\r\n" + zaber_lines()[0] + "\r\n";
    };
    auto lines = wire::lines_over(std::make_unique<Babbler>(clock, answer, seed),
                                  {.max_line_bytes = 4096, .clock = &clock});
    fixture::ZaberLink link(std::move(lines), {.clock = &clock});
    if (seed % 5 == 0) link.require_checksums();
    for (int i = 0; i < 4; ++i) {
      const auto reply = link.ask(1, i % 2, "get pos");
      if (!reply) return fuzz::wrong_with_refusal(reply.error());
    }
    return {};
  });
}

TEST(ZaberDoor, StandsLinesThatEndTooEarly) {
  for (const std::string& line : zaber_lines()) {
    for (std::size_t size = 0; size <= line.size(); ++size) {
      for (const std::string_view half : half_words()) {
        const std::string cut = line.substr(0, size).append(half);
        ASSERT_EQ(wrong_with_zaber_line(cut), "") << cut;
      }
    }
  }
}

TEST(UsbDoor, StandsTransfersOfAnyLength) {
  for (std::size_t size = 0; size < 140; ++size) {
    const Exact transfer(std::string(size, '\x01'));
    for (const std::size_t packet : {3U, 8U, 64U}) {
      EXPECT_LE(wire::without_ftdi_status(transfer.view(), packet).size(), size);
    }
  }
}

TEST(UsbDoor, StandsDevicesThatDescribeAndSayAnything) {
  using Kind = wire::UsbEndpoint::Kind;
  fuzz::try_cases({20'000}, [](unsigned seed) -> std::string {
    std::mt19937 random(seed);
    wire::MemoryUsbState state;
    state.info.vendor = 0x0403;
    for (unsigned i = random() % 4; i > 0; --i) {
      wire::UsbInterface interface;
      interface.number = static_cast<int>(random() % 4);
      interface.device_class = random() % 2 == 0 ? 0x02 : 0x0a;
      interface.subclass = 0x02;
      for (unsigned k = random() % 4; k > 0; --k) {
        interface.endpoints.push_back({static_cast<std::uint8_t>(random()),
                                       random() % 4 == 0 ? Kind::kInterrupt : Kind::kBulk,
                                       random() % 2 == 0 ? 64 : random() % 4});
      }
      state.interfaces.push_back(interface);
    }
    for (int i = 0; i < 30; ++i) state.packets.emplace_back(random() % 70, '\x31');
    QuickClock clock;
    auto device = std::make_unique<wire::MemoryUsb>(state);
    if (seed % 3 == 0) {
      const auto probe = cmm::open_mitutoyo_itn(std::move(device), {}, &clock);
      if (!probe) return fuzz::wrong_with_refusal(probe.error());
      const auto reading = (*probe)->read_mm();
      return reading ? "" : fuzz::wrong_with_refusal(reading.error());
    }
    auto stream = seed % 3 == 1 ? wire::open_ftdi(std::move(device), &clock)
                                : wire::open_cdc_acm(std::move(device));
    if (!stream) return fuzz::wrong_with_refusal(stream.error());
    const auto lines =
        wire::lines_over(*std::move(stream), {.max_line_bytes = 99, .clock = &clock});
    for (int i = 0; i < 8; ++i) {
      const auto line = lines->read_line(milliseconds(5));
      if (!line) return fuzz::wrong_with_refusal(line.error());
      if (auto wrong = fuzz::wrong_with_text(core::printable(lines->unfinished()));
          !wrong.empty()) {
        return wrong;
      }
    }
    return {};
  });
}

TEST(IndicatorDoor, StandsDamagedReadings) {
  const std::vector<std::string> good = {"+012.345\r", " 1.25\r\n", "1 -125.0 um\r",
                                         "01A+0123.456\r", "911\r"};
  const fuzz::Mutation mutation(good, {"\r", "\n", "mm", "in", "1e400", "-", ".", "\xff",
                                       std::string(300, '0'), std::string(1, '\0')});
  fuzz::try_cases({20'000}, [&](unsigned seed) -> std::string {
    const std::string text = mutation.input(seed);
    const Exact exact(text);
    const auto reading = cmm::digimatic_reading(exact.view());
    if (!reading) {
      if (auto wrong = fuzz::wrong_with_refusal(reading.error()); !wrong.empty()) return wrong;
    } else if (!std::isfinite(*reading)) {
      return "a reading that is no number";
    }
    for (const char* kind : {"sylvac", "mahr", "qm-height"}) {
      QuickClock clock;
      const auto probe =
          cmm::open_ascii_probe(std::make_unique<Babbler>(
                                    clock, [&] { return text + good[seed % 4]; }, seed),
                                *cmm::ascii_probe_settings(kind), &clock);
      if (!probe) return fuzz::wrong_with_refusal(probe.error());
      const auto value = (*probe)->read_mm();
      if (!value) {
        if (auto wrong = fuzz::wrong_with_refusal(value.error()); !wrong.empty()) return wrong;
      } else if (!std::isfinite(*value)) {
        return "a reading that is no number";
      }
    }
    return {};
  });
}

}  // namespace
}  // namespace rondure::doors
