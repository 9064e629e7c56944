// What points, datums and windows leave no value of a drawing, and what the refusal says to plan.

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

using Association = record::Indication::Association;
using Direction = record::Indication::Direction;
using record::Form;
using record::Shape;
using record::Side;
using test::about;
using test::along;
using test::DrawnPart;
using test::Layers;
using test::round_journal;
using test::why_refused;
using Space = std::vector<Eigen::Vector3d>;

TEST(DrawingRefusals, OfDatumsSayWhatToPlanInstead) {
  DrawnPart part;
  part.add("K", Shape::kCone, test::w7());
  part.plane("E", {test::w5_plane()});
  part.plane("F", test::w4_face());
  part.add("S", Shape::kCircle, {test::w3_a()[0]});
  Layers arc(2);
  for (int layer = 0; layer < 2; ++layer) {
    for (int k = 0; k < 8; ++k) {
      arc[static_cast<std::size_t>(layer)].emplace_back(
          9 * std::cos(0.3 * k), 9 * std::sin(0.3 * k), 20.0 * layer + 0.01 * (k % 3));
    }
  }
  part.cylinder("arc", arc, Side::kInside);
  part.cylinder("A", test::w3_a());
  part.cylinder("C", test::w3_c());
  const auto why = [&](std::vector<std::string> datum, Association association) {
    return why_refused(part, about(Form::kCoaxiality, std::move(datum), association)).what;
  };
  EXPECT_EQ(why({"K"}, Association::kLs),
            "datum \"K\": a cone gives no datum here; name a cylinder or a plane");
  EXPECT_EQ(why({"E-F"}, Association::kLs),
            "datum \"E-F\": a common datum is of cylinders; name one plane");
  EXPECT_EQ(why({"S"}, Association::kLs),
            "datum S has 1 section, an axis needs 2; name a common datum, e.g. \"A-B\"");
  for (const Association association :
       {Association::kOneSided, Association::kEqualised, Association::kLs, Association::kZone}) {
    for (const std::vector<std::string>& datum :
         {std::vector<std::string>{"arc"}, std::vector<std::string>{"E", "arc"}}) {
      EXPECT_EQ(why(datum, association),
                "datum arc: no axis rests on arc: layer 1: the points leave 240 deg of the turn "
                "unseen; measure the whole turn, and keep what windows and gaps leave open below "
                "180 deg");
    }
  }
  EXPECT_EQ(why({"E"}, Association::kLs),
            "coaxiality is about an axis: name a cylinder as datum, alone or after the plane");
  EXPECT_EQ(why({"E", "A-S"}, Association::kLs),
            "datum A-S: after a plane one cylinder gives the axis; name one");
  // Single sections apart from each other are a common datum.
  EXPECT_TRUE(part.last(about(Form::kCoaxiality, {"A-S"}, Association::kLs)).has_value());
}

TEST(DrawingRefusals, OfRunOutAndLocationSayWhatToPlanInstead) {
  const auto part_with = [](Shape shape, const Layers& layers) {
    DrawnPart out;
    out.cylinder("A", round_journal(10.0, {0.0, 40.0}, 16));
    out.add("X", shape, layers);
    return out;
  };
  const auto what = [&](Shape shape, const Layers& layers, const record::Characteristic& asked) {
    return why_refused(part_with(shape, layers), asked).what;
  };
  const auto run_out = about(Form::kRunOut, {"A"});
  EXPECT_EQ(what(Shape::kCylinder, test::w3_c(), along(run_out, Direction::kAxial)),
            "axial run-out is that of a face; of a cylinder ask for \"radial\"");
  EXPECT_EQ(what(Shape::kCylinder, test::w3_c(), along(run_out, Direction::kConical)),
            "conical run-out is that of a cone; of a cylinder ask for \"radial\"");
  EXPECT_EQ(what(Shape::kPlane, test::w4_face(), run_out),
            "radial run-out is that of a cylinder; of a plane ask for \"axial\"");
  EXPECT_EQ(what(Shape::kCircle, {test::w3_c()[0]}, about(Form::kCoaxiality, {"A"})),
            "1 section of X gives no direction; plan at least 2 layers, or ask for concentricity");
  EXPECT_EQ(what(Shape::kPlane, test::w4_face(), about(Form::kCoaxiality, {"A"})),
            "coaxiality is that of an axis, a plane has none: ask for run-out or "
            "perpendicularity");
  // A face of scattered points has no circle about the datum.
  EXPECT_EQ(
      why_refused(part_with(Shape::kPlane, {test::w5_plane()}), along(run_out, Direction::kAxial))
          .code,
      core::Code::kSampling);
  auto at_radius = along(run_out, Direction::kAxial);
  at_radius.indication.radius_mm = 20.0;
  EXPECT_EQ(what(Shape::kPlane, test::w4_face(), at_radius),
            "a face needs circles about the datum axis: layers are circles of the plane; no turn "
            "of points within 0.1 mm of radius 20.000 mm");
}

TEST(DrawingRunOut, OfACircleTouchedOnOneSideIsRefused) {
  DrawnPart part;
  part.cylinder("A", round_journal(10.0, {-60.0, -20.0}, 16));
  Layers half = virtual_face(15.0, 24);
  half[1].resize(11);
  part.plane("F", half);
  auto asked = along(about(Form::kRunOut, {"A"}), Direction::kAxial);
  EXPECT_EQ(why_refused(part, asked).code, core::Code::kSampling);
  asked.indication.radius_mm = 30.0;
  EXPECT_EQ(why_refused(part, asked).code, core::Code::kSampling);
  asked.indication.radius_mm = 15.0;
  EXPECT_GT(part.value(asked), 0.0);
}

