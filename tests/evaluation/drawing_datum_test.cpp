// Datums, location and run-out of the characteristics of a drawing. Expected numbers: methods,
// drawing sections 10 and 12.

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
#include "tests/core/full.h"
#include "tests/evaluation/drawing_part.h"
#include "tests/fit/drawing_cases.h"

namespace rondure::evaluation {
namespace {

using Association = record::Indication::Association;
using Direction = record::Indication::Direction;
using record::Form;
using record::Side;
using test::about;
using test::along;
using test::DrawnPart;
using test::Layers;
using test::round_journal;
using test::turned_surface;
using test::why_refused;
using Space = std::vector<Eigen::Vector3d>;

DrawnPart stepped_shaft() {
  DrawnPart out;
  out.cylinder("A", test::w3_a());
  out.cylinder("B", test::w3_b());
  out.cylinder("C", test::w3_c());
  return out;
}

DrawnPart face_on_bore() {
  DrawnPart out;
  out.cylinder("D", test::w4_bore(), Side::kInside);
  out.plane("F", test::w4_face());
  return out;
}

/// The warning of a datum that rocks.
std::optional<core::Error> rocks(const Finding& found) {
  const auto at = std::ranges::find(found.warnings, core::Code::kSeveralOptima, &core::Error::code);
  return at == found.warnings.end() ? std::nullopt : std::optional(*at);
}

struct ShaftRow {
  const char* datum;
  Association association;
  double circular0, circular1, total, coaxiality, parallelism;
};

constexpr ShaftRow kShaftRows[] = {{"A-B", Association::kOneSided, 0.012915342347, 0.012284378989,
                                    0.017466571286, 0.013383231729, 0.000758773721},
                                   {"A-B", Association::kEqualised, 0.012950673898, 0.012327642478,
                                    0.017484243056, 0.013420164686, 0.000743553052},
                                   {"A-B", Association::kLs, 0.012668516176, 0.012214968814,
                                    0.017271967182, 0.013283035987, 0.000786017244},
                                   {"A-B", Association::kZone, 0.013008958618, 0.012325595843,
                                    0.017627258782, 0.013490347282, 0.000761987567},
                                   {"A", Association::kOneSided, 0.025787294547, 0.031191448253,
                                    0.033453338510, 0.031569999139, 0.002921705217},
                                   {"A", Association::kEqualised, 0.018164133017, 0.019483501407,
                                    0.023340545492, 0.020795802200, 0.001777621912},
                                   {"A", Association::kLs, 0.016698321232, 0.017958444899,
                                    0.022269250077, 0.018443767895, 0.001622578409}};

double digits(Association association, bool rocks) {
  if (association == Association::kEqualised) return 1e-8;
  return association == Association::kOneSided && rocks ? 1e-7 : 1e-10;
}

TEST(DrawingDatums, OfTheSteppedShaftGiveEveryRow) {
  const DrawnPart shaft = stepped_shaft();
  for (const ShaftRow& row : kShaftRows) {
    SCOPED_TRACE(row.datum + std::string(" ") + std::string(name_of(row.association)));
    const double near = digits(row.association, row.datum == std::string("A"));
    const auto run_out = shaft.last(about(Form::kRunOut, {row.datum}, row.association));
    ASSERT_TRUE(run_out.has_value()) << run_out.error().what;
    ASSERT_EQ(run_out->local.size(), 2U);
    EXPECT_NEAR(run_out->local[0].value_mm, row.circular0, near);
    EXPECT_NEAR(run_out->local[1].value_mm, row.circular1, near);
    EXPECT_EQ(run_out->worst, row.circular0 > row.circular1 ? 0U : 1U);
    EXPECT_EQ(run_out->judged.front().value_mm, run_out->local[run_out->worst].value_mm);
    const auto value = [&](Form form) {
      return shaft.value(about(form, {row.datum}, row.association));
    };
    EXPECT_NEAR(value(Form::kTotalRunOut), row.total, near);
    EXPECT_NEAR(value(Form::kCoaxiality), row.coaxiality, near);
    EXPECT_NEAR(value(Form::kParallelism), row.parallelism, near);
  }
}

TEST(DrawingDatums, StateTheValueAboutTheEqualisedOneBesideAOneSidedOne) {
  const DrawnPart shaft = stepped_shaft();
  for (const std::size_t row : {0U, 4U}) {
    const auto found =
        shaft.last(about(Form::kTotalRunOut, {kShaftRows[row].datum}, Association::kOneSided));
    ASSERT_TRUE(found.has_value()) << found.error().what;
    ASSERT_EQ(found->about_equalised_mm.size(), 1U);
    EXPECT_NEAR(found->about_equalised_mm[0], kShaftRows[row + 1].total, 1e-8);
  }
  for (const Association other : {Association::kLs, Association::kZone, Association::kEqualised}) {
    const auto found = shaft.last(about(Form::kTotalRunOut, {"A"}, other));
    ASSERT_TRUE(found.has_value());
    EXPECT_TRUE(found->about_equalised_mm.empty());
    EXPECT_FALSE(rocks(*found));
  }
}

TEST(DrawingDatums, ThatRockAreNamedWithTheirPlayLengthAndDistance) {
  const auto found = stepped_shaft().last(about(Form::kRunOut, {"A"}, Association::kOneSided));
  ASSERT_TRUE(found.has_value());
  ASSERT_TRUE(rocks(*found));
  EXPECT_NE(rocks(*found)->what.find("7.8 um"), std::string::npos) << rocks(*found)->what;
  ASSERT_EQ(found->datums.size(), 1U);
  EXPECT_NEAR(found->datums[0].play_mm, 7.822657e-3, 1e-8);
  EXPECT_NEAR(found->datums[0].length_mm, 18.06, 0.1);
  const auto number = [&](const std::string& name) {
    const auto at = std::ranges::find(found->numbers, name, &NamedNumber::name);
    return at == found->numbers.end() ? std::nan("") : at->value;
  };
  EXPECT_EQ(number("datum_length_mm"), found->datums[0].length_mm);
  EXPECT_NEAR(number("datum_distance_mm"), 82.0, 0.1);
  EXPECT_EQ(number("datum_play"), found->datums[0].play_mm);
  EXPECT_EQ(found->reference.english(), "about A, one-sided");
}

TEST(DrawingDatums, OfARockingBoreAreItsMaximumInscribedCylinder) {
  // The radius falls to second order only from where the contacts lie in one section.
  const Layers bore = {{{15.7195, 0.2556, 0.0046},
                        {-0.4723, 16.4492, 0.0282},
                        {-16.6654, 0.2556, -0.0071},
                        {-0.4723, -15.9374, -0.0355}},
                       {{15.7597, 0.1576, 48.554},
                        {-0.4352, 16.3538, 48.5697},
                        {-16.6314, 0.1576, 48.5653},
                        {-0.4352, -16.0379, 48.5238}}};
  DrawnPart part;
  part.cylinder("A", bore, Side::kInside);
  part.cylinder("C", test::w3_c());
  const auto found = part.last(about(Form::kRunOut, {"A"}, Association::kOneSided));
  ASSERT_TRUE(found.has_value()) << found.error().what;
  // By a search over all sets of contacts with 34 digits.
  EXPECT_NEAR(found->datums[0].radii_mm.at(0), 16.192441981600, 1e-9);
  const Eigen::Vector3d& w = found->datums[0].place.direction;
  EXPECT_NEAR(w.x() / w.z(), 0.000699977965, 1e-6);
  EXPECT_NEAR(w.y() / w.z(), -0.001965319848, 1e-6);
  EXPECT_TRUE(rocks(*found));
}

struct FaceRow {
  Association association;
  double inner, outer, total;
};

constexpr FaceRow kFaceRows[] = {
    {Association::kOneSided, 0.005448112342, 0.011596123586, 0.012402190616},
    {Association::kEqualised, 0.002917121726, 0.006534134314, 0.008706017281},
    {Association::kLs, 0.002626546172, 0.005769861751, 0.008123093357}};

TEST(DrawingDatums, OfAShortBoreGiveEveryRowOfItsFace) {
  const DrawnPart part = face_on_bore();
  for (const FaceRow& row : kFaceRows) {
    SCOPED_TRACE(name_of(row.association));
    const double near = digits(row.association, true);
    auto asked = along(about(Form::kRunOut, {"D"}, row.association), Direction::kAxial);
    const auto run_out = part.last(asked);
    ASSERT_TRUE(run_out.has_value()) << run_out.error().what;
    ASSERT_EQ(run_out->local.size(), 2U);
    EXPECT_EQ(run_out->local[0].place, LocalValue::Place::kRadius);
    EXPECT_NEAR(run_out->local[0].position, 15.0, 0.01);
    EXPECT_NEAR(run_out->local[1].position, 30.0, 0.01);
    EXPECT_NEAR(run_out->local[0].value_mm, row.inner, near);
    EXPECT_NEAR(run_out->local[1].value_mm, row.outer, near);
    EXPECT_EQ(run_out->worst, 1U);
    asked.indication.radius_mm = 15.0;
    EXPECT_NEAR(part.value(asked), row.inner, near);
    EXPECT_NEAR(
        part.value(along(about(Form::kTotalRunOut, {"D"}, row.association), Direction::kAxial)),
        row.total, near);
    EXPECT_NEAR(part.value(about(Form::kPerpendicularity, {"D"}, row.association)), row.total,
                near);
  }
}

TEST(DrawingDatums, OfACrownedPlaneAreThoseOfItsMinimumZone) {
  DrawnPart part;
  part.plane("E", {test::w5_plane()});
  part.cylinder("B", test::w5_bore(), Side::kInside);
  const auto value = [&](Association association) {
    return part.value(about(Form::kPerpendicularity, {"E"}, association));
  };
  EXPECT_NEAR(value(Association::kOneSided), 0.003710729147, 1e-10);
  EXPECT_NEAR(value(Association::kEqualised), 0.003710729147, 1e-10);
  EXPECT_NEAR(value(Association::kZone), 0.003710729147, 1e-10);
  EXPECT_NEAR(value(Association::kLs), 0.003748467537, 1e-10);
  const auto found = part.last(about(Form::kPerpendicularity, {"E"}, Association::kOneSided));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->judged[0].symbol, "PER \u00d8");
  EXPECT_TRUE(found->about_equalised_mm.empty());
}

TEST(DrawingDatums, OfAPlaneAndACylinderAreTheAxisAlongItsNormal) {
  DrawnPart part;
  part.plane("E", {test::w5_plane()});
  part.cylinder("B", test::w5_bore(), Side::kInside);
  auto other_bore = test::w5_bore();
  other_bore.back().pop_back();  // the same points would be the same feature
  part.cylinder("C", other_bore, Side::kInside);
  const auto found = part.last(about(Form::kCoaxiality, {"E", "B"}, Association::kOneSided));
  ASSERT_TRUE(found.has_value()) << found.error().what;
  ASSERT_EQ(found->datums.size(), 2U);
  EXPECT_TRUE(found->datums[0].plane);
  EXPECT_FALSE(found->datums[1].plane);
  EXPECT_NEAR(found->datums[1].radii_mm.at(0), 5.998453309577, 1e-10);
  const fit::Axis& axis = found->datums[1].place;
  const Eigen::Vector3d at_zero =
      axis.point_mm - axis.direction * (axis.point_mm.z() / axis.direction.z());
  EXPECT_NEAR(at_zero.x(), 9.996972056616, 1e-10);
  EXPECT_NEAR(at_zero.y(), 12.499954079720, 1e-10);
  // Perpendicularity asks for a direction only: the plane alone gives it.
  EXPECT_EQ(part.value(about(Form::kPerpendicularity, {"E", "B"})),
            part.value(about(Form::kPerpendicularity, {"E"})));
  for (const Association other : {Association::kLs, Association::kZone}) {
    const auto coaxiality = part.last(about(Form::kCoaxiality, {"E", "B"}, other));
    ASSERT_TRUE(coaxiality.has_value());
    EXPECT_NEAR(coaxiality->datums[1].radii_mm.at(0), 6.0, 2e-3);
  }
}

TEST(DrawingDatums, OfAnAxisAndAPlaneAreTheAxis) {
  DrawnPart part = face_on_bore();
  part.cylinder("C", test::w3_c());
  EXPECT_EQ(part.value(about(Form::kTotalRunOut, {"D", "F"})),
            part.value(about(Form::kTotalRunOut, {"D"})));
}

DrawnPart moved_part(const DrawnPart& part,
                     const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& move) {
  DrawnPart out = part;
  for (FeatureResult& feature : out.features) {
    for (CloudPoint& point : feature.cloud) point.tip_mm = move(point.tip_mm);
  }
  return out;
}

/// The points of each layer in another order, and the layers, too.
DrawnPart reordered(const DrawnPart& part) {
  DrawnPart out = part;
  for (FeatureResult& feature : out.features) {
    const int last = feature.feature.layers - 1;
    for (CloudPoint& point : feature.cloud) point.layer = last - point.layer;
    std::ranges::reverse(feature.cloud);
  }
  return out;
}

TEST(DrawingInvariance, ShiftTurnOrderMirrorAndSwap) {
  const DrawnPart part = stepped_shaft();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.3, Eigen::Vector3d(2, -1, 0.5).normalized()));
  const DrawnPart others[] = {
      moved_part(part,
                 [](const auto& p) { return Eigen::Vector3d(p + Eigen::Vector3d(1e3, 0, -1e3)); }),
      moved_part(part, [&](const auto& p) { return Eigen::Vector3d(turn * p); }),
      moved_part(part, [](const auto& p) { return Eigen::Vector3d(-p.x(), p.y(), p.z()); }),
      moved_part(part, [](const auto& p) { return Eigen::Vector3d(p.x(), -p.y(), -p.z()); }),
      reordered(part)};
  for (const Association association :
       {Association::kOneSided, Association::kEqualised, Association::kLs, Association::kZone}) {
    for (const Form form :
         {Form::kRunOut, Form::kTotalRunOut, Form::kCoaxiality, Form::kParallelism}) {
      SCOPED_TRACE(std::string(name_of(association)) + " " + std::string(name_of(form)));
      const double value = part.value(about(form, {"A-B"}, association));
      for (const DrawnPart& other : others) {
        EXPECT_NEAR(other.value(about(form, {"A-B"}, association)), value, 1e-9);
      }
      EXPECT_NEAR(part.value(about(form, {"B-A"}, association)), value, 1e-9);
    }
  }
}

