#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/part/internal/families.h"
#include "fit/profiles/profile_filter.h"
#include "fit/references/one_sided.h"
#include "tests/evaluation/drawing_part.h"
#include "tests/evaluation/drawing_surface.h"

// Expected numbers: methods, drawing section 12; tolerances: section 13.

namespace rondure::evaluation {
namespace {

using test::asked;
using test::drawn;
using test::DrawnSurface;
using Indication = record::Indication;
using SizeKind = Indication::Size;
using RankKind = Indication::Rank;
using record::Form;

constexpr double kSizeDigits = 1e-10;
constexpr double kRocking = 1e-7;  // GN, GX of a tapered journal
const fit::Material kShaft{false, 1.4987};
const fit::Material kBore{true, 1.5};

record::Characteristic size_asked(SizeKind size,
                                  Indication::Section section = Indication::Section::kAll) {
  record::Characteristic out = asked(Form::kDiameter);
  out.indication.size = size;
  out.indication.section = section;
  return out;
}

record::Characteristic rank_asked(RankKind rank) {
  record::Characteristic out = size_asked(SizeKind::kLP);
  out.indication.rank = rank;
  return out;
}

record::Characteristic envelope_asked(double lower_mm, double upper_mm) {
  record::Characteristic out = asked(Form::kDiameter);
  out.indication.requirement = Indication::Requirement::kEnvelope;
  out.lower_mm = lower_mm;
  out.tolerance_mm = upper_mm;
  return out;
}

Finding found(const DrawnSurface& part, const record::Characteristic& asked,
              Proof proof = Proof::kFull) {
  auto finding = find_size(part.surface, asked, proof);
  EXPECT_TRUE(finding.has_value()) << finding.error().what;
  if (finding) return *std::move(finding);
  Finding none;
  none.judged.push_back({"none", NAN, {}});
  return none;
}

double value(const DrawnSurface& part, const record::Characteristic& asked,
             Proof proof = Proof::kFull) {
  return found(part, asked, proof).judged.front().value_mm;
}

core::Error refusal(const DrawnSurface& part, const record::Characteristic& asked) {
  const auto finding = find_size(part.surface, asked, Proof::kFull);
  EXPECT_FALSE(finding.has_value());
  return finding ? core::Error{} : finding.error();
}

double number(const Finding& finding, const std::string& name) {
  for (const NamedNumber& n : finding.numbers) {
    if (n.name == name) return n.value;
  }
  ADD_FAILURE() << "no number " << name;
  return NAN;
}

test::Layers scaled(test::Layers layers, double factor) {
  for (auto& layer : layers) {
    for (auto& p : layer) p *= factor;
  }
  return layers;
}

/// W1 at 20 degC.
DrawnSurface w1_at_20_degC() {
  const double factor = 0.999981200518866;
  return drawn(scaled(test::w1(), factor), {false, 1.4987 * factor});
}

TEST(DrawingSize, OfW1HasEveryDigit) {
  for (const Proof proof : {Proof::kFull, Proof::kNone}) {
    const auto part = drawn(test::w1(), kShaft);
    EXPECT_NEAR(value(part, size_asked(SizeKind::kGG), proof), 24.990122662043, kSizeDigits);
    EXPECT_NEAR(value(part, size_asked(SizeKind::kGN), proof), 25.003379302565, kSizeDigits);
    EXPECT_NEAR(value(part, size_asked(SizeKind::kGX), proof), 24.977528966340, kSizeDigits);
    EXPECT_NEAR(value(part, size_asked(SizeKind::kGC), proof), 24.990454189110, kSizeDigits);
  }
  const auto warm = w1_at_20_degC();
  EXPECT_NEAR(value(warm, size_asked(SizeKind::kGG)), 24.989652860704, kSizeDigits);
  EXPECT_NEAR(value(warm, size_asked(SizeKind::kGN)), 25.002909252007, kSizeDigits);
  EXPECT_NEAR(value(warm, size_asked(SizeKind::kGX)), 24.977059401755, kSizeDigits);
  EXPECT_NEAR(value(warm, rank_asked(RankKind::kSX)), 24.991825191661, kSizeDigits);
  EXPECT_NEAR(value(warm, rank_asked(RankKind::kSN)), 24.987345108986, kSizeDigits);
}

TEST(DrawingSize, OfW1HasEveryDigitOfItsRanks) {
  const auto part = drawn(test::w1(), kShaft);
  const double expected[] = {24.992295033840, 24.987814866940, 24.990122662068, 24.990321456530,
                             24.990054950390, 0.004480166900,  0.001499276509};
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_NEAR(value(part, rank_asked(static_cast<RankKind>(i))), expected[i], kSizeDigits) << i;
  }
  const Finding all = found(part, size_asked(SizeKind::kLP));
  ASSERT_EQ(all.judged.size(), 2U);
  EXPECT_EQ(all.judged[0].symbol, "d LP SX");
  EXPECT_EQ(all.judged[1].symbol, "d LP SN");
  EXPECT_NEAR(all.judged[0].value_mm, expected[0], kSizeDigits);
  EXPECT_NEAR(all.judged[1].value_mm, expected[1], kSizeDigits);
  EXPECT_NEAR(number(all, "SM"), expected[3], kSizeDigits);
  EXPECT_EQ(number(all, "pairs"), 18.0);
  EXPECT_EQ(number(all, "lost pairs"), 0.0);
  ASSERT_EQ(all.rows.size(), 4U);  // two of the greatest, two of the least
  EXPECT_EQ(std::max(all.rows[0], all.rows[1]) - std::min(all.rows[0], all.rows[1]), 6U);
}

TEST(DrawingSize, WithoutARankIsTheGreatestAgainstTheUpperTheLeastAgainstTheLowerLimit) {
  const auto part = drawn(test::w1(), kShaft);
  auto asked = size_asked(SizeKind::kLP);
  asked.lower_mm = 24.98;
  asked.tolerance_mm = 25.0;
  const Finding both = found(part, asked);
  ASSERT_EQ(both.judged.size(), 2U);
  EXPECT_EQ(both.judged[0].limits.upper_mm, 25.0);
  EXPECT_FALSE(both.judged[0].limits.lower_mm);
  EXPECT_EQ(both.judged[1].limits.lower_mm, 24.98);
  EXPECT_FALSE(both.judged[1].limits.upper_mm);
  asked.tolerance_mm.reset();
  const Finding lower = found(part, asked);
  ASSERT_EQ(lower.judged.size(), 1U);
  EXPECT_EQ(lower.judged[0].symbol, "d LP SN");
}

TEST(DrawingSize, OfTheSectionsOfW1HasEveryDigit) {
  const auto part = drawn(test::w1(), kShaft);
  const double gg[] = {24.988230605498, 24.990304803404, 24.991832577303};
  const double gn[] = {24.998545665996, 25.001440240767, 25.003379412312};
  auto asked = size_asked(SizeKind::kGG, Indication::Section::kACS);
  asked.lower_mm = 24.989;
  asked.tolerance_mm = 25.0;
  const Finding sections = found(part, asked);
  ASSERT_EQ(sections.local.size(), 3U);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ(sections.local[j].layer, static_cast<int>(j));
    EXPECT_NEAR(sections.local[j].value_mm, gg[j], kSizeDigits);
  }
  ASSERT_EQ(sections.judged.size(), 2U);
  EXPECT_NEAR(sections.judged[0].value_mm, gg[2], kSizeDigits);
  EXPECT_NEAR(sections.judged[1].value_mm, gg[0], kSizeDigits);
  EXPECT_EQ(sections.worst, 0U);  // below the lower limit
  const Finding circumscribed = found(part, size_asked(SizeKind::kGN, Indication::Section::kACS));
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(circumscribed.local[j].value_mm, gn[j], kSizeDigits);
  }
  auto second = size_asked(SizeKind::kGG, Indication::Section::kSCS);
  second.indication.section_layers = {2.0};
  EXPECT_NEAR(value(part, second), gg[1], kSizeDigits);
  second.indication.section_layers = {4.0};
  EXPECT_EQ(refusal(part, second).code, core::Code::kRank);
}

