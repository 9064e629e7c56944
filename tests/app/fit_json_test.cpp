#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using nlohmann::json;
using ::testing::UnorderedElementsAre;

constexpr double kEqual_mm = 1e-9;

/// A reader of its own: two or three numbers a line behind one header line.
std::vector<Eigen::Vector3d> points_of(const std::filesystem::path& file) {
  std::ifstream lines(file);
  std::string line;
  std::getline(lines, line);
  std::vector<Eigen::Vector3d> out;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    fields >> p.x() >> p.y();
    fields >> p.z();
    out.push_back(p);
  }
  return out;
}

std::vector<std::string> keys_of(const json& object) {
  std::vector<std::string> out;
  for (const auto& [key, value] : object.items()) out.push_back(key);
  return out;
}

Eigen::Vector3d vector_of(const json& array) {
  return {array.at(0).get<double>(), array.at(1).get<double>(),
          array.size() > 2 ? array.at(2).get<double>() : 0.0};
}

/// Distances of points from the axis (or centre) that one reference states.
std::vector<double> radii_about(const json& reference, const std::vector<Eigen::Vector3d>& points) {
  const bool circle = reference.contains("center_mm");
  const Eigen::Vector3d at =
      vector_of(circle ? reference["center_mm"] : reference["axis"]["point_mm"]);
  const Eigen::Vector3d along =
      circle ? Eigen::Vector3d::UnitZ() : vector_of(reference["axis"]["direction"]);
  std::vector<double> out;
  for (const Eigen::Vector3d& p : points) out.push_back((p - at).cross(along).norm());
  return out;
}

void expect_deviation(const json& reference, const std::vector<Eigen::Vector3d>& points) {
  const auto radii = radii_about(reference, points);
  const auto [least, most] = std::minmax_element(radii.begin(), radii.end());
  EXPECT_NEAR(reference["deviation_mm"], *most - *least, kEqual_mm);
}

void expect_zone(const json& zone, const std::vector<Eigen::Vector3d>& points) {
  expect_deviation(zone, points);
  const auto radii = radii_about(zone, points);
  EXPECT_THAT(keys_of(zone["contacts"]), UnorderedElementsAre("outer", "inner"));
  for (const std::size_t row : zone["contacts"]["outer"]) {
    EXPECT_NEAR(radii.at(row), zone["outer_radius_mm"], kEqual_mm) << row;
  }
  for (const std::size_t row : zone["contacts"]["inner"]) {
    EXPECT_NEAR(radii.at(row), zone["inner_radius_mm"], kEqual_mm) << row;
  }
  EXPECT_FALSE(zone["contacts"]["outer"].empty());
  EXPECT_FALSE(zone["contacts"]["inner"].empty());
  EXPECT_THAT(keys_of(zone["certificate"]),
              UnorderedElementsAre("kind", "scope", "gap_mm", "reason"));
  EXPECT_THAT(zone["certificate"]["kind"].get<std::string>(),
              ::testing::AnyOf("global", "local", "none"));
}

void expect_axis(const json& axis, const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d along = vector_of(axis["direction"]);
  EXPECT_NEAR(along.norm(), 1.0, 1e-12);
  Eigen::Index largest = 0;
  along.cwiseAbs().maxCoeff(&largest);
  EXPECT_GT(along[largest], 0.0);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  // The nearest point of a line: the way there is square to the line.
  EXPECT_NEAR((vector_of(axis["point_mm"]) - mean).dot(along), 0.0, kEqual_mm);
}

/// A circumscribed reference holds all points and touches its contacts; an inscribed one is held
/// off by all.
void expect_one_sided(const json& found, const std::vector<Eigen::Vector3d>& points, bool outside) {
  expect_deviation(found, points);
  const json& contacts = found["contacts"][outside ? "outer" : "inner"];
  EXPECT_GE(contacts.size(), 2U);
  const double radius = found["radius_mm"];
  const auto radii = radii_about(found, points);
  for (const double r : radii) EXPECT_GE(outside ? radius - r : r - radius, -kEqual_mm);
  for (const std::size_t row : contacts) EXPECT_NEAR(radii.at(row), radius, kEqual_mm);
  EXPECT_NE(found["certificate"]["kind"], "none");
}

json fit(const std::string& shape, const std::filesystem::path& file,
         const std::string& reference = "all") {
  const Outcome outcome = rondure({"fit", shape, file, "--json", "--reference", reference});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out);
}