TEST(DrawingInvariance, OfAFaceWhicheverWayItsAxisPoints) {
  const DrawnPart part = face_on_bore();
  const auto asked = along(about(Form::kRunOut, {"D"}), Direction::kAxial);
  const double value = part.value(asked);
  const Eigen::Quaterniond over(Eigen::AngleAxisd(3.0, Eigen::Vector3d(1, 2, 0).normalized()));
  const DrawnPart turned = moved_part(
      part, [&](const auto& p) { return Eigen::Vector3d(over * p + Eigen::Vector3d(0, 1e3, 0)); });
  EXPECT_NEAR(turned.value(asked), value, 1e-9);
  EXPECT_NEAR(reordered(part).value(asked), value, 1e-9);
}

TEST(DrawingDatums, DoNotChangeByDoubledPointsUnlessLeastSquares) {
  DrawnPart doubled = stepped_shaft();
  auto& cloud = doubled.features[0].cloud;
  const std::size_t count = cloud.size();
  for (std::size_t i = 0; i < count; ++i) cloud.push_back(cloud[i]);
  const DrawnPart part = stepped_shaft();
  const auto change = [&](Association association) {
    const auto asked = about(Form::kTotalRunOut, {"A-B"}, association);
    return std::abs(doubled.value(asked) - part.value(asked));
  };
  EXPECT_LT(change(Association::kOneSided), 1e-9);
  EXPECT_GT(change(Association::kLs), 1e-7);
}