TEST(DrawingRefusals, OfALayerOfOnePointNameItOnce) {
  auto layers = test::turned_layers(3, 12, [](int, double) { return 12.0; });
  layers[2].resize(1);
  EXPECT_EQ(refusal(drawn(layers, {false, 0.0}), size_asked(SizeKind::kLP)).what,
            "layer 3 has 1 points, and a circle needs at least 3: touch more");
}

TEST(DrawingRefusals, OfLayersUpsideDownNameNoSection) {
  auto layers = test::turned_layers(3, 12, [](int j, double) { return 12.0 + 0.1 * j; });
  record::Characteristic lowest = size_asked(SizeKind::kGG, Indication::Section::kSCS);
  lowest.indication.section_layers = {1.0};
  EXPECT_NEAR(value(drawn(layers, {false, 0.0}), lowest), 24.0, 1e-6);
  std::reverse(layers.begin(), layers.end());
  const core::Error why = refusal(drawn(layers, {false, 0.0}), lowest);
  EXPECT_EQ(why.code, core::Code::kMeaning);
  EXPECT_EQ(why.what,
            "section_layers counts from the lowest layer, but layer 2 lies below layer 1: number "
            "the layers of the file upwards");
}

TEST(DrawingSize, OfAnySectionListsItsGreatestAndItsLeast) {
  const auto part = drawn(test::w1(), kShaft);
  const Finding whole = found(part, size_asked(SizeKind::kLP));
  const Finding sections = found(part, size_asked(SizeKind::kLP, Indication::Section::kACS));
  ASSERT_EQ(sections.local.size(), 3U);
  double greatest = 0.0;
  double least = 100.0;
  for (const LocalValue& section : sections.local) {
    ASSERT_TRUE(section.least_mm);
    EXPECT_LT(*section.least_mm, section.value_mm);
    greatest = std::max(greatest, section.value_mm);
    least = std::min(least, *section.least_mm);
  }
  EXPECT_EQ(greatest, whole.judged[0].value_mm);
  EXPECT_EQ(least, whole.judged[1].value_mm);
  EXPECT_EQ(sections.judged[0].value_mm, greatest);
  EXPECT_EQ(sections.judged[1].value_mm, least);
}

