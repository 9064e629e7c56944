// Bodies beside the part: every question of a path sees them, whatever their shape and frame.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/noise.h"
#include "core/units.h"
#include "plans/forecast/forecast.h"
#include "plans/forecast/picture.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/scene.h"
#include "plans/run/runner.h"
#include "record/sha256.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "tests/plans/files.h"
#include "tests/plans/random_inspection.h"
#include "tests/plans/stl_files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;
using test::between;
using test::cylinder_soup;
using test::Soup;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::lines_of;
using ::testing::Not;

/// The first example with these bodies.
PlanOrProblems with_bodies(const Json& bodies, const std::filesystem::path& folder = {},
                           const Json& patch = Json::object()) {
  Json out = Json::parse(testing::bytes_of(testing::example("01_spool_simulated.json")));
  out["fixture"]["bodies"] = bodies;
  out.merge_patch(patch);
  return parse_plan(out.dump(), folder, "plan.json");
}

std::string refusal(const Json& body, const Json& patch = Json::object()) {
  return lines_of(with_bodies(Json::array({body}), {}, patch));
}

void save(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// Wall, bore and ends of a ring about z.
Soup ring_soup(double inner, double outer, double from, double to, int facets) {
  Soup out;
  const auto at = [&](double r, int k, double z) {
    const double theta = core::kTwoPi * (k % facets) / facets;
    return Vector3d(r * std::cos(theta), r * std::sin(theta), z);
  };
  for (int k = 0; k < facets; ++k) {
    for (const auto& [r, z, s, t] :
         {std::array{outer, from, outer, to}, std::array{outer, to, inner, to},
          std::array{inner, to, inner, from}, std::array{inner, from, outer, from}}) {
      out.add(at(r, k, z), at(r, k + 1, z), at(s, k + 1, t));
      out.add(at(r, k, z), at(s, k + 1, t), at(s, k, t));
    }
  }
  return out;
}

TEST(Bodies, OfEveryShapeAndFrameStopThePathAndAreNamed) {
  // The spool, 50 mm thick, stands about (0, 0, 150); the bodies stand 15 mm beside it.
  const Json box = {{"id", "stop"}, {"shape", "box"}, {"size_mm", {20, 20, 40}}};
  const Json rod = {
      {"id", "stop"}, {"shape", "cylinder"}, {"diameter_mm", 20}, {"from_mm", -20}, {"to_mm", 20}};
  const Json tube = {{"id", "stop"},           {"shape", "ring"}, {"diameter_mm", 140},
                     {"bore_diameter_mm", 64}, {"from_mm", -20},  {"to_mm", 20}};
  const auto in = [](Json body, const std::string& frame, const Json& at) {
    body["frame"] = frame;
    body["position_mm"] = at;
    return body;
  };
  for (const Json& body :
       {in(box, "base", {40, 0, 150}), in(rod, "base", {40, 0, 150}), in(tube, "base", {0, 0, 150}),
        in(box, "hoop", {0, 40, 0}), in(rod, "ring", {-40, 0, 0}), in(tube, "part", {0, 0, 0})}) {
    EXPECT_THAT(refusal(body), AllOf(HasSubstr("/features/0/sampling: layer"),
                                     HasSubstr("to the body \"stop\" on the way to machine")))
        << body.dump();
  }
  EXPECT_EQ(refusal(in(box, "base", {80, 0, 150})), "");
  EXPECT_EQ(refusal(in(tube, "base", {0, 0, 60})), "") << "below the spool";
  Json wide = in(box, "base", {60, 0, 150});
  EXPECT_EQ(refusal(wide), "");
  wide["clearance_mm"] = 30;
  EXPECT_THAT(refusal(wide), HasSubstr("nearer than 37 mm (machine.clearance_mm with 2 mm by which "
                                       "the place may be off and 30 mm of the body) to the body"));
  Json turned = in(box, "base", {55, 0, 150});
  turned["size_mm"] = {4, 4, 90};
  EXPECT_EQ(refusal(turned), "");
  turned["rotation_deg"] = {0, 90, 0};
  EXPECT_THAT(refusal(turned), HasSubstr("the body \"stop\""));
}

TEST(Bodies, OfTheHoopTurnWithAlphaAlone) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::KeyedNoise random(seed, {23});
    FixturePlan fixture;
    const auto numbers = [&] {
      return std::array{between(random, -50, 50), between(random, -50, 50),
                        between(random, -50, 50)};
    };
    fixture.axis_point_mm = numbers();
    fixture.axis_offset_mm = numbers();
    fixture.part_position_mm = numbers();
    const core::Pose pose{between(random, -1.5, 1.5), between(random, -1.5, 1.5)};
    const Eigen::Isometry3d X_WN =
        fixture::body_to_machine(nominal_kinematics(fixture), pose) * nominal_seat(fixture);
    const auto X_WH = frame_of(BodyPlan::Frame::kHoop, fixture, {X_WN, X_WN});
    const Vector3d p(between(random, -80, 80), between(random, -80, 80), between(random, -80, 80));
    const double c = std::cos(pose.alpha_rad);
    const double s = std::sin(pose.alpha_rad);
    const Vector3d turned(p.x(), c * p.y() - s * p.z(), s * p.y() + c * p.z());
    EXPECT_LT((X_WH * p - vector3(fixture.axis_point_mm) - turned).norm(), 1e-10);
  }
}

