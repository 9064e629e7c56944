// Twins of every kind, drawn anew each time: how often an interval holds the truth at the touched
// points, and what is said of parts below and above their limits. The limits are planted: whatever
// the truth of a value is, its limit is set so that the part takes up 50 or 80 % of it, or exceeds
// it by 2, 10 or 50 %. The counts behind docs/developer/accuracy.md: RONDURE_FULL=all.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/evaluate.h"
#include "evaluation/results/finding.h"
#include "plans/plan.h"
#include "tests/core/full.h"
#include "tests/plans/files.h"
#include "tests/plans/random_inspection.h"

namespace rondure::plans {
namespace {

using evaluation::CharacteristicResult;
using evaluation::Verdict;
using record::Form;

/// Truth over limit.
constexpr std::array<double, 5> kLevels_1 = {0.5, 0.8, 1.02, 1.1, 1.5};
constexpr std::size_t kFirstBad = 2;
constexpr std::size_t kTenPercent = 3;
/// Share of the parts at half of their limits and with U below T/4 that conform, at least: who
/// leaves all undecided is never wrong.
constexpr double kUseful_1 = 0.9;
/// Half of the distance of two limits.
constexpr double kHalf_mm = 10.0 * core::kMicrometre;

/// What was said of parts at one level.
struct Said {
  int parts = 0;
  int conform = 0;
  int rejected = 0;
  int undecided = 0;
  int none = 0;          ///< Void.
  int wrong_narrow = 0;  ///< Conform beyond the limit with U below T/20.
  int clear = 0;         ///< With U below T/4.
  int clear_conform = 0;