TEST(DrawingSize, OfW2HasEveryDigit) {
  const auto part = drawn(test::w2(), {false, 0.0});
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGG)), 39.998642923760, kSizeDigits);
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGN)), 40.007007118519, kRocking);
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGX)), 39.984416299395, kRocking);
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGC)), 39.996674586266, kSizeDigits);
  EXPECT_NEAR(value(part, rank_asked(RankKind::kSX)), 40.007007314984, kSizeDigits);
}

TEST(DrawingSize, OfW6HasEveryDigit) {
  const auto part = drawn(test::w6(), kBore, {4});
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGG)), 39.999953257850, kSizeDigits);
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGN)), 40.005130693014, kSizeDigits);
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGX)), 39.994130396679, kSizeDigits);
  EXPECT_NEAR(value(part, size_asked(SizeKind::kGC)), 39.999630265339, kSizeDigits);
  const Finding local = found(part, size_asked(SizeKind::kLP));
  EXPECT_EQ(number(local, "pairs"), 14.0);
  EXPECT_EQ(number(local, "lost pairs"), 2.0);
  EXPECT_NEAR(number(local, "SX"), 40.005130701989, kSizeDigits);
  EXPECT_NEAR(number(local, "SN"), 39.994129828310, kSizeDigits);
  EXPECT_NEAR(number(local, "SA"), 39.999972416259, kSizeDigits);
  EXPECT_NEAR(number(local, "SQ"), 0.003750924192, kSizeDigits);
  const auto forgotten = drawn(test::w6(), kBore);
  EXPECT_NEAR(value(forgotten, size_asked(SizeKind::kGG)), 40.378788150630, kSizeDigits);
  EXPECT_NEAR(value(forgotten, size_asked(SizeKind::kGN)), 42.999503191355, kSizeDigits);
  EXPECT_NEAR(value(forgotten, size_asked(SizeKind::kGX)), 39.994130396679, kSizeDigits);
  const Finding spoilt = found(forgotten, size_asked(SizeKind::kLP));
  EXPECT_EQ(number(spoilt, "pairs"), 2.0);
  EXPECT_NEAR(number(spoilt, "SX"), 42.999503198979, kSizeDigits);
}