TEST(Bodies, AsShapesAndAsMeshesRefuseTheSameOfAThousandTargets) {
  const record::Scratch scratch;
  // A fixture like that of the source: hoop, two half rings and five feet.
  Json shapes = Json::array({{{"id", "hoop"},
                              {"shape", "ring"},
                              {"frame", "hoop"},
                              {"diameter_mm", 260},
                              {"bore_diameter_mm", 200},
                              {"from_mm", -15},
                              {"to_mm", 15}},
                             {{"id", "ring"},
                              {"shape", "ring"},
                              {"frame", "ring"},
                              {"diameter_mm", 120},
                              {"bore_diameter_mm", 60},
                              {"from_mm", -60},
                              {"to_mm", -50}}});
  Json meshes = Json::array();
  for (int foot = 0; foot < 5; ++foot) {
    const double theta = core::kTwoPi * foot / 5;
    shapes.push_back({{"id", fmt::format("foot {}", foot + 1)},
                      {"shape", "cylinder"},
                      {"diameter_mm", 30},
                      {"from_mm", 0},
                      {"to_mm", 40},
                      {"position_mm", {150 * std::cos(theta), 150 * std::sin(theta), 0}}});
  }
  for (Json body : shapes) {
    const std::string file = body["id"].get<std::string>() + ".stl";
    const double outer = 0.5 * body["diameter_mm"].get<double>();
    const double from = body["from_mm"];
    const double to = body["to_mm"];
    save(scratch / file,
         test::stl_text(
             body.contains("bore_diameter_mm")
                 ? ring_soup(0.5 * body["bore_diameter_mm"].get<double>(), outer, from, to, 120)
                 : cylinder_soup(outer, from, to, 120)));
    for (const char* key : {"diameter_mm", "bore_diameter_mm", "from_mm", "to_mm"}) body.erase(key);
    body.update({{"shape", "mesh"}, {"file", file}, {"unit", "mm"}, {"facets", "round"}});
    meshes.push_back(body);
  }
  const auto by_shape = with_bodies(shapes);
  const auto by_mesh = with_bodies(meshes, scratch.path());
  ASSERT_TRUE(by_shape) << lines_of(by_shape);
  ASSERT_TRUE(by_mesh) << lines_of(by_mesh);
  const Scene shape_scene(*by_shape, by_shape->features.front());
  const Scene mesh_scene(*by_mesh, by_mesh->features.front());
  PathGeometry geometry;
  geometry.clearance_mm = 5.0;
  int refused = 0;
  int differ = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    core::KeyedNoise random(seed, {24});
    const core::Pose pose{between(random, -1.0, 1.0), between(random, -1.0, 1.0)};
    const Eigen::Isometry3d X_WN =
        fixture::body_to_machine(nominal_kinematics(*by_shape->fixture), pose) *
        nominal_seat(*by_shape->fixture);
    const Vector3d target(between(random, -200, 200), between(random, -200, 200),
                          between(random, 10, 300));
    const Way way = {{{target.x(), target.y(), 450.0}, target}, {Phase::kTravel}};
    const auto one = shape_scene.first_hit(way, {X_WN, X_WN}, geometry);
    const auto other = mesh_scene.first_hit(way, {X_WN, X_WN}, geometry);
    refused += one ? 1 : 0;
    if (one.has_value() == other.has_value() && (!one || one->name == other->name)) continue;
    // Shapes err at their edges by up to 4 % of the room, meshes by what lies between facets and
    // wall, both on the safe side.
    ++differ;
  }
  EXPECT_GT(refused, 150);
  EXPECT_LT(refused, 700);
  EXPECT_LE(differ, 10);
}

