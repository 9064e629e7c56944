#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "record/decision_rule.h"
#include "record/tasks/characteristic.h"
#include "record/tasks/contour.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "record/tasks/spindle.h"
#include "record/tasks/surface.h"
#include "record/tasks/uncertainty.h"
#include "record/tasks/wheel.h"

namespace rondure::record {
namespace {

using ::testing::HasSubstr;

/// A number of which every bit counts.
constexpr double kOdd = 0.1 + 0.2;

/// The settings, one line each, numbers by their bits.
std::vector<std::string> lines_of(const std::vector<Setting>& settings) {
  std::vector<std::string> out;
  for (const Setting& setting : settings) {
    out.push_back(setting.name + " " +
                  (setting.number ? std::to_string(std::bit_cast<std::uint64_t>(*setting.number))
                                  : "'" + setting.text + "'"));
  }
  return out;
}

/// Expects that a task goes to settings and back with the same bits.
template <class Task>
void comes_back(const Task& task) {
  const auto settings = settings_of_task(task, "of/");
  const auto read = task_of<Task>(settings, "of/");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(lines_of(settings_of_task(*read, "of/")), lines_of(settings));
}

/// Expects that no text of a task can be another word, and that each key keeps its kind.
/// @param free  Keys whose text may be anything.
template <class Task>
void refuses_other_words(const Task& task, const std::vector<std::string>& free = {}) {
  const auto settings = settings_of_task(task);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    SCOPED_TRACE(settings[i].name);
    if (std::find(free.begin(), free.end(), settings[i].name) != free.end()) continue;
    auto other = settings;
    other[i].text = "nothing-of-that";
    if (!other[i].number) {
      const auto read = task_of<Task>(other);
      ASSERT_FALSE(read);
      EXPECT_EQ(read.error().code, core::Code::kMeaning);
      EXPECT_THAT(read.error().what, HasSubstr("\"" + settings[i].name + "\""));
      EXPECT_THAT(read.error().what, HasSubstr("\"nothing-of-that\""));
      other[i].number = 1.0;
    } else {
      other[i].number.reset();
    }
    EXPECT_FALSE(task_of<Task>(other)) << "a number where a text belongs, or the reverse";
  }
}

SpindleTask full_spindle() {
  SpindleTask out;
  out.layout = SpindleTask::Layout::kReference;
  out.p1_to_p2_deg = kOdd;
  out.p2_to_p3_deg = -kOdd;
  out.p1_to_p3_deg = -0.0;
  out.crank_radius_mm = std::numeric_limits<double>::denorm_min();
  out.samples = 720;
  out.probe_noise_um = kOdd / 3.0;
  out.probe_range_um = kOdd / 5.0;
  out.tip_width_mm = kOdd / 7.0;
  out.second_order = SpindleTask::SecondOrder::kOff;
  out.motion = SpindleTask::Motion::kAsPublished;
  out.filter = SpindleTask::Filter::kNone;
  out.wheel_radius_from.emplace().feature = "ground with";
  SpindleInfluencesTask& declared = out.uncertainty.emplace();
  declared.gain_1 = DeclaredInfluence{kOdd / 100.0};
  declared.line_um = DeclaredInfluence{kOdd, DeclaredInfluence::Distribution::kRectangular};
  declared.encoder_urad = DeclaredInfluence{0.0};
  return out;
}

WheelTask full_wheel() {
  WheelTask out;
  out.mode = WheelTask::Mode::kEnvelope;
  out.nominal_radius_mm = kOdd;
  out.axis_x_mm = -kOdd;
  out.axis_z_mm = -0.0;
  out.center = WheelTask::Center::kAsPublished;
  out.kappa_limit = kOdd / 7.0;
  out.expansion_per_K = kOdd * 1e-7;
  out.robust = Switch::kOn;
  out.short_arc = WheelTask::ShortArc::kAllowed;
  GroundSurfaceTask& surface = out.surface.emplace();
  surface.form = GroundSurfaceTask::Form::kTable;
  surface.coefficients = {0.0, kOdd, -0.0};
  surface.vertex_radius_mm = 80.0 * kOdd;
  surface.table_x_mm = {1.0, kOdd};
  surface.cusp_um = kOdd;
  surface.radius = GroundSurfaceTask::Radius::kEffective;
  surface.touch_off_mm = 0.0;
  WheelInfluencesTask& declared = out.uncertainty.emplace();
  declared.point_um = DeclaredInfluence{kOdd};
  declared.wear_um = DeclaredInfluence{kOdd, DeclaredInfluence::Distribution::kRectangular};
  return out;
}

ContourTask full_contour() {
  ContourTask out;
  out.crank_radius_mm = kOdd;
  out.method = ContourTask::Method::kAsPublished;
  out.error = ContourTask::Error::kCommandMinusActual;
  out.c_axis = ContourTask::CAxis::kAgainstWheel;
  out.gauge = ContourTask::Gauge::kClockwise;
  out.phase_offset_deg = -0.0;
  out.samples = 16;
  out.filter = ContourTask::Filter::kDoneByGauge;
  out.base_circle = ContourTask::BaseCircle::kGeometric;
  out.wheel_radius_from.emplace().feature = "ground with";
  out.parts = {{"", "a1.csv", "p1.csv", ""}, {"second", "a2.csv", "p2.csv", "m2.csv"}};
  ContourInfluencesTask& declared = out.uncertainty.emplace();
  declared.gauge_um = DeclaredInfluence{kOdd};
  declared.skew_ms = DeclaredInfluence{kOdd, DeclaredInfluence::Distribution::kRectangular};
  return out;
}

RotaryTask full_rotary_axes() {
  RotaryTask out;
  out.balls = {{"A", {kOdd, -0.0, 1.0}}, {"B", {0.0, 0.0, kOdd}}};
  out.ball_diameter_mm = kOdd * 100.0;
  out.alpha_stations_deg = {-10.0, kOdd};
  out.beta_stations_deg = {5.0};
  out.verification = {{kOdd, -kOdd}, {1.0, 2.0}};
  RotaryInfluencesTask& declared = out.uncertainty.emplace();
  declared.ball_um = DeclaredInfluence{kOdd};
  declared.expansion_per_K = DeclaredInfluence{23e-6};
  return out;
}

DecisionRuleTask full_rule() {
  DecisionRuleTask out;
  out.rule = DecisionRuleTask::Rule::kGuardBand;
  out.measurand = DecisionRuleTask::Measurand::kWholeSurface;
  out.judge = DecisionRuleTask::Judge::kCorrected;
  out.guard_factor = kOdd;
  out.prior = PriorTask{PriorTask::Distribution::kNormal, kOdd, kOdd / 3.0};
  out.rejection_guard_percent = -kOdd;
  out.zones = "two";
  return out;
}

UncertaintyTask full_uncertainty() {
  UncertaintyTask out;
  out.coverage_percent = 99.0 + kOdd;
  out.seed = 9007199254740991;
  ProbeInfluencesTask& probe = out.probe.emplace();
  probe.repeatability_um = kOdd;
  probe.lobes = {{3, kOdd}, {5, 0.0}};
  MachineInfluencesTask& machine = out.machine.emplace();
  machine.translations = {{.error = "EYX", .linear_um_m = kOdd}, {.error = "EZZ"}};
  machine.rotations = {{.error = "ECZ", .wave_urad = kOdd}};
  out.thermal.emplace().drift_K = kOdd;
  out.fixture.emplace();
  FormSpectrumTask& spectrum = out.form_spectrum.emplace();
  spectrum.amplitudes = FormSpectrumTask::Amplitudes::kAbsolute;
  spectrum.terms = {{2, 0, kOdd}, {3, 4, 1.0}};
  return out;
}

CharacteristicTask full_characteristic() {
  CharacteristicTask out;
  out.id = "30h6";
  out.form = Form::kDiameter;
  out.reference = Reference::kLeastSquares;
  out.lower_um = -13.0;
  out.upper_um = kOdd;
  out.harmonic_limits = {{2, 15, kOdd}};
  Indication& i = out.indication;
  i.parameter = Indication::Parameter::kPeak;
  i.size = Indication::Size::kGN;
  i.rank = Indication::Rank::kSQ;
  i.section = Indication::Section::kSCS;
  i.section_layers = {1.0, 3.0};
  i.requirement = Indication::Requirement::kEnvelope;
  i.of = Indication::Of::kMedianLine;
  i.direction = Indication::Direction::kConical;
  i.radius_mm = kOdd;
  i.angle_deg = -0.0;
  i.from_mm = -kOdd;
  i.to_mm = kOdd;
  i.datum = {"A-B", "C"};
  i.association = Indication::Association::kZone;
  i.filter = Indication::Filter::kSpline;
  i.cutoff_upr = 50.0;
  i.cutoff_mm = 0.8;
  i.outliers = Indication::Outliers::kFiveScales;
  i.decision_rule = full_rule();
  return out;
}

SurfaceSettings full_surface() {
  SurfaceSettings out;
  out.letter = "A";
  out.clamping = "one";
  out.faces = Faces::kDown;
  out.half_angle_deg = -kOdd;
  out.first_layer_mm = kOdd;
  out.exclude.resize(2);
  out.exclude[0].name = "keyway";
  out.exclude[0].from_deg = 85.0;
  out.exclude[0].to_deg = kOdd;
  out.exclude[1].name = "hole";
  out.exclude[1].guard_mm = 0.0;
  out.exclude[1].found_beyond_um = kOdd;
  return out;
}

FixtureSettings full_fixture() {
  FixtureSettings out;
  out.id = "F-01";
  out.axis_point_mm = {kOdd, -0.0, -kOdd};
  out.max_beta_deg = 90.0;
  out.max_age_days = kOdd;
  out.calibration = "{}";
  return out;
}

TEST(Tasks, ComeBackFromTheirSettingsWithTheSameBits) {
  comes_back(ContourTask());
  comes_back(full_contour());
  comes_back(RotaryTask());
  comes_back(full_rotary_axes());
  comes_back(DecisionRuleTask());
  comes_back(full_rule());
  comes_back(UncertaintyTask());
  comes_back(full_uncertainty());
  comes_back(EnvironmentSettings{"limits", kOdd, kOdd});
  comes_back(CharacteristicTask());
  comes_back(full_characteristic());
  comes_back(SurfaceSettings());
  comes_back(full_surface());
  comes_back(FixtureSettings());
  comes_back(full_fixture());
  comes_back(MergedPosesSettings{Merge::kKinematics, 3, {kOdd, 1.0, -0.0}, {0.0, kOdd, 2.0}});
  comes_back(ExpansionSettings{kOdd, 1e-6, std::nullopt, std::nullopt, 0.1});
  comes_back(SpindleTask());
  comes_back(full_spindle());
  comes_back(WheelTask());
  comes_back(full_wheel());
}

TEST(Tasks, KeepADeclaredZeroApartFromWhatWasNotDeclared) {
  const auto read = task_of<SpindleTask>(settings_of_task(full_spindle()));
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_TRUE(read->uncertainty);
  ASSERT_TRUE(read->uncertainty->encoder_urad);
  EXPECT_EQ(read->uncertainty->encoder_urad->value, 0.0);
  EXPECT_FALSE(read->uncertainty->noise_um);
  EXPECT_DOUBLE_EQ(u_of(read->uncertainty->line_um), kOdd / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(u_of(read->uncertainty->gain_1), kOdd / 100.0);
  EXPECT_EQ(u_of(read->uncertainty->noise_um), 0.0);
}

TEST(Tasks, HaveTheirDefaultsWhereAJournalSaysNothing) {
  const auto spindle = task_of<SpindleTask>({});
  ASSERT_TRUE(spindle);
  EXPECT_EQ(lines_of(settings_of_task(*spindle)), lines_of(settings_of_task(SpindleTask())));
  const auto wheel = task_of<WheelTask>({});
  ASSERT_TRUE(wheel);
  EXPECT_EQ(lines_of(settings_of_task(*wheel)), lines_of(settings_of_task(WheelTask())));
}

TEST(Tasks, TakeTheRadiusOfAWheelOnlyWhereTheJournalNamesIt) {
  const auto names_of = [](const std::vector<Setting>& settings) {
    std::string out;
    for (const Setting& one : settings) out += one.name + " = " + one.text + "\n";
    return out;
  };
  EXPECT_THAT(names_of(settings_of_task(full_contour())),
              ::testing::HasSubstr("wheel_radius_from/feature = ground with"));
  // A journal from before the key: its settings are those of a radius given as a number.
  const std::vector<Setting> before = settings_of_task(ContourTask());
  EXPECT_THAT(names_of(before), ::testing::Not(::testing::HasSubstr("wheel_radius_from")));
  const auto read = task_of<ContourTask>(before);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_FALSE(read->wheel_radius_from);
  EXPECT_EQ(read->wheel_radius_mm, ContourTask().wheel_radius_mm);
}

TEST(Tasks, RefuseAnUnknownWordByTheNameOfItsSetting) {
  refuses_other_words(full_spindle(), {"wheel_radius_from/feature"});
  refuses_other_words(full_wheel());
  refuses_other_words(full_contour(), {"parts/name", "parts/axes", "parts/pin", "parts/main",
                                       "wheel_radius_from/feature"});
  refuses_other_words(full_rotary_axes(), {"balls/id"});
  refuses_other_words(full_rule(), {"zones", "outcomes", "repeats", "outliers"});
  refuses_other_words(full_characteristic(), {"id", "drawing_zone", "datum", "decision_rule/zones",
                                              "decision_rule/outcomes", "decision_rule/repeats",
                                              "decision_rule/outliers"});
  refuses_other_words(full_surface(), {"letter", "clamping", "exclude/name"});
  refuses_other_words(full_uncertainty());
  refuses_other_words(SamplingSettings{SamplingMethod::kScan});
  refuses_other_words(MergedPosesSettings());
}

TEST(Tasks, RefuseAnObjectThatLacksAKeyWhichAPlanMustGive) {
  auto settings = settings_of_task(full_rule(), "decision_rule/");
  std::erase_if(settings, [](const Setting& s) { return s.name.ends_with("prior/mean_um"); });
  const auto rule = task_of<DecisionRuleTask>(settings, "decision_rule/");
  ASSERT_FALSE(rule);
  EXPECT_THAT(rule.error().what, HasSubstr("\"decision_rule/prior/mean_um\" is missing"));
  settings = settings_of_task(full_uncertainty(), "uncertainty/");
  std::erase_if(settings, [](const Setting& s) { return s.name.ends_with("translations/error"); });
  EXPECT_FALSE(recorded_uncertainty(settings)) << "an error of no axis";
}

TEST(Tasks, CountAGroupOfInfluencesWhereItIsDeclaredAndOnlyThere) {
  auto settings = settings_of_uncertainty(full_uncertainty(), 11.5e-6);
  auto recorded = recorded_uncertainty(settings);
  ASSERT_TRUE(recorded && *recorded);
  EXPECT_EQ((*recorded)->expansion_per_K, 11.5e-6);
  EXPECT_EQ(lines_of(settings_of_uncertainty((*recorded)->task, 11.5e-6)), lines_of(settings));
  std::erase_if(settings, [](const Setting& s) { return s.text == "probe"; });
  recorded = recorded_uncertainty(settings);
  ASSERT_TRUE(recorded && *recorded);
  EXPECT_FALSE((*recorded)->task.probe);
  EXPECT_TRUE((*recorded)->task.fixture) << "declared, with the defaults of its keys";
  settings.push_back({"uncertainty/declared", std::nullopt, "prob"});
  recorded = recorded_uncertainty(settings);
  ASSERT_FALSE(recorded);
  EXPECT_THAT(recorded.error().what, HasSubstr("\"prob\", which is not known"));
  recorded = recorded_uncertainty({});
  ASSERT_TRUE(recorded);
  EXPECT_FALSE(*recorded) << "nothing is declared";
}

TEST(Tasks, GiveACharacteristicInMillimetresAboutTheMinimumZoneUnlessTheyNameAnother) {
  CharacteristicTask asked;
  asked.id = "round";
  asked.form = Form::kRoundness;
  asked.tolerance_um = 12.0;
  asked.drawing_zone = "C4";
  asked.harmonic_limits = {{2, 15, 0.5}};
  const Characteristic kept = characteristic_of(asked);
  EXPECT_EQ(kept.id, "round");
  EXPECT_EQ(kept.form, Form::kRoundness);
  EXPECT_EQ(kept.reference, Reference::kMinimumZone);
  EXPECT_EQ(kept.tolerance_mm, 12.0 * core::kMicrometre);
  EXPECT_EQ(kept.drawing_zone, "C4");
  ASSERT_EQ(kept.harmonic_limits.size(), 1U);
  EXPECT_EQ(kept.harmonic_limits.front().last, 15);
  EXPECT_EQ(kept.harmonic_limits.front().amplitude_mm, 0.5 * core::kMicrometre);

  asked.reference = Reference::kLeastSquares;
  asked.tolerance_um.reset();
  EXPECT_EQ(characteristic_of(asked).reference, Reference::kLeastSquares);
  EXPECT_FALSE(characteristic_of(asked).tolerance_mm);
}

TEST(Characteristics, HaveTheLimitsOfASizeAsSizes) {
  CharacteristicTask asked;
  asked.form = Form::kDiameter;
  asked.lower_um = -13.0;
  EXPECT_DOUBLE_EQ(*characteristic_of(asked, 30.0).lower_mm, 29.987);
  EXPECT_FALSE(characteristic_of(asked, 30.0).tolerance_mm);
  asked.upper_um = 0.0;
  EXPECT_EQ(characteristic_of(asked, 30.0).tolerance_mm, 30.0);
}

TEST(Characteristics, LimitTheRangeOfSizesByTheRangeItself) {
  CharacteristicTask asked;
  asked.form = Form::kDiameter;
  asked.tolerance_um = 5.0;
  asked.upper_um = 5.0;
  for (const auto rank : {Indication::Rank::kSR, Indication::Rank::kSQ}) {
    asked.indication.rank = rank;
    EXPECT_EQ(characteristic_of(asked, 30.0).tolerance_mm, 5.0 * core::kMicrometre);
  }
}

TEST(Characteristics, OfTheRadiusOfAWheelHaveLimitsWithTheirSigns) {
  CharacteristicTask asked;
  asked.form = Form::kRadius;
  asked.tolerance_um = 20.0;  // of the amount
  EXPECT_EQ(characteristic_of(asked).tolerance_mm, 20.0 * core::kMicrometre);
  EXPECT_FALSE(characteristic_of(asked).lower_mm);
  asked.tolerance_um.reset();
  EXPECT_FALSE(characteristic_of(asked).toleranced());
  asked.symmetric_um = 20.0;
  EXPECT_EQ(characteristic_of(asked).lower_mm, -20.0 * core::kMicrometre);
  EXPECT_EQ(characteristic_of(asked).tolerance_mm, 20.0 * core::kMicrometre);
  asked.symmetric_um.reset();
  asked.lower_um = -20.0;
  asked.upper_um = -5.0;
  EXPECT_EQ(characteristic_of(asked, 30.0).lower_mm, -20.0 * core::kMicrometre);
  EXPECT_EQ(characteristic_of(asked, 30.0).tolerance_mm, -5.0 * core::kMicrometre);
}

// Lengths are held in mm, angles in mrad: 20 urad are 0.02 mrad. Keys of the other unit say
// nothing.
TEST(Characteristics, OfAnglesHaveLimitsInMicroradians) {
  CharacteristicTask asked;
  asked.form = Form::kAxisError;
  asked.symmetric_um = 7.0;
  asked.symmetric_urad = 20.0;
  for (const auto error :
       {Indication::AxisError::kA, Indication::AxisError::kB, Indication::AxisError::kC}) {
    asked.indication.error = error;
    EXPECT_DOUBLE_EQ(characteristic_of(asked).lower_mm.value(), -0.020);
    EXPECT_DOUBLE_EQ(characteristic_of(asked).tolerance_mm.value(), 0.020);
  }
  asked.indication.error = Indication::AxisError::kX;
  EXPECT_DOUBLE_EQ(characteristic_of(asked).tolerance_mm.value(), 0.007);
  asked.indication.error = Indication::AxisError::kC;
  asked.symmetric_urad.reset();
  EXPECT_FALSE(characteristic_of(asked).toleranced());
  asked.lower_urad = -20.0;
  asked.upper_urad = -5.0;
  EXPECT_DOUBLE_EQ(characteristic_of(asked).lower_mm.value(), -0.020);
  EXPECT_DOUBLE_EQ(characteristic_of(asked).tolerance_mm.value(), -0.005);
  asked.tolerance_urad = 8.0;
  EXPECT_FALSE(characteristic_of(asked).lower_mm);
  EXPECT_DOUBLE_EQ(characteristic_of(asked).tolerance_mm.value(), 0.008);
}

TEST(Characteristics, OfAnalysesCarryTheirOwnDecisionRule) {
  std::array<CharacteristicLevel, 1> levels;
  levels[0].decision_rule.emplace().rule = DecisionRuleTask::Rule::kJcgm106;
  for (const Form form :
       {Form::kRoundness, Form::kRoundnessRms, Form::kHarmonicLimits, Form::kMotionTotal,
        Form::kMotionSynchronous, Form::kMotionAsynchronous, Form::kRadius, Form::kRunOut,
        Form::kContourDeviation, Form::kContourSpread, Form::kFixtureResidual,
        Form::kFixtureResidualRms, Form::kAxisError}) {
    SCOPED_TRACE(name_of(form));
    CharacteristicTask asked;
    asked.form = form;
    auto kept = characteristic_of(asked, 0.0, levels).indication.decision_rule;
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->rule, DecisionRuleTask::Rule::kJcgm106);
    asked.indication.decision_rule.emplace().rule = DecisionRuleTask::Rule::kIso14253;
    kept = characteristic_of(asked, 0.0, levels).indication.decision_rule;
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->rule, DecisionRuleTask::Rule::kIso14253);
    EXPECT_FALSE(characteristic_of(CharacteristicTask{}).indication.decision_rule);
  }
}

