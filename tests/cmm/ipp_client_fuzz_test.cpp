// Answers of a server, bent in every way: the client ends each time, with a value or an error.
// RONDURE_FULL: a million answers; under the address sanitizer, RONDURE_FULL=1 and the asan preset.

#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "cmm/ipp_client/client.h"
#include "cmm/ipp_client/dialogue.h"
#include "core/units.h"
#include "tests/cmm/scripted_server.h"

namespace rondure::cmm {
namespace {

using Lines = std::vector<std::string>;

int inputs() { return std::getenv("RONDURE_FULL") != nullptr ? 1'000'000 : 20'000; }

/// What servers say, of every kind.
const Lines& seeds() {
  static const Lines kSeeds = {
      "00001 &",
      "00001 %",
      "00001 # X(1.5), Y(-2), Z(3e2), ER(2), Part.Temperature(20.5), Time(1)",
      "00001 # ER(3.0), IJK(0,0,1), X(27.25), Y(0.5), Z(10.0)",
      "00001 # (0, 0.6, 0.8), (0, 0.8, -0.6)",
      "00001 # 118.5,0.0001,-3.0002,0, 118.4992,0.1614,-3.0002,0",
      "00001 # Tool.Name(\"Probe1\")",
      "00001 # GetMachineClass(CartCMMWithRotaryTable)",
      "00001 # ErrStatus(0)",
      "00001 ! Error(2, 1006, \"00001 PtMeas\", \"Surface not found\")",
      "00001 ! Error(1, 504, SetProp, \"Argument out of range\")",
      "00001 ! Error(9, 0503, \"\", \"Controller communications failure\")",
      "E0000 ! Error(3, 0500, \"\", \"Emergency stop\")",
      "E0000 # KeyPress(\"F1\")",
      "E0001 &",
      "E0001 %",
      "99999 # X(1)",
  };
  return kSeeds;
}

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) { return random_() % n; }
  const std::string& any() { return seeds()[below(seeds().size())]; }

  std::string bent(std::string line) {
    for (std::size_t i = 1 + below(3); i > 0; --i) bend(line);
    return line;
  }

 private:
  void bend(std::string& line) {
    static constexpr std::string_view kOdd = " #&%!(),.\"E+-0123456789XYZ\t\r\x01\x80\xff";
    const std::size_t at = line.empty() ? 0 : below(line.size());
    switch (below(7)) {
      case 0:
        if (!line.empty()) line[at] = kOdd[below(kOdd.size())];
        break;
      case 1:
        line.insert(at, 1, kOdd[below(kOdd.size())]);
        break;
      case 2:
        line.erase(at, 1 + below(4));
        break;
      case 3:
        line.insert(at, line.substr(below(line.size() + 1), below(20)));
        break;
      case 4:
        line.insert(at, std::string(1 + below(200), kOdd[below(kOdd.size())]));
        break;
      case 5:
        line = line.substr(0, at) + any();
        break;
      default:
        line.resize(at);
    }
  }

  std::mt19937_64 random_;
};

/// Reads a reply in all the ways there are.
void read_everything(const ipp::client::Reply& reply) {
  (void)ipp::client::find_point(reply);
  (void)ipp::client::scan_points(reply);
  (void)ipp::client::find_number(reply, "ER");
  (void)ipp::client::find_value(reply, "Tool.Name");
}

TEST(IppClientFuzz, ASessionEndsWhateverIsAnswered) {
  Mutator mutator(1);
  int values = 0;
  int errors = 0;
  for (int i = 0; i < inputs(); ++i) {
    Lines answer = {"00001 &"};
    for (std::size_t k = mutator.below(5); k > 0; --k) answer.push_back(mutator.any());
    answer.push_back("00001 %");
    std::string& bent = answer[mutator.below(answer.size())];
    bent = mutator.bent(bent);
    auto line = std::make_unique<ScriptedServer>(
        [&](const std::string&, const std::string&) { return answer; });
    line->hang_up();
    ipp::client::Session session(std::move(line), {std::chrono::milliseconds(1000), true});
    const auto reply = session.call("PtMeas", {}, std::chrono::milliseconds(1000));
    if (reply) read_everything(*reply);
    ++(reply ? values : errors);
    (void)session.take_unsolicited();
  }
  EXPECT_GT(values, inputs() / 20);
  EXPECT_GT(errors, inputs() / 20);
}

/// A machine whose answers are bent from some line on.
TEST(IppClientFuzz, AMachineEndsWhateverIsAnswered) {
  const int sessions = inputs() / 100;
  int opened = 0;
  int touched = 0;
  for (int i = 0; i < sessions; ++i) {
    SCOPED_TRACE(i);
    Mutator mutator(static_cast<std::uint64_t>(i));
    std::size_t until_bent = mutator.below(120);
    const auto answer = [&](const std::string& tag, const std::string& method) -> Lines {
      Lines out = {tag + " &"};
      if (method.starts_with("GetDMEVersion")) out.push_back(tag + " # DMEVersion(\"1.4\")");
      if (method.starts_with("GetErr")) out.push_back(tag + " # ErrStatus(0)");
      if (method.starts_with("IsHomed")) out.push_back(tag + " # IsHomed(1)");
      if (method.starts_with("EnumTools")) out.push_back(tag + " # \"T1\"");
      if (method.starts_with("GetProp(Tool.Name")) out.push_back(tag + " # Tool.Name(\"T1\")");
      if (method.starts_with("Get(")) out.push_back(tag + " # X(30), Y(0), Z(10)");
      if (method.starts_with("PtMeas")) out.push_back(tag + " # X(27), Y(0), Z(10), ER(2)");
      if (method.starts_with("Scan")) out.push_back(tag + " # 23,0,10,0,23,10,-23,0,10,0,-23,10");
      if (method.starts_with("AlignPart")) out.push_back(tag + " # (0,0,1), (0,1,0)");
      out.push_back(tag + " %");
      for (std::string& line : out) {
        if (until_bent-- == 0) line = mutator.bent(line);
      }
      return out;
    };
    IppMachineOptions options;
    options.answer_limit = options.motion_limit = std::chrono::milliseconds(2);
    options.park_W_mm = {30.0, 0.0, 10.0};
    options.speeds.touch_mm_s = 1e9;  // what does not end is given up at once
    const auto machine = IppMachine::open(
        [&]() -> core::Result<std::unique_ptr<wire::LineTransport>> {
          return std::make_unique<ScriptedServer>(answer);
        },
        options);
    if (!machine) continue;
    ++opened;
    (void)(*machine)->home();
    (void)(*machine)->move_to({30.0, 0.0, 10.0});
    const TouchCommand touch = {1, {27.0, 0.0, 10.0}, -Eigen::Vector3d::UnitX(), 3.0, 3.0};
    if ((*machine)->touch(touch)) ++touched;
    ScanCircleCommand scan;
    scan.center_W_mm = {0.0, 0.0, 10.0};
    scan.start_tip_W_mm = {27.0, 0.0, 10.0};
    scan.sweep_rad = core::kTwoPi;
    scan.points = 4;
    (void)(*machine)->scan_circle(scan);
    (void)(*machine)->align_part({});
    (void)(*machine)->status();
    (void)(*machine)->recover();
  }
  EXPECT_GT(opened, sessions / 10);
  EXPECT_GT(touched, sessions / 20);
  EXPECT_LT(touched, sessions);
}

}  // namespace
}  // namespace rondure::cmm
