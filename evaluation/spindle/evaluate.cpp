#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/spindle/internal/probe_influences.h"
#include "evaluation/spindle/result.h"
#include "record/tasks/settings.h"
#include "record/tasks/spindle.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::kMicrometre;
using record::SpindleTask;

fit::ThreeProbeOptions::SecondOrder second_order_of(SpindleTask::SecondOrder asked) {
  using SecondOrder = fit::ThreeProbeOptions::SecondOrder;
  switch (asked) {
    case SpindleTask::SecondOrder::kAuto:
      break;
    case SpindleTask::SecondOrder::kOn:
      return SecondOrder::kOn;
    case SpindleTask::SecondOrder::kOff:
      return SecondOrder::kOff;
  }
  return SecondOrder::kAuto;
}

/// Why the settings allow no interval of part and motion.
std::optional<core::Phrase> obstacle_of(const SpindleTask& task) {
  if (task.motion == SpindleTask::Motion::kAsPublished) {
    return core::phrase(
        "the motion is as published, for comparison only; make it "
        "\"least-squares\"");
  }
  return std::nullopt;
}

/// The arm and the places of the probes about the pin.
struct ProbeHead {
  fit::SwingArm arm;
  fit::ProbeLayout layout;
  std::optional<MeasuredRadius> wheel_radius;
};

core::Result<ProbeHead> head_of(const SpindleTask& task, const RadiusOf& earlier,
                                std::vector<Gate>& gates) {
  TRY(const auto stated, probe_layout(task));
  ProbeHead out{
      {task.crank_radius_mm, task.wheel_radius_mm, task.pin_radius_mm}, stated, std::nullopt};
  if (!task.wheel_radius_from) return out;
  TRY(auto radius, take_radius(task.wheel_radius_from->feature, earlier, gates));
  if (!radius.nominal_mm) {
    return core::fail(core::Code::kMissingKey,
                      core::phrase("feature {} states no nominal radius, on which the probes were "
                                   "set",
                                   radius.feature));
  }
  out.arm.wheel_radius_mm = radius.radius_mm;
  TRY(out.layout, fit::turned_by_arm(stated, out.arm, *radius.nominal_mm));
  out.wheel_radius = std::move(radius);
  return out;
}

/// SpindleResult::gain_within: a layout may have its pole between the ends.
double gain_within(const std::vector<ProbeSource>& sources, const fit::ThreeProbeResult& found) {
  constexpr int kSteps = 8;  // of a quarter of a standard uncertainty
  const auto stated = found.layout.angles_rad();
  double out = 0.0;
  for (const ProbeSource& source : sources) {
    const auto by = source.per_u.segment<3>(fit::kFirstAngle);
    for (int step = -kSteps; step <= kSteps && !by.isZero(0.0); ++step) {
      const double times = 0.25 * step;
      const auto layout = fit::ProbeLayout::of(stated[1] - stated[0] + times * (by[1] - by[0]),
                                               stated[2] - stated[1] + times * (by[2] - by[1]));
      if (!layout) return HUGE_VAL;
      for (const fit::RecoveredHarmonic& h : found.harmonics) {
        if (h.recovered) out = std::max(out, layout->gain(h.order));
      }
    }
  }
  return out;
}

std::vector<std::vector<double>> turns_of(const fit::ThreeProbeResult& result,
                                          std::vector<double> fit::CentreMotion::*direction) {
  std::vector<std::vector<double>> out;
  for (const fit::CentreMotion& turn : result.motion) out.push_back(turn.*direction);
  return out;
}

}  // namespace

core::Result<fit::ProbeLayout> probe_layout(const SpindleTask& task) {
  return fit::stated_layout(name_of(task.layout), task.p1_to_p2_deg, task.p2_to_p3_deg,
                            task.p1_to_p3_deg);
}

fit::ThreeProbeOptions separation_options(const SpindleTask& task) {
  using Options = fit::ThreeProbeOptions;
  Options out;
  out.samples = task.samples;
  out.highest = task.highest_order;
  out.greatest_gain = task.greatest_gain;
  out.tip_width_mm = task.tip_width_mm.value_or(0.0);
  if (task.probe_noise_um) out.noise_mm = *task.probe_noise_um * kMicrometre;
  if (task.uncertainty) {
    const auto& declared = *task.uncertainty;
    if (declared.noise_um) {
      out.noise_mm = declared.noise_um->standard_uncertainty() * kMicrometre;
    }
    // Declared gains and angles take the place of the bare noise: see gates.cpp.
    out.judge_first_harmonic = !(declared.gain_1 && declared.angle_deg);
  }
  out.second_order = second_order_of(task.second_order);
  if (task.motion == SpindleTask::Motion::kAsPublished) out.motion = Options::Motion::kAsPublished;
  return out;
}

