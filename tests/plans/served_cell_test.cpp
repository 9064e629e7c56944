// The virtual cell behind the I++ DME server: what comes over the wire has the bits of the machine
// in the same process.

#include "plans/cell/served_cell.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cmm/grid.h"
#include "cmm/ipp/numbers.h"
#include "cmm/ipp_server/service.h"
#include "core/units.h"
#include "fixture/kinematics.h"
#include "tests/core/full.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using cmm::ipp::Item;
using Eigen::Vector3d;

constexpr double kApproach_mm = 3.0;

/// The touches of 4 layers of 7 points in a pose, with a way around the part that is free.
struct Tour {
  struct Stop {
    Vector3d away_W_mm;
    cmm::TouchCommand touch;
  };
  std::vector<Stop> stops;
};

Tour tour(const Plan& plan, const core::Pose& pose) {
  const FeaturePlan& feature = plan.features[0];
  Eigen::Isometry3d X_WP =
      fixture::body_to_machine({Eigen::Map<const Vector3d>(plan.fixture->axis_point_mm.data()),
                                Eigen::Map<const Vector3d>(plan.fixture->axis_offset_mm.data())},
                               pose);
  const double radius_mm = 0.5 * (feature.nominal.diameter_mm + plan.probe->tip_diameter_mm);
  Tour out;
  for (int layer = 0; layer < 4; ++layer) {
    for (int point = 0; point < 7; ++point) {
      const double theta = core::kTwoPi * point / 7.0;
      const Vector3d u(std::cos(theta), std::sin(theta), 0.0);
      const Vector3d h(0.0, 0.0, -30.0 + 20.0 * layer);
      cmm::TouchCommand touch;
      touch.id = static_cast<std::int64_t>(out.stops.size());
      touch.expected_tip_W_mm = X_WP * (radius_mm * u + h);
      touch.direction_W = X_WP.linear() * -u;
      touch.approach_mm = kApproach_mm;
      touch.search_mm = kApproach_mm;
      touch = cmm::on_grid(touch);
      out.stops.push_back({cmm::on_grid_mm(X_WP * (100.0 * u + h)), touch});
    }
  }
  return out;
}

std::string coordinates(const Vector3d& p) {
  return fmt::format("X({}),Y({}),Z({})", cmm::ipp::wire_number(p.x()),
                     cmm::ipp::wire_number(p.y()), cmm::ipp::wire_number(p.z()));
}

std::string vector_text(const Vector3d& v) {
  return fmt::format("{},{},{}", cmm::ipp::wire_number(v.x()), cmm::ipp::wire_number(v.y()),
                     cmm::ipp::wire_number(v.z()));
}

Vector3d start_of(const cmm::TouchCommand& touch) {
  return cmm::on_grid_mm(touch.expected_tip_W_mm - touch.approach_mm * touch.direction_W);
}

core::Pose example_pose() {
  return {cmm::angle_on_grid(7.35 * core::kDegree), cmm::angle_on_grid(-4.2 * core::kDegree)};
}

/// The commands of a client that makes a tour, without tags.
/// @param radius_mm  From the point that PtMeas names to the centre of the tip.
std::vector<std::string> commands(const Tour& tour, const core::Pose& pose, double radius_mm) {
  const Eigen::Matrix3d R = fixture::body_to_machine({}, pose).linear();
  std::vector<std::string> out = {
      "StartSession()",
      "Home()",
      "ChangeTool(\"T1\")",
      "SetProp(Tool.PtMeasPar.Approach(3),Tool.PtMeasPar.Search(3),Tool.PtMeasPar.Retract(-1))",
      fmt::format("AlignPart(0,0,1,{},0,1,0,{},0,0)", vector_text(cmm::direction_on_grid(R.col(2))),
                  vector_text(cmm::direction_on_grid(R.col(1)))),
      "GoTo(X(200))"};
  for (const Tour::Stop& stop : tour.stops) {
    out.push_back(fmt::format("GoTo({})", coordinates(stop.away_W_mm)));
    out.push_back(fmt::format("GoTo({})", coordinates(start_of(stop.touch))));
    const Vector3d named = stop.touch.expected_tip_W_mm + radius_mm * stop.touch.direction_W;
    out.push_back(fmt::format("PtMeas({},IJK({}))", coordinates(named),
                              vector_text(-stop.touch.direction_W)));
    out.push_back(fmt::format("GoTo({})", coordinates(stop.away_W_mm)));
  }
  return out;
}