TEST(Bodies, ThatAreThePartItselfStopNoTouch) {
  const record::Scratch scratch;
  const Soup part = cylinder_soup(25.0, -40.0, 40.0, 96);
  save(scratch / "part.stl", test::stl_text(part));
  const Json body = {
      {"id", "part"}, {"shape", "mesh"}, {"frame", "part"}, {"file", "part.stl"}, {"unit", "mm"}};
  const auto plan = with_bodies(Json::array({body}), scratch.path());
  ASSERT_TRUE(plan) << lines_of(plan);
  const auto bare = forecast(*with_bodies(Json::array()));
  const auto found = forecast(*plan);
  ASSERT_TRUE(bare && found) << found.error().what;
  EXPECT_EQ(found->path_mm, bare->path_mm);
  // A flange of the part that the plan does not know is in the way.
  Soup flanged = part;
  const Soup flange = cylinder_soup(45.0, 0.0, 10.0, 48);
  for (const auto& [a, b, c] : flange.corners)
    flanged.add(flange.points[a], flange.points[b], flange.points[c]);
  save(scratch / "part.stl", test::stl_text(flanged));
  EXPECT_THAT(lines_of(with_bodies(Json::array({body}), scratch.path())),
              HasSubstr("to the part, body \"part\""));
}

TEST(Bodies, OfThePartAreNotThereWhileItsPlaceHoldsBalls) {
  const record::Scratch scratch;
  save(scratch / "part.stl", test::stl_text(cylinder_soup(25.0, -40.0, 40.0, 96)));
  Json plan = Json::parse(testing::bytes_of(testing::example("18_calibrate_and_inspect.json")));
  plan["fixture"]["bodies"] = Json::array({{{"id", "part"},
                                            {"shape", "mesh"},
                                            {"frame", "part"},
                                            {"file", "part.stl"},
                                            {"unit", "mm"}}});
  const auto read = parse_plan(plan.dump(), scratch.path(), "plan.json");
  ASSERT_TRUE(read) << lines_of(read);
  const auto found = forecast(*read);
  EXPECT_TRUE(found) << found.error().what;
  plan["fixture"]["bodies"][0]["frame"] = "ring";
  const auto ring = parse_plan(plan.dump(), scratch.path(), "plan.json");
  EXPECT_FALSE(ring && forecast(*ring)) << "a ball stands within it";
}

