// Planes, cones, spheres and sizes through `rondure fit`. Expected numbers: methods, drawing
// section 12.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/fit/drawing_cases.h"

namespace rondure::app::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Words = std::vector<std::string>;

constexpr double kDigits = 1e-10;

std::string row(const Eigen::Vector3d& p, const std::string& more) {
  return fmt::format("{:.6f},{:.6f},{:.6f}{}\n", p.x(), p.y(), p.z(), more);
}

/// Rows of the layers, each with its number and with more columns.
std::string layered(const test::Layers& layers, const std::string& more = "") {
  std::string out;
  for (std::size_t j = 0; j < layers.size(); ++j) {
    for (const auto& p : layers[j]) out += row(p, fmt::format(",{}", j) + more);
  }
  return out;
}

std::string plain(const std::vector<Eigen::Vector3d>& points) {
  std::string out = "x,y,z\n";
  for (const auto& p : points) out += row(p, "");
  return out;
}

Outcome fit_of(const std::string& shape, const std::string& text, const Words& more = {}) {
  const Scratch folder;
  write(folder / "points.csv", text);
  Words words = {"fit", shape, folder / "points.csv"};
  words.insert(words.end(), more.begin(), more.end());
  return rondure(words);
}

json found_in(const std::string& shape, const std::string& text, Words more = {}) {
  more.emplace_back("--json");
  const Outcome outcome = fit_of(shape, text, more);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.status == 0 ? json::parse(outcome.out) : json();
}

const Words kShaftSizes = {"--size", "GG,GN,GX,GC,LP", "--tip-diameter-mm", "2.9974"};

void expect_sizes_of_w1(const json& sizes) {
  EXPECT_NEAR(sizes.at("GG_mm"), 24.990122662043, kDigits);
  EXPECT_NEAR(sizes.at("GN_mm"), 25.003379302565, kDigits);
  EXPECT_NEAR(sizes.at("GX_mm"), 24.977528966340, kDigits);
  EXPECT_NEAR(sizes.at("GC_mm"), 24.990454189110, kDigits);
  const json& local = sizes.at("LP");
  EXPECT_EQ(local.at("pairs"), 18);
  EXPECT_NEAR(local.at("SX_mm"), 24.992295033840, kDigits);
  EXPECT_NEAR(local.at("SN_mm"), 24.987814866940, kDigits);
  EXPECT_NEAR(local.at("SA_mm"), 24.990122662068, kDigits);
  EXPECT_NEAR(local.at("SM_mm"), 24.990321456530, kDigits);
  EXPECT_NEAR(local.at("SD_mm"), 24.990054950390, kDigits);
  EXPECT_NEAR(local.at("SR_mm"), 0.004480166900, kDigits);
  EXPECT_NEAR(local.at("SQ_mm"), 0.001499276509, kDigits);
}

TEST(FitSizes, AreThoseOfTheThreeLobedShaft) {
  const json of_layers = found_in("cylinder", "x,y,z,layer\n" + layered(test::w1()), kShaftSizes);
  EXPECT_FALSE(of_layers.at("sizes").at("inside"));
  expect_sizes_of_w1(of_layers.at("sizes"));
  EXPECT_NEAR(of_layers.at("mz").at("deviation_mm"), 0.012925222992, kDigits);
  // Without the column, layers are told apart by their heights.
  const json of_heights = found_in("cylinder", plain(test::all_of(test::w1())), kShaftSizes);
  expect_sizes_of_w1(of_heights.at("sizes"));
  // The mating size alone is that of the surface for any tip.
  const Outcome text = fit_of("cylinder", plain(test::all_of(test::w1())), kShaftSizes);
  EXPECT_THAT(text.out, HasSubstr("sizes of an outer surface, tip diameter 2.9974 mm\n"));
  EXPECT_THAT(text.out, HasSubstr("    GG 24.990123 mm, as felt by the tip\n"));
  EXPECT_THAT(text.out, HasSubstr("    GN 25.003379 mm\n"));
  EXPECT_THAT(text.out, HasSubstr("LP of 18 pairs, as felt by the tip\n      SX 24.992295"));
}

