#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/part/internal/families.h"
#include "fit/least_squares/cylinder.h"
#include "fit/profiles/profile_filter.h"
#include "fit/references/min_zone.h"
#include "tests/evaluation/drawing_part.h"
#include "tests/evaluation/drawing_surface.h"

// Expected numbers: methods, drawing section 12; tolerances: section 13.

namespace rondure::evaluation {
namespace {

using record::Form;
using record::Reference;
using test::asked;
using test::drawn;
using test::DrawnSurface;
using Indication = record::Indication;
using testing::UnorderedElementsAre;

constexpr double kFormDigits = 1e-10;

record::Characteristic asked_about(Form form, Reference reference,
                                   Indication::Parameter parameter) {
  record::Characteristic out = asked(form, reference);
  out.indication.parameter = parameter;
  return out;
}

Finding form_of(const DrawnSurface& part, const record::Characteristic& asked,
                Proof proof = Proof::kFull) {
  auto finding = find_form(part.surface, asked, proof);
  EXPECT_TRUE(finding.has_value()) << finding.error().what;
  if (finding) return *std::move(finding);
  Finding none;
  none.judged.push_back({"none", NAN, {}});
  return none;
}

double form_value(const DrawnSurface& part, Form form, Reference reference,
                  Indication::Parameter parameter = Indication::Parameter::kTotal,
                  Proof proof = Proof::kFull) {
  return form_of(part, asked_about(form, reference, parameter), proof).judged.front().value_mm;
}

TEST(DrawingForm, OfW1HasEveryDigit) {
  const auto part = drawn(test::w1(), {false, 1.4987});
  for (const Proof proof : {Proof::kFull, Proof::kNone}) {
    const auto total = [&](Reference reference) {
      return form_value(part, Form::kCylindricity, reference, Indication::Parameter::kTotal, proof);
    };
    EXPECT_NEAR(total(Reference::kLeastSquares), 0.013274091480, kFormDigits);
    EXPECT_NEAR(total(Reference::kMinimumZone), 0.012925222992, kFormDigits);
    EXPECT_NEAR(total(Reference::kMinimumCircumscribed), 0.014990571544, kFormDigits);
    EXPECT_NEAR(total(Reference::kMaximumInscribed), 0.013103715746, kFormDigits);
  }
  const auto about_ls = [&](Indication::Parameter parameter) {
    return form_value(part, Form::kCylindricity, Reference::kLeastSquares, parameter);
  };
  EXPECT_NEAR(about_ls(Indication::Parameter::kPeak), 0.006779747648, kFormDigits);
  EXPECT_NEAR(about_ls(Indication::Parameter::kValley), 0.006494343833, kFormDigits);
  EXPECT_NEAR(about_ls(Indication::Parameter::kRms), 0.004304023965, kFormDigits);
  const Finding zone = form_of(part, asked(Form::kCylindricity));
  EXPECT_THAT(zone.rows, UnorderedElementsAre(24, 28, 32, 2, 6, 10));
  EXPECT_EQ(zone.reference.english(), "MZCY");
  EXPECT_FALSE(zone.no_verdict);
}

TEST(DrawingForm, OfTheSectionsOfW1HasEveryDigit) {
  const auto part = drawn(test::w1(), {false, 1.4987});
  const double mz[] = {0.010699433035, 0.011275428571, 0.011843450463};
  const double ls[] = {0.010797474394, 0.011379622917, 0.011979020321};
  const Finding zone = form_of(part, asked(Form::kRoundness));
  const Finding squares = form_of(part, asked(Form::kRoundness, Reference::kLeastSquares));
  ASSERT_EQ(zone.local.size(), 3U);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(zone.local[j].value_mm, mz[j], kFormDigits);
    EXPECT_NEAR(squares.local[j].value_mm, ls[j], kFormDigits);
  }
  EXPECT_EQ(zone.worst, 2U);
  EXPECT_EQ(zone.judged.front().symbol, "RONt");
  EXPECT_NEAR(zone.judged.front().value_mm, mz[2], kFormDigits);
  auto second = asked(Form::kRoundness);
  second.indication.section = Indication::Section::kSCS;
  second.indication.section_layers = {1.0, 2.0};
  const Finding named = form_of(part, second);
  EXPECT_EQ(named.local.size(), 2U);
  EXPECT_NEAR(named.judged.front().value_mm, mz[1], kFormDigits);
  EXPECT_EQ(named.reference.english(), "MZCI of section 1, 2");
}

TEST(DrawingForm, OfW2HasEveryDigit) {
  const auto part = drawn(test::w2(), {false, 0.0});
  const auto total = [&](Reference reference) {
    return form_value(part, Form::kCylindricity, reference);
  };
  EXPECT_NEAR(total(Reference::kLeastSquares), 0.013113329553, kFormDigits);
  EXPECT_NEAR(total(Reference::kMinimumZone), 0.012258387523, kFormDigits);
  EXPECT_NEAR(total(Reference::kMinimumCircumscribed), 0.017120683899, 1e-7);
  EXPECT_NEAR(total(Reference::kMaximumInscribed), 0.013688429668, 1e-7);
  const auto about_ls = [&](Indication::Parameter parameter) {
    return form_value(part, Form::kCylindricity, Reference::kLeastSquares, parameter);
  };
  EXPECT_NEAR(about_ls(Indication::Parameter::kPeak), 0.005106329340, kFormDigits);
  EXPECT_NEAR(about_ls(Indication::Parameter::kValley), 0.008007000213, kFormDigits);
  EXPECT_NEAR(about_ls(Indication::Parameter::kRms), 0.003839465262, kFormDigits);
  const double mz[] = {0.002345528766, 0.002295522438, 0.002077187855, 0.002128465590};
  const Finding sections = form_of(part, asked(Form::kRoundness));
  for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(sections.local[j].value_mm, mz[j], kFormDigits);
}

TEST(DrawingForm, OfW6LeavesTheKeywayOut) {
  const auto part = drawn(test::w6(), {true, 1.5}, {4});
  const auto about_ls = [&](Indication::Parameter parameter) {
    return form_value(part, Form::kCylindricity, Reference::kLeastSquares, parameter);
  };
  EXPECT_NEAR(about_ls(Indication::Parameter::kTotal), 0.005921111894, kFormDigits);
  EXPECT_NEAR(about_ls(Indication::Parameter::kPeak), 0.003244244779, kFormDigits);
  EXPECT_NEAR(about_ls(Indication::Parameter::kValley), 0.002676867115, kFormDigits);
  EXPECT_NEAR(form_value(part, Form::kCylindricity, Reference::kMinimumZone), 0.005500437469,
              kFormDigits);
  const Finding sections = form_of(part, asked(Form::kRoundness));
  EXPECT_NEAR(sections.local[0].value_mm, 0.005356876307, kFormDigits);
  EXPECT_NEAR(sections.local[1].value_mm, 0.005429806783, kFormDigits);
  EXPECT_FALSE(sections.no_verdict);
  EXPECT_NEAR(
      form_value(drawn(test::w6(), {true, 1.5}), Form::kCylindricity, Reference::kMinimumZone),
      2.876876894098, kFormDigits);
}

TEST(DrawingForm, OfW8IsThatOfTheFilteredPoints) {
  std::vector<double> r_mm;
  for (int i = 0; i < 360; ++i) {
    const double t = core::kTwoPi * i / 360.0;
    r_mm.push_back(20.0 + 0.004 * std::cos(2 * t - 0.3) + 0.003 * std::cos(3 * t - 1.1) +
                   0.0015 * std::cos(7 * t + 0.4) + 0.0008 * std::cos(40 * t) +
                   0.0005 * std::cos(120 * t - 0.2));
  }
  const auto low = fit::filter_closed(r_mm, {});
  ASSERT_TRUE(low.has_value());
  test::Layers layer(1);
  for (std::size_t i = 0; i < 360; ++i) {
    const double t = core::kTwoPi * static_cast<double>(i) / 360.0;
    layer[0].emplace_back(low->r_mm[i] * std::cos(t), low->r_mm[i] * std::sin(t), 0.0);
  }
  const auto part = drawn(layer, {false, 1.0});
  part.of->feature.shape = record::Shape::kCircle;
  EXPECT_NEAR(form_value(part, Form::kRoundness, Reference::kLeastSquares), 0.014761219827,
              kFormDigits);
  EXPECT_NEAR(
      form_value(part, Form::kRoundness, Reference::kLeastSquares, Indication::Parameter::kRms),
      0.003699531587, kFormDigits);
  EXPECT_NEAR(form_value(part, Form::kRoundness, Reference::kMinimumZone), 0.013080953212,
              kFormDigits);
}

TEST(DrawingForm, OfPlanesHasEveryDigit) {
  const auto face = test::drawn_plane(test::all_of(test::w4_face()));
  EXPECT_NEAR(form_value(face, Form::kFlatness, Reference::kLeastSquares), 0.005428189038,
              kFormDigits);
  EXPECT_NEAR(
      form_value(face, Form::kFlatness, Reference::kLeastSquares, Indication::Parameter::kPeak),
      0.002344499915, kFormDigits);
  EXPECT_NEAR(
      form_value(face, Form::kFlatness, Reference::kLeastSquares, Indication::Parameter::kValley),
      0.003083689123, kFormDigits);
  EXPECT_NEAR(
      form_value(face, Form::kFlatness, Reference::kLeastSquares, Indication::Parameter::kRms),
      0.001829028978, kFormDigits);
  const Finding zone = form_of(face, asked(Form::kFlatness));
  EXPECT_NEAR(zone.judged.front().value_mm, 0.005350052640, kFormDigits);
  EXPECT_THAT(zone.rows, UnorderedElementsAre(1, 7, 15, 21));
  EXPECT_EQ(zone.reference.english(), "MZPL");
  EXPECT_FALSE(zone.no_verdict);
  const auto crowned = test::drawn_plane(test::w5_plane());
  EXPECT_NEAR(form_value(crowned, Form::kFlatness, Reference::kLeastSquares), 0.00642, kFormDigits);
  EXPECT_NEAR(form_value(crowned, Form::kFlatness, Reference::kMinimumZone), 0.00635, kFormDigits);
}

// 4 um of form along 40 mm, 0.1 um across: the plane of least extent stands on edge, and 0.2 um
// conformed to 2.5.
TEST(DrawingForm, OfAFaceTouchedAlongOneLineIsRefused) {
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 24; ++i) {
    const double x = -20.0 + 40.0 * i / 23.0;
    line.emplace_back(x, 1e-4 * std::sin(37.0 * i), 2e-3 * std::cos(0.3 * x));
  }
  for (const auto reference : {Reference::kMinimumZone, Reference::kLeastSquares}) {
    const auto face = test::drawn_plane(line);
    const auto found = find_form(face.surface, asked(Form::kFlatness, reference), Proof::kFull);
    ASSERT_FALSE(found.has_value());
    EXPECT_EQ(found.error().code, core::Code::kCollinear);
  }
  test::DrawnPart part;
  part.plane("A", {line});
  part.plane("B", {test::w5_plane()});
  for (const auto association :
       {Indication::Association::kLs, Indication::Association::kOneSided}) {
    const auto found = part.last(test::about(Form::kParallelism, {"A"}, association));
    ASSERT_FALSE(found.has_value());
    EXPECT_EQ(found.error().code, core::Code::kCollinear);
  }
}