fit::ProbeReadings probe_readings(const record::Series& series) {
  const auto scaled = [&](std::string_view column, double unit) {
    std::vector<double> values = series.column(column).value_or(std::vector<double>());
    for (double& value : values) value *= unit;
    return values;
  };
  return {
      scaled("alpha_deg", kDegree),
      scaled("beta_deg", kDegree),
      {scaled("H1_um", kMicrometre), scaled("H2_um", kMicrometre), scaled("H3_um", kMicrometre)}};
}

core::Result<SpindleResult> spindle_facts(const fit::ProbeReadings& readings,
                                          const fit::SwingArm& arm, const fit::ProbeLayout& layout,
                                          const fit::ThreeProbeOptions& options, double cutoff_upr,
                                          bool inside) {
  TRY(auto separation, fit::separate_three_probe(readings, arm, layout, options));
  fit::RoundnessOptions roundness;
  roundness.references = {fit::CircleReference::kLs, fit::CircleReference::kMz,
                          fit::CircleReference::kMc, fit::CircleReference::kMi};
  roundness.highest_harmonic = 0;  // the separation has the table, with uncertainties
  roundness.inside = inside;
  roundness.filter.filter =
      cutoff_upr > 0.0 ? fit::ProfileFilter::kGaussian : fit::ProfileFilter::kNone;
  if (cutoff_upr > 0.0) roundness.filter.cutoff_upr = cutoff_upr;
  std::vector<double> theta;
  for (std::size_t n = 0; n < separation.profile.r_mm.size(); ++n)
    theta.push_back(separation.profile.angle_rad(n));
  TRY(auto part, fit::evaluate_profile(theta, separation.profile.r_mm, roundness));
  const auto x = turns_of(separation, &fit::CentreMotion::x_mm);
  const auto y = turns_of(separation, &fit::CentreMotion::y_mm);
  const auto motion_x = fit::axis_motion(separation.alpha_rad, x);
  const auto motion_y = fit::axis_motion(separation.alpha_rad, y);
  return SpindleResult{arm, std::move(separation), std::move(part), motion_x, motion_y};
}

core::Result<SpindleResult> evaluate_spindle(const record::RunRecord& record, int index,
                                             const RadiusOf& earlier, FeatureResult& result) {
  const record::Feature& feature = result.feature;
  TRY(const auto task, record::task_of<SpindleTask>(feature.settings));
  TRY(auto head, head_of(task, earlier, result.gates));
  const double cutoff = task.filter == SpindleTask::Filter::kNone ? 0.0 : task.cutoff_upr;
  const fit::ProbeReadings readings = probe_readings(*record.data_of(index, "data"));
  TRY(auto facts, spindle_facts(readings, head.arm, head.layout, separation_options(task), cutoff,
                                feature.side == record::Side::kInside));
  facts.feature_id = feature.id;
  facts.influences = task.uncertainty;
  if (task.probe_range_um) facts.probe_range_mm = *task.probe_range_um * kMicrometre;
  for (const std::vector<double>& probe : readings.h_mm) {
    for (const double h : probe) {
      facts.greatest_reading_mm = std::max(facts.greatest_reading_mm, std::abs(h));
    }
  }
  facts.no_interval_because = obstacle_of(task);
  facts.wheel_radius = std::move(head.wheel_radius);
  const auto sources = probe_sources(facts.declares_probes() ? *task.uncertainty : usual_probes(),
                                     facts.arm, head.layout, facts.wheel_radius);
  facts.gain_within = gain_within(sources, facts.separation);
  facts.greatest_gain = task.greatest_gain;
  facts.first_harmonic = fit::observe_first_harmonic(facts.separation, covariance_of(sources));
  for (Gate& gate : gates_of(facts, readings, feature.characteristics)) {
    if (gate.outcome == Gate::Outcome::kVoids && voids_all(gate) && !facts.void_because) {
      facts.void_because = gate.reason;
    }
    result.gates.push_back(std::move(gate));
  }
  result.warnings = facts.separation.warnings;
  result.warnings.insert(result.warnings.end(), facts.roundness.warnings.begin(),
                         facts.roundness.warnings.end());
  return facts;
}

}  // namespace rondure::evaluation
