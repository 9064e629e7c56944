#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/geometry/swing_arm.h"
#include "fit/spindle/probe_layout.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/schema/internal/setting_list.h"
#include "plans/spindle_plan.h"

namespace rondure::plans {
namespace {

using core::Code;
using core::kDegree;
using record::SpindleTask;

constexpr std::array kSpindleForms = {
    record::Form::kRoundness,         record::Form::kRoundnessRms,
    record::Form::kHarmonicLimits,    record::Form::kMotionTotal,
    record::Form::kMotionSynchronous, record::Form::kMotionAsynchronous};
constexpr std::array<record::WantedColumn, 5> kProbeColumns = {
    {{"alpha_deg"}, {"H1_um"}, {"H2_um"}, {"H3_um"}, {"beta_deg", false}}};
constexpr std::uint64_t kProbeStream = 0x5b1d1eU;
constexpr double kDriftCycles = 0.37;  ///< Cycles per turn, so that it never repeats with the work.

fit::SwingArm arm_of(const SpindleTask& plan) {
  return {plan.crank_radius_mm, plan.wheel_radius_mm, plan.pin_radius_mm};
}

/// The layout stated in the plan; no value is guessed.
core::Result<fit::ProbeLayout> layout_of(const SpindleTask& plan) {
  return fit::stated_layout(name_of(plan.layout), plan.p1_to_p2_deg, plan.p2_to_p3_deg,
                            plan.p1_to_p3_deg);
}

/// Checks that the angles are given once and completely, or not at all.
bool check_angles(const SpindleTask& plan, const std::string& where, Findings& findings) {
  const bool own = plan.layout == SpindleTask::Layout::kAngles;
  const auto refuse = [&](Code code, std::string_view key, std::string what) {
    findings.meaning(code, fmt::format("{}/{}", where, key), std::move(what));
    return false;
  };
  if (!own) {
    for (const std::string_view key : {"p1_to_p2_deg", "p2_to_p3_deg", "p1_to_p3_deg"}) {
      if (!findings.is_given(fmt::format("{}/{}", where, key))) continue;
      return refuse(
          Code::kMeaning, key,
          fmt::format("has no effect: the layout is \"{}\"; remove it, or make the layout "
                      "\"angles\"",
                      name_of(plan.layout)));
    }
    return true;
  }
  if (!plan.p1_to_p2_deg) {
    return refuse(Code::kMissingKey, "p1_to_p2_deg",
                  "this key is missing: the angle from probe 1 to probe 2");
  }
  if (plan.p2_to_p3_deg && plan.p1_to_p3_deg) {
    return refuse(Code::kMeaning, "p1_to_p3_deg",
                  "the place of probe 3 is given twice, from probe 1 and from probe 2; remove one");
  }
  if (!plan.p2_to_p3_deg && !plan.p1_to_p3_deg) {
    return refuse(Code::kMissingKey, "p2_to_p3_deg",
                  "this key is missing: the angle from probe 2 to probe 3; or give p1_to_p3_deg, "
                  "from probe 1");
  }
  return true;
}

/// The keys beside a wheel radius of an earlier feature (check_references()).
void check_source_of_arm(const SpindleTask& plan, const std::string& where, Findings& findings) {
  if (findings.is_given(where + "/wheel_radius_mm")) {
    findings.meaning(Code::kMeaning, where + "/wheel_radius_mm",
                     "the wheel radius is that of an earlier feature (wheel_radius_from); remove "
                     "one");
  }
  if (!arm_of(plan).swings()) {
    findings.meaning(Code::kMeaning, where + "/wheel_radius_from",
                     "has no effect: the probes stand still; remove it, or give crank_radius_mm");
  } else if (!(plan.pin_radius_mm > 0.0)) {
    findings.meaning(Code::kMissingKey, where + "/pin_radius_mm",
                     "this key is missing: an arm that swings needs the radius of the pin");
  }
}

void check_spindle(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const SpindleTask& plan = *feature.spindle;
  if (check_angles(plan, where, findings)) {
    if (const auto layout = layout_of(plan); !layout) {
      findings.meaning(layout.error().code, where, layout.error().what);
    }
  }
  if (plan.wheel_radius_from) {  // the arm is checked with the radius, once that is measured
    check_source_of_arm(plan, where, findings);
  } else if (const auto arm = fit::check_swing_arm(arm_of(plan)); !arm) {
    findings.meaning(arm.error().code, where, arm.error().what);
  }
  const auto refuse_idle = [&](const char* key, const char* why) {
    if (!findings.is_given(where + key)) return;
    findings.meaning(Code::kMeaning, where + key, fmt::format("has no effect: {}; remove it", why));
  };
  if (!arm_of(plan).swings() && !plan.wheel_radius_from) {
    refuse_idle("/wheel_radius_mm", "the probes stand still, as there is no crank_radius_mm");
  }
  if (plan.filter == SpindleTask::Filter::kNone) {
    refuse_idle("/cutoff_upr", "the filter is \"none\"");
  }
  if (plan.samples < 2 * plan.highest_order + 2) {
    findings.meaning(Code::kSampling, where + "/samples",
                     fmt::format("{} samples a revolution do not carry {} undulations; at least {} "
                                 "are needed, {} are better",
                                 plan.samples, plan.highest_order, 2 * plan.highest_order + 2,
                                 7 * plan.highest_order));
  }
  const bool second = plan.second_order == SpindleTask::SecondOrder::kOn;
  if ((second || plan.tip_width_mm) && !(plan.pin_radius_mm > 0.0)) {
    findings.meaning(Code::kMissingKey, where + "/pin_radius_mm",
                     fmt::format("this key is missing: {} needs the radius of the part",
                                 second ? "the second order" : "tip_width_mm"));
  }
}

/// The simulated profile and motion at the probes.
struct ProbedWorld {
  const SimulatedSpindlePlan& hidden;
  fit::SwingArm arm;
  std::array<double, 3> places_rad;  ///< True angles of the probes.

