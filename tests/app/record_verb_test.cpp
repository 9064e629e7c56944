// rondure record and rondure devices, with instruments on pseudo-terminals.

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/on_terminal.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A Sylvac indicator: answers every "?" with the next of its readings, 1 um farther each time.
class Sylvac {
 public:
  explicit Sylvac(double first_mm) : reading_mm_(first_mm) {
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
    name_ = ::ptsname(master_);
    held_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY);  // the line stays up between two programs
    termios raw = {};
    ::tcgetattr(held_, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(held_, TCSANOW, &raw);
    thread_ = std::thread([this] { answer(); });
  }
  ~Sylvac() {
    over_ = true;
    thread_.join();
    ::close(held_);
    ::close(master_);
  }
  Sylvac(const Sylvac&) = delete;
  Sylvac& operator=(const Sylvac&) = delete;

  [[nodiscard]] std::string word() const { return "sylvac:" + name_; }

 private:
  void answer() {
    while (!over_) {
      pollfd ready = {master_, POLLIN, 0};
      char c = 0;
      if (::poll(&ready, 1, 50) != 1 || ::read(master_, &c, 1) != 1 || c != '?') continue;
      char text[32];
      const int length = std::snprintf(text, sizeof text, "%+08.3f\r", reading_mm_);
      reading_mm_ += 0.001;
      (void)!::write(master_, text, static_cast<std::size_t>(length));
    }
  }

  int master_ = -1;
  int held_ = -1;
  std::string name_;
  double reading_mm_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

std::string rows_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with('#')) out += line + "\n";
  }
  return out;
}

struct Recording {
  Scratch folder;
  Sylvac one{0.5};
  Sylvac two{-1.25};
  std::string file = (folder / "shaft.csv").string();

  [[nodiscard]] std::vector<std::string> words(const std::string& step = "120") const {
    return {"record", "--probe", one.word(), "--probe", two.word(), "--step-deg",
            step,     "--count", "3",        "--out",   file};
  }
};

TEST(Record, ReadsTheIndicatorsAtEveryAngleThatIsConfirmed) {
  Recording recording;
  OnTerminal program(recording.words());
  for (const char* angle :
       {"1 of 3: turn the part to 0 deg", "turn the part to 120 deg", "turn the part to 240 deg"}) {
    ASSERT_TRUE(program.wait_for(angle)) << program.shown();
    ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
    program.type("\n");
  }
  EXPECT_EQ(program.finish(), 0) << program.shown();
  EXPECT_EQ(rows_of(recording.file),
            "alpha_deg,H1_um,H2_um\n0,500,-1250\n120,501,-1249\n240,502,-1248\n");
}

TEST(Record, GoesOnBehindTheLastRowOfAnInterruptedRecording) {
  Recording recording;
  {
    OnTerminal program(recording.words());
    ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
    program.type("\n");
    ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
    program.type("q\n");
    EXPECT_EQ(program.finish(), 3) << program.shown();
    EXPECT_THAT(program.shown(), HasSubstr("goes on behind it"));
  }
  EXPECT_EQ(rows_of(recording.file), "alpha_deg,H1_um,H2_um\n0,500,-1250\n");
  OnTerminal other_angles(recording.words("90"));
  ASSERT_TRUE(other_angles.wait_for("2 of 3: turn the part to 90 deg")) << other_angles.shown();
  other_angles.type("q\n");  // the first angle is the same: it may go on with other steps
  EXPECT_EQ(other_angles.finish(), 3);
  OnTerminal program(recording.words());
  ASSERT_TRUE(program.wait_for("2 of 3: turn the part to 120 deg")) << program.shown();
  program.type("\n");
  ASSERT_TRUE(program.wait_for("3 of 3")) << program.shown();
  program.type("\n");
  EXPECT_EQ(program.finish(), 0) << program.shown();
  EXPECT_EQ(rows_of(recording.file),
            "alpha_deg,H1_um,H2_um\n0,500,-1250\n120,501,-1249\n240,502,-1248\n");
  OnTerminal refused(recording.words("90"));
  EXPECT_EQ(refused.finish(), 2);
  EXPECT_THAT(refused.shown(), HasSubstr("row 2 is at 120 deg"));
}

TEST(Record, RefusesTrackingUnknownIndicatorsAndNobodyAtTheTerminal) {
  auto words = Recording().words();
  words.insert(words.end(), {"--rate-hz", "50"});
  const Outcome tracking = rondure(words);
  EXPECT_EQ(tracking.status, 2);
  EXPECT_THAT(tracking.err, AllOf(HasSubstr("take 0.1 s for a round"), HasSubstr("Stop the part")));
  if (::isatty(STDIN_FILENO) != 1) {
    const Outcome alone = rondure(Recording().words());
    EXPECT_EQ(alone.status, 2);
    EXPECT_THAT(alone.err, HasSubstr("standard input is no terminal"));
  }
  Scratch folder;
  const std::string file = (folder / "x.csv").string();
  OnTerminal unknown({"record", "--probe", "vernier:/dev/ttyUSB0", "--out", file});
  EXPECT_EQ(unknown.finish(), 2);
  EXPECT_THAT(unknown.shown(), HasSubstr("is no indicator"));
  OnTerminal missing({"record", "--probe", "mahr:/dev/rondure-no-such-line", "--out", file});
  EXPECT_EQ(missing.finish(), 3);
  EXPECT_THAT(missing.shown(), HasSubstr("there is no /dev/rondure-no-such-line"));
}

TEST(Devices, AreNoErrorWhenThereAreNone) {
  const Outcome text = rondure({"devices"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_FALSE(text.out.empty());
  const Outcome as_json = rondure({"devices", "--json"});
  EXPECT_EQ(as_json.status, 0);
  EXPECT_THAT(as_json.out, HasSubstr("\"devices\": ["));
}

}  // namespace
}  // namespace rondure::app::testing