TEST(Characteristics, TakeFromTheFeatureThenFromThePlan) {
  std::array<CharacteristicLevel, 2> levels;
  auto& [feature, plan] = levels;
  plan.defaults.reference = Reference::kMinimumCircumscribed;
  plan.defaults.filter = Indication::Filter::kGaussian;
  plan.defaults.cutoff_upr = 50.0;
  feature.defaults.cutoff_upr = 150.0;
  feature.decision_rule.emplace().ratio = 10.0;
  CharacteristicTask asked;
  asked.form = Form::kRoundness;
  auto kept = characteristic_of(asked, 0.0, levels);
  EXPECT_EQ(kept.reference, Reference::kMinimumCircumscribed);
  EXPECT_EQ(kept.indication.filter, Indication::Filter::kGaussian);
  EXPECT_EQ(kept.indication.cutoff_upr, 150.0);
  EXPECT_EQ(kept.indication.outliers, Indication::Outliers::kNone);
  ASSERT_TRUE(kept.indication.decision_rule);
  EXPECT_EQ(kept.indication.decision_rule->ratio, 10.0);

  asked.indication.filter = Indication::Filter::kNone;
  asked.reference = Reference::kLeastSquares;
  asked.indication.decision_rule.emplace();
  kept = characteristic_of(asked, 0.0, levels);
  EXPECT_EQ(kept.reference, Reference::kLeastSquares);
  EXPECT_FALSE(kept.indication.cutoff_upr) << "nothing to cut off";
  EXPECT_EQ(kept.indication.decision_rule->ratio, 4.0) << "the nearest rule as a whole";
}

