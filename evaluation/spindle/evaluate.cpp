#include <memory>

#include <fmt/format.h>

#include "core/units.h"
#include "evaluation/analysis.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluation.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::kMicrometre;

core::Result<fit::ProbeLayout> layout_of(const record::Feature& feature) {
  const std::string name = feature.word("layout").value_or("angles");
  if (name == "published-a") return fit::published_layout_a();
  if (name == "published-b") return fit::published_layout_b();
  if (name == "reference") return fit::reference_layout();
  const double p2 = feature.number("p1_to_p2_deg").value_or(0.0);
  const auto between = feature.number("p2_to_p3_deg");
  const double p3 = between ? *between : feature.number("p1_to_p3_deg").value_or(0.0) - p2;
  return fit::ProbeLayout::of(p2 * kDegree, p3 * kDegree);
}

fit::ThreeProbeOptions separation_options(const record::Feature& feature) {
  using Options = fit::ThreeProbeOptions;
  Options out;
  out.samples = static_cast<int>(feature.number("samples").value_or(out.samples));
  out.highest = static_cast<int>(feature.number("highest_order").value_or(out.highest));
  out.greatest_gain = feature.number("greatest_gain").value_or(out.greatest_gain);
  if (const auto noise_um = feature.number("probe_noise_um"))
    out.noise_mm = *noise_um * kMicrometre;
  out.expected_amplitude_mm = feature.number("expected_amplitude_um").value_or(0.1) * kMicrometre;
  out.resample = feature.word("resampling") != "off";
  if (feature.word("recovery") == "regularised") out.recovery = Options::Recovery::kTikhonov;
  if (feature.word("second_order") == "on") out.second_order = Options::SecondOrder::kOn;
  if (feature.word("second_order") == "off") out.second_order = Options::SecondOrder::kOff;
  if (feature.word("motion") == "as-published") out.motion = Options::Motion::kAsPublished;
  return out;
}

fit::SwingArm arm_of(const record::Feature& feature) {
  return {feature.number("crank_radius_mm").value_or(0.0),
          feature.number("wheel_radius_mm").value_or(0.0),
          feature.number("pin_radius_mm").value_or(0.0)};
}

std::vector<std::vector<double>> turns_of(const fit::ThreeProbeResult& result,
                                          std::vector<double> fit::CentreMotion::*direction) {
  std::vector<std::vector<double>> out;
  for (const fit::CentreMotion& turn : result.motion) out.push_back(turn.*direction);
  return out;
}

}  // namespace

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
  auto separation = fit::separate_three_probe(readings, arm, layout, options);
  if (!separation) return core::fail(separation.error());
  fit::RoundnessOptions roundness;
  roundness.references = {fit::CircleReference::kLs, fit::CircleReference::kMz,
                          fit::CircleReference::kMc, fit::CircleReference::kMi};
  roundness.highest_harmonic = 0;  // the separation has the table, with uncertainties
  roundness.inside = inside;
  roundness.filter.filter =
      cutoff_upr > 0.0 ? fit::ProfileFilter::kGaussian : fit::ProfileFilter::kNone;
  if (cutoff_upr > 0.0) roundness.filter.cutoff_upr = cutoff_upr;
  std::vector<double> theta;
  for (std::size_t n = 0; n < separation->profile.r_mm.size(); ++n)
    theta.push_back(separation->profile.angle_rad(n));
  auto part = fit::evaluate_profile(theta, separation->profile.r_mm, roundness);
  if (!part) return core::fail(part.error());
  const auto x = turns_of(*separation, &fit::CentreMotion::x_mm);
  const auto y = turns_of(*separation, &fit::CentreMotion::y_mm);
  const auto motion_x = fit::axis_motion(separation->alpha_rad, x);
  const auto motion_y = fit::axis_motion(separation->alpha_rad, y);
  return SpindleResult{arm, *std::move(separation), *std::move(part), motion_x, motion_y};
}

void evaluate_spindle(const record::RunRecord& record, int index, FeatureResult& result) {
  const record::Feature& feature = result.feature;
  const auto layout = layout_of(feature);
  if (!layout) {
    result.failure = layout.error();
    return;
  }
  const double cutoff =
      feature.word("filter") == "none" ? 0.0 : feature.number("cutoff_upr").value_or(50.0);
  auto facts =
      spindle_facts(probe_readings(*record.data_of(index, "data")), arm_of(feature), *layout,
                    separation_options(feature), cutoff, feature.side == record::Side::kInside);
  if (!facts) {
    result.failure = facts.error();
    return;
  }
  result.warnings = facts->separation.warnings;
  result.warnings.insert(result.warnings.end(), facts->roundness.warnings.begin(),
                         facts->roundness.warnings.end());
  result.analysis = std::make_shared<AnalysisResult>(*std::move(facts));
}

}  // namespace rondure::evaluation