TEST(FitJson, HoldsTheContractForACircle) {
  const auto file = source_dir() / "tests/data/axle_mzc_3/points.csv";
  const auto points = points_of(file);
  const json found = fit("circle", file);
  EXPECT_EQ(found["shape"], "circle");
  EXPECT_EQ(found["points"], 24);
  EXPECT_THAT(keys_of(found),
              UnorderedElementsAre("shape", "points", "read", "ls", "mz", "mc", "mi", "warnings"));
  EXPECT_THAT(keys_of(found["ls"]),
              UnorderedElementsAre("center_mm", "radius_mm", "deviation_mm", "rms_mm"));
  EXPECT_THAT(keys_of(found["mz"]),
              UnorderedElementsAre("center_mm", "inner_radius_mm", "outer_radius_mm",
                                   "deviation_mm", "contacts", "certificate"));
  expect_deviation(found["ls"], points);
  expect_zone(found["mz"], points);
  expect_one_sided(found["mc"], points, true);
  expect_one_sided(found["mi"], points, false);
  // tests/data/axle_mzc_3/certified.json
  EXPECT_NEAR(found["ls"]["deviation_mm"], 0.039101674003819755214, kEqual_mm);
  EXPECT_NEAR(found["mz"]["deviation_mm"], 0.03823094398156937045, kEqual_mm);
  EXPECT_THAT(found["mz"]["contacts"]["outer"], UnorderedElementsAre(7, 19));
  EXPECT_THAT(found["mz"]["contacts"]["inner"], UnorderedElementsAre(0, 15));
}

TEST(FitJson, HoldsTheContractForACylinder) {
  const auto file = source_dir() / "tests/data/nist_cyl_13/points.csv";
  const auto points = points_of(file);
  const json found = fit("cylinder", file);
  EXPECT_EQ(found["shape"], "cylinder");
  EXPECT_EQ(found["points"], 184);
  EXPECT_THAT(keys_of(found),
              UnorderedElementsAre("shape", "points", "read", "ls", "mz", "mc", "mi", "warnings"));
  EXPECT_THAT(keys_of(found["ls"]),
              UnorderedElementsAre("axis", "radius_mm", "deviation_mm", "rms_mm"));
  EXPECT_THAT(keys_of(found["mz"]),
              UnorderedElementsAre("axis", "inner_radius_mm", "outer_radius_mm", "deviation_mm",
                                   "contacts", "certificate"));
  for (const char* reference : {"ls", "mz"}) expect_axis(found[reference]["axis"], points);
  expect_deviation(found["ls"], points);
  expect_zone(found["mz"], points);
  EXPECT_LE(found["mz"]["deviation_mm"], found["ls"]["deviation_mm"]);
  expect_one_sided(found["mc"], points, true);
  expect_one_sided(found["mi"], points, false);
}

// The corners of an octahedron inside those of a cube: by symmetry all places are known.
TEST(FitJson, HoldsTheContractForASphere) {
  const Scratch directory;
  const auto file = directory.path() / "ball.csv";
  {
    std::ofstream out(file);
    out << "x,y,z\n10,0,0\n-10,0,0\n0,10,0\n0,-10,0\n0,0,10\n0,0,-10\n";
    const double c = 10.01 / std::sqrt(3.0);
    for (const double x : {c, -c}) {
      for (const double y : {c, -c}) {
        for (const double z : {c, -c}) out << fmt::format("{},{},{}\n", x, y, z);
      }
    }
  }
  const json found = fit("sphere", file);
  EXPECT_THAT(keys_of(found),
              UnorderedElementsAre("shape", "points", "read", "ls", "mz", "mc", "mi", "warnings"));
  EXPECT_NEAR(found["mz"]["deviation_mm"], 0.01, 1e-12);
  EXPECT_NEAR(found["mz"]["inner_radius_mm"], 10.0, 1e-12);
  EXPECT_NEAR(found["mc"]["radius_mm"], 10.01, 1e-12);
  EXPECT_NEAR(found["mi"]["radius_mm"], 10.0, 1e-12);
  EXPECT_EQ(found["mc"]["certificate"]["kind"], "global");
  EXPECT_EQ(found["mz"]["center_mm"].size(), 3U);
}

