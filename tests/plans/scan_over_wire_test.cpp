// Scans over I++ DME: a run over the wire has the bits of the run in one process, and a machine
// that cannot scan is not moved.

#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmm/ipp_server/server.h"
#include "core/units.h"
#include "evaluation/evaluate.h"
#include "fit/references/min_zone.h"
#include "plans/cell/internal/open_cell.h"
#include "plans/cell/served_cell.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"
#include "tests/core/full.h"
#include "tests/plans/files.h"
#include "tests/plans/turned_part.h"
#include "tests/record/sample_run.h"
#include "wire/tcp_line.h"

namespace rondure::plans {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::uint64_t kSeed = 20261121;

/// The virtual cell of a plan behind a socket, for one client after the other.
class WireServer {
 public:
  /// @param late  Points it leaves out at the start of each scan.
  explicit WireServer(const Plan& plan, std::size_t late = 0, const cmm::ipp::Profile& profile = {})
      : cell_(plan, kSeed),
        server_(cell_, with_profile(server_options(plan), profile)),
        late_(late),
        listener_(wire::TcpListener::open("127.0.0.1", 0).value()),
        thread_([this] { serve(); }) {}
  ~WireServer() {
    stop_ = true;
    thread_.join();
  }

  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }
  /// What happens to a line before it is sent: told the command that it answers.
  using Spoil = std::function<void(const std::string& command, std::string& line)>;
  /// Before the client comes.
  void spoil(Spoil spoil) { spoil_ = std::move(spoil); }
  /// Moves, turns, touches and scans that were asked for.
  [[nodiscard]] int motions() const { return motions_; }

 private:
  static cmm::ipp::ServerOptions with_profile(cmm::ipp::ServerOptions options,
                                              const cmm::ipp::Profile& profile) {
    options.controller.profile = profile;
    return options;
  }

  void serve() {
    while (!stop_) {
      auto client = listener_.accept(std::chrono::milliseconds(20));
      if (!client || !*client) continue;
      while (!stop_ && (*client)->is_open()) {
        const auto line = (*client)->read_line(std::chrono::milliseconds(20));
        if (line && *line) answer((*line)->text, **client);
      }
    }
  }

  void answer(const std::string& text, wire::LineTransport& client) {
    for (const std::string_view motion : {" Home(", " GoTo(", " AlignPart(", " PtMeas(", " Scan"}) {
      if (text.find(motion) != std::string::npos) ++motions_;
    }
    server_.receive({text}, 0.0);
    std::size_t left_out = text.find(" ScanOnCircle(") == std::string::npos ? 0 : 3 * late_;
    for (std::string line : server_.take_output()) {
      if (spoil_) spoil_(text, line);
      for (const std::size_t data = line.find("# "); data == 6 && left_out > 0; --left_out) {
        line.erase(data + 2, line.find(',') + 1 - (data + 2));
      }
      (void)client.write_line(line);
    }
  }

  ServedCell cell_;
  cmm::ipp::Server server_;
  Spoil spoil_;
  std::size_t late_;
  wire::TcpListener listener_;
  std::atomic<bool> stop_ = false;
  std::atomic<int> motions_ = 0;
  std::thread thread_;
};

Plan shaft() {
  auto plan = read_plan(testing::example("08_shaft_scanned.json"));
  EXPECT_TRUE(plan) << testing::lines_of(plan);
  return std::move(plan).value();  // throws: the test fails, the others go on
}

Plan over_wire(Plan plan, std::uint16_t port) {
  plan.machine->driver = MachinePlan::Driver::kIppdme;
  plan.machine->host = "127.0.0.1";
  plan.machine->port = port;
  plan.machine->tool = "T1";
  plan.fixture->driver = FixturePlan::Driver::kIppdme;
  return plan;
}

RunOptions seeded_options(const std::filesystem::path& directory) {
  RunOptions options = testing::options_for(directory);
  options.seed = kSeed;
  return options;
}

record::RunRecord run_of(const Plan& plan, const std::filesystem::path& directory) {
  const auto run = run_plan(plan, seeded_options(directory));
  EXPECT_TRUE(run) << (run ? "" : run.error().what);
  if (run && run->failure) ADD_FAILURE() << run->failure->what;
  auto read = record::read_journal(directory);
  EXPECT_TRUE(read);
  return std::move(read).value().record;
}

/// A shaft of three lobes, 5 um, whose scans lie as those of real servers do: about the step that
/// was asked for, points missing, starts turned.
Plan three_lobes(int repeats, int points, double noise_um) {
  Plan plan = shaft();
  SimulationPlan& truth = *plan.simulation;
  truth = {};
  truth.part.lobes = {{3, 2.5, 40.0, 0.0}};
  truth.probe.repeatability_um = noise_um;
  truth.machine.scan_start_deg = 1.0;
  truth.machine.scan_step_percent = 3.0;
  truth.machine.scan_dropped_percent = 2.0;
  FeaturePlan& seat = plan.features.front();
  seat.sampling.points_per_layer = points;
  seat.pose_search.repeats = repeats;
  return plan;
}