  [[nodiscard]] double drift_um(double alpha) const {
    return hidden.asynchronous_um * std::sin(kDriftCycles * alpha);
  }
  [[nodiscard]] double motion_x_um(double alpha) const {
    return sum_of(hidden.motion_x, alpha) + drift_um(alpha);
  }
  [[nodiscard]] double motion_y_um(double alpha) const {
    return sum_of(hidden.motion_y, alpha) +
           hidden.asynchronous_um * std::cos(kDriftCycles * alpha) - hidden.asynchronous_um;
  }
  [[nodiscard]] double profile_um(double theta) const {
    return sum_of(hidden.profile, theta) +
           hidden.eccentricity_um * std::cos(theta - hidden.eccentricity_deg * kDegree);
  }
  /// The noise-free reading of probe i: the exact distance along its line for a part of known
  /// radius, otherwise to first order.
  [[nodiscard]] double reading_um(std::size_t i, double alpha) const {
    const double beta = arm.beta_rad(alpha);
    const double direction = places_rad[i] + beta;
    const double along =
        motion_y_um(alpha) * std::cos(direction) + motion_x_um(alpha) * std::sin(direction);
    const double across = motion_x_um(alpha) * std::cos(direction) -
                          motion_y_um(alpha) * std::sin(direction) - hidden.line_error_um[i];
    const double at = alpha + beta + places_rad[i];
    const double radius_um = arm.pin_radius_mm / core::kMicrometre;
    double reading = profile_um(at) + along;
    if (radius_um > 0.0) {
      for (int pass = 0; pass < 4; ++pass) {
        const double shift = std::atan2(across, radius_um + reading - along);
        const double rho = radius_um + profile_um(at - shift);
        reading = along + std::sqrt(rho * rho - across * across) - radius_um;
      }
    }
    return reading * (1.0 + hidden.probe_gain_error[i]) + hidden.probe_offset_um[i];
  }
};

record::Series readings(const ProbedWorld& world, int feature, std::uint64_t seed) {
  record::Series out;
  out.feature = feature;
  out.columns = {{"alpha_deg", "deg"}, {"H1_um", "um"}, {"H2_um", "um"}, {"H3_um", "um"}};
  const int count = world.hidden.turns * world.hidden.samples_per_turn;
  for (int m = 0; m < count; ++m) {
    const double alpha_deg = 360.0 * m / world.hidden.samples_per_turn;
    out.values.push_back(alpha_deg);
    core::KeyedNoise noise(
        seed, {kProbeStream, static_cast<std::uint64_t>(feature), static_cast<std::uint64_t>(m)});
    for (std::size_t i = 0; i < 3; ++i) {
      out.values.push_back(world.reading_um(i, alpha_deg * kDegree) +
                           world.hidden.probe_noise_um * noise.normal());
    }
  }
  return out;
}

/// Adds the true profile over the part and the true motion over the work, each at equal angles.
void add_truth(const ProbedWorld& world, int feature, const SpindleTask& plan, AnalysisData& out) {
  record::Series truth;
  truth.feature = feature;
  truth.name = "truth";
  truth.role = record::Series::Role::kTruth;
  truth.columns = {{"angle_deg", "deg"}, {"profile_um", "um"}, {"RX_um", "um"}, {"RY_um", "um"}};
  for (int n = 0; n < plan.samples; ++n) {
    const double angle_deg = 360.0 * n / plan.samples;
    const double angle = angle_deg * kDegree;
    const double form = sum_of(world.hidden.profile, angle);
    truth.values.insert(truth.values.end(), {angle_deg, form, sum_of(world.hidden.motion_x, angle),
                                             sum_of(world.hidden.motion_y, angle)});
  }
  out.series.push_back(std::move(truth));
}

core::Result<AnalysisData> simulate_spindle(const Plan& plan, std::size_t index, std::uint64_t seed,
                                            bool errors) {
  const SpindleTask& asked = *plan.features[index].spindle;
  SimulatedSpindlePlan hidden = *plan.simulation->spindle;
  if (!errors) {
    hidden.probe_noise_um = hidden.p2_error_deg = hidden.p3_error_deg = 0.0;
    hidden.probe_offset_um = hidden.probe_gain_error = hidden.line_error_um = {};
  }
  TRY(const auto layout, layout_of(asked));
  ProbedWorld world{hidden, arm_of(asked), layout.angles_rad()};
  if (asked.wheel_radius_from) {
    // The head was set on the nominal wheel: on another one its lines miss the pin.
    const NamedWheel wheel = named_wheel(plan, *asked.wheel_radius_from);
    world.arm.wheel_radius_mm = wheel.true_mm;
    TRY(const auto turned, fit::turned_by_arm(layout, world.arm, wheel.nominal_mm));
    world.places_rad = turned.angles_rad();
  }
  world.places_rad[1] += hidden.p2_error_deg * kDegree;
  world.places_rad[2] += hidden.p3_error_deg * kDegree;
  const auto feature = static_cast<int>(index);
  AnalysisData out;
  out.series.push_back(readings(world, feature, seed));
  add_truth(world, feature, asked, out);
  return out;
}

}  // namespace

const AnalysisKind& spindle_kind() {
  static constexpr AnalysisKind kKind = {
      .type = "spindle",
      .shape = record::Shape::kSpindle,
      .forms = kSpindleForms,
      .is_simulated = simulates<&SimulationPlan::spindle>,
      .settings = settings_of_section<&FeaturePlan::spindle>,
      .files = [](const FeaturePlan& feature) { return source_file(feature, kProbeColumns); },
      .check = check_spindle,
      .simulate = simulate_spindle};
  return kKind;
}

}  // namespace rondure::plans