/// The dense section of the specification, filtered at 50 UPR, at some heights.
DrawnSurface w8(const std::vector<double>& means_mm) {
  test::Layers layers;
  for (std::size_t j = 0; j < means_mm.size(); ++j) {
    std::vector<double> r_mm;
    for (int i = 0; i < 360; ++i) {
      const double t = core::kTwoPi * i / 360.0;
      r_mm.push_back(means_mm[j] + 0.004 * std::cos(2 * t - 0.3) + 0.003 * std::cos(3 * t - 1.1) +
                     0.0015 * std::cos(7 * t + 0.4) + 0.0008 * std::cos(40 * t) +
                     0.0005 * std::cos(120 * t - 0.2));
    }
    const auto low = fit::filter_closed(r_mm, {});
    EXPECT_TRUE(low.has_value());
    auto& layer = layers.emplace_back();
    const double heights_mm[] = {0.0, 10.0, 25.0};
    for (std::size_t i = 0; i < 360; ++i) {
      const double t = core::kTwoPi * static_cast<double>(i) / 360.0;
      layer.emplace_back(low->r_mm[i] * std::cos(t), low->r_mm[i] * std::sin(t), heights_mm[j]);
    }
  }
  DrawnSurface out = drawn(layers, {false, 1.0});
  out.surface.axis = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  for (std::size_t j = 0; j < out.surface.sections.size(); ++j) {
    out.surface.sections[j].dense = true;
    const double heights_mm[] = {0.0, 10.0, 25.0};
    out.surface.sections[j].height_mm = heights_mm[j];
  }
  if (means_mm.size() == 1) out.of->feature.shape = record::Shape::kCircle;
  return out;
}

record::Characteristic filtered(record::Characteristic asked) {
  asked.indication.filter = Indication::Filter::kGaussian;
  asked.indication.cutoff_upr = 50.0;
  return asked;
}

TEST(DrawingSize, OfW8HasEveryDigit) {
  const auto part = w8({20.0});
  const Finding local = found(part, filtered(size_asked(SizeKind::kLP)));
  EXPECT_EQ(number(local, "pairs"), 180.0);
  EXPECT_NEAR(number(local, "SX"), 38.009035157494, kSizeDigits);
  EXPECT_NEAR(number(local, "SN"), 37.991094644894, kSizeDigits);
  EXPECT_NEAR(number(local, "SA"), 38.000000000000, kSizeDigits);
  EXPECT_NEAR(number(local, "SM"), 38.000279393401, kSizeDigits);
  EXPECT_NEAR(number(local, "SD"), 38.000064901194, kSizeDigits);
  EXPECT_NEAR(number(local, "SR"), 0.017940512600, kSizeDigits);
  EXPECT_NEAR(number(local, "SQ"), 0.005697049139, kSizeDigits);
  EXPECT_NEAR(value(part, filtered(size_asked(SizeKind::kCC))), 38.000016866345, kSizeDigits);
  EXPECT_NEAR(value(part, filtered(size_asked(SizeKind::kCA))), 37.999999832642, kSizeDigits);
  EXPECT_NEAR(value(part, filtered(size_asked(SizeKind::kGG))), 38.000000000000, kSizeDigits);
  EXPECT_NEAR(value(w8({20.0, 20.004, 20.001}), filtered(size_asked(SizeKind::kCV))),
              38.004599991166, kSizeDigits);
}

TEST(DrawingSize, OfADenseSectionWithoutOppositeSamplesIsOfItsSeries) {
  // The same profile at 359 and at 360 angles: no two of 359 are opposite.
  const auto radius = [](int, double t) {
    return 20.0 + 0.004 * std::cos(2 * t - 0.3) + 0.003 * std::cos(3 * t - 1.1);
  };
  const auto ranks = [&](int points) {
    auto part = drawn(test::turned_layers(2, points, radius), {false, 1.0});
    for (auto& section : part.surface.sections) section.dense = true;
    return found(part, filtered(size_asked(SizeKind::kLP)));
  };
  const Finding series = ranks(359);
  EXPECT_EQ(number(series, "pairs"), 3600.0);
  EXPECT_NEAR(number(series, "SX"), 38.008, 1e-8);
  EXPECT_NEAR(number(series, "SN"), 37.992, 1e-8);
  EXPECT_TRUE(series.rows.empty());
  EXPECT_EQ(number(ranks(360), "pairs"), 360.0);
}