TEST(DrawingSides, ShaftAndBoreSwapPeakAndValley) {
  const auto shaft = drawn(test::w1(), {false, 1.5});
  const auto bore = drawn(test::w1(), {true, 1.5});
  for (const Form form : {Form::kCylindricity, Form::kRoundness}) {
    const auto about_ls = [&](const DrawnSurface& part, Indication::Parameter parameter) {
      return form_value(part, form, Reference::kLeastSquares, parameter);
    };
    EXPECT_NE(about_ls(shaft, Indication::Parameter::kPeak),
              about_ls(shaft, Indication::Parameter::kValley));
    EXPECT_EQ(about_ls(shaft, Indication::Parameter::kTotal),
              about_ls(bore, Indication::Parameter::kTotal));
  }
  EXPECT_EQ(form_value(shaft, Form::kCylindricity, Reference::kLeastSquares,
                       Indication::Parameter::kPeak),
            form_value(bore, Form::kCylindricity, Reference::kLeastSquares,
                       Indication::Parameter::kValley));
}

TEST(DrawingRelations, OfFormHoldWithTheirSlack) {
  std::mt19937 engine(19);
  std::uniform_real_distribution<double> rough(-0.01, 0.01);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const auto layers =
        test::turned_layers(3, 12, [&](int, double) { return 15.0 + rough(engine); });
    const auto part = drawn(layers, {false, 0.0});
    const double mz = form_value(part, Form::kCylindricity, Reference::kMinimumZone);
    for (const Reference other : {Reference::kLeastSquares, Reference::kMinimumCircumscribed,
                                  Reference::kMaximumInscribed}) {
      EXPECT_LE(mz, form_value(part, Form::kCylindricity, other) + 1e-12);
    }
    const auto zone = fit::min_zone_cylinder(part.surface.points_mm);
    const double t = zone->axis.direction.cross(part.surface.axis.direction).norm();
    EXPECT_LE(form_value(part, Form::kRoundness, Reference::kMinimumZone),
              mz + 15.0 * t * t + 1e-12);
  }
}