/// CYLt of the same touches, the n-th points of all passes averaged.
double averaged_by_index_um(const record::RunRecord& run) {
  int last = -1;
  for (const record::PoseVisit& pose : run.poses) {
    if (pose.final_cloud) last = pose.id;
  }
  std::map<std::pair<int, int>, std::pair<Eigen::Vector3d, int>> sums;
  for (const record::Touch& touch : run.touches) {
    if (touch.pose != last || touch.purpose != record::Touch::Purpose::kMeasure) continue;
    auto [found, fresh] =
        sums.try_emplace({touch.layer, touch.point}, std::pair(Eigen::Vector3d::Zero().eval(), 0));
    found->second.first += touch.tip_mm;
    ++found->second.second;
  }
  std::vector<Eigen::Vector3d> means;
  for (const auto& [place, sum] : sums) means.emplace_back(sum.first / sum.second);
  const auto zone = fit::min_zone_cylinder(means, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(zone);
  return zone ? zone->width_mm() / core::kMicrometre : 0.0;
}

void expect_same(const record::RunRecord& run, const record::RunRecord& wanted) {
  ASSERT_EQ(run.touches.size(), wanted.touches.size());
  for (std::size_t i = 0; i < run.touches.size(); ++i) {
    const record::Touch& a = run.touches[i];
    const record::Touch& b = wanted.touches[i];
    ASSERT_EQ(a.tip_mm, b.tip_mm) << i << ": " << (a.tip_mm - b.tip_mm).transpose();
    ASSERT_EQ(a.approach, b.approach) << i;
    ASSERT_EQ(a.temperature_degC, b.temperature_degC) << i;
    ASSERT_EQ(a.scale_temperature_degC, b.scale_temperature_degC) << i;
    ASSERT_TRUE(a.layer == b.layer && a.point == b.point && a.pose == b.pose) << i;
  }
}

TEST(TurnedPartOverWire, HasTheBitsOfTheRunInOneProcess) {
  const Plan inside = testing::turned_part();
  const record::Scratch scratch;
  const auto wanted = run_of(inside, scratch / "inside");
  WireServer server(inside);
  const auto run = run_of(over_wire(inside, server.port()), scratch / "wire");
  EXPECT_GT(run.touches.size(), 60U);
  expect_same(run, wanted);
}

TEST(ScanOverWire, HasTheBitsOfTheRunInOneProcessAlsoWhenItIsResumed) {
  Plan inside = shaft();
  // The served machine is not switched off between two runs: what drifts would go on drifting.
  inside.simulation->machine.drift_x_um = 0.0;
  inside.simulation->machine.drift_y_um = 0.0;
  inside.simulation->machine.drift_z_um = 0.0;
  const record::Scratch scratch;
  const auto wanted = run_of(inside, scratch / "inside");
  ASSERT_EQ(wanted.touches.back().temperature_degC, 21.5);
  ASSERT_EQ(wanted.touches.back().scale_temperature_degC, 20.8);
  const WireServer server(inside);
  const Plan plan = over_wire(inside, server.port());
  expect_same(run_of(plan, scratch / "wire"), wanted);
  RunOptions options = seeded_options(scratch / "cut");
  options.before_move = [left = 2](const NextMove& move) mutable -> core::Result<void> {
    const bool scan = move.what.find("scan") != std::string::npos;
    if (!scan || left-- > 0) return {};
    return core::fail(core::Code::kStopped, "no");
  };
  {
    const auto stopped = run_plan(plan, options);
    ASSERT_TRUE(stopped && stopped->failure);
    ASSERT_EQ(stopped->failure->code, core::Code::kStopped) << stopped->failure->what;
  }
  const auto resumed = resume_plan(plan, seeded_options(scratch / "cut"));
  ASSERT_TRUE(resumed) << resumed.error().front().what;
  ASSERT_FALSE(resumed->failure) << resumed->failure->what;
  const auto record = record::read_journal(scratch / "cut");
  ASSERT_TRUE(record);
  expect_same(record->record, wanted);
}

TEST(ScanOverWire, IrregularPassesAreNotAveragedByIndex) {
  const record::Scratch scratch;
  for (const int points : {360, 48}) {
    for (const int repeats : {1, 5}) {
      SCOPED_TRACE(::testing::Message() << points << " points, " << repeats << " repeats");
      const Plan inside = three_lobes(repeats, points, 0.0);
      const WireServer server(inside);
      const auto run =
          run_of(over_wire(inside, server.port()), scratch / fmt::format("{}-{}", points, repeats));
      const auto evaluation = evaluation::evaluate(run);
      ASSERT_TRUE(evaluation);
      const evaluation::FeatureResult& seat = evaluation->features.front();
      ASSERT_TRUE(seat.mz_cylinder) << (seat.failure ? seat.failure->what : "");
      // 48 points miss the crests by at most 3.75 deg: 2.5 (1 - cos 11.25 deg) um each.
      const double zone_um = seat.mz_cylinder->width_mm() / core::kMicrometre;
      EXPECT_NEAR(zone_um, 5.0, 0.05);
      EXPECT_LT(seat.cloud.size(), 4U * static_cast<unsigned>(points * repeats));
      EXPECT_NE(seat.characteristics.front().value->operator_text().english().find(
                    repeats == 1 ? fmt::format("4 x {} points, scanned; r_tip", points)
                                 : "; 5 passes at places of their own, not averaged;"),
                std::string::npos)
          << seat.characteristics.front().value->operator_text();
      const double by_index_um = averaged_by_index_um(run);
      std::printf("%d points, %d repeats: CYLt %.3f um; by index %.3f um\n", points, repeats,
                  zone_um, by_index_um);
      EXPECT_TRUE(repeats == 1 || by_index_um > 5.5) << "what this is about";
    }
  }
}

TEST(ScanOverWire, TheIntervalOfIrregularPassesHoldsTheTruth) {
  const record::Scratch scratch;
  Plan inside = three_lobes(5, 120, 0.3);
  inside.uncertainty.emplace().most_trials = test::cases(2'000, 10'000);
  inside.uncertainty->probe.emplace();  // its repeatability comes from the passes
  const WireServer server(inside);
  const auto run = run_of(over_wire(inside, server.port()), scratch / "run");
  const auto evaluation = evaluation::evaluate(run);
  ASSERT_TRUE(evaluation);
  const evaluation::FeatureResult& seat = evaluation->features.front();
  ASSERT_TRUE(seat.repeat_sigma_mm);
  EXPECT_NEAR(*seat.repeat_sigma_mm / core::kMicrometre, 0.3, 0.02);
  EXPECT_GT(seat.repeat_freedom, 200);
  EXPECT_GT(seat.repeat_zone_mean_mm.value_or(0.0), 5.0 * core::kMicrometre);
  const auto& value = seat.characteristics.front().value;
  ASSERT_TRUE(value);
  const auto* said = value->uncertainty().about(evaluation::Measurand::kSampledPoints);
  ASSERT_NE(said, nullptr) << value->uncertainty().why();
  const evaluation::UncertaintyStatement& interval = *said;
  std::printf("noise 0.3 um, 5 passes: CYLt %.2f um, interval %.3f .. %.3f um\n",
              seat.mz_cylinder->width_mm() / core::kMicrometre, interval.low_mm / core::kMicrometre,
              interval.high_mm / core::kMicrometre);
  EXPECT_LT(interval.low_mm, 5.0 * core::kMicrometre);
  EXPECT_GT(interval.high_mm, 5.0 * core::kMicrometre);
}

/// In place of the numbers of a line of data, what a function makes of them.
void change_numbers(std::string& line, const std::function<void(std::vector<double>&)>& change) {
  const std::string head = line.substr(0, 8);  // "00001 # "
  std::vector<double> numbers;
  for (std::size_t at = 8; at < line.size();) {
    std::size_t used = 0;
    numbers.push_back(std::stod(line.substr(at), &used));
    at += used + 1;
  }
  change(numbers);
  line = head + fmt::format("{}", fmt::join(numbers, ","));
}

struct WrongAnswer {
  std::string command;  ///< Beginning of what it answers.
  int which = 1;        ///< Which of them, counted from 1.
  std::function<void(std::string&)> change;
  std::string says;
};

std::vector<WrongAnswer> wrong_answers() {
  const auto replace = [](std::string from, std::string to) {
    return [=](std::string& line) {
      const auto at = line.find(from);
      if (at != std::string::npos) line.replace(at, line.find(')', at) - at, to);
    };
  };
  return {
      {"PtMeas(", 15, replace("X(", "X(1234"), "the expected contact"},
      {"PtMeas(", 16, replace("Part.Temperature(", "Part.Temperature(293.5"),
       "Part.Temperature as 293.5 degC"},
      {"AlignPart(", 2,
       [](std::string& line) { line = line.substr(0, 8) + "0,-0.5,0.8660254,0,0.8660254,0.5"; },
       "deg off, at most 8 deg"},
      {"ScanOnCircle(", 2,
       [](std::string& line) {
         change_numbers(line, [](std::vector<double>& n) { n.resize(15); });
       },
       "points, 48 were asked for"},
      {"ScanOnCircle(", 3,
       [](std::string& line) {
         change_numbers(line, [](std::vector<double>& n) { n[n.size() / 6 * 3 + 2] += 2.0; });
       },
       "off its plane"},
  };
}

TEST(ScanOverWire, AWrongAnswerStopsTheRunWhichResumesToTheSameValue) {
  const Plan inside = three_lobes(2, 48, 0.2);
  const record::Scratch scratch;
  const auto wanted = run_of(inside, scratch / "inside");
  int number = 0;
  for (const WrongAnswer& wrong : wrong_answers()) {
    SCOPED_TRACE(wrong.command + " " + wrong.says);
    WireServer server(inside);
    server.spoil(
        [&wrong, left = wrong.which](const std::string& command, std::string& line) mutable {
          const bool data = line.size() > 8 && line[6] == '#';
          if (data && command.substr(6).starts_with(wrong.command) && --left == 0)
            wrong.change(line);
        });
    const Plan plan = over_wire(inside, server.port());
    const auto directory = scratch / fmt::format("{}", number++);
    {
      const auto stopped = run_plan(plan, seeded_options(directory));
      ASSERT_TRUE(stopped && stopped->failure);
      EXPECT_EQ(stopped->failure->code, core::Code::kMachine);
      EXPECT_THAT(stopped->failure->what, AllOf(HasSubstr(wrong.says), HasSubstr("then resume")));
    }
    const auto resumed = resume_plan(plan, seeded_options(directory));
    ASSERT_TRUE(resumed) << resumed.error().front().what;
    ASSERT_FALSE(resumed->failure) << resumed->failure->what;
    const auto record = record::read_journal(directory);
    ASSERT_TRUE(record);
    expect_same(record->record, wanted);
  }
}

TEST(ScanOverWire, ARunWhoseScansBeginBesideTheStartIsResumed) {
  Plan inside = shaft();
  inside.simulation->machine.drift_x_um = 0.0;
  inside.simulation->machine.drift_y_um = 0.0;
  inside.simulation->machine.drift_z_um = 0.0;
  const record::Scratch scratch;
  const WireServer server(inside, 2);
  const Plan plan = over_wire(inside, server.port());
  RunOptions options = seeded_options(scratch / "cut");
  options.before_move = [left = 2](const NextMove& move) mutable -> core::Result<void> {
    const bool scan = move.what.find("scan") != std::string::npos;
    if (!scan || left-- > 0) return {};
    return core::fail(core::Code::kStopped, "no");
  };
  {
    const auto stopped = run_plan(plan, options);
    ASSERT_TRUE(stopped && stopped->failure);
    ASSERT_EQ(stopped->failure->code, core::Code::kStopped) << stopped->failure->what;
  }
  const auto resumed = resume_plan(plan, seeded_options(scratch / "cut"));
  ASSERT_TRUE(resumed) << resumed.error().front().what;
  EXPECT_FALSE(resumed->failure) << resumed->failure->what;
}

TEST(ScanOverWire, AMachineThatDoesNotScanIsRefusedBeforeItMoves) {
  cmm::ipp::Profile no_parameters = cmm::ipp::as_recorded();
  no_parameters.lacks.emplace_back("Tool.ScanPar");
  Plan plan = shaft();
  plan.machine->retract = MachinePlan::Retract::kByDistance;
  for (const auto& [profile, why] : {std::pair(cmm::ipp::touches_only(), "OnScanReport"),
                                     std::pair(no_parameters, "Tool.ScanPar")}) {
    SCOPED_TRACE(why);
    const WireServer server(shaft(), 0, profile);
    const record::Scratch scratch;
    const auto refused = run_plan(over_wire(plan, server.port()), seeded_options(scratch / "run"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kMachine);
    EXPECT_EQ(refused.error().where, "/features/0/sampling/method");
    EXPECT_THAT(refused.error().what,
                AllOf(HasSubstr("feature seat is to be scanned"),
                      HasSubstr("does not scan circles"), HasSubstr(why),
                      HasSubstr("give \"method\": \"touch\""), HasSubstr("nothing has moved")));
    EXPECT_EQ(server.motions(), 0);
    EXPECT_FALSE(std::filesystem::exists(scratch / "run")) << "there is nothing to record";
  }
}

TEST(ScanOverWire, AMachineThatDoesNotScanTouches) {
  Plan plan = shaft();
  plan.features.front().sampling.method = record::SamplingMethod::kTouch;
  cmm::Capabilities machine;
  machine.name = "old machine";
  EXPECT_TRUE(check_abilities(plan, machine));
  plan.features.front().sampling.method = record::SamplingMethod::kScan;
  EXPECT_FALSE(check_abilities(plan, machine));
  machine.scans_circles = true;
  EXPECT_TRUE(check_abilities(plan, machine));
}

}  // namespace
}  // namespace rondure::plans