/// What the machine in this process reads.
std::vector<Vector3d> read_directly(const Plan& plan, const Tour& tour, const core::Pose& pose) {
  SimulatedCell cell(plan, 5, false);
  cell.mount(plan.features[0]);
  std::vector<Vector3d> out;
  EXPECT_TRUE(cell.machine().home());
  EXPECT_TRUE(cell.home_fixture());
  EXPECT_TRUE(cell.turn_to(pose));
  const Vector3d park = cell.machine().position_W_mm();
  EXPECT_TRUE(cell.machine().move_to({200.0, park.y(), park.z()}));
  for (const Tour::Stop& stop : tour.stops) {
    EXPECT_TRUE(cell.machine().move_to(stop.away_W_mm));
    EXPECT_TRUE(cell.machine().move_to(start_of(stop.touch)));
    const auto reading = cell.machine().touch(stop.touch);
    EXPECT_TRUE(reading.has_value());
    out.push_back(reading ? reading->tip_W_mm : Vector3d::Zero());
    EXPECT_TRUE(cell.machine().move_to(stop.away_W_mm));
  }
  return out;
}

std::optional<Vector3d> point_of(const cmm::ipp::Response& response) {
  const Item* x = cmm::ipp::find_call(response.data, "X");
  const Item* y = cmm::ipp::find_call(response.data, "Y");
  const Item* z = cmm::ipp::find_call(response.data, "Z");
  if (x == nullptr || y == nullptr || z == nullptr) return std::nullopt;
  return Vector3d(*single_number(*x), *single_number(*y), *single_number(*z));
}

void expect_same_bits(MachinePlan::Point named) {
  Plan plan = testing::plan_of("01_spool_simulated.json");
  plan.machine->point = named;
  const double radius_mm =
      named == MachinePlan::Point::kSurface ? 0.5 * plan.probe->tip_diameter_mm : 0.0;
  const core::Pose pose = example_pose();
  const Tour way = tour(plan, pose);
  const std::vector<Vector3d> wanted = read_directly(plan, way, pose);
  ServedCell cell(plan, 5);
  cmm::ipp::Server server(cell, server_options(plan));
  std::vector<Vector3d> got;
  int tag = 0;
  for (const std::string& command : commands(way, pose, radius_mm)) {
    SCOPED_TRACE(command);
    server.receive({fmt::format("{:05} {}", ++tag, command)}, 0.0);
    for (const std::string& line : server.take_output()) {
      const auto response = cmm::ipp::parse_response(line);
      ASSERT_TRUE(response.has_value());
      ASSERT_NE(response->kind, cmm::ipp::Response::Kind::kError) << line;
      if (const auto point = point_of(*response)) got.push_back(*point);
    }
  }
  ASSERT_EQ(got.size(), 28U);
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i], wanted[i]) << i;
  EXPECT_EQ(cell.machine().position_W_mm(), way.stops.back().away_W_mm);
}

TEST(ServedCell, TouchesOverTheWireHaveTheBitsOfTheMachineInTheSameProcess) {
  for (const MachinePlan::Point named :
       {MachinePlan::Point::kSurface, MachinePlan::Point::kCenter}) {
    SCOPED_TRACE(name_of(named));
    expect_same_bits(named);
  }
}