TEST(DrawingSize, OfAPerfectCircleTouchedBesideItsCentreIsItsDiameter) {
  test::Layers layers;
  for (int j = 0; j < 2; ++j) {
    auto& layer = layers.emplace_back();
    for (int i = 0; i < 12; ++i) {
      const double t = core::kTwoPi * i / 12.0;
      const double off = 0.05;
      const double r = -off * std::cos(t) + std::sqrt(144.0 - std::pow(off * std::sin(t), 2));
      layer.emplace_back(off + r * std::cos(t), r * std::sin(t), 10.0 * j);
    }
  }
  const Finding local = found(drawn(layers, {false, 0.0}), size_asked(SizeKind::kLP));
  EXPECT_EQ(number(local, "pairs"), 12.0);
  EXPECT_NEAR(number(local, "SX"), 24.0, 1e-11);
  EXPECT_NEAR(number(local, "SN"), 24.0, 1e-11);
}

double round_12(int /*layer*/, double /*angle*/) { return 12.0; }

/// Points all over a ball: the cylinder through them has a radius of its own.
TEST(DrawingSize, OfABallIsThatOfItsSphere) {
  constexpr int kPoints = 40;
  constexpr double kGolden = 2.399963229728653;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kPoints; ++i) {
    const double z = (2.0 * i + 1.0) / kPoints - 1.0;
    const double r = std::sqrt(1.0 - z * z);
    points.emplace_back(13.45 * r * std::cos(kGolden * i), 13.45 * r * std::sin(kGolden * i),
                        13.45 * z);
  }
  test::DrawnPart part;
  part.add("ball", record::Shape::kSphere, {points}).tip_radius_mm = 1.0;
  for (const SizeKind size : {SizeKind::kGG, SizeKind::kGN, SizeKind::kGX, SizeKind::kGC}) {
    EXPECT_NEAR(part.value(size_asked(size)), 24.9, kSizeDigits);
  }
}

/// 25 points of a ball of radius 12 mm with an oval of 4 um, evenly over its cap of this half
/// angle; its mean radius is 12 mm.
DrawnSurface cap_of_a_ball(double half_deg) {
  constexpr int kPoints = 25;
  constexpr double kGolden = 2.399963229728653;
  const double low = std::cos(half_deg * core::kDegree);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kPoints; ++i) {
    const double z = low + (1.0 - low) * (i + 0.5) / kPoints;
    const double r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d n(r * std::cos(kGolden * i), r * std::sin(kGolden * i), z);
    points.emplace_back((12.0 + 4e-3 * (1.5 * z * z - 0.5)) * n);
  }
  auto out = drawn({points}, kShaft);
  out.of->feature.shape = record::Shape::kSphere;
  return out;
}

// An oval turns into size on a cap: on half a ball by 0.8, on one of 30 deg by 1.8 of its height.
TEST(DrawingSize, OfACapOfABallHasNoVerdict) {
  for (const double half_deg : {20.0, 45.0, 60.0}) {
    const Finding cap = found(cap_of_a_ball(half_deg), size_asked(SizeKind::kGG));
    ASSERT_TRUE(cap.no_verdict) << half_deg;
    EXPECT_THAT(cap.no_verdict->english(), testing::HasSubstr("25 points must reach 74 deg"));
  }
  for (const double half_deg : {80.0, 90.0, 120.0, 180.0}) {
    EXPECT_FALSE(found(cap_of_a_ball(half_deg), size_asked(SizeKind::kGG)).no_verdict) << half_deg;
  }
}

TEST(DrawingSize, OfOddLayersSaysToPlanAnEvenNumber) {
  const auto odd = drawn(test::turned_layers(2, 7, round_12), kShaft);
  const core::Error why = refusal(odd, size_asked(SizeKind::kLP));
  EXPECT_EQ(why.code, core::Code::kSampling);
  EXPECT_EQ(why.what, "7 points a layer have no opposite ones; plan an even number, or a scan");
  const auto even = drawn(test::turned_layers(2, 8, round_12, 15.0, 0.0, 0.3), kShaft);
  EXPECT_EQ(number(found(even, size_asked(SizeKind::kLP)), "pairs"), 8.0);
  const auto one_out = drawn(test::turned_layers(1, 12, round_12), kShaft, {3});
  one_out.of->feature.shape = record::Shape::kCircle;
  const Finding less = found(one_out, size_asked(SizeKind::kLP));
  EXPECT_EQ(number(less, "pairs"), 5.0);
  EXPECT_EQ(number(less, "lost pairs"), 1.0);
  const auto spoilt = drawn(test::turned_layers(2, 6, round_12), kShaft, {0, 1, 2});
  EXPECT_EQ(refusal(spoilt, size_asked(SizeKind::kLP)).what,
            "the windows leave no opposite points in layer 1; turn sampling.start_deg, or plan "
            "more points");
}