TEST(DrawingRunOut, OfAnEccentricCylinderIsTwiceTheEccentricity) {
  DrawnPart part;
  part.cylinder("A", round_journal(15.0, {0.0, 20.0}, 24));
  part.cylinder("B", round_journal(12.0, {180.0, 200.0}, 24));
  // Points lie on the line of both axes, where the distance is greatest and least.
  part.cylinder("C", round_journal(20.0, {80.0, 100.0, 120.0}, 24, [](double z) {
                  return Eigen::Vector2d(0.05 + 1e-4 * (z - 80.0), 0.0);
                }));
  const auto found = part.last(about(Form::kRunOut, {"A-B"}, Association::kOneSided));
  ASSERT_TRUE(found.has_value()) << found.error().what;
  ASSERT_EQ(found->local.size(), 3U);
  EXPECT_NEAR(found->local[0].value_mm, 0.100, 1e-10);
  EXPECT_NEAR(found->local[1].value_mm, 0.104, 1e-10);
  EXPECT_NEAR(found->local[2].value_mm, 0.108, 1e-10);
  EXPECT_EQ(found->worst, 2U);
  EXPECT_NEAR(part.value(about(Form::kCoaxiality, {"A-B"})), 0.108, 1e-9);
}

TEST(DrawingDatums, OfPerfectFormAreTheirAxis) {
  for (const Association association :
       {Association::kOneSided, Association::kEqualised, Association::kLs}) {
    SCOPED_TRACE(name_of(association));
    for (const int count : test::full() ? std::vector{7, 36, 360} : std::vector{7, 36}) {
      for (const Side side : {Side::kOutside, Side::kInside}) {
        DrawnPart part;
        part.cylinder("A", round_journal(10.0, {-60.0, -40.0, -20.0}, count), side);
        part.plane("E", {round_journal(30.0, {2.0}, 36)[0], round_journal(15.0, {2.0}, 36)[0]});
        part.cylinder("C", round_journal(20.0, {20.0, 40.0}, 24,
                                         [](double /*z*/) { return Eigen::Vector2d(0.003, 0.0); }));
        EXPECT_NEAR(part.value(about(Form::kRunOut, {"A"}, association)), 0.006, 1e-8);
        EXPECT_NEAR(part.value(about(Form::kParallelism, {"A"}, association)), 0.0, 1e-8);
        EXPECT_NEAR(part.value(about(Form::kPerpendicularity, {"E"}, association)), 0.0, 1e-9);
        EXPECT_NEAR(part.value(about(Form::kRunOut, {"E", "A"}, association)), 0.006, 1e-8);
      }
    }
  }
}