TEST(ServedCell, ATouchOverTheSocketTakesLessThanAMillisecond) {
  const Plan plan = testing::plan_of("01_spool_simulated.json");
  const std::vector<std::string> all =
      commands(tour(plan, example_pose()), example_pose(), 0.5 * plan.probe->tip_diameter_mm);
  ServedCell cell(plan, 5);
  cmm::ipp::Server server(cell, server_options(plan));
  auto listener = wire::TcpListener::open("127.0.0.1", 0);
  ASSERT_TRUE(listener.has_value());
  std::atomic<bool> stop = false;
  cmm::ipp::ServiceOptions options;
  options.stop_requested = [&stop] { return stop.load(); };
  options.tell = [](std::string_view) {};
  std::thread thread([&] { EXPECT_TRUE(serve(*listener, server, options)); });
  auto client = wire::connect_tcp("127.0.0.1", listener->port());
  EXPECT_TRUE(client.has_value());
  const auto begin = std::chrono::steady_clock::now();
  int tag = 0;
  for (const std::string& command : all) {
    EXPECT_TRUE((*client)->write_line(fmt::format("{:05} {}", ++tag, command)));
    while (true) {
      const auto line = (*client)->read_line(std::chrono::milliseconds(5000));
      EXPECT_TRUE(line && *line);
      if (!line || !*line || (*line)->text.ends_with(" %")) break;
    }
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  stop = true;
  thread.join();
  const double each_ms = took.count() / 28.0;
  std::printf("4 x 7 touches over the socket: %.3f ms a touch\n", each_ms);
  // The figure itself is for a machine at rest; other work beside the tests may take its time.
  EXPECT_LT(each_ms, test::full() ? 1.0 : 20.0);
}

TEST(ServedCell, TurnsWithinTheLimitsOfTheFixtureOnly) {
  const Plan plan = testing::plan_of("01_spool_simulated.json");
  ServedCell cell(plan, 5);
  const Eigen::Matrix3d beyond = fixture::body_to_machine({}, {2.0, 0.0}).linear();  // 115 deg
  const std::array<cmm::ipp::Alignment, 2> wanted = {
      {{Vector3d::UnitZ(), beyond.col(2)}, {Vector3d::UnitY(), beyond.col(1)}}};
  const auto refused = cell.align_part(wanted);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, core::Code::kPoseRange);
  EXPECT_EQ(cell.table_angles_deg(), (std::vector<double>{0.0, 0.0}));
  const std::array<cmm::ipp::Alignment, 1> level = {{{Vector3d::UnitZ(), Vector3d::UnitZ()}}};
  EXPECT_TRUE(cell.align_part(level));
  EXPECT_FALSE(cell.choose_feature(1));
  EXPECT_TRUE(cell.choose_feature(0));
}

TEST(ServedCell, OffersTheToolOfThePlan) {
  Plan plan = testing::plan_of("01_spool_simulated.json");
  plan.machine->tool = "Probe 7";
  ServedCell cell(plan, 5);
  EXPECT_EQ(cell.machine().capabilities().tools, std::vector<std::string>{"Probe 7"});
}

TEST(ServedCell, TurnsTheBallsOfACalibrationToTheirTruePlaces) {
  const Plan plan = testing::plan_of("03_calibrate_fixture.json");
  ASSERT_TRUE(check_servable(plan));
  ServedCell served(plan, 5);
  EXPECT_TRUE(served.choose_feature(0));
  SimulatedCell cell(plan, 5, false);
  cell.mount(plan.features[0]);
  ASSERT_TRUE(served.machine().home() && served.home_table());
  ASSERT_TRUE(cell.machine().home() && cell.home_fixture());
  const core::Pose pose = example_pose();
  const Eigen::Matrix3d R = fixture::body_to_machine({}, pose).linear();
  const std::array<cmm::ipp::Alignment, 2> wanted = {
      {{Vector3d::UnitZ(), R.col(2)}, {Vector3d::UnitY(), R.col(1)}}};
  ASSERT_TRUE(served.align_part(wanted));
  ASSERT_TRUE(cell.turn_to(pose));
  const Eigen::Isometry3d X_WB = fixture::body_to_machine(cell.kinematics(), pose);
  cmm::TouchCommand down;  // onto the pole of the ball in the middle
  down.expected_tip_W_mm = X_WB * Vector3d(0.0, 0.0, 90.0) + Vector3d(0.0, 0.0, 7.0);
  down.direction_W = -Vector3d::UnitZ();
  down.approach_mm = down.search_mm = kApproach_mm;
  down = cmm::on_grid(down);
  for (cmm::Machine* machine : {&served.machine(), &cell.machine()}) {
    ASSERT_TRUE(machine->move_to(start_of(down)));
  }
  const auto over_wire = served.machine().touch(down);
  const auto inside = cell.machine().touch(down);
  ASSERT_TRUE(over_wire && inside);
  EXPECT_EQ(over_wire->tip_W_mm, inside->tip_W_mm);
}

TEST(ServedCell, APlanWithoutASimulationCannotBeServed) {
  const auto plan = read_plan(testing::example("09_axle_points_file.json"));
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(check_servable(*plan).error().code, core::Code::kMeaning);
  EXPECT_TRUE(check_servable(testing::plan_of("01_spool_simulated.json")));
}

}  // namespace
}  // namespace rondure::plans