TEST(DrawingForm, OfAnUnseenArcHasNoVerdictUnlessItIsTooWide) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> rough(-0.01, 0.01);
  const auto radius = [&](int, double) { return 15.0 + rough(engine); };
  auto layers = test::turned_layers(3, 12, radius);
  const auto window = drawn(layers, {false, 0.0}, {8, 9, 10, 11});
  for (auto& layer : layers) layer.resize(8);  // 150 deg without a point
  const auto arc = drawn(layers, {false, 0.0});
  for (const Form form : {Form::kCylindricity, Form::kRoundness}) {
    auto zone = asked(form);
    EXPECT_TRUE(form_of(arc, zone).no_verdict);
    EXPECT_FALSE(form_of(window, zone).no_verdict);
    EXPECT_FALSE(form_of(arc, zone, Proof::kNone).no_verdict);
    zone.tolerance_mm = 1e-4;  // what is unseen can only add
    EXPECT_FALSE(form_of(arc, zone).no_verdict);
    auto squares = asked(form, Reference::kLeastSquares);
    squares.tolerance_mm = 1e-4;
    EXPECT_TRUE(form_of(arc, squares).no_verdict);
  }
}

TEST(DrawingForm, OfAWindowOverHalfTheTurnHasNoVerdict) {
  const auto layers = test::turned_layers(3, 12, [](int, double) { return 15.0; });
  const auto under = drawn(layers, {false, 0.0}, {8, 9, 10, 11});          // 150 deg open
  const auto half = drawn(layers, {false, 0.0}, {7, 8, 9, 10, 11});        // 180 deg open
  const auto over = drawn(layers, {false, 0.0}, {5, 6, 7, 8, 9, 10, 11});  // 240 deg open
  const auto roundness = asked(Form::kRoundness, Reference::kLeastSquares);
  EXPECT_FALSE(form_of(under, roundness).no_verdict);
  EXPECT_TRUE(form_of(half, roundness).no_verdict);
  EXPECT_TRUE(form_of(over, roundness).no_verdict);
}