TEST(DrawingDatums, OfAPerfectTaperHaveAnEqualisedAxis) {
  // All points of the narrow end touch, and round-off chooses among them.
  DrawnPart part;
  part.cylinder("A",
                {{{14.9931, 0.0, 0.0},
                  {9.3455, 11.7275, 0.0},
                  {-3.3447, 14.6239, 0.0},
                  {-13.5214, 6.5083, 0.0},
                  {-13.5214, -6.5083, 0.0},
                  {-3.3447, -14.6239, 0.0},
                  {9.3455, -11.7275, 0.0}},
                 {{14.9841, 0.0, 17.938},
                  {9.3398, 11.7204, 17.938},
                  {-3.3427, 14.6151, 17.938},
                  {-13.5133, 6.5043, 17.938},
                  {-13.5133, -6.5043, 17.938},
                  {-3.3427, -14.6151, 17.938},
                  {9.3398, -11.7204, 17.938}}},
                Side::kInside);
  part.cylinder("C", round_journal(20.0, {60.0, 70.0, 80.0}, 36,
                                   [](double /*z*/) { return Eigen::Vector2d(-0.0069, 0.0); }));
  EXPECT_LT(part.value(about(Form::kTotalRunOut, {"A"}, Association::kEqualised)), 1e-3);
}

TEST(DrawingRunOut, AboutItsOwnCircumscribedAxisIsTheCylindricity) {
  DrawnPart part;
  part.cylinder("A", test::w1());
  Layers again = test::w1();
  for (auto& layer : again) std::ranges::reverse(layer);
  part.cylinder("C", again);
  EXPECT_NEAR(part.value(about(Form::kTotalRunOut, {"A"}, Association::kOneSided)), 0.014990571544,
              1e-8);
}

