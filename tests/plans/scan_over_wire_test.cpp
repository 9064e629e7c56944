// Scans over I++ DME: a run over the wire has the bits of the run in one process, and a machine
// that cannot scan is not moved.

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmm/ipp_server.h"
#include "plans/cell.h"
#include "plans/runner.h"
#include "plans/served_cell.h"
#include "record/journal.h"
#include "tests/plans/files.h"
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
  /// @param scans  Whether the server knows scans at all.
  /// @param late  Points it leaves out at the start of each scan.
  WireServer(const Plan& plan, bool scans, std::size_t late = 0)
      : cell_(plan, kSeed),
        server_(cell_, server_options(plan)),
        scans_(scans),
        late_(late),
        listener_(wire::TcpListener::open("127.0.0.1", 0).value()),
        thread_([this] { serve(); }) {}
  ~WireServer() {
    stop_ = true;
    thread_.join();
  }

  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }
  /// Moves, turns, touches and scans that were asked for.
  [[nodiscard]] int motions() const { return motions_; }

 private:
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
    const std::string tag = text.substr(0, text.find(' '));
    if (!scans_ && text.find(" OnScanReport(") != std::string::npos) {
      (void)client.write_line(tag + " &");
      (void)client.write_line(
          tag + " ! Error(3, 0501, \"OnScanReport(X(), Y(), Z())\", \"Unsupported command\")");
      (void)client.write_line(tag + " %");
      return;
    }
    for (const std::string_view motion : {" Home(", " GoTo(", " AlignPart(", " PtMeas(", " Scan"}) {
      if (text.find(motion) != std::string::npos) ++motions_;
    }
    server_.receive({text, {}}, 0.0);
    std::size_t left_out = text.find(" ScanOnCircle(") == std::string::npos ? 0 : 3 * late_;
    for (std::string line : server_.take_output()) {
      for (const std::size_t data = line.find("# "); data == 6 && left_out > 0; --left_out) {
        line.erase(data + 2, line.find(',') + 1 - (data + 2));
      }
      (void)client.write_line(line);
    }
  }

  ServedCell cell_;
  cmm::ipp::Server server_;
  bool scans_;
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
  plan.machine->driver = "ippdme";
  plan.machine->host = "127.0.0.1";
  plan.machine->port = port;
  plan.machine->tool = "T1";
  plan.fixture->driver = "ippdme";
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
  const WireServer server(inside, true);
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

TEST(ScanOverWire, ARunWhoseScansBeginBesideTheStartIsResumed) {
  Plan inside = shaft();
  inside.simulation->machine.drift_x_um = 0.0;
  inside.simulation->machine.drift_y_um = 0.0;
  inside.simulation->machine.drift_z_um = 0.0;
  const record::Scratch scratch;
  const WireServer server(inside, true, 2);
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
  const WireServer server(shaft(), false);
  const record::Scratch scratch;
  const auto refused = run_plan(over_wire(shaft(), server.port()), seeded_options(scratch / "run"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kMachine);
  EXPECT_EQ(refused.error().where, "/features/0/sampling/method");
  EXPECT_THAT(refused.error().what,
              AllOf(HasSubstr("feature seat is to be scanned"), HasSubstr("does not scan circles"),
                    HasSubstr("give \"method\": \"touch\""), HasSubstr("nothing has moved")));
  EXPECT_EQ(server.motions(), 0);
  EXPECT_FALSE(std::filesystem::exists(scratch / "run")) << "there is nothing to record";
}

TEST(ScanOverWire, AMachineThatDoesNotScanTouches) {
  Plan plan = shaft();
  plan.features.front().sampling.method = "touch";
  cmm::Capabilities machine;
  machine.name = "old machine";
  EXPECT_TRUE(check_abilities(plan, machine));
  plan.features.front().sampling.method = "scan";
  EXPECT_FALSE(check_abilities(plan, machine));
  machine.scans_circles = true;
  EXPECT_TRUE(check_abilities(plan, machine));
}

}  // namespace
}  // namespace rondure::plans