TEST(FitSizes, OfABoreAddTheTip) {
  test::Layers bore = test::w6();
  for (auto& layer : bore) layer.erase(layer.begin() + 4);  // the keyway
  const Words size = {"--size", "GG,GX,LP", "--tip-diameter-mm", "3", "--inside"};
  const json sizes = found_in("cylinder", plain(test::all_of(bore)), size).at("sizes");
  EXPECT_TRUE(sizes.at("inside"));
  EXPECT_NEAR(sizes.at("GG_mm"), 39.999953257850, kDigits);
  EXPECT_NEAR(sizes.at("GX_mm"), 39.994130396679, kDigits);
  EXPECT_FALSE(sizes.contains("GN_mm"));
  EXPECT_EQ(sizes.at("LP").at("pairs"), 14);
  EXPECT_NEAR(sizes.at("LP").at("SX_mm"), 40.005130701989, kDigits);
  EXPECT_NEAR(sizes.at("LP").at("SN_mm"), 39.994129828310, kDigits);
  EXPECT_THAT(fit_of("cylinder", plain(test::all_of(bore)), size).out,
              HasSubstr("    GX 39.994130 mm\n"));
}

TEST(FitSizes, ThatDoNotExistAreNullWithTheirReason) {
  test::Layers odd = test::w1();
  odd[1].pop_back();
  odd[1].erase(odd[1].begin(), odd[1].begin() + 5);  // one half turn: no point has its opposite
  const json found = found_in("cylinder", "x,y,z,layer\n" + layered(odd), {"--size", "GG,LP"});
  EXPECT_TRUE(found.at("sizes").at("LP").is_null());
  EXPECT_FALSE(found.at("sizes").at("GG_mm").is_null());
  ASSERT_EQ(found.at("warnings").size(), 1U) << found.at("warnings");
  EXPECT_EQ(found.at("warnings")[0].at("code"), "sampling");
  EXPECT_THAT(found.at("warnings")[0].at("what").get<std::string>(),
              HasSubstr("section 2 of 3, of 6 points, has no two points opposite"));
  // An upper half, as a reference sphere is touched, holds no inscribed sphere.
  const json cap = found_in("sphere", plain(test::w10()), {"--size", "GG,GX"});
  EXPECT_TRUE(cap.at("sizes").at("GX_mm").is_null());
  EXPECT_THAT(cap.dump(), HasSubstr("reference-absent"));
}

TEST(FitSizes, OfASectionAndOfABallAreTheirs) {
  const auto ring = test::w1().front();
  std::string flat = "x,y\n";
  for (const auto& p : ring) flat += fmt::format("{:.6f},{:.6f}\n", p.x(), p.y());
  const json circle = found_in("circle", flat, {"--size", "GN,LP"});
  EXPECT_NEAR(circle.at("sizes").at("GN_mm"), 2.0 * circle.at("mc").at("radius_mm").get<double>(),
              kDigits);
  EXPECT_EQ(circle.at("sizes").at("LP").at("pairs"), 6);

  const json ball = found_in("sphere", plain(test::w10()),
                             {"--size", "GG,GC", "--tip-diameter-mm", "3", "--inside"});
  EXPECT_NEAR(ball.at("ls").at("radius_mm"), 14.499006959907, kDigits);
  EXPECT_NEAR(ball.at("ls").at("deviation_mm"), 0.000804625049, kDigits);
  EXPECT_NEAR(ball.at("mz").at("deviation_mm"), 0.0006, kDigits);
  EXPECT_NEAR(ball.at("mz").at("outer_radius_mm"), 14.499399912845, kDigits);
  EXPECT_THAT(ball.at("mz").at("contacts").at("outer"), ElementsAre(3, 5, 8));
  EXPECT_THAT(ball.at("mz").at("contacts").at("inner"), ElementsAre(4, 6));
  EXPECT_NEAR(ball.at("sizes").at("GG_mm"), 2.0 * (14.499006959907 + 1.5), kDigits);
  EXPECT_NEAR(ball.at("sizes").at("GC_mm"), 2.0 * (14.499399912845 - 0.0003 + 1.5), kDigits);
}