TEST(DrawingSize, OfTooFewPairsHasNoVerdictAndOfLostOnesAWarning) {
  const auto one_pair = [](double radius_mm) {
    test::Layers layers;
    for (int j = 0; j < 3; ++j) {
      auto& layer = layers.emplace_back();
      for (const double deg : {0.0, 40.0, 80.0, 120.0, 180.0, 240.0, 280.0, 320.0}) {
        const double t = deg * core::kDegree;
        layer.emplace_back(radius_mm * std::cos(t), radius_mm * std::sin(t), 15.0 * j);
      }
    }
    return drawn(layers, {false, 0.0});
  };
  record::Characteristic size = size_asked(SizeKind::kLP);
  size.lower_mm = 23.9;
  size.tolerance_mm = 24.1;
  const Finding inside = found(one_pair(12.0), size);
  EXPECT_EQ(number(inside, "pairs"), 3.0);
  EXPECT_EQ(number(inside, "lost pairs"), 9.0);
  EXPECT_TRUE(inside.no_verdict);
  ASSERT_EQ(inside.warnings.size(), 1U);
  EXPECT_EQ(inside.warnings[0].what,
            "3 pairs of opposite points, 9 lost: a point of theirs is missing");
  EXPECT_FALSE(found(one_pair(12.1), size).no_verdict) << "a size that fails fails";
  EXPECT_TRUE(found(one_pair(12.0), envelope_asked(23.9, 24.1)).no_verdict);
  const Finding window =
      found(drawn(test::turned_layers(2, 12, round_12), {false, 0.0}, {3}), size);
  EXPECT_EQ(window.warnings.size(), 1U);
  EXPECT_FALSE(window.no_verdict);
}

TEST(DrawingEnvelope, OfW1FailsThoughEveryOtherSizeIsInside) {
  const Finding fails = found(w1_at_20_degC(), envelope_asked(24.979, 25.0));
  ASSERT_EQ(fails.judged.size(), 2U);
  EXPECT_EQ(fails.judged[0].symbol, "d GN");
  EXPECT_NEAR(fails.judged[0].value_mm, 25.002909252007, kSizeDigits);
  EXPECT_EQ(fails.judged[0].limits.upper_mm, 25.0);
  EXPECT_FALSE(fails.judged[0].limits.lower_mm);
  EXPECT_EQ(fails.judged[1].symbol, "d LP SN");
  EXPECT_NEAR(fails.judged[1].value_mm, 24.987345108986, kSizeDigits);
  EXPECT_EQ(fails.judged[1].limits.lower_mm, 24.979);
  EXPECT_FALSE(fails.judged[1].limits.upper_mm);
}

TEST(DrawingEnvelope, OfABoreIsItsInscribedCylinderAgainstTheLowerLimit) {
  const Finding bore = found(drawn(test::w6(), kBore, {4}), envelope_asked(39.995, 40.010));
  ASSERT_EQ(bore.judged.size(), 2U);
  EXPECT_EQ(bore.judged[0].symbol, "d GX");
  EXPECT_NEAR(bore.judged[0].value_mm, 39.994130396679, kSizeDigits);
  EXPECT_EQ(bore.judged[0].limits.lower_mm, 39.995);
  EXPECT_EQ(bore.judged[1].symbol, "d LP SX");
  EXPECT_NEAR(bore.judged[1].value_mm, 40.005130701989, kSizeDigits);
  EXPECT_EQ(bore.judged[1].limits.upper_mm, 40.010);
}

TEST(DrawingEnvelope, FailsWhereLocalSizeIsUndefinedAndIsVoidWhereItHolds) {
  const auto odd = drawn(test::turned_layers(3, 7, round_12), {false, 0.0});
  const Finding fails = found(odd, envelope_asked(23.9, 23.99));
  ASSERT_EQ(fails.judged.size(), 1U);
  EXPECT_NEAR(fails.judged[0].value_mm, 24.0, kSizeDigits);
  EXPECT_EQ(refusal(odd, envelope_asked(23.9, 24.01)).code, core::Code::kSampling);
}