// Three points of a plane: the least cylinder is as wide as their triangle is high.
TEST(FitJson, HoldsTheContractForALine) {
  const Scratch directory;
  const auto file = directory.path() / "edge.csv";
  std::ofstream(file) << "x,y,z\n5,0,0\n5,0.01,50\n5,0,100\n";
  const json found = fit("line", file);
  EXPECT_THAT(keys_of(found),
              UnorderedElementsAre("shape", "points", "read", "ls", "mz", "warnings"));
  EXPECT_THAT(keys_of(found["ls"]), UnorderedElementsAre("axis", "deviation_mm", "rms_mm"));
  EXPECT_NEAR(found["mz"]["diameter_mm"], 0.01, 1e-12);
  EXPECT_NEAR(found["ls"]["deviation_mm"], 2.0 * 0.01 * 2.0 / 3.0, 1e-12);
  EXPECT_THAT(found["mz"]["contacts"]["outer"], UnorderedElementsAre(0, 1, 2));
}

TEST(FitJson, AReferenceThatDoesNotExistIsNullWithItsReason) {
  const Scratch directory;
  const auto file = directory.path() / "arc.csv";
  {
    std::ofstream out(file);
    out << "x,y\n";
    for (int k = 0; k <= 20; ++k) {
      const double theta = 2.5 * k / 20.0 + 0.001 * (k % 3);
      out << fmt::format("{},{}\n", 25.0 * std::cos(theta), 25.0 * std::sin(theta));
    }
  }
  const json found = fit("circle", file);
  EXPECT_TRUE(found.at("mi").is_null());
  EXPECT_FALSE(found.at("mc").is_null());
  ASSERT_EQ(found["warnings"].size(), 2U);
  EXPECT_EQ(found["warnings"][0]["code"], "not-full-section");
  EXPECT_THAT(found["warnings"][0]["what"].get<std::string>(),
              ::testing::HasSubstr("leave 217 deg of the turn unseen"));
  EXPECT_EQ(found["warnings"][1]["code"], "reference-absent");
  EXPECT_THAT(found["warnings"][1]["what"].get<std::string>(),
              ::testing::HasSubstr("no maximum inscribed circle"));
}

TEST(FitJson, WithoutAProofThereIsNoGap) {
  const Scratch directory;
  const auto file = directory.path() / "ball.csv";
  {
    std::ofstream out(file);
    out << "x,y,z\n";
    for (int k = 0; k < 32; ++k) {  // exact: no contact tells the optimum from its neighbours
      const double across = 0.1 + core::kTwoPi * (k / 4) / 8.0;
      const double up = std::array{-1.0, -0.3, 0.4, 1.1}[static_cast<std::size_t>(k % 4)];
      out << fmt::format("{},{},{}\n", 25.0 * std::cos(across) * std::cos(up),
                         25.0 * std::sin(across) * std::cos(up), 25.0 * std::sin(up));
    }
  }
  const json found = fit("sphere", file);
  ASSERT_EQ(found["mz"]["certificate"]["kind"], "none");
  EXPECT_TRUE(found["mz"]["certificate"]["gap_mm"].is_null());
  const Outcome table = rondure({"fit", "sphere", file});
  EXPECT_EQ(table.status, 0);
  EXPECT_THAT(table.out, ::testing::Not(::testing::HasSubstr("inf")));
}

TEST(FitJson, OneReferenceLeavesTheOthersOut) {
  for (const auto& [shape, set] :
       {std::pair{"circle", "axle_mzc_3"}, std::pair{"cylinder", "nist_cyl_13"}}) {
    const auto file = source_dir() / "tests/data" / set / "points.csv";
    EXPECT_THAT(keys_of(fit(shape, file, "ls")),
                UnorderedElementsAre("shape", "points", "read", "ls", "warnings"));
    EXPECT_THAT(keys_of(fit(shape, file, "mz")),
                UnorderedElementsAre("shape", "points", "read", "mz", "warnings"));
  }
}

TEST(FitJson, OneReferenceGivesTheSameNumbersAsAll) {
  const auto file = source_dir() / "tests/data/nist_cyl_13/points.csv";
  const json all = fit("cylinder", file);
  EXPECT_EQ(fit("cylinder", file, "ls")["ls"], all["ls"]);
  EXPECT_EQ(fit("cylinder", file, "mz")["mz"], all["mz"]);
}

}  // namespace
}  // namespace rondure::app::testing