TEST(DrawingForm, OfALayerOfOnePointHasNoVerdict) {
  auto layers = test::turned_layers(5, 12, [](int, double) { return 15.0; });
  auto cylindricity = asked(Form::kCylindricity, Reference::kLeastSquares);
  EXPECT_FALSE(form_of(drawn(layers, {false, 0.0}), cylindricity).no_verdict);
  layers[4].resize(1);
  const auto why = form_of(drawn(layers, {false, 0.0}), cylindricity).no_verdict;
  ASSERT_TRUE(why);
  EXPECT_EQ(why->english(),
            "layer 5 has 1 points, a turn needs at least 3: touch more there, or leave the layer "
            "out");
}

TEST(DrawingForm, OfACircleThatIsNotUniqueHasNoVerdictWithinItsRange) {
  // Dents at 0 and 180 deg hold the inscribed circle, which slides across them: RONt is anything
  // from 17.07 to 28 um about circles whose radius agrees to 1 nm.
  const auto part =
      drawn(test::turned_layers(1, 360,
                                [](int, double t) {
                                  const auto k = std::lround(core::degrees(t));
                                  return 25.0 + (k % 180 == 0 ? -0.010 : k == 90 ? 0.008 : 0.0);
                                }),
            {false, 0.0});
  part.of->feature.shape = record::Shape::kCircle;
  auto inscribed = asked(Form::kRoundness, Reference::kMaximumInscribed);
  const Finding free = form_of(part, inscribed);
  ASSERT_FALSE(free.unique);
  EXPECT_NEAR(free.judged.front().value_mm, 0.028, 1e-4);
  inscribed.tolerance_mm = 0.020;
  EXPECT_TRUE(form_of(part, inscribed).no_verdict);
  inscribed.tolerance_mm = 0.030;
  EXPECT_FALSE(form_of(part, inscribed).no_verdict);
}

TEST(DrawingRefusals, OfFormSayWhatToPlanInstead) {
  const auto refusal = [](const DrawnSurface& part, const record::Characteristic& asked) {
    const auto finding = find_form(part.surface, asked, Proof::kFull);
    EXPECT_FALSE(finding.has_value());
    return finding ? core::Error{} : finding.error();
  };
  const auto part = drawn(test::w1(), {false, 1.5});
  EXPECT_EQ(refusal(part, asked_about(Form::kCylindricity, Reference::kMinimumZone,
                                      Indication::Parameter::kPeak))
                .code,
            core::Code::kMeaning);
  const auto one_layer = drawn({test::w1().front()}, {false, 1.5});
  EXPECT_EQ(refusal(one_layer, asked(Form::kCylindricity)).code, core::Code::kRank);
  const auto threes =
      drawn(test::turned_layers(3, 3, [](int, double) { return 12.0; }), {false, 1.5});
  EXPECT_EQ(refusal(threes, asked(Form::kRoundness)).code, core::Code::kTooFewPoints);
  EXPECT_EQ(refusal(threes, asked(Form::kRoundness, Reference::kLeastSquares)).code,
            core::Code::kTooFewPoints);
  const auto plane = test::drawn_plane({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(refusal(plane, asked(Form::kFlatness)).code, core::Code::kTooFewPoints);
  EXPECT_EQ(refusal(test::drawn_plane(test::w5_plane()),
                    asked(Form::kFlatness, Reference::kMaximumInscribed))
                .code,
            core::Code::kMeaning);
}

}  // namespace
}  // namespace rondure::evaluation