/// The axes are those of the specification's table for C; distances from them by a program of its
/// own.
TEST(DrawingRunOut, OfAJournalAboutTheAxisThatItSharesWithAnother) {
  DrawnPart shaft = stepped_shaft();
  struct Row {
    std::size_t journal;
    Association association;
    double total_mm;
  };
  for (const Row& row :
       {Row{0, Association::kLs, 0.003447398356}, Row{1, Association::kLs, 0.002303955747},
        Row{0, Association::kOneSided, 0.003072264182},
        Row{1, Association::kOneSided, 0.002299917148}}) {
    const auto found = find(surfaces_of(shaft.features), row.journal,
                            about(Form::kTotalRunOut, {"A-B"}, row.association));
    ASSERT_TRUE(found.has_value()) << found.error().what;
    EXPECT_NEAR(found->judged[0].value_mm, row.total_mm, 1e-9);
  }
}

TEST(DrawingDatums, OfTheSamePointsUnderAnotherNameAreRefused) {
  DrawnPart part;
  part.cylinder("A", test::w1());
  part.cylinder("C", test::w1());
  for (const Form form : {Form::kRunOut, Form::kTotalRunOut, Form::kCoaxiality}) {
    EXPECT_EQ(
        why_refused(part, about(form, {"A"})).what,
        "datum \"A\": A and C have the same points, and a feature is no datum of itself; name "
        "another, or give each its own points");
  }
}

/// The virtual shaft of the specification, section 10, without noise.
DrawnPart virtual_shaft(int count) {
  DrawnPart out;
  out.cylinder("A", round_journal(15.0, {0.0, 25.0}, 36));
  out.cylinder("B", round_journal(15.0, {170.0, 195.0}, 36));
  out.cylinder("C", turned_surface({90.0, 101.0, 112.0}, count, [](double t, double z) {
                 const double r =
                     20.0 + 0.0016 * std::cos(2.0 * t - 0.2) + 0.006 * (z - 101.0) / 22.0;
                 return Eigen::Vector2d(0.0048 + 2e-5 * (z - 101.0) + r * std::cos(t),
                                        0.0031 - 4e-5 * (z - 101.0) + r * std::sin(t));
               }));
  return out;
}

Layers virtual_face(double step_mm, int count) {
  Layers out;
  for (double radius = 15.0; radius < 30.0 + 0.5 * step_mm; radius += step_mm) {
    out.emplace_back();
    const double q = radius / 30.0;
    for (int i = 0; i < count; ++i) {
      const double t = core::kTwoPi * i / count;
      out.back().emplace_back(
          radius * std::cos(t), radius * std::sin(t),
          0.0021 * q * std::cos(t - 0.9) - 0.0042 * q * q + 0.0012 * q * q * std::cos(2.0 * t));
    }
  }
  return out;
}

constexpr double kNanometre = 1e-6;

TEST(DrawingDatums, OfTheVirtualShaftGiveTheTruth) {
  const DrawnPart part = virtual_shaft(3600);
  const auto run_out = part.last(about(Form::kRunOut, {"A-B"}, Association::kOneSided));
  ASSERT_TRUE(run_out.has_value()) << run_out.error().what;
  ASSERT_EQ(run_out->local.size(), 3U);
  EXPECT_NEAR(run_out->local[0].value_mm, 12.8322472237e-3, kNanometre);
  EXPECT_NEAR(run_out->local[1].value_mm, 12.5850773204e-3, kNanometre);
  EXPECT_NEAR(run_out->local[2].value_mm, 12.3793349373e-3, kNanometre);
  EXPECT_EQ(run_out->worst, 0U);
  EXPECT_NEAR(part.value(about(Form::kTotalRunOut, {"A-B"}, Association::kOneSided)),
              18.9668157826e-3, kNanometre);
  EXPECT_NEAR(part.value(about(Form::kCoaxiality, {"A-B"}, Association::kOneSided)),
              11.5772190098e-3, kNanometre);
  // A few touched points never read more than the surface has.
  const DrawnPart touched = virtual_shaft(6);
  EXPECT_LE(touched.value(about(Form::kRunOut, {"A-B"})), 12.8322472237e-3 + kNanometre);
}

TEST(DrawingDatums, OfTheVirtualFaceGiveTheTruth) {
  DrawnPart part;
  part.cylinder("A", round_journal(10.0, {-60.0, -20.0}, 36));
  part.plane("F", virtual_face(0.25, 720));
  auto asked = along(about(Form::kRunOut, {"A"}, Association::kOneSided), Direction::kAxial);
  const auto found = part.last(asked);
  ASSERT_TRUE(found.has_value()) << found.error().what;
  EXPECT_EQ(found->local.size(), 61U);
  EXPECT_NEAR(found->local.front().value_mm, 2.3586891559e-3, kNanometre);
  EXPECT_NEAR(found->local.back().value_mm, 5.7029433643e-3, kNanometre);
  EXPECT_EQ(found->worst, 60U);
  asked.indication.radius_mm = 15.0;
  EXPECT_NEAR(part.value(asked), 2.3586891559e-3, kNanometre);
  EXPECT_NEAR(part.value(along(about(Form::kTotalRunOut, {"A"}), Direction::kAxial)),
              7.2588387416e-3, kNanometre);
  EXPECT_NEAR(part.value(about(Form::kPerpendicularity, {"A"})), 7.2588387416e-3, kNanometre);
}