TEST(DrawingSides, ShaftAndBoreDifferByFourTipRadii) {
  const auto shaft = drawn(test::w1(), {false, 1.5});
  const auto bore = drawn(test::w1(), {true, 1.5});
  EXPECT_NEAR(value(bore, size_asked(SizeKind::kGG)) - value(shaft, size_asked(SizeKind::kGG)), 6.0,
              1e-12);
  EXPECT_EQ(found(shaft, size_asked(SizeKind::kGN)).reference.english(), "GN");
  EXPECT_EQ(found(shaft, size_asked(SizeKind::kGX)).reference.english(), "GX, as felt by the tip");
  EXPECT_EQ(found(bore, size_asked(SizeKind::kGX)).reference.english(), "GX");
  EXPECT_EQ(found(bore, size_asked(SizeKind::kGN)).reference.english(), "GN, as felt by the tip");
}

TEST(DrawingTip, EnvelopeSizesDoNotDependOnIt) {
  // The tip centres follow the parallel curve of a lobed shaft.
  const auto size_with = [](double rho) {
    test::Layers layers(2);
    for (std::size_t j = 0; j < 2; ++j) {
      for (int i = 0; i < 720; ++i) {
        const double t = core::kTwoPi * i / 720.0;
        const double r = 12.5 + 0.006 * std::cos(3 * t);
        const double slope = -0.018 * std::sin(3 * t);
        const Eigen::Vector2d u(std::cos(t), std::sin(t));
        const Eigen::Vector2d normal =
            (r * u + slope * Eigen::Vector2d(u.y(), -u.x())) / std::hypot(r, slope);
        const Eigen::Vector2d p = r * u + rho * normal;
        layers[j].emplace_back(p.x(), p.y(), 20.0 * static_cast<double>(j));
      }
    }
    return value(drawn(layers, {false, rho}), size_asked(SizeKind::kGN), Proof::kNone);
  };
  const double half = size_with(0.5);
  EXPECT_NEAR(half, 25.012, 1e-6);
  EXPECT_NEAR(size_with(1.0), half, 1e-6);
  EXPECT_NEAR(size_with(2.0), half, 1e-6);
}

TEST(DrawingTip, OfUnknownRadiusGivesNoSize) {
  auto part = drawn(test::w1(), {false, 0.0});
  part.surface.tip_known = false;
  EXPECT_EQ(refusal(part, size_asked(SizeKind::kGG)).what,
            "the tip radius is not known: give source.tip_diameter_mm; a size needs it");
}

TEST(DrawingRelations, OfSizesHoldWithTheirSlack) {
  std::mt19937 engine(20261123);
  std::uniform_real_distribution<double> rough(-0.01, 0.01);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const double lean = 0.2 * rough(engine);
    const auto layers = test::turned_layers(
        3, 12, [&](int j, double t) { return 15.0 + lean * j * std::cos(t) + rough(engine); });
    const auto part = drawn(layers, {false, 0.0});
    const double gn = value(part, size_asked(SizeKind::kGN), Proof::kNone);
    const double gx = value(part, size_asked(SizeKind::kGX), Proof::kNone);
    const double gg = value(part, size_asked(SizeKind::kGG), Proof::kNone);
    EXPECT_LE(gx, gg);
    EXPECT_LE(gg, gn);
    const Finding local = found(part, size_asked(SizeKind::kLP));
    EXPECT_LE(number(local, "SN"), number(local, "SM"));
    EXPECT_LE(number(local, "SM"), number(local, "SX"));
    // Angle of the GN and GX axis to the least-squares axis, misalignment of a pair.
    const double radius = 15.0;
    const auto slack = [&](const fit::OneSidedCylinder& cylinder) {
      const double t = cylinder.axis.direction.cross(part.surface.axis.direction).norm();
      const double eps = 0.003;
      const double q = 0.02;  // no section centre is farther from such an axis
      return radius * t * t + 0.5 * radius * eps * eps + q * q / radius;
    };
    const auto& points = part.surface.points_mm;
    EXPECT_LE(number(local, "SX"), gn + slack(*fit::min_circumscribed_cylinder(points)));
    EXPECT_GE(number(local, "SN"), gx - slack(*fit::max_inscribed_cylinder(points)));
    const Finding sections = found(part, size_asked(SizeKind::kGN, Indication::Section::kACS));
    const auto outer = fit::min_circumscribed_cylinder(points);
    const double t = outer->axis.direction.cross(part.surface.axis.direction).norm();
    // The layers are square to z: their points differ in height along the least-squares axis.
    const double off_square = part.surface.axis.direction.head<2>().norm();
    for (const LocalValue& section : sections.local) {
      EXPECT_LE(section.value_mm, gn + radius * t * (t + 2.0 * off_square) + 1e-12);
    }
  }
}