  /// @param share_1  U over T.
  void add(Verdict verdict, double share_1) {
    ++parts;
    clear += share_1 < 0.25 ? 1 : 0;
    clear_conform += share_1 < 0.25 && verdict == Verdict::kConforms ? 1 : 0;
    const bool narrow = share_1 < 0.05;
    conform += verdict == Verdict::kConforms ? 1 : 0;
    rejected += verdict == Verdict::kDoesNotConform ? 1 : 0;
    undecided += verdict == Verdict::kUndecided ? 1 : 0;
    none += verdict == Verdict::kVoid ? 1 : 0;
    wrong_narrow += verdict == Verdict::kConforms && narrow ? 1 : 0;
  }
};

/// All that is counted of one form.
struct Counted {
  int twins = 0;
  int stated = 0;  ///< With an interval.
  int inside = 0;
  int below = 0;  ///< Truth below the interval.
  double over_u = 0.0;
  double over_u2 = 0.0;
  double u_um = 0.0;
  std::array<Said, kLevels_1.size()> said = {};
};

using Counts = std::map<std::string, Counted>;

std::string name_of_asked(const record::Characteristic& asked) {
  std::string out(record::name_of(asked.form));
  if (asked.form == Form::kLocation || asked.form == Form::kAxisError) return out;
  return out + " " + std::string(asked.id);
}

/// The limits between which the truths take up `level` of what is allowed.
void plant(record::Characteristic& asked, const CharacteristicResult& found, double level) {
  const auto [least, greatest] =
      std::minmax_element(found.truths_mm.begin(), found.truths_mm.end());
  if (asked.lower_mm) {
    asked.tolerance_mm = *greatest + (1.0 - level) * kHalf_mm;
    asked.lower_mm = std::min(*least, *greatest) - 2.0 * kHalf_mm;
  } else {
    asked.tolerance_mm = std::abs(*greatest) / level;
  }
}

bool is_planted(const CharacteristicResult& found) {
  return found.characteristic.toleranced() && found.characteristic.harmonic_limits.empty() &&
         !found.truths_mm.empty() && std::abs(found.truths_mm.front()) > 1e-9;
}

void count_interval(const CharacteristicResult& found, Counted& out) {
  ++out.twins;
  if (!found.value || found.truths_mm.size() != 1) return;
  const auto* stated = found.value->statement();
  if (stated == nullptr) return;
  const double truth = found.truths_mm.front();
  ++out.stated;
  const bool above_low = stated->at_most || truth >= stated->low_mm;
  out.inside += above_low && truth <= stated->high_mm ? 1 : 0;
  out.below += above_low ? 0 : 1;
  const double u = stated->standard_uncertainty_mm;
  const double over = (found.value->quoted_mm() - truth) / u;
  out.over_u += over;
  out.over_u2 += over * over;
  out.u_um += u / core::kMicrometre;
}

/// Counts one twin; at the planted limits too where `with_verdicts`.
void count_twin(const Plan& plan, bool with_verdicts, Counts& counts) {
  const test::Inspection run = test::inspect(plan);
  for (const evaluation::FeatureResult& feature : run.evaluation.features) {
    for (const CharacteristicResult& found : feature.characteristics) {
      if (is_planted(found)) count_interval(found, counts[name_of_asked(found.characteristic)]);
    }
  }
  // Without the full counts the extremes alone, which leave nothing to chance.
  const std::size_t step = test::full() ? 1 : kLevels_1.size() - 1;
  for (std::size_t l = 0; with_verdicts && l < kLevels_1.size(); l += step) {
    record::RunRecord planted = run.record;
    for (std::size_t f = 0; f < run.evaluation.features.size(); ++f) {
      const auto& results = run.evaluation.features[f].characteristics;
      for (std::size_t c = 0; c < results.size(); ++c) {
        if (!is_planted(results[c])) continue;
        plant(planted.features[f].characteristics[c], results[c], kLevels_1[l]);
      }
    }
    const auto judged = evaluation::evaluate(planted);
    ASSERT_TRUE(judged.has_value());
    for (std::size_t f = 0; f < run.evaluation.features.size(); ++f) {
      const auto& results = run.evaluation.features[f].characteristics;
      for (std::size_t c = 0; c < results.size(); ++c) {
        if (!is_planted(results[c])) continue;
        const CharacteristicResult& said = judged->features[f].characteristics[c];
        const auto* stated = said.value ? said.value->statement() : nullptr;
        const double allowed = said.characteristic.lower_mm
                                   ? 2.0 * kHalf_mm
                                   : said.characteristic.tolerance_mm.value_or(0.0);
        const double share_1 =
            stated != nullptr ? 0.5 * (stated->high_mm - stated->low_mm) / allowed : 1.0;
        counts[name_of_asked(said.characteristic)].said[l].add(said.verdict, share_1);
      }
    }
  }
}

void print(const char* title, const Counts& counts) {
  std::printf("%s\nform | twins, stated | inside | truth below | d/u mean, sd | u um", title);
  for (const double level : kLevels_1) std::printf(" | %.2f", level);
  std::printf("   (conform / undecided / rejected / void)\n");
  for (const auto& [name, c] : counts) {
    const double n = std::max(1, c.stated);
    std::printf("%s | %d, %d | %.1f %% | %d | %+.2f, %.2f | %.3f", name.c_str(), c.twins, c.stated,
                100.0 * c.inside / n, c.below, c.over_u / n,
                std::sqrt(std::max(0.0, c.over_u2 / n - std::pow(c.over_u / n, 2))), c.u_um / n);
    for (const Said& s : c.said) {
      std::printf(" | %d/%d/%d/%d", s.conform, s.undecided, s.rejected, s.none);
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

/// The rule's own risk and two standard deviations of the count.
int allowed(int parts) {
  constexpr double kRisk_1 = 0.025;
  return static_cast<int>(
      std::ceil(kRisk_1 * parts + 2.0 * std::sqrt(parts * kRisk_1 * (1.0 - kRisk_1))));
}

void expect_honest(const Counts& counts) {
  std::array<Said, kLevels_1.size()> all = {};
  for (const auto& [name, c] : counts) {
    SCOPED_TRACE(name);
    EXPECT_EQ(c.said.back().conform, 0);
    for (std::size_t l = kFirstBad; l < kLevels_1.size(); ++l) {
      EXPECT_LE(c.said[l].conform, allowed(c.said[l].parts)) << kLevels_1[l];
    }
    EXPECT_EQ(c.said[kTenPercent].wrong_narrow, 0);
    for (std::size_t l = 0; l < kLevels_1.size(); ++l) {
      all[l].parts += c.said[l].parts;
      all[l].conform += c.said[l].conform;
      all[l].clear += c.said[l].clear;
      all[l].clear_conform += c.said[l].clear_conform;
    }
  }
  for (std::size_t l = 0; l < kLevels_1.size(); ++l) {
    std::printf("%.2f: %d of %d conform, %d of %d with U < T/4\n", kLevels_1[l], all[l].conform,
                all[l].parts, all[l].clear_conform, all[l].clear);
  }
  EXPECT_GT(all.front().clear, 0);
  EXPECT_GE(all.front().clear_conform, kUseful_1 * all.front().clear);
}

// ---- Set-ups.

Plan judged_example(const std::string& name) {
  Plan out = testing::plan_of(name);
  out.decision_rule = {};
  out.decision_rule.rule = record::DecisionRuleTask::Rule::kIso14253;
  return out;
}

/// Fewest trials and no budget, so that many twins can be drawn.
void judge_by_interval(Plan& plan) {
  if (!plan.uncertainty) plan.uncertainty.emplace();
  plan.uncertainty->most_trials = plan.uncertainty->least_trials;
  plan.uncertainty->budget_trials = 0;
}

template <class Waves>
void shuffle(Waves& waves, core::KeyedNoise& draw) {
  for (auto& wave : waves) {
    wave.phase_deg = 360.0 * draw.uniform();
    if constexpr (requires { wave.amplitude_mdeg; }) {
      wave.amplitude_mdeg *= 0.6 + 0.8 * draw.uniform();
    } else {
      wave.amplitude_um *= 0.6 + 0.8 * draw.uniform();
    }
  }
}

struct Sampling {
  int layers = 2;
  int points = 8;
};

/// Leaves what takes a tenth of the time: four call-outs of journal A.
void keep_quick(Plan& plan) {
  plan.features.resize(1);
  std::erase_if(plan.features.front().characteristics, [](const record::CharacteristicTask& asked) {
    return asked.form != Form::kCylindricity && asked.form != Form::kTaper &&
           asked.id != "30h6 GG" && asked.id != "STRt median 3";
  });
}

/// The shaft of example 15: twenty call-outs in one clamping.
Plan shaft(const Sampling& sampling, std::uint64_t seed) {
  Plan out = judged_example("15_shaft_drawing.json");
  judge_by_interval(out);
  record::ProbeInfluencesTask& probe = out.uncertainty->probe.emplace();
  probe.repeatability_um = 0.3;
  probe.lobes = {{3, 0.05}};
  core::KeyedNoise draw(seed, {15});
  out.simulation->seed = seed;
  out.simulation->probe.repeatability_um = 0.3;
  if (!test::full()) keep_quick(out);
  for (FeaturePlan& feature : out.features) {
    feature.exclude.clear();
    feature.sampling.method = decltype(feature.sampling.method){};
    feature.sampling.layers = feature.type == record::Shape::kCylinder ? sampling.layers : 2;
    feature.sampling.points_per_layer = test::cases(std::min(sampling.points, 36), sampling.points);
  }
  for (SimulatedFeaturePlan& feature : out.simulation->features) {
    feature.keyways.clear();
    shuffle(feature.lobes, draw);
    const double grown = 3.0;  // form against noise as on a part near its limits
    for (LobePlan& lobe : feature.lobes) lobe.amplitude_um *= grown;
    for (double* value :
         {&feature.offset_x_um, &feature.offset_y_um, &feature.slope_x_urad, &feature.slope_y_urad,
          &feature.taper_um, &feature.tilt_urad, &feature.saucer_um, &feature.wave_um}) {
      *value *= grown * (2.0 * draw.uniform() - 1.0);
    }
    if (feature.id.starts_with("journal") || feature.id.starts_with("seat")) {
      feature.barrel_um = draw.normal();
      feature.bend_um = draw.normal();
      feature.bend_phase_deg = 360.0 * draw.uniform();
    }
  }
  return out;
}

/// One analysis of example 16.
Plan analysis(record::Shape type, std::uint64_t seed) {
  Plan out = judged_example("16_four_analyses.json");
  judge_by_interval(out);
  std::erase_if(out.features, [&](const FeaturePlan& feature) { return feature.type != type; });
  core::KeyedNoise draw(seed, {16});
  SimulationPlan& twin = *out.simulation;
  twin.seed = seed;
  const auto ask = [&](const char* id, Form form, double tolerance_um) {
    record::CharacteristicTask asked;
    asked.id = id;
    asked.form = form;
    asked.tolerance_um = tolerance_um;
    out.features.front().characteristics.push_back(asked);
  };
  if (type == record::Shape::kSpindle) {
    ask("RONq", Form::kRoundnessRms, 10.0);
    if (test::full()) {
      ask("total", Form::kMotionTotal, 10.0);
      ask("asynchronous", Form::kMotionAsynchronous, 10.0);
    }
    shuffle(twin.spindle->profile, draw);
    shuffle(twin.spindle->motion_x, draw);
    shuffle(twin.spindle->motion_y, draw);
    twin.spindle->eccentricity_deg = 360.0 * draw.uniform();
    twin.spindle->asynchronous_um = 0.15;
    twin.spindle->turns = 8;
    for (double& gain : twin.spindle->probe_gain_error) gain = 0.003 * draw.normal();
    twin.spindle->p2_error_deg = 0.05 * draw.normal();
    twin.spindle->p3_error_deg = 0.05 * draw.normal();
  } else if (type == record::Shape::kWheel) {
    ask("edge roundness", Form::kRoundness, 10.0);
    shuffle(twin.wheel->lobes, draw);
    twin.wheel->points = 36;
    twin.wheel->eccentricity_deg = 360.0 * draw.uniform();
    twin.wheel->axis_x_mm += 0.5 * core::kMicrometre * draw.normal();
    twin.wheel->axis_z_mm += 0.5 * core::kMicrometre * draw.normal();
    twin.wheel->radius_mm += 0.01 * draw.uniform();
  } else {
    shuffle(twin.contour->c_error, draw);
    shuffle(twin.contour->x_error, draw);
    shuffle(twin.contour->rest, draw);
  }
  return out;
}

/// The head of example 19.
Plan head(std::uint64_t seed) {
  Plan out = judged_example("19_five_axis_head.json");
  out.features.resize(1);
  judge_by_interval(out);
  core::KeyedNoise draw(seed, {19});
  out.simulation->seed = seed;
  for (HeadMotionPlan& wave : out.simulation->five_axis->errors) {
    wave.phase_deg = 360.0 * draw.uniform();
  }
  for (record::CharacteristicTask& asked : out.features.front().characteristics) {
    if (asked.form == Form::kLocation) asked.tolerance_um = 15.0;
  }
  return out;
}

/// What a calibration of balls is uncertain of in a twin: its touches alone.
void declare_touches_alone(Plan& plan) {
  record::ProbeInfluencesTask& probe = plan.uncertainty->probe.emplace();
  probe.repeatability_um = plan.simulation->probe.repeatability_um;
  probe.lobes = {{3, 0.05}};
  for (FeaturePlan& feature : plan.features) {
    if (!feature.rotary_axes) continue;
    auto& influences = feature.rotary_axes->uncertainty.emplace();
    for (record::Influence* one :
         {&influences.ball_um, &influences.repeat_urad, &influences.reading_urad}) {
      one->emplace().value = 0.0;
    }
  }
}

/// The calibration of example 03, or calibration and part of example 18.
Plan calibration(const char* example, std::uint64_t seed) {
  Plan out = judged_example(example);
  judge_by_interval(out);
  declare_touches_alone(out);
  core::KeyedNoise draw(seed, {18});
  out.simulation->seed = seed;
  out.simulation->fixture.motion->seed = seed;
  shuffle(out.simulation->part.lobes, draw);
  return out;
}

/// The part of example 21, in a fixture that stands elsewhere each time.
Plan on_holes(std::uint64_t seed) {
  Plan out = judged_example("21_fixture_on_holes.json");
  judge_by_interval(out);
  out.uncertainty->machine = {};  // this twin has no such errors
  out.uncertainty->thermal = {};
  out.uncertainty->fixture = {};
  declare_touches_alone(out);
  core::KeyedNoise draw(seed, {21});
  out.simulation->seed = seed;
  shuffle(out.simulation->part.lobes, draw);
  for (std::size_t i = 0; i < 3; ++i) {
    // Together within the millimetre that the plan allows.
    out.simulation->fixture.base_offset_mm[i] = 0.6 * (draw.uniform() - 0.5);
    out.simulation->fixture.base_rotation_deg[i] = 0.1 * (draw.uniform() - 0.5);
  }
  return out;
}

/// The pins of example 20 with traces, before and after the correction.
Plan next_pins(std::uint64_t seed) {
  Plan out = judged_example("20_crank_pin_next_part.json");
  judge_by_interval(out);
  auto influences = testing::plan_of("07_crank_pin.json").features.front().contour->uncertainty;
  // What this twin grinds is no draw of encoders.
  influences->c_encoder_urad = influences->x_encoder_um = record::DeclaredInfluence{0.0};
  for (FeaturePlan& feature : out.features) {
    feature.contour->separation = record::ContourTask::Separation::kDirect;
    feature.contour->error = record::ContourTask::Error::kCommandMinusActual;
    feature.contour->c_axis = record::ContourTask::CAxis::kAgainstWheel;
    feature.contour->uncertainty = influences;
    for (record::CharacteristicTask& asked : feature.characteristics) {
      asked.id = feature.id + ", " + asked.id;
    }
  }
  core::KeyedNoise draw(seed, {20});
  out.simulation->seed = seed;
  shuffle(out.simulation->contour->c_error, draw);
  shuffle(out.simulation->contour->x_error, draw);
  return out;
}

template <class Draw>
void study(const char* title, const Draw& draw, int few, int full, int all, int judged_of_all) {
  Counts counts;
  const int twins = test::cases(few, full, all);
  const int judged = test::cases(few, full, judged_of_all);
  for (int n = 0; n < twins; ++n) {
    count_twin(draw(static_cast<std::uint64_t>(1000 + n)), n < judged, counts);
  }
  print(title, counts);
  expect_honest(counts);
}

class PlantedShafts : public ::testing::TestWithParam<Sampling> {};

TEST_P(PlantedShafts, ConformOnlyWithinTheirLimits) {
  const Sampling sampling = GetParam();
  const std::string title =
      std::to_string(sampling.layers) + " x " + std::to_string(sampling.points);
  study(
      title.c_str(), [&](std::uint64_t seed) { return shaft(sampling, seed); }, 1,
      sampling.points > 36 ? 1 : 2, 200, 30);
}
INSTANTIATE_TEST_SUITE_P(Samplings, PlantedShafts,
                         ::testing::Values(Sampling{2, 8}, Sampling{3, 12}, Sampling{4, 8},
                                           Sampling{5, 12}, Sampling{3, 36}, Sampling{5, 90}));

TEST(PlantedAnalyses, SpindlesConformOnlyWithinTheirLimits) {
  study(
      "spindle", [](std::uint64_t seed) { return analysis(record::Shape::kSpindle, seed); }, 1, 3,
      200, 40);
}
TEST(PlantedAnalyses, WheelsConformOnlyWithinTheirLimits) {
  study(
      "wheel", [](std::uint64_t seed) { return analysis(record::Shape::kWheel, seed); }, 1, 20, 200,
      40);
}
TEST(PlantedAnalyses, PinsConformOnlyWithinTheirLimits) {
  if (!test::full()) GTEST_SKIP() << "takes 6 s of processor time: run by ./test.sh --full";
  study(
      "pin", [](std::uint64_t seed) { return analysis(record::Shape::kContour, seed); }, 1, 2, 200,
      40);
}
TEST(PlantedAnalyses, HeadsConformOnlyWithinTheirLimits) {
  study(
      "head", [](std::uint64_t seed) { return head(seed); }, 1, 40, 200, 40);
}
TEST(PlantedAnalyses, CalibrationsConformOnlyWithinTheirLimits) {
  study(
      "calibration",
      [](std::uint64_t seed) { return calibration("03_calibrate_fixture.json", seed); }, 1, 40, 200,
      40);
}
TEST(PlantedAnalyses, CalibrationsAndTheirPartsConformOnlyWithinTheirLimits) {
  study(
      "calibration and part",
      [](std::uint64_t seed) { return calibration("18_calibrate_and_inspect.json", seed); }, 1, 4,
      200, 40);
}
TEST(PlantedAnalyses, NextPinsConformOnlyWithinTheirLimits) {
  if (!test::full()) GTEST_SKIP() << "takes some seconds a twin: run by ./test.sh --full";
  study("next pin", next_pins, 1, 1, 200, 20);
}
TEST(PlantedAnalyses, PartsOnHolesConformOnlyWithinTheirLimits) {
  study("part on holes", on_holes, 1, 4, 200, 40);
}

}  // namespace
}  // namespace rondure::plans