TEST(DrawingRelations, BetweenRunOutAndLocationHold) {
  std::mt19937 random(19);
  std::normal_distribution<double> noise(0.0, 2e-3);
  const auto rough = [&](const Layers& layers) {
    Layers out = layers;
    for (auto& layer : out) {
      for (auto& p : layer) p += Eigen::Vector3d(noise(random), noise(random), 0.0);
    }
    return out;
  };
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    DrawnPart part;
    part.cylinder("A", rough(round_journal(15.0, {0.0, 20.0, 30.0}, 8)));
    part.cylinder("B", rough(round_journal(12.0, {100.0, 110.0}, 7)));
    part.cylinder("C", rough(round_journal(20.0, {50.0, 60.0, 70.0}, 9)));
    for (const Association association : {Association::kOneSided, Association::kLs}) {
      const auto value = [&](Form form) { return part.value(about(form, {"A-B"}, association)); };
      EXPECT_LE(value(Form::kRunOut), value(Form::kTotalRunOut));
      EXPECT_LE(value(Form::kParallelism), value(Form::kCoaxiality));
      EXPECT_EQ(value(Form::kConcentricity), value(Form::kCoaxiality));
    }
  }
}

TEST(DrawingLocation, ConcentricityIsOfTheNamedSections) {
  const DrawnPart part = stepped_shaft();
  auto asked = about(Form::kConcentricity, {"A-B"});
  asked.indication.section = record::Indication::Section::kSCS;
  asked.indication.section_layers = {2.0};
  const auto found = part.last(asked);
  ASSERT_TRUE(found.has_value()) << found.error().what;
  ASSERT_EQ(found->local.size(), 1U);
  EXPECT_EQ(found->local[0].layer, 1);
  EXPECT_EQ(found->judged[0].symbol, "CONC \u00d8");
  asked.indication.section_layers = {1.0};
  EXPECT_EQ(std::max(part.value(asked), found->judged[0].value_mm),
            part.value(about(Form::kCoaxiality, {"A-B"})));
  asked.indication.section_layers = {3.0};
  EXPECT_EQ(why_refused(part, asked).code, core::Code::kRank);
}

/// Plane through the origin whose normal leans by an angle to z, with a crown and a wave.
Layers leaning_plane(double angle_rad, double azimuth_rad, double form_mm) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(azimuth_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  Layers out(1);
  for (int i = -3; i <= 3; ++i) {
    for (int k = -2; k <= 2; ++k) {
      const double z = form_mm * std::cos(1.7 * i + 0.9 * k * k);
      out[0].push_back(turn * Eigen::Vector3d(8.0 * i, 7.0 * k, z));
    }
  }
  return out;
}

/// Least range over all normals at an angle to z, by brute force.
double least_range(const Space& points, double angle_rad, double azimuth_rad) {
  double least = 1e9;
  for (int i = -20000; i <= 20000; ++i) {
    const double t = azimuth_rad + 1e-7 * i;
    const Eigen::Vector3d n(std::sin(angle_rad) * std::cos(t), std::sin(angle_rad) * std::sin(t),
                            std::cos(angle_rad));
    double low = 1e9;
    double high = -1e9;
    for (const auto& p : points) {
      low = std::min(low, n.dot(p));
      high = std::max(high, n.dot(p));
    }
    least = std::min(least, high - low);
  }
  return least;
}

TEST(DrawingOrientation, OfAPlaneIsFreeToTurnAboutTheDatum) {
  const double nominal = 30.0 * core::kDegree;
  const Layers points = leaning_plane(nominal + 2e-4, 0.7, 0.003);
  DrawnPart part;
  part.cylinder("A", round_journal(10.0, {0.0, 40.0}, 16));
  part.plane("E", {leaning_plane(0.0, 0.0, 0.0)});
  part.plane("K", points);
  auto asked = about(Form::kAngularity, {"E"});
  asked.indication.angle_deg = 30.0;
  const double value = part.value(asked);
  EXPECT_NEAR(value, least_range(points[0], nominal, 0.7), 1e-8);
  EXPECT_LE(value, least_range(points[0], nominal, 0.7) + 1e-12);
  asked.indication.datum = {"A"};
  asked.indication.angle_deg = 60.0;
  EXPECT_NEAR(part.value(asked), value, 1e-9);
  asked.indication.angle_deg.reset();
  EXPECT_EQ(why_refused(part, asked).code, core::Code::kMissingKey);
  // The same zone by its other names.
  const Layers upright = leaning_plane(90.0 * core::kDegree + 1e-4, 2.1, 0.002);
  part.plane("L", upright);
  const double expected = least_range(upright[0], 0.25 * core::kTwoPi, 2.1);
  EXPECT_NEAR(part.value(about(Form::kPerpendicularity, {"E"})), expected, 1e-8);
  EXPECT_NEAR(part.value(about(Form::kParallelism, {"A"})), expected, 1e-8);
}

