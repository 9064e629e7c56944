// Public reference sets (tests/data): least squares against the certified values of NIST, minimum
// zones against an independent solver in 50-digit arithmetic.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "fit/geometry/axis.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/references/min_zone.h"
#include "record/points/points.h"

namespace rondure::fit {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Set {
  json certified;
  record::PointTable table;
};

Set load(const std::string& name) {
  const fs::path folder = fs::path(RONDURE_SOURCE_DIR) / "tests/data" / name;
  Set set;
  set.certified = json::parse(record::read_file(folder / "certified.json").value());
  set.table = record::read_points(record::read_file(folder / "points.csv").value(), name).value();
  return set;
}

std::vector<std::string> sets_of(const std::string& kind) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(RONDURE_SOURCE_DIR) / "tests/data")) {
    if (!fs::exists(entry.path() / "certified.json")) continue;
    if (load(entry.path().filename()).certified["kind"] == kind)
      names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

double number(const json& value) {
  return value.is_string() ? std::strtod(value.get<std::string>().c_str(), nullptr)
                           : value.get<double>();
}

Eigen::Vector3d vector3(const json& value) {
  return {number(value[0]), number(value[1]), number(value[2])};
}

class ReferenceCylinder : public testing::TestWithParam<std::string> {};

TEST_P(ReferenceCylinder, MatchesTheCertifiedLeastSquares) {
  const Set set = load(GetParam());
  const auto ls = ls_cylinder(set.table.points_mm);
  ASSERT_TRUE(ls.has_value());
  const json& verified = set.certified["verified"]["ls_cylinder"];
  const Axis axis{vector3(verified["axis_point"]), vector3(verified["axis_direction"])};
  EXPECT_NEAR(2.0 * ls->radius_mm, 2.0 * number(verified["radius"]), 1e-9);
  EXPECT_LT(distance_mm(ls->axis, axis.point_mm), 1e-9);
  EXPECT_LT(ls->axis.direction.cross(axis.direction).norm(), 1e-9);
  EXPECT_NEAR(ls->deviation_mm, number(verified["zone"]), 1e-9);
  const json& published = set.certified["published"]["ls_cylinder"];
  if (published.contains("diameter")) {
    EXPECT_NEAR(2.0 * ls->radius_mm, number(published["diameter"]), 1e-9);
    const Axis stated{vector3(published["axis_point"]), vector3(published["axis_direction"])};
    EXPECT_LT(distance_mm(ls->axis, stated.point_mm), 1e-9);
    EXPECT_LT(ls->axis.direction.cross(stated.direction.normalized()).norm(), 1e-9);
  }
}

TEST_P(ReferenceCylinder, ReachesTheVerifiedMinimumZone) {
  const Set set = load(GetParam());
  const json& verified = set.certified["verified"]["mz_cylinder"];
  const auto zone = min_zone_cylinder(set.table.points_mm);
  ASSERT_TRUE(zone.has_value());
  EXPECT_LE(zone->width_mm(), number(verified["zone"]) + 1e-10);
  EXPECT_GE(zone->width_mm(), number(verified["zone"]) - 1e-10)
      << "a narrower zone than the verified optimum: check the reference";
  EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kLocal) << zone->certificate.reason;
}

INSTANTIATE_TEST_SUITE_P(Public, ReferenceCylinder, testing::ValuesIn(sets_of("cylinder")),
                         [](const auto& set) { return set.param; });

class ReferenceCircle : public testing::TestWithParam<std::string> {};

std::vector<Eigen::Vector2d> flat(const Set& set) {
  std::vector<Eigen::Vector2d> out;
  for (const auto& p : set.table.points_mm) out.emplace_back(p.head<2>());
  return out;
}

TEST_P(ReferenceCircle, MatchesTheCertifiedLeastSquares) {
  const Set set = load(GetParam());
  const auto ls = ls_circle(flat(set));
  ASSERT_TRUE(ls.has_value());
  const json& verified = set.certified["verified"]["lsc"];
  EXPECT_NEAR(ls->center_mm.x(), number(verified["center"][0]), 1e-9);
  EXPECT_NEAR(ls->center_mm.y(), number(verified["center"][1]), 1e-9);
  EXPECT_NEAR(2.0 * ls->radius_mm, 2.0 * number(verified["radius"]), 1e-9);
  EXPECT_NEAR(ls->deviation_mm, number(verified["zone"]), 1e-9);
}

TEST_P(ReferenceCircle, ReachesTheVerifiedMinimumZone) {
  const Set set = load(GetParam());
  const json& verified = set.certified["verified"];
  ASSERT_TRUE(verified.contains("mzc") && verified["mzc"].contains("zone"));
  const auto zone = min_zone_circle(flat(set));
  ASSERT_TRUE(zone.has_value());
  EXPECT_NEAR(zone->width_mm(), number(verified["mzc"]["zone"]), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Public, ReferenceCircle, testing::ValuesIn(sets_of("circle")),
                         [](const auto& set) { return set.param; });

}  // namespace
}  // namespace rondure::fit
