#pragma once

#include <string_view>

#include "plans/schema/key_spec.h"
#include "plans/schema/machine_errors_table.h"
#include "plans/uncertainty_plan.h"

// The part of plan_table.h for the decision rule and the uncertainty.

namespace rondure::plans {

template <class Visitor>
void describe(Visitor& v, PriorPlan& p) {
  const auto size = [](std::string_view meaning) {
    return required(above(0.0, 10'000.0, meaning));
  };
  v.text("distribution", p.distribution,
         {.one_of = {"gamma", "normal"},
          .meaning = "Of the form deviation over the parts of the process; normal: cut at 0."});
  v.number("mean_um", p.mean_um, size("Its mean."));
  v.number("standard_deviation_um", p.standard_deviation_um,
           size("Its standard deviation; of gamma at most the mean."));
}

template <class Visitor>
void describe_statements(Visitor& v, DecisionRulePlan& p) {
  v.text("zones", p.zones,
         {.meaning = "Statement of ASME B89.7.3.1: which zones there are and how large. This and "
                     "the next three are needed by n-to-1 and guard-band."});
  v.text("outcomes", p.outcomes,
         {.meaning = "Statement: what is done with a part in each of the zones."});
  v.text("repeats", p.repeats,
         {.meaning = "Statement: how repeated measurements of one part are dealt with."});
  v.text("outliers", p.outliers,
         {.meaning = "Statement: how values that do not belong are dealt with."});
}

template <class Visitor>
void describe(Visitor& v, DecisionRulePlan& p) {
  v.text("rule", p.rule,
         {.one_of = {"simple-acceptance", "iso-14253-1", "jcgm-106", "n-to-1", "guard-band"},
          .meaning = "simple-acceptance: the measured value is compared with the tolerance, no "
                     "uncertainty is taken into account. The others need uncertainty and may end "
                     "undecided (docs/decision-rules.md)."});
  v.text("measurand", p.measurand,
         {.one_of = {"sampled-points", "whole-surface"},
          .meaning = "What the verdict is about: the surface at the sampled points, or the whole "
                     "surface under the form spectrum."});
  v.text("judge", p.judge,
         {.one_of = {"as-read", "corrected"},
          .meaning = "as-read: a value that was read above the tolerance never conforms, whatever "
                     "the correction for noise says. corrected: only the corrected value and its "
                     "interval count, by agreement of both parties; the report says so."});
  v.number("guard_factor", p.guard_factor,
           range(0.0, 10.0, "iso-14253-1: guard band in parts of the interval beside the value."));
  v.number(
      "consumer_risk_percent", p.consumer_risk_percent,
      above(0.0, 50.0, "jcgm-106: largest probability that an accepted part does not conform."));
  v.number("producer_risk_percent", p.producer_risk_percent,
           above(0.0, 50.0, "jcgm-106: largest probability that a rejected part conforms."));
  v.object("prior", p.prior,
           {.meaning = "What is known of the parts of this process before the measurement. With it "
                       "the report states the global risks, and jcgm-106 uses it."});
  v.number("ratio", p.ratio,
           range(1.0, 100.0, "n-to-1: N, tolerance over the width of the interval at least."));
  v.number("acceptance_guard_percent", p.acceptance_guard_percent,
           within(1000.0, "guard-band: below the tolerance, in percent of U; < 0: relaxed."));
  v.number("rejection_guard_percent", p.rejection_guard_percent,
           within(1000.0, "guard-band: above the tolerance, in percent of U; < 0: relaxed."));
  describe_statements(v, p);
}

template <class Visitor>
void describe(Visitor& v, LobeInfluencePlan& p) {
  v.whole("order", p.order, required(range(1, 50, "Lobes in a turn.")));
  v.number("amplitude_um", p.amplitude_um,
           required(range(0.0, 1000.0, "Half of peak to valley; its phase is taken as unknown.")));
}

template <class Visitor>
void describe(Visitor& v, ProbeInfluencesPlan& p) {
  v.number("repeatability_um", p.repeatability_um,
           range(0.0, 1000.0,
                 "Standard deviation of one touch; normal. Left out: that of the repeated touches "
                 "of the run."));
  v.number("degrees_of_freedom", p.degrees_of_freedom,
           range(0.0, 1e6,
                 "How many stand behind repeatability_um; left out or 0: it is known exactly. "
                 "Repeats of the run bring their own."));
  v.number("correlation_length_mm", p.correlation_length_mm,
           range(0.0, 1000.0,
                 "Of a scan: way along the surface over which the errors of neighbouring points "
                 "lose their likeness (to 1/e). 0: each point anew."));
  v.list("lobes", p.lobes, {.meaning = "How the pre-travel changes with the direction."});
  v.number("form_limit_um", p.form_limit_um,
           range(0.0, 1000.0,
                 "Limit of the probing form error (ISO 10360-5), where repeatability and lobes are "
                 "not known."));
  v.number("tip_radius_um", p.tip_radius_um,
           range(0.0, 1000.0,
                 "Standard uncertainty of the qualified tip radius; normal. Left out: that of the "
                 "qualification of the run."));
}

template <class Visitor>
void describe(Visitor& v, MachineInfluencesPlan& p) {
  v.list("translations", p.translations,
         {.meaning = "Term by term: standard uncertainty of each coefficient; a wave has the "
                     "amplitude given and an unknown phase."});
  v.list("rotations", p.rotations, {.meaning = "The same of roll, pitch and yaw."});
  constexpr std::string_view kSquare = "Standard uncertainty of the angle between these axes.";
  v.number("squareness_xy_urad", p.squareness_xy_urad, range(0.0, 10'000.0, kSquare));
  v.number("squareness_xz_urad", p.squareness_xz_urad, range(0.0, 10'000.0, kSquare));
  v.number("squareness_yz_urad", p.squareness_yz_urad, range(0.0, 10'000.0, kSquare));
  constexpr std::string_view kOffset = "From where the ram turns to the tip.";
  v.number("tip_offset_x_mm", p.tip_offset_x_mm, within(2000.0, kOffset));
  v.number("tip_offset_y_mm", p.tip_offset_y_mm, within(2000.0, kOffset));
  v.number("tip_offset_z_mm", p.tip_offset_z_mm, within(2000.0, kOffset));
  v.number("length_limit_um", p.length_limit_um,
           range(0.0, 1000.0, "Limit of the length error (ISO 10360-2): what does not grow."));
  v.number("length_limit_um_m", p.length_limit_um_m,
           range(0.0, 1000.0, "The same: what grows with the length."));
}

template <class Visitor>
void describe(Visitor& v, ThermalInfluencesPlan& p) {
  v.number("drift_K", p.drift_K,
           range(0.0, 20.0, "Largest change of the part from the first to the last touch; even."));
  constexpr std::string_view kDrift =
      "Largest change of the reading of a fixed point in that time; rectangular.";
  v.number("machine_drift_x_um", p.machine_drift_x_um, range(0.0, 1000.0, kDrift));
  v.number("machine_drift_y_um", p.machine_drift_y_um, range(0.0, 1000.0, kDrift));
  v.number("machine_drift_z_um", p.machine_drift_z_um, range(0.0, 1000.0, kDrift));
}

template <class Visitor>
void describe(Visitor& v, FixtureInfluencesPlan& p) {
  v.number("angle_deg", p.angle_deg,
           range(0.0, 10.0, "Standard uncertainty of the pose about each axis; normal."));
  v.number("position_um", p.position_um,
           range(0.0, 1000.0, "Standard uncertainty of the pivot in a pose; normal."));
  v.number("creep_deg", p.creep_deg,
           range(0.0, 10.0, "Largest turn of the part from the first to the last touch; even."));
}

template <class Visitor>
void describe(Visitor& v, FormTermPlan& p) {
  v.whole("undulations", p.undulations, required(range(0, 200, "In a turn.")));
  v.whole("degree", p.degree, range(0, 20, "Of the Legendre polynomial along the part."));
  v.number("amplitude_um", p.amplitude_um,
           required(range(0.0, 1000.0, "Standard deviation of its coefficients.")));
}

template <class Visitor>
void describe(Visitor& v, FormSpectrumPlan& p) {
  v.text("amplitudes", p.amplitudes,
         {.one_of = {"relative", "absolute"},
          .meaning = "relative: only their ratios are known, the size common to all is estimated "
                     "from the points."});
  v.list("terms", p.terms,
         {.meaning = "Which forms the surface may have; left out: the part's own harmonics, from "
                     "dense layers (14 points and more)."});
}

template <class Visitor>
void describe(Visitor& v, UncertaintyPlan& p) {
  v.number("coverage_percent", p.coverage_percent,
           range(50.0, 99.9, "Probability of the coverage interval."));
  v.whole("least_trials", p.least_trials, range(2000, 1'000'000, "Trials at least."));
  v.whole("most_trials", p.most_trials, range(2000, 1'000'000, "Trials at most."));
  v.number("tolerance_um", p.tolerance_um,
           range(0.0, 100.0,
                 "Numerical tolerance: trials end when the printed numbers are known this well "
                 "(JCGM 101, 7.9); 0: all trials are done."));
  v.whole("budget_trials", p.budget_trials,
          range(0, 1'000'000, "Trials of each influence alone; 0: no budget."));
  v.number("expected_spots", p.expected_spots,
           range(0.01, 10.0,
                 "Points that stand out by themselves (burrs, dirt, scratches) and that a part "
                 "is expected to have: they are form and are never smoothed away."));
  v.whole("seed", p.seed, range(0, 9007199254740991.0, "Same seed, same numbers."));
  v.object("probe", p.probe, {.meaning = "Declared influences of the probe."});
  v.object("machine", p.machine, {.meaning = "Of the geometry of the machine."});
  v.object("thermal", p.thermal,
           {.meaning = "Of temperature, beside those of part.expansion_uncertainty_per_K and "
                       "environment.temperature_uncertainty_K."});
  v.object("fixture", p.fixture, {.meaning = "Of the fixture."});
  v.object("form_spectrum", p.form_spectrum,
           {.meaning = "What the surface between the points may be like; without it nothing is "
                       "said of the whole surface."});
}

}  // namespace rondure::plans
