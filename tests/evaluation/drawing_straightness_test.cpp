#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/part/internal/families.h"
#include "tests/evaluation/drawing_surface.h"

// Expected numbers: methods, drawing section 12 (W2); tolerances: section 13.

namespace rondure::evaluation {
namespace {

using record::Form;
using record::Reference;
using test::asked;
using test::drawn;
using test::DrawnSurface;
using Indication = record::Indication;

constexpr double kLineDigits = 1e-10;

record::Characteristic median_line_asked() {
  record::Characteristic out = asked(Form::kStraightness);
  out.indication.of = Indication::Of::kMedianLine;
  return out;
}

Finding line_of(const DrawnSurface& part, const record::Characteristic& asked) {
  auto finding = find_straightness(part.surface, asked, Proof::kFull);
  EXPECT_TRUE(finding.has_value()) << finding.error().what;
  if (finding) return *std::move(finding);
  Finding none;
  none.judged.push_back({"none", NAN, {}});
  return none;
}

core::Error line_refusal(const DrawnSurface& part, const record::Characteristic& asked) {
  const auto finding = find_straightness(part.surface, asked, Proof::kFull);
  EXPECT_FALSE(finding.has_value());
  return finding ? core::Error{} : finding.error();
}

const fit::Material kPlainShaft{false, 0.0};

TEST(DrawingStraightness, OfTheGeneratricesOfW2HasEveryDigit) {
  const auto part = drawn(test::w2(), kPlainShaft);
  const double mz[] = {0.001633333164, 0.000801411359, 0.000966666112, 0.002262698473,
                       0.003999998872, 0.005421151974, 0.004966665269, 0.003488391981};
  const Finding zone = line_of(part, asked(Form::kStraightness));
  ASSERT_EQ(zone.local.size(), 8U);
  ASSERT_EQ(zone.lines.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(zone.local[k].place, LocalValue::Place::kAngle);
    const double off_rad = zone.local[k].position - static_cast<double>(k) * 45.0 * core::kDegree;
    EXPECT_NEAR(std::remainder(off_rad, core::kTwoPi), 0.0, 0.002);
    EXPECT_NEAR(zone.local[k].value_mm, mz[k], kLineDigits);
  }
  EXPECT_EQ(zone.worst, 5U);
  EXPECT_EQ(zone.rows, (std::vector<std::size_t>{5, 13, 21, 29}));
  EXPECT_NEAR(zone.judged.front().value_mm, mz[5], kLineDigits);
  const Finding squares = line_of(part, asked(Form::kStraightness, Reference::kLeastSquares));
  EXPECT_NEAR(squares.judged.front().value_mm, 0.005444722141, kLineDigits);
  EXPECT_EQ(squares.judged.front().symbol, "STRt");
}

TEST(DrawingStraightness, StatesAnglesFromMachineXHoweverTheAxisLeans) {
  auto part = drawn(test::w2(), kPlainShaft);
  // Its least component is y, and fit::across() begins there.
  part.surface.axis.direction = Eigen::Vector3d(0.001, 0.0, 1.0).normalized();
  const Finding lines = line_of(part, asked(Form::kStraightness));
  ASSERT_EQ(lines.local.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    const double off_rad = lines.local[k].position - static_cast<double>(k) * 45.0 * core::kDegree;
    EXPECT_NEAR(std::remainder(off_rad, core::kTwoPi), 0.0, 0.005);
    EXPECT_EQ(lines.lines[k].angle_rad, lines.local[k].position);
  }
}

TEST(DrawingStraightness, OfABoreSwapsPeakAndValley) {
  const auto value = [](bool inside, Indication::Parameter parameter) {
    auto peak = asked(Form::kStraightness, Reference::kLeastSquares);
    peak.indication.parameter = parameter;
    const Finding lines = line_of(drawn(test::w2(), {inside, 0.0}), peak);
    return lines.judged.front().value_mm;
  };
  using Parameter = Indication::Parameter;
  EXPECT_EQ(value(false, Parameter::kPeak), value(true, Parameter::kValley));
  EXPECT_EQ(value(false, Parameter::kValley), value(true, Parameter::kPeak));
  EXPECT_NE(value(false, Parameter::kPeak), value(false, Parameter::kValley));
  EXPECT_EQ(value(false, Parameter::kRms), value(true, Parameter::kRms));
}

TEST(DrawingStraightness, OfTheMedianLineOfW2HasEveryDigit) {
  const auto part = drawn(test::w2(), kPlainShaft);
  const Finding line = line_of(part, median_line_asked());
  EXPECT_NEAR(line.judged.front().value_mm, 0.002483893854, kLineDigits);
  EXPECT_EQ(line.centers_mm.size(), 4U);
  EXPECT_FALSE(line.no_verdict);
  auto squares = median_line_asked();
  squares.reference = Reference::kLeastSquares;
  EXPECT_GE(line_of(part, squares).judged.front().value_mm, line.judged.front().value_mm);
}

TEST(DrawingStraightness, OfAPerfectCylinderIsNotVoid) {
  const auto part =
      drawn(test::turned_layers(4, 12, [](int, double) { return 10.0; }), kPlainShaft);
  const Finding line = line_of(part, median_line_asked());
  EXPECT_NEAR(line.judged.front().value_mm, 0.0, 1e-12);
  EXPECT_FALSE(line.no_verdict);
}

TEST(DrawingStraightness, OfHalfAShaftHasNoVerdictAndNoTaperEither) {
  auto layers = test::turned_layers(4, 12, [](int, double) { return 10.0; });
  const auto whole = drawn(layers, kPlainShaft);
  for (auto& layer : layers) layer.resize(7);
  const auto half = drawn(layers, kPlainShaft);
  for (const Form form : {Form::kStraightness, Form::kTaper}) {
    EXPECT_FALSE(line_of(whole, asked(form, Reference::kLeastSquares)).no_verdict);
    EXPECT_TRUE(line_of(half, asked(form, Reference::kLeastSquares)).no_verdict);
  }
}

TEST(DrawingTaper, OfW2HasEveryDigit) {
  const auto part = drawn(test::w2(), kPlainShaft);
  const double tapers[] = {0.008940004424, 0.008612582072, 0.009435002017, 0.008750501283};
  const double parallel[] = {0.017959994262, 0.017324123011, 0.018829992962, 0.017564611463};
  const Finding taper = line_of(part, asked(Form::kTaper));
  const Finding ranges = line_of(part, asked(Form::kGeneratrixParallelism));
  ASSERT_EQ(taper.local.size(), 4U);
  ASSERT_EQ(ranges.local.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(taper.local[k].value_mm, tapers[k], kLineDigits);
    EXPECT_NEAR(ranges.local[k].value_mm, parallel[k], kLineDigits);
  }
  EXPECT_EQ(taper.worst, 2U);
  EXPECT_EQ(taper.judged.front().symbol, "CYLtt");
  EXPECT_NEAR(taper.judged.front().value_mm, tapers[2], kLineDigits);
  EXPECT_NEAR(ranges.judged.front().value_mm, parallel[2], kLineDigits);
  ASSERT_EQ(taper.numbers.size(), 2U);
  EXPECT_EQ(taper.numbers[0].name, "diameter change over length");
  EXPECT_NEAR(taper.numbers[0].value, 0.017869044029, kLineDigits);
  EXPECT_NEAR(taper.numbers[1].value, 0.017063657767, kLineDigits);
  EXPECT_EQ(taper.rows.size(), 8U);  // of both generatrices of the plane
}

TEST(DrawingStraightness, LeavesOutTheGeneratrixOfAWindow) {
  const auto part = drawn(test::w2(), kPlainShaft, {5});
  const Finding lines = line_of(part, asked(Form::kStraightness));
  EXPECT_EQ(lines.local.size(), 7U);
  // Opposite it lies no generatrix any more.
  EXPECT_EQ(line_of(part, asked(Form::kTaper)).local.size(), 3U);
}

TEST(DrawingStraightness, BridgesAWindowThatEndsAlongTheGeneratrix) {
  auto part = drawn(test::w2(), kPlainShaft);
  // Row 9: layer 2, second generatrix; rows and points are alike here.
  auto& points = part.surface.sections[1].points;
  points.erase(points.begin() + 1);
  part.surface.left_out.push_back({9, "hole"});
  part.surface.sections[1].gap = true;
  const Finding lines = line_of(part, asked(Form::kStraightness));
  ASSERT_EQ(lines.local.size(), 8U);
  EXPECT_EQ(lines.lines[1].position_mm.size(), 3U);
  part.surface.left_out.clear();
  EXPECT_EQ(line_refusal(part, asked(Form::kStraightness)).code, core::Code::kSampling);
}

TEST(DrawingStraightness, OfDenseSectionsHasALineEveryTenDegrees) {
  // A bow of the generatrices at 90 deg only, between the points of the scan.
  const auto radius = [](int j, double t) {
    return 20.0 + (j == 1 ? 0.004 * std::max(0.0, std::sin(t)) * std::sin(t) : 0.0);
  };
  auto part = drawn(test::turned_layers(3, 361, radius, 15.0, 0.001, 0.002), kPlainShaft);
  part.surface.axis = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  for (auto& section : part.surface.sections) section.dense = true;
  const Finding lines = line_of(part, asked(Form::kStraightness));
  ASSERT_EQ(lines.local.size(), 36U);
  EXPECT_NEAR(lines.local[lines.worst].value_mm, 0.004, 1e-6);
  EXPECT_NEAR(core::degrees(lines.local[lines.worst].position), 90.0, 1e-9);
  EXPECT_TRUE(lines.rows.empty());
}

TEST(DrawingStraightness, LosesNoGeneratrixOfALayerWithFewerPoints) {
  const auto dent = [](int j, double t) {
    return j == 2 && std::abs(t - 0.7854) < 0.1 ? 9.9 : 10.0;
  };
  auto part = drawn(test::turned_layers(4, 8, dent), kPlainShaft);
  EXPECT_GT(line_of(part, asked(Form::kStraightness)).judged.front().value_mm, 0.05);
  auto& first = part.surface.sections[0].points;
  first = {first[0], first[2], first[4], first[6]};
  for (const Form form : {Form::kStraightness, Form::kTaper}) {
    const core::Error why = line_refusal(part, asked(form));
    EXPECT_EQ(why.code, core::Code::kSampling);
    EXPECT_NE(why.what.find("layer 1 has no point within 0.5 deg"), std::string::npos) << why.what;
  }
}

TEST(DrawingTaper, OfOneOppositePairAmongManyHasNoVerdict) {
  test::Layers layers;
  for (int j = 0; j < 3; ++j) {
    auto& layer = layers.emplace_back();
    for (const double deg : {0.0, 40.0, 80.0, 120.0, 180.0, 240.0, 280.0, 320.0}) {
      const double t = deg * core::kDegree;
      layer.emplace_back(10.0 * std::cos(t), 10.0 * std::sin(t), 15.0 * j);
    }
  }
  const Finding taper = line_of(drawn(layers, kPlainShaft), asked(Form::kTaper));
  EXPECT_EQ(taper.local.size(), 1U);
  EXPECT_TRUE(taper.no_verdict);
}

TEST(DrawingRefusals, OfStraightnessSayWhatToPlanInstead) {
  const auto round = [](int, double) { return 12.0; };
  const auto staggered = drawn(test::turned_layers(4, 12, round, 15.0, 0.0, 0.1), kPlainShaft);
  const auto two = drawn(test::turned_layers(2, 12, round), kPlainShaft);
  const auto odd = drawn(test::turned_layers(3, 7, round), kPlainShaft);
  const auto sentence = [](const DrawnSurface& part, const record::Characteristic& asked,
                           core::Code code, const std::string& words) {
    const core::Error why = line_refusal(part, asked);
    EXPECT_EQ(why.code, code) << why.what;
    EXPECT_NE(why.what.find(words), std::string::npos) << why.what;
  };
  sentence(staggered, asked(Form::kStraightness), core::Code::kSampling, "sampling.stagger 0");
  sentence(two, asked(Form::kStraightness), core::Code::kSampling, "at least 3 layers");
  sentence(two, median_line_asked(), core::Code::kRank, "plan at least 3 layers");
  sentence(two, asked(Form::kTaper), core::Code::kSampling, "an even number of points a layer");
  sentence(odd, asked(Form::kTaper), core::Code::kSampling, "an even number of points a layer");
  sentence(staggered, asked(Form::kStraightness, Reference::kMaximumInscribed),
           core::Code::kMeaning, "reference \"mz\" or \"ls\"");
  auto peak = asked(Form::kStraightness);
  peak.indication.parameter = Indication::Parameter::kPeak;
  sentence(odd, peak, core::Code::kMeaning, "plan reference \"ls\"");
  auto median_peak = median_line_asked();
  median_peak.indication.parameter = Indication::Parameter::kPeak;
  sentence(odd, median_peak, core::Code::kMeaning, "total");
}

}  // namespace
}  // namespace rondure::evaluation