TEST(Bodies, AreKeptAwayFromTheReferenceSphereAndBelowThePark) {
  const auto plan = with_bodies(Json::array({{{"id", "lamp"},
                                              {"shape", "box"},
                                              {"size_mm", {20, 20, 20}},
                                              {"position_mm", {300, 0, 135}}}}));
  ASSERT_TRUE(plan) << lines_of(plan);
  const auto foretold = forecast(*plan);
  ASSERT_FALSE(foretold);
  EXPECT_THAT(core::to_line(foretold.error()),
              AllOf(HasSubstr("reference sphere, point 1"), HasSubstr("the body \"lamp\"")));
  const record::Scratch scratch;
  const auto run = run_plan(*plan, testing::options_for(scratch / "run"));
  ASSERT_TRUE(run && run->failure);
  EXPECT_THAT(run->failure->what, HasSubstr("the body \"lamp\""));
  EXPECT_TRUE(testing::journal_of(scratch / "run").touches.empty()) << "nothing has moved to it";
  EXPECT_THAT(refusal({{"id", "mast"},
                       {"shape", "cylinder"},
                       {"diameter_mm", 20},
                       {"from_mm", 0},
                       {"to_mm", 520},
                       {"position_mm", {-300, 0, 0}}}),
              AllOf(HasSubstr("/machine/park_mm"), HasSubstr("raise it")));
}

TEST(Bodies, WhoseFileChangedAreNotResumedWith) {
  const record::Scratch scratch;
  const std::string first = test::stl_text(cylinder_soup(10.0, 0.0, 20.0, 12));
  save(scratch / "foot.stl", first);
  const Json body = {{"id", "foot"},
                     {"shape", "mesh"},
                     {"file", "foot.stl"},
                     {"unit", "mm"},
                     {"position_mm", {-150, 0, 0}}};
  const auto plan = with_bodies(Json::array({body}), scratch.path());
  ASSERT_TRUE(plan) << lines_of(plan);
  RunOptions stopped = testing::options_for(scratch / "run");
  stopped.stop_requested = [left = 20]() mutable { return left-- == 0; };
  ASSERT_TRUE(run_plan(*plan, stopped));
  const auto said = record::task_of<record::FixtureSettings>(
      testing::journal_of(scratch / "run").settings, "fixture/");
  ASSERT_TRUE(said && said->bodies);
  EXPECT_EQ(*said->bodies, record::sha256_hex(first) + "  foot.stl\n");
  save(scratch / "foot.stl", test::stl_text(cylinder_soup(10.0, 0.0, 21.0, 12)));
  const auto other = resume_plan(*with_bodies(Json::array({body}), scratch.path()),
                                 testing::options_for(scratch / "run"));
  ASSERT_FALSE(other);
  EXPECT_THAT(core::to_line(other.error().front()),
              AllOf(HasSubstr("/fixture/bodies/0/file"), HasSubstr("foot.stl is not the file")));
  save(scratch / "foot.stl", first);
  const auto again = resume_plan(*with_bodies(Json::array({body}), scratch.path()),
                                 testing::options_for(scratch / "run"));
  ASSERT_TRUE(again) << again.error().front().what;
  EXPECT_FALSE(again->failure);
}

TEST(Bodies, AreDrawnBesideThePath) {
  const record::Scratch scratch;
  save(scratch / "foot.stl", test::stl_text(cylinder_soup(10.0, 0.0, 20.0, 12)));
  const auto plan = with_bodies(Json::array({{{"id", "foot"},
                                              {"shape", "mesh"},
                                              {"file", "foot.stl"},
                                              {"unit", "mm"},
                                              {"position_mm", {-150, 0, 0}}},
                                             {{"id", "rod"},
                                              {"shape", "cylinder"},
                                              {"diameter_mm", 20},
                                              {"from_mm", 0},
                                              {"to_mm", 50},
                                              {"position_mm", {150, 0, 0}}}}),
                                scratch.path());
  ASSERT_TRUE(plan) << lines_of(plan);
  const auto found = forecast(*plan);
  ASSERT_TRUE(found) << found.error().what;
  const std::string drawn = forecast_picture(*plan, found->stages.back());
  EXPECT_THAT(drawn, AllOf(HasSubstr("<path d=\"M"), HasSubstr("fill=\"#cfc8b8\"")));
  const std::string bare = forecast_picture(*with_bodies(Json::array()), found->stages.back());
  EXPECT_THAT(bare, Not(HasSubstr("<path d=")));
}

}  // namespace
}  // namespace rondure::plans