TEST(FitSizes, NeedATipThatFitsThePart) {
  for (const std::string shape : {"cylinder", "cone"}) {
    Words more = {"--tip-diameter-mm", "60"};
    if (shape == "cylinder") more.insert(more.end(), {"--size", "GG"});
    const Outcome outcome =
        fit_of(shape, plain(test::all_of(shape == "cone" ? test::w7() : test::w1())), more);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("check --tip-diameter-mm; a bore needs --inside"));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(FitPlane, GivesTheFlatnessOfTheFaceWithASaucer) {
  const std::string part = "x,y,z,layer,feature\n" + layered(test::w4_bore(), ",bore D") +
                           layered(test::w4_face(), ",face F");
  const json found = found_in("plane", part, {"--feature", "face F", "--outward", "0,0,1"});
  EXPECT_EQ(found.at("feature"), "face F");
  EXPECT_EQ(found.at("points"), 24);
  EXPECT_THAT(found.at("warnings"), IsEmpty());
  const json& ls = found.at("ls");
  EXPECT_NEAR(ls.at("deviation_mm"), 0.005428189038, kDigits);
  EXPECT_NEAR(ls.at("peak_mm"), 0.002344499915, kDigits);
  EXPECT_NEAR(ls.at("valley_mm"), 0.003083689123, kDigits);
  EXPECT_NEAR(ls.at("rms_mm"), 0.001829028978, kDigits);
  const json& mz = found.at("mz");
  EXPECT_NEAR(mz.at("deviation_mm"), 0.005350052640, kDigits);
  EXPECT_THAT(mz.at("contacts").at("outer"), ElementsAre(1, 7));  // rows 13, 19 of the part
  EXPECT_THAT(mz.at("contacts").at("inner"), ElementsAre(15, 21));
  EXPECT_EQ(mz.at("certificate").at("kind"), "global");

  const json below = found_in("plane", part, {"--feature", "face F", "--outward", "0.1,0,-1"});
  EXPECT_NEAR(below.at("ls").at("peak_mm"), 0.003083689123, kDigits);
  EXPECT_THAT(below.at("mz").at("contacts").at("outer"), ElementsAre(15, 21));
  const json sideless = found_in("plane", part, {"--feature", "face F"});
  EXPECT_EQ(sideless.at("ls"), ls);
  EXPECT_THAT(sideless.at("warnings").dump(), HasSubstr("the side of the material is not stated"));
}

TEST(FitPlane, GivesTheOuterPlaneOfTheCrownedPlane) {
  const json mz =
      found_in("plane", plain(test::w5_plane()), {"--reference", "mz", "--outward", "0,0,1"})
          .at("mz");
  EXPECT_NEAR(mz.at("deviation_mm"), 0.00635, kDigits);
  EXPECT_THAT(mz.at("contacts").at("outer"), ElementsAre(6, 7));
  const auto normal = mz.at("plane").at("normal").get<std::vector<double>>();
  EXPECT_NEAR(normal[0] / normal[2], 3.75e-6, 1e-12);
  EXPECT_NEAR(normal[1] / normal[2], -8e-6, 1e-12);
  // It touches the two highest points.
  const auto at = mz.at("plane").at("point_mm").get<std::vector<double>>();
  const Eigen::Vector3d high = test::w5_plane()[6];
  EXPECT_NEAR(normal[0] * (high.x() - at[0]) + normal[1] * (high.y() - at[1]) +
                  normal[2] * (high.z() - at[2]),
              0.0, kDigits);
  const Outcome text = fit_of("plane", plain(test::w5_plane()), {"--outward", "0,0,1"});
  EXPECT_THAT(text.out, HasSubstr("MZPL  deviation 6.3500 um\n    outer (one-sided) plane"));
  EXPECT_THAT(text.out, HasSubstr("contacts +6 +7 -0 -14"));
}

TEST(FitCone, GivesTheWorkedExample) {
  const std::string file = plain(test::all_of(test::w7()));
  const json found = found_in("cone", file);
  const json& ls = found.at("ls");
  EXPECT_NEAR(ls.at("full_angle_deg"), 19.999348718107, kDigits);
  EXPECT_NEAR(ls.at("diameter_mm"), 35.172166985417, kDigits);
  EXPECT_NEAR(ls.at("deviation_mm"), 0.006448422130, kDigits);
  EXPECT_NEAR(ls.at("rms_mm"), 0.001772115874, kDigits);
  const auto along = ls.at("axis").at("direction").get<std::vector<double>>();
  EXPECT_NEAR(along[0] / along[2], 0.00019696673504, 1e-12);
  EXPECT_NEAR(along[1] / along[2], -0.00009347580125, 1e-12);
  const json& mz = found.at("mz");
  EXPECT_NEAR(mz.at("deviation_mm"), 0.005292692947, kDigits);
  EXPECT_NEAR(mz.at("full_angle_deg"), 19.998538403922, kDigits);
  EXPECT_THAT(mz.at("contacts").at("outer"), ElementsAre(4, 8, 19));
  EXPECT_THAT(mz.at("contacts").at("inner"), ElementsAre(2, 7, 17, 22));
  EXPECT_EQ(mz.at("certificate").at("kind"), "local");
  EXPECT_THAT(found.at("warnings"), IsEmpty());
  EXPECT_THAT(fit_of("cone", file).out,
              HasSubstr("full angle 19.999349 deg, diameter 35.172167 mm at the point"));
  // The surface lies one tip radius closer, normal to itself: 2 rho / cos(half angle) square to z.
  const json surface = found_in("cone", file, {"--tip-diameter-mm", "2", "--reference", "ls"});
  const double half = 0.5 * 19.999348718107 * 3.14159265358979323846 / 180.0;
  EXPECT_NEAR(surface.at("ls").at("diameter_mm"), 35.172166985417 - 2.0 / std::cos(half), kDigits);
  const json bore =
      found_in("cone", file, {"--tip-diameter-mm", "2", "--inside", "--reference", "ls"});
  EXPECT_NEAR(bore.at("ls").at("diameter_mm"), 35.172166985417 + 2.0 / std::cos(half), kDigits);
}

TEST(FitFeatures, OfAFileAreToldApart) {
  const std::string file = (source_dir() / "tests/data/shaft_drawing/shaft.csv").string();
  const Outcome none = rondure({"fit", "cylinder", file});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("holds the features \"A\", \"B\", \"C\", \"D\""));
  const Outcome other = rondure({"fit", "cylinder", file, "--feature", "E"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("no row is of feature \"E\""));
  const Outcome named = fit_of("sphere", plain(test::w10()), {"--feature", "E"});
  EXPECT_EQ(named.status, 2);
  EXPECT_THAT(named.err, HasSubstr("the file has no column feature"));
  const std::string latin = "Fl\xE4";
  const std::string part = "x,y,z,layer,feature\n" + layered(test::w4_face(), "," + latin);
  EXPECT_EQ(found_in("plane", part, {"--feature", latin}).at("feature"), "Fl\uFFFD");
  const Outcome a = rondure({"fit", "cylinder", file, "--feature", "A"});
  EXPECT_THAT(a.out, HasSubstr("cylinder A, 24 points\n"));
}

}  // namespace
}  // namespace rondure::app::testing