TEST(DrawingSize, OfPointsThatHideAPartOfTheTurnHasNoVerdict) {
  auto layers = test::turned_layers(3, 12, round_12);
  for (auto& layer : layers) layer.resize(8);  // 150 deg without a point
  const auto arc = drawn(layers, {false, 0.0});
  EXPECT_TRUE(found(arc, size_asked(SizeKind::kGG)).no_verdict);
  // A window over the same points is known.
  const auto window = drawn(test::turned_layers(3, 12, round_12), {false, 0.0}, {8, 9, 10, 11});
  EXPECT_FALSE(found(window, size_asked(SizeKind::kGG)).no_verdict);
  const auto half = drawn(test::turned_layers(3, 12, round_12), {false, 0.0}, {6, 7, 8, 9, 10, 11});
  EXPECT_TRUE(found(half, size_asked(SizeKind::kGG, Indication::Section::kACS)).no_verdict);
  auto one = test::turned_layers(4, 12, round_12);
  one[3].resize(1);
  for (const SizeKind size : {SizeKind::kGG, SizeKind::kGN, SizeKind::kGX, SizeKind::kGC}) {
    EXPECT_TRUE(found(drawn(one, {false, 0.0}), size_asked(size)).no_verdict);
  }
  for (auto& layer : layers) layer.resize(6);
  EXPECT_EQ(refusal(drawn(layers, {false, 0.0}), size_asked(SizeKind::kGG)).code,
            core::Code::kReferenceAbsent);
}

struct Refused {
  std::string name;
  record::Characteristic asked;
  core::Code code;
  std::string words;  // what to plan instead
};

record::Characteristic with(record::Characteristic asked, auto change) {
  change(asked.indication);
  return asked;
}

TEST(DrawingRefusals, OfSizesSayWhatToPlanInstead) {
  const auto touched = drawn(test::w1(), kShaft);
  const std::vector<Refused> cases = {
      {"spherical", size_asked(SizeKind::kLS), core::Code::kMeaning, "ask for size LP or GX"},
      {"unfiltered CC", size_asked(SizeKind::kCC), core::Code::kMeaning,
       "give filter and cutoff_upr"},
      {"touched CC", filtered(size_asked(SizeKind::kCC)), core::Code::kSampling,
       "350 are needed for 50 UPR; scan, or ask for size GG"},
      {"CV of sections", filtered(size_asked(SizeKind::kCV, Indication::Section::kACS)),
       core::Code::kMeaning, "section \"all\""},
      {"rank of GG", with(size_asked(SizeKind::kGG), [](Indication& i) { i.rank = RankKind::kSA; }),
       core::Code::kMeaning, "leave rank out"},
      {"envelope of a section",
       with(envelope_asked(24.0, 26.0),
            [](Indication& i) { i.section = Indication::Section::kACS; }),
       core::Code::kMeaning, "leave size and section out"},
  };
  for (const Refused& one : cases) {
    const core::Error why = refusal(touched, one.asked);
    EXPECT_EQ(why.code, one.code) << one.name;
    EXPECT_NE(why.what.find(one.words), std::string::npos) << one.name << ": " << why.what;
  }
  const auto one_layer = drawn({test::w1().front()}, kShaft);
  EXPECT_EQ(refusal(one_layer, size_asked(SizeKind::kGN)).code, core::Code::kRank);
  const auto few = drawn(test::turned_layers(2, 2, round_12), kShaft);
  EXPECT_EQ(refusal(few, size_asked(SizeKind::kGG)).code, core::Code::kTooFewPoints);
  auto gap = w8({20.0});
  gap.surface.sections.front().gap = true;
  EXPECT_EQ(refusal(gap, filtered(size_asked(SizeKind::kCA))).code, core::Code::kSampling);
  auto unsorted = drawn(test::w1(), kShaft);
  unsorted.surface.sections.clear();
  EXPECT_NE(refusal(unsorted, size_asked(SizeKind::kLP)).what.find("column layer"),
            std::string::npos);
}

}  // namespace
}  // namespace rondure::evaluation