TEST(DrawingDatums, OfMoreThanAQuarterOfTheTurnUnseenAreRefused) {
  const auto run_out = [](std::size_t count, Association association) {
    Layers open = round_journal(15.0, {0.0, 40.0}, 24);
    for (auto& layer : open) layer.resize(count);
    DrawnPart part;
    part.cylinder("A", open);
    part.cylinder("C", round_journal(20.0, {80.0, 100.0}, 24));
    return part.last(about(Form::kRunOut, {"A"}, association));
  };
  EXPECT_TRUE(run_out(19, Association::kLs).has_value());  // 90 deg open
  for (const Association association :
       {Association::kOneSided, Association::kEqualised, Association::kLs, Association::kZone}) {
    const auto refused = run_out(18, association);  // 105 deg open
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, core::Code::kReferenceAbsent);
  }
}

TEST(DrawingRefusals, OfHalfAFaceLeaveNoVerdict) {
  DrawnPart part;
  part.cylinder("A", round_journal(10.0, {-60.0, -20.0}, 16));
  const Layers whole = virtual_face(15.0, 24);
  Layers half = whole;
  for (auto& circle : half) circle.resize(13);
  const auto flatness = [] {
    record::Characteristic out;
    out.form = Form::kFlatness;
    return out;
  }();
  for (const auto& asked : {flatness, about(Form::kPerpendicularity, {"A"}),
                            along(about(Form::kTotalRunOut, {"A"}), Direction::kAxial)}) {
    SCOPED_TRACE(name_of(asked.form));
    DrawnPart seen = part;
    seen.plane("F", whole);
    ASSERT_TRUE(seen.last(asked).has_value());
    EXPECT_FALSE(seen.last(asked)->no_verdict.has_value());
    DrawnPart unseen = part;
    unseen.plane("F", half);
    ASSERT_TRUE(unseen.last(asked).has_value());
    EXPECT_TRUE(unseen.last(asked)->no_verdict.has_value());
  }
}

TEST(DrawingRefusals, OfAWindowOverHalfTheTurnLeaveNoVerdict) {
  record::SurfaceSettings settings;
  settings.exclude.emplace_back();
  settings.exclude.back().name = "flat";
  settings.exclude.back().from_deg = 80.0;
  settings.exclude.back().to_deg = 280.0;
  DrawnPart part;
  part.cylinder("A", round_journal(15.0, {0.0, 40.0}, 24));
  part.cylinder("C", round_journal(20.0, {80.0, 100.0}, 24)).feature.settings =
      record::settings_of_task(settings);
  for (const Form form : {Form::kRunOut, Form::kTotalRunOut, Form::kCoaxiality}) {
    SCOPED_TRACE(name_of(form));
    const auto found = part.last(about(form, {"A"}));
    ASSERT_TRUE(found.has_value()) << found.error().what;
    EXPECT_TRUE(found->no_verdict.has_value());
  }
}

TEST(DrawingRefusals, OfAPartOfTheTurnLeaveNoVerdict) {
  Layers open = round_journal(20.0, {80.0, 100.0}, 24,
                              [](double /*z*/) { return Eigen::Vector2d(0.002, 0.0); });
  for (auto& layer : open) layer.resize(15);  // 150 deg are not touched
  DrawnPart part;
  part.cylinder("A", round_journal(15.0, {0.0, 40.0}, 24));
  part.cylinder("C", open);
  for (const Form form :
       {Form::kRunOut, Form::kTotalRunOut, Form::kCoaxiality, Form::kParallelism}) {
    SCOPED_TRACE(name_of(form));
    auto asked = about(form, {"A"});
    asked.tolerance_mm = 0.01;
    const auto found = part.last(asked);
    ASSERT_TRUE(found.has_value()) << found.error().what;
    EXPECT_TRUE(found->no_verdict.has_value());
  }
  // The rest of the turn can only add to a run-out that fails already.
  auto asked = about(Form::kRunOut, {"A"});
  asked.tolerance_mm = 0.001;
  EXPECT_FALSE(part.last(asked)->no_verdict.has_value());
}

TEST(DrawingAttack, NoValueComesOutOfPointsThatFixNothing) {
  const auto with_datum = [](const Layers& layers) {
    DrawnPart out;
    out.cylinder("A", layers);
    out.cylinder("C", test::w3_c());
    return out;
  };
  Layers holed = test::w3_a();
  holed[1][3].x() = std::numeric_limits<double>::quiet_NaN();
  const Layers one_place(2, Space(6, Eigen::Vector3d(1.0, 2.0, 3.0)));
  Layers flat = test::w3_a();
  for (auto& p : flat[1]) p.z() -= 18.0;
  for (const Association association :
       {Association::kOneSided, Association::kEqualised, Association::kLs, Association::kZone}) {
    for (const Layers& layers : {holed, one_place, flat}) {
      EXPECT_FALSE(with_datum(layers).last(about(Form::kRunOut, {"A"}, association)).has_value());
    }
  }
  DrawnPart line;
  Layers row(1);
  for (int i = 0; i < 9; ++i) row[0].emplace_back(i, 2.0 * i, 0.0);
  line.plane("E", row);
  line.cylinder("C", test::w3_c());
  for (const Association association : {Association::kOneSided, Association::kLs}) {
    EXPECT_FALSE(line.last(about(Form::kPerpendicularity, {"E"}, association)).has_value());
  }
}

}  // namespace
}  // namespace rondure::evaluation