TEST(DrawingOrientation, OfAnAxisHasARoundZoneOnlyWhereItsDirectionIsThatOfTheDatum) {
  DrawnPart part;
  part.cylinder("A", round_journal(10.0, {0.0, 40.0}, 16));
  part.plane("E", {leaning_plane(0.0, 0.0, 0.0)});
  const auto leaning_cylinder = [](double angle_rad) {
    Layers out = round_journal(6.0, {-20.0, 0.0, 20.0}, 12);
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()))
                                     .toRotationMatrix();
    for (auto& layer : out) {
      for (auto& p : layer) p = turn * p;
    }
    return out;
  };
  const auto asked = [](Form form, const char* datum, double angle_deg) {
    auto out = about(form, {datum});
    if (form == Form::kAngularity) out.indication.angle_deg = angle_deg;
    return out;
  };
  const auto symbol = [&](const record::Characteristic& of) {
    return part.last(of)->judged.front().symbol;
  };
  constexpr double kLean = 1e-4;
  constexpr double kRange = 40.0 * kLean;  // of centres 40 mm apart; all but 1e-10 of it
  part.cylinder("G", leaning_cylinder(kLean));
  EXPECT_NEAR(part.value(asked(Form::kParallelism, "A", 0)), kRange, 1e-9);
  EXPECT_EQ(symbol(asked(Form::kParallelism, "A", 0)), "PAR \u00d8");
  EXPECT_NEAR(part.value(asked(Form::kPerpendicularity, "E", 0)), kRange, 1e-9);
  EXPECT_EQ(symbol(asked(Form::kPerpendicularity, "E", 0)), "PER \u00d8");
  EXPECT_NEAR(part.value(asked(Form::kAngularity, "A", 0)), kRange, 1e-9);
  EXPECT_EQ(symbol(asked(Form::kAngularity, "A", 0)), "ANG \u00d8");
  part.cylinder("H", leaning_cylinder(0.25 * core::kTwoPi + kLean));
  EXPECT_NEAR(part.value(asked(Form::kParallelism, "E", 0)), kRange, 1e-9);
  EXPECT_EQ(symbol(asked(Form::kParallelism, "E", 0)), "PAR");
  EXPECT_NEAR(part.value(asked(Form::kPerpendicularity, "A", 0)), kRange, 1e-9);
  EXPECT_EQ(symbol(asked(Form::kPerpendicularity, "A", 0)), "PER");
  part.cylinder("I", leaning_cylinder(50.0 * core::kDegree + kLean));
  EXPECT_NEAR(part.value(asked(Form::kAngularity, "A", 50)), kRange, 1e-9);
  EXPECT_NEAR(part.value(asked(Form::kAngularity, "E", 40)), kRange, 1e-9);
}

TEST(DrawingDatums, AreNamedByLetterOrIdAndSplitAtHyphens) {
  DrawnPart part;
  part.cylinder("left journal", test::w3_a()).feature.settings = {
      test::text_setting("letter", "A")};
  part.cylinder("right-journal", test::w3_b()).feature.settings = {
      test::text_setting("letter", "B")};
  part.cylinder("A-B", test::w3_a());
  part.cylinder("C", test::w3_c());
  const auto coaxiality = [&](const std::string& datum) {
    return about(Form::kCoaxiality, {datum});
  };
  // The whole text first: a feature may be called so.
  EXPECT_NEAR(part.value(coaxiality("A-B")), 0.018443767895, 1e-10);
  part.features[2].feature.id = "other";
  EXPECT_NEAR(part.value(coaxiality("A-B")), 0.013283035987, 1e-10);
  EXPECT_NEAR(part.value(coaxiality("left journal-B")), 0.013283035987, 1e-10);
  EXPECT_NEAR(part.value(coaxiality("left journal")), 0.018443767895, 1e-10);
  EXPECT_TRUE(part.last(coaxiality("right-journal")).has_value());
  EXPECT_EQ(why_refused(part, coaxiality("A-D")).what,
            "datum \"A-D\": no feature has the letter or id \"D\"; the plan has A, B, other, C");
  EXPECT_EQ(why_refused(part, coaxiality("A-A")).what, "datum \"A-A\" names \"A\" twice");
  EXPECT_EQ(why_refused(part, coaxiality("C")).what,
            "datum \"C\": a feature is no datum of itself");
  EXPECT_EQ(why_refused(part, coaxiality("C")).code, core::Code::kMeaning);
  EXPECT_EQ(why_refused(part, coaxiality("A-")).code, core::Code::kMeaning);
  EXPECT_EQ(why_refused(part, about(Form::kCoaxiality, {"A", "nothing"})).code,
            core::Code::kMeaning);
}

TEST(DrawingDatums, OfATrialAreTheStatedOnesAlone) {
  const DrawnPart shaft = stepped_shaft();
  const auto asked = about(Form::kTotalRunOut, {"A"}, Association::kOneSided);
  const auto trial = find(surfaces_of(shaft.features), 2, asked, Proof::kNone);
  ASSERT_TRUE(trial.has_value());
  EXPECT_EQ(trial->judged[0].value_mm, shaft.value(asked));
  EXPECT_TRUE(trial->about_equalised_mm.empty());
  EXPECT_FALSE(rocks(*trial));
}

