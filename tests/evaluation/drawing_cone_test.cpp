// Run-out of cones: normal to the surface, at the heights that were touched.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "evaluation/evaluate.h"
#include "evaluation/part/internal/families.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"
#include "tests/evaluation/drawing_part.h"
#include "tests/fit/drawing_cases.h"

namespace rondure::evaluation {
namespace {

using Direction = record::Indication::Direction;
using record::Form;
using record::Shape;
using test::about;
using test::along;
using test::DrawnPart;
using test::Layers;
using test::round_journal;

/// A surface as prepared() makes it of whole layers; for shapes whose fit is not of interest here.
PreparedSurface prepared_by_hand(const FeatureResult& feature) {
  PreparedSurface out;
  out.of = &feature;
  for (std::size_t row = 0; row < feature.cloud.size(); ++row) {
    const CloudPoint& point = feature.cloud[row];
    if (point.layer == static_cast<int>(out.sections.size())) {
      out.sections.push_back({.layer = point.layer, .height_mm = point.tip_mm.z(), .points = {}});
    }
    out.sections.back().points.push_back(row);
    out.points_mm.push_back(point.tip_mm);
    out.rows.push_back(row);
  }
  return out;
}

/// The z axis through the origin.
DatumResult z_axis() {
  DatumResult out;
  out.name = "Z";
  return out;
}

TEST(DrawingRunOut, OfAConeIsNormalToItsSurface) {
  DrawnPart part;
  auto& cone = part.add("K", Shape::kCone, test::w7());
  const std::vector<DatumResult> datums = {z_axis()};
  const auto find = [&](const record::Characteristic& asked) {
    return find_run_out(prepared_by_hand(cone), asked, datums);
  };
  const auto asked = about(Form::kRunOut, {"Z"});
  EXPECT_EQ(find(along(asked, Direction::kConical)).error().code, core::Code::kMissingKey);
  cone.feature.settings = {test::number_setting("half_angle_deg", 10.0)};
  const auto square = find(asked);
  const auto normal = find(along(asked, Direction::kConical));
  ASSERT_TRUE(square.has_value()) << square.error().what;
  ASSERT_TRUE(normal.has_value()) << normal.error().what;
  const double expected[][2] = {{0.015056806218, 0.014828059499},
                                {0.020483091278, 0.020171907096},
                                {0.026931105214, 0.026521961212}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(square->local[i].value_mm, expected[i][0], 1e-10);
    EXPECT_NEAR(normal->local[i].value_mm, expected[i][1], 1e-10);
  }
  EXPECT_EQ(normal->worst, 2U);
  for (const double planned_deg : {-10.0, 8.9, 11.1, 75.0}) {
    cone.feature.settings = {test::number_setting("half_angle_deg", planned_deg)};
    const auto other = find(along(asked, Direction::kConical));
    ASSERT_FALSE(other.has_value()) << planned_deg;
    EXPECT_NE(other.error().what.find("show a half angle of 10.0"), std::string::npos)
        << other.error().what;
  }
  EXPECT_EQ(find(about(Form::kTotalRunOut, {"Z"})).error().what,
            "radial run-out is that of a cylinder; of a cone ask for \"conical\"");
  EXPECT_EQ(find(along(about(Form::kTotalRunOut, {"Z"}), Direction::kConical)).error().what,
            "total run-out is radial or axial; of a cone ask for run-out");
}

/// An ideal cone that sits 0.05 mm askew under the machine is touched at heights that differ.
Layers askew_cone() {
  Layers touched(2);
  for (int layer = 0; layer < 2; ++layer) {
    for (int k = 0; k < 12; ++k) {
      const double theta = k * core::kTwoPi / 12.0;
      const double z = 10.0 * layer + 0.05 * std::cos(theta);
      const double r = 18.0 - z * std::tan(15.0 * core::kDegree);
      touched[static_cast<std::size_t>(layer)].emplace_back(r * std::cos(theta),
                                                            r * std::sin(theta), z);
    }
  }
  return touched;
}

TEST(DrawingRunOut, OfATouchedConeCountsEachPointAtTheHeightWhereItWasTouched) {
  DrawnPart part;
  auto& cone = part.add("K", Shape::kCone, askew_cone());
  cone.clamping->file.reset();
  cone.feature.settings = {test::number_setting("half_angle_deg", -15.0)};
  const std::vector<DatumResult> datums = {z_axis()};
  for (const Direction direction : {Direction::kRadial, Direction::kConical}) {
    const auto found =
        find_run_out(prepared_by_hand(cone), along(about(Form::kRunOut, {"Z"}), direction), datums);
    ASSERT_TRUE(found.has_value()) << found.error().what;
    EXPECT_NEAR(found->judged.front().value_mm, 0.0, 1e-12);
  }
}

TEST(DrawingRunOut, OfAConeInAFileHasNoVerdictWhereHeightsDecide) {
  DrawnPart part;
  const auto& cone = part.add("K", Shape::kCone, askew_cone());
  const std::vector<DatumResult> datums = {z_axis()};
  const auto find = [&](double limit_mm) {
    record::Characteristic asked = about(Form::kRunOut, {"Z"});
    asked.tolerance_mm = limit_mm;
    return find_run_out(prepared_by_hand(cone), asked, datums);
  };
  const auto near = find(0.010);
  ASSERT_TRUE(near.has_value()) << near.error().what;
  ASSERT_TRUE(near->no_verdict);
  EXPECT_EQ(near->no_verdict->english(),
            "the rows of a layer lie at different heights: 26.795 um as read, 0.000 um brought to "
            "one height along the cone; measure each layer at one height");
  EXPECT_FALSE(find(0.030)->no_verdict) << "both ways within the limit";
}

TEST(DrawingRunOut, OfAConeNeedsTwoLayers) {
  DrawnPart part;
  auto& cone = part.add("K", Shape::kCone, {askew_cone().front()});
  cone.feature.settings = {test::number_setting("half_angle_deg", -15.0)};
  const auto found =
      find_run_out(prepared_by_hand(cone), along(about(Form::kRunOut, {"Z"}), Direction::kConical),
                   std::vector<DatumResult>{z_axis()});
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, core::Code::kSampling) << found.error().what;
}

TEST(DrawingRunOut, OfAConeIsAboutTheDatumOfThePart) {
  DrawnPart part;
  part.cylinder("Z", round_journal(10.0, {-40.0, -20.0}, 8));
  part.add("K", Shape::kCone, test::w7()).feature.settings = {
      test::number_setting("half_angle_deg", 10.0)};
  EXPECT_NEAR(part.value(along(about(Form::kRunOut, {"Z"}), Direction::kConical)), 0.026521961212,
              1e-10);
}

}  // namespace
}  // namespace rondure::evaluation