TEST(Characteristics, TakeNothingThatTheirFormDoesNotKnow) {
  std::array<CharacteristicLevel, 1> levels;
  levels[0].defaults.reference = Reference::kMaximumInscribed;
  levels[0].defaults.filter = Indication::Filter::kGaussian;
  levels[0].defaults.cutoff_upr = 50.0;
  levels[0].defaults.cutoff_mm = 0.8;
  levels[0].defaults.association = Indication::Association::kLs;
  CharacteristicTask asked;
  asked.form = Form::kFlatness;
  auto kept = characteristic_of(asked, 0.0, levels);
  EXPECT_EQ(kept.reference, Reference::kMinimumZone) << "a plane has no maximum inscribed";
  EXPECT_FALSE(kept.indication.filter);
  EXPECT_FALSE(kept.indication.association);
  asked.form = Form::kRunOut;
  kept = characteristic_of(asked, 0.0, levels);
  EXPECT_EQ(kept.indication.association, Indication::Association::kLs);
  EXPECT_EQ(kept.indication.cutoff_upr, 50.0);
  EXPECT_FALSE(kept.indication.cutoff_mm);
  asked.form = Form::kCylindricity;
  asked.indication.parameter = Indication::Parameter::kPeak;
  EXPECT_EQ(characteristic_of(asked, 0.0, levels).reference, Reference::kLeastSquares);
}

// A journal of this version may be older than the key; what is always written would be asked of it.
TEST(Tasks, AContourWritesTheSamplingTimeOnlyWhereThePlanStatesIt) {
  const auto states = [](const std::vector<Setting>& settings) {
    return std::any_of(settings.begin(), settings.end(),
                       [](const Setting& setting) { return setting.name == "sampling_ms"; });
  };
  ContourTask task;
  EXPECT_FALSE(states(settings_of_task(task)));
  task.sampling_ms = 4.0;
  EXPECT_TRUE(states(settings_of_task(task)));
  comes_back(task);
}

TEST(Tasks, RefuseAWholeNumberThatIsNone) {
  for (const double samples : {720.5, 1e300, -1.0}) {
    SCOPED_TRACE(samples);
    const auto read = task_of<SpindleTask>(std::vector<Setting>{{"samples", samples, ""}});
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().what, HasSubstr("\"samples\""));
  }
}

}  // namespace
}  // namespace rondure::record