/// Two cylinders, touched in the stated poses.
record::RunRecord two_clouds(const core::Pose& first, const core::Pose& second) {
  record::RunRecord out;
  out.ending = "finished";
  const Layers clouds[] = {round_journal(15.0, {0.0, 20.0}, 8),
                           round_journal(20.0, {60.0, 80.0}, 8)};
  for (int f = 0; f < 2; ++f) {
    record::Feature feature;
    feature.id = f == 0 ? "A" : "C";
    feature.layers = 2;
    feature.points_per_layer = 8;
    out.features.push_back(feature);
    out.poses.push_back({f, f, {}, f == 0 ? first : second, true, 0.0});
    for (int layer = 0; layer < 2; ++layer) {
      for (int i = 0; i < 8; ++i) {
        record::Touch touch;
        touch.id = static_cast<std::int64_t>(out.touches.size());
        touch.pose = f;
        touch.layer = layer;
        touch.point = i;
        touch.tip_mm = clouds[f][static_cast<std::size_t>(layer)][static_cast<std::size_t>(i)];
        touch.approach = -Eigen::Vector3d(touch.tip_mm.x(), touch.tip_mm.y(), 0.0).normalized();
        out.touches.push_back(touch);
      }
    }
  }
  return out;
}

core::Result<Finding> coaxiality_of(const record::RunRecord& record) {
  const auto evaluation = evaluate(record);
  if (!evaluation) return core::fail(evaluation.error());
  return find(surfaces_of(evaluation->features), 1, about(Form::kCoaxiality, {"A"}));
}

TEST(DrawingDatums, OfAnotherClampingAreRefused) {
  const core::Pose level{0.0, 0.0};
  const core::Pose leaning{0.02, 0.005};
  EXPECT_TRUE(coaxiality_of(two_clouds(level, level)).has_value());
  const auto apart = coaxiality_of(two_clouds(level, leaning));
  ASSERT_FALSE(apart.has_value());
  EXPECT_EQ(apart.error().code, core::Code::kMeaning);
  EXPECT_EQ(apart.error().what,
            "datum A: A was measured in pose (0, 0) deg and C in (1.14592, 0.286479) deg: measure "
            "both in one pose, e.g. with pose_search.strategy \"start-pose\"");
  auto moved_between = two_clouds(level, level);
  moved_between.decisions.push_back(
      {-1, 0.0, {core::MessageCode::kPartLocatedAgain, {16.0, std::string("moved")}}});
  EXPECT_FALSE(coaxiality_of(moved_between).has_value());
  moved_between.decisions.back().message.arguments[0] = 0.0;  // before both
  EXPECT_TRUE(coaxiality_of(moved_between).has_value());
}

TEST(DrawingDatums, AreTakenToTheTemperatureOfTheFeature) {
  DrawnPart part = stepped_shaft();
  const auto asked = about(Form::kTotalRunOut, {"A-B"});
  ThermalCorrection warm;
  warm.part_expansion_1_K = 1.15e-5;
  warm.part_degC = 24.0;
  ThermalCorrection cool = warm;
  cool.part_degC = 20.0;
  part.features[2].thermal = cool;
  EXPECT_EQ(why_refused(part, asked).what,
            "datum A-B: C is corrected to 20 degC and A is as measured: plan the same for both");
  part.features[0].thermal = warm;
  part.features[1].thermal = warm;
  DrawnPart scaled = stepped_shaft();
  for (const std::size_t i : {0U, 1U}) {
    for (CloudPoint& point : scaled.features[i].cloud) point.tip_mm *= 1.0 + 4.0 * 1.15e-5;
  }
  EXPECT_NEAR(part.value(asked), scaled.value(asked), 1e-12);
}

TEST(DrawingDatums, OfAnotherFileNeedTheSameClampingName) {
  const auto files = [](const std::string& first, const std::string& second) {
    auto out = two_clouds({}, {});
    out.features[0].points_sha256 = first;
    out.features[1].points_sha256 = second;
    for (auto& feature : out.features) feature.strategy = record::Strategy::kPointsFile;
    return out;
  };
  EXPECT_TRUE(coaxiality_of(files("one", "one")).has_value());
  EXPECT_FALSE(coaxiality_of(files("one", "two")).has_value());
  EXPECT_FALSE(coaxiality_of(files("", "")).has_value());
  auto named = files("one", "two");
  for (auto& feature : named.features) feature.settings = {test::text_setting("clamping", "chuck")};
  EXPECT_TRUE(coaxiality_of(named).has_value());
  named.features[1].settings = {test::text_setting("clamping", "vice")};
  EXPECT_FALSE(coaxiality_of(named).has_value());
  for (auto& feature : named.features) feature.points_sha256 = "one";
  const auto apart = coaxiality_of(named);
  ASSERT_FALSE(apart.has_value()) << "one file, two clampings";
  EXPECT_NE(apart.error().what.find("A was measured in clamping \"chuck\" and C in \"vice\""),
            std::string::npos)
      << apart.error().what;
  auto mixed = files("one", "one");
  mixed.features[1].strategy = record::Strategy::kGuided;
  EXPECT_FALSE(coaxiality_of(mixed).has_value());
}

}  // namespace
}  // namespace rondure::evaluation
