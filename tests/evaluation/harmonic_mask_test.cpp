#include "evaluation/harmonic_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/internal/conformance.h"
#include "reports/html/report.h"
#include "tests/reports/synthetic.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Harmonics 1..50 of amplitude 0.1 um, number 3 of 0.4 um in layer 0 and 0.9 um in layer 1.
Case with_harmonics() {
  Case made = cylinder_case(2, 360, 1);
  evaluation::FeatureResult& feature = made.evaluation.features[0];
  for (evaluation::LayerResult& layer : feature.layers) {
    layer.filtered.emplace();
    for (int number = 1; number <= 50; ++number) {
      const double third = layer.layer == 0 ? 0.4e-3 : 0.9e-3;
      layer.filtered->harmonics.harmonics.push_back({number, number == 3 ? third : 0.1e-3, {}});
    }
  }
  return made;
}

record::Characteristic mask(std::vector<record::HarmonicLimit> lines) {
  record::Characteristic asked;
  asked.id = "waviness";
  asked.form = record::Form::kHarmonicLimits;
  asked.harmonic_limits = std::move(lines);
  return asked;
}

TEST(HarmonicMask, EachHarmonicIsTakenWhereItIsLargest) {
  const Case made = with_harmonics();
  const auto worst = worst_harmonics(made.evaluation.features[0]);
  ASSERT_EQ(worst.size(), 50U);
  EXPECT_EQ(worst[2].number, 3);
  EXPECT_EQ(worst[2].layer, 1);
  EXPECT_DOUBLE_EQ(worst[2].amplitude_mm, 0.9e-3);
}

TEST(HarmonicMask, WhereLinesOverlapTheLeastLimitCounts) {
  const Case made = with_harmonics();
  const auto all = against_mask(made.evaluation.features[0], mask({{2, 10, 0.8e-3}, {3, 3, 2e-3}}));
  ASSERT_EQ(all.size(), 9U);
  EXPECT_DOUBLE_EQ(all[1].limit_mm, 0.8e-3);
  EXPECT_TRUE(all[1].exceeds());
  EXPECT_FALSE(all[0].exceeds());
}

TEST(HarmonicMask, TheNearestToItsLimitDecidesNotTheLargest) {
  const Case made = with_harmonics();
  const auto nearest =
      nearest_to_mask(made.evaluation.features[0], mask({{2, 5, 2e-3}, {6, 50, 0.12e-3}}));
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->harmonic.number, 6);
  EXPECT_DOUBLE_EQ(nearest->limit_mm, 0.12e-3);
}

TEST(HarmonicMask, AMaskAboveWhatThePointsCarryHasNoValue) {
  Case made = with_harmonics();
  evaluation::FeatureResult& feature = made.evaluation.features[0];
  EXPECT_FALSE(nearest_to_mask(feature, mask({{2, 51, 1e-3}})));
  feature.layers[0].filtered.reset();
  const auto sparse = nearest_to_mask(feature, mask({{2, 5, 1e-3}}));
  ASSERT_FALSE(sparse);
  EXPECT_EQ(sparse.error().code, core::Code::kSampling);
}

/// The verdict on one mask, of a finished run with everything that it needs.
evaluation::CharacteristicResult judged(const record::Characteristic& asked) {
  Case made = with_harmonics();
  evaluation::FeatureResult& feature = made.evaluation.features[0];
  feature.feature.strategy = record::Strategy::kPointsFile;
  feature.feature.characteristics = {asked};
  feature.characteristics.clear();
  made.record.ending = "finished";
  std::vector<std::optional<evaluation::FoundCharacteristic>> found(
      feature.feature.characteristics.size());
  decide(made.record, evaluation::DecisionRule(), std::nullopt, found, feature);
  return feature.characteristics.at(0);
}

TEST(HarmonicMask, IsJudgedLikeAnyCharacteristic) {
  const evaluation::CharacteristicResult good = judged(mask({{2, 50, 1e-3}}));
  EXPECT_EQ(good.verdict, evaluation::Verdict::kConforms) << good.reason;
  EXPECT_THAT(good.reason, HasSubstr("harmonic 3 of layer 2 is nearest to its limit"));
  EXPECT_DOUBLE_EQ(*good.characteristic.tolerance_mm, 1e-3);
  EXPECT_EQ(judged(mask({{2, 50, 0.5e-3}})).verdict, evaluation::Verdict::kDoesNotConform);
  const evaluation::CharacteristicResult beyond = judged(mask({{2, 60, 1e-3}}));
  EXPECT_EQ(beyond.verdict, evaluation::Verdict::kVoid);
  EXPECT_TRUE(beyond.characteristic.tolerance_mm) << "a void mask must make the run void";
}

TEST(HarmonicMask, ThePageDrawsTheLimitsAndListsWhatGoesBeyond) {
  Case made = with_harmonics();
  evaluation::FeatureResult& feature = made.evaluation.features[0];
  EXPECT_THAT(write_html(made.record, made.evaluation), HasSubstr("The plan gives no limits."));
  feature.feature.characteristics.push_back(mask({{2, 10, 0.8e-3}, {11, 50, 1e-3}}));
  const std::string page = write_html(made.record, made.evaluation);
  EXPECT_THAT(page, HasSubstr("Harmonics beyond the limits of <bdi>waviness</bdi>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">3</td><td class=\"n\">2</td><td "
                              "class=\"n\">0.900</td><td class=\"n\">0.800</td>"));
  EXPECT_THAT(write_html(cylinder_case(4, 7, 1).record, cylinder_case(4, 7, 1).evaluation),
              Not(HasSubstr("Harmonics of the sections")));
}

}  // namespace
}  // namespace rondure::reports
