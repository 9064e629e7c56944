#include "evaluation/correction/corrections.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <Eigen/Core>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/contour/internal/trials.h"
#include "evaluation/correction/internal/barred.h"
#include "evaluation/interval/internal/declared.h"
#include "evaluation/spindle/internal/noise_runs.h"
#include "record/tasks/contour.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {

core::Result<AxisTableGain> axis_table_gain(const record::RunRecord& record,
                                            const FeatureResult& result) {
  if (result.failure) return core::fail(*result.failure);
  if (!result.analysis) {
    return core::fail(core::Code::kMeaning, core::phrase("the feature has no result"));
  }
  const auto& facts = std::get<RotaryResult>(result.analysis->found);
  if (facts.withheld) return core::fail(core::Code::kMeaning, *facts.withheld);
  record::Characteristic residual;
  residual.form = record::Form::kFixtureResidualRms;
  const UncertaintyStatus status =
      intervals_of(facts, std::span(&residual, 1), uncertainty_options(record)).front();
  if (!status.result()) return core::fail(core::Code::kMeaning, status.why());
  const UncertaintyStatement& left = status.result()->sampled;
  AxisTableGain out;
  out.before_mm = facts.calibration.verification.before_rms_mm;
  out.after_mm = facts.calibration.verification.rms_mm;
  // Three coordinates of each ball have noise.
  const double noise2 = 3.0 * facts.noise_mm * facts.noise_mm;
  const double before_mm = std::sqrt(std::max(0.0, out.before_mm * out.before_mm - noise2));
  out.gain.estimate_mm = before_mm - left.estimate_mm;
  out.gain.low_mm = before_mm - left.high_mm;
  out.gain.high_mm = before_mm - left.low_mm;
  out.gain.standard_uncertainty_mm = left.standard_uncertainty_mm;
  if (out.gain.low_mm <= 0.0) {
    return core::fail(
        core::Code::kMeaning,
        core::phrase("the predicted gain is not significant: {} um, interval {} to {} um",
                     core::um(out.gain.estimate_mm), core::um(out.gain.low_mm),
                     core::um(out.gain.high_mm)));
  }
  return out;
}

namespace {

using core::Code;
using Eigen::VectorXd;

constexpr std::uint64_t kSeed = 1;  // any one: a table has the same bits in every run

/// Sum over the orders from 2 on, cosine and sine of each.
double wave_at(const VectorXd& coefficients, double angle_rad) {
  double out = 0.0;
  for (Eigen::Index k = 0; k + 1 < coefficients.size(); k += 2) {
    const double order = 2.0 + static_cast<double>(k / 2);
    out += coefficients[k] * std::cos(order * angle_rad) +
           coefficients[k + 1] * std::sin(order * angle_rad);
  }
  return out;
}

/// The mean over the angle of the square of a wave is half of that of its coefficients.
void fill_motion_u(const fit::SeparationModel& model, const fit::ThreeProbeResult& found,
                   SpindleTable& out) {
  double x_mm2 = 0.0;
  double y_mm2 = 0.0;
  visit_noise(model, found, kSeed, [&](const fit::SpindleCurves& curves) {
    x_mm2 += 0.5 * curves.x_mm.squaredNorm() / kNoiseEvaluations;
    y_mm2 += 0.5 * curves.y_mm.squaredNorm() / kNoiseEvaluations;
  });
  out.u_motion_x_mm = std::sqrt(x_mm2);
  out.u_motion_y_mm = std::sqrt(y_mm2);
}

}  // namespace

core::Result<SpindleTable> spindle_table(const FeatureResult& result) {
  if (auto why = barred(result)) return core::fail(Code::kMeaning, *std::move(why));
  const auto& facts = std::get<SpindleResult>(result.analysis->found);
  const fit::ThreeProbeResult& found = facts.separation;
  if (facts.void_because) return core::fail(Code::kMeaning, *facts.void_because);
  if (!found.contradictions.empty()) return core::fail(found.contradictions.front());
  TRY(const auto model, fit::SeparationModel::of(found));
  const fit::SpindleCurves curves = model.at(fit::ProbeErrors::Zero());
  SpindleTable out;
  out.missing = found.unrecovered;
  for (std::size_t i = 0; i < SpindleTable::kRows; ++i) {
    SpindleRow row;
    row.alpha_rad = core::kTwoPi * static_cast<double>(i) / SpindleTable::kRows;
    const double beta = facts.arm.beta_rad(row.alpha_rad);
    row.theta_rad = std::fmod(row.alpha_rad + beta + core::kTwoPi, core::kTwoPi);
    row.profile_mm = wave_at(curves.profile_mm, row.theta_rad);
    row.motion_x_mm = wave_at(curves.x_mm, row.alpha_rad);
    row.motion_y_mm = wave_at(curves.y_mm, row.alpha_rad);
    if (facts.arm.swings()) {
      row.command_mm =
          -wave_at(curves.profile_mm, row.theta_rad + std::numbers::pi) / std::cos(beta);
    }
    out.rows.push_back(row);
  }
  out.u_profile_mm = found.profile_sigma_mm;
  fill_motion_u(model, found, out);
  return out;
}

core::Result<const WheelResult*> wheel_for_path(const FeatureResult& result) {
  using core::Code;
  if (auto why = barred(result)) return core::fail(Code::kMeaning, *std::move(why));
  const auto& facts = std::get<WheelResult>(result.analysis->found);
  const fit::WheelEvaluation& found = facts.evaluation;
  if (found.refused) return core::fail(*found.refused);
  if (!found.path) {
    return core::fail(Code::kMeaning, "no surface is to be ground (wheel.surface)");
  }
  if (!found.wheel.radius_void_because.empty()) {
    return core::fail(Code::kMeaning, found.wheel.radius_void_because);
  }
  for (const CharacteristicResult& c : result.characteristics) {
    if (c.verdict != Verdict::kVoid && c.verdict != Verdict::kDoesNotConform) continue;
    return core::fail_with(Code::kMeaning, "{} {}: {}", c.characteristic.id, name_of(c.verdict),
                           c.reason.english());
  }
  return &facts;
}

namespace {

using core::Code;
using core::kTwoPi;

std::optional<core::Phrase> barred(const ContourResult& facts) {
  for (const auto& curve : {facts.total_void, facts.following_void, facts.rest_void}) {
    if (curve) return curve;
  }
  if (facts.options.method == fit::ContourMethod::kAsPublished) {
    return core::phrase(
        "method as-published turns f onto the contour, which is for comparison only");
  }
  return std::nullopt;
}

/// Standard deviation of f over the parts, at the angles of the contours; 0 of one part.
std::vector<double> following_deviation(const fit::ContourStudy& study,
                                        const std::vector<double>& mean_mm) {
  std::vector<double> out(mean_mm.size(), 0.0);
  std::vector<double> values(study.parts.size());
  for (std::size_t m = 0; m < out.size() && values.size() > 1; ++m) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = study.parts[i].following.error_mm[m];
    }
    out[m] = core::standard_deviation(values, mean_mm[m]);
  }
  return out;
}

/// C position of the method at a C position of the control, and the other way round.
double sensed(const ContourResult& facts, double c_rad) {
  return facts.options.axes.c_direction * c_rad;
}

void fill_rows(const ContourResult& facts, const record::ContourCorrectionTask& asked,
               std::span<const double> following_u_mm, XCorrection& out) {
  const fit::CrankGeometry& crank = facts.options.geometry;
  const auto deviation_mm = following_deviation(facts.study, fit::mean_following(facts.study));
  const auto rows = static_cast<std::size_t>(asked.rows());
  const double resolution_mm = asked.resolution_um * core::kMicrometre;
  const auto over_alpha =
      fit::x_table_mm(facts.study, crank, {rows, asked.highest_order, resolution_mm});
  out.parts = facts.study.parts.size();
  for (std::size_t i = 0; i < rows; ++i) {
    const bool against = facts.options.axes.c_direction < 0;
    const std::size_t row = against ? (rows - i) % rows : i;
    const double alpha = kTwoPi * static_cast<double>(row) / static_cast<double>(rows);
    const double beta = fit::contact_angle_rad(crank, alpha);
    const double of_mean = fit::closed_at(deviation_mm, beta);
    const double u2 = std::pow(fit::closed_at(following_u_mm, beta), 2) +
                      of_mean * of_mean / static_cast<double>(out.parts);
    out.x_mm.push_back(over_alpha[row]);
    const double eta_u2 = u2 / std::pow(std::cos(beta - alpha), 2);
    out.u_mm.push_back(std::sqrt(eta_u2 + resolution_mm * resolution_mm / 12.0));
  }
}

/// What the correction adds to the contour of each part.
core::Result<std::vector<std::vector<double>>> changes(const ContourResult& facts,
                                                       const XCorrection& correction) {
  std::vector<std::vector<double>> out;
  const std::vector<double> none(facts.options.axes.samples, 0.0);
  const std::vector<double> nowhere(facts.options.samples, 0.0);
  for (const fit::ContourPartResult& part : facts.study.parts) {
    // Without traces the correction is ground alone: what it adds hangs on no other error.
    fit::AxisErrors errors = facts.study.traced() ? part.axes.errors : fit::AxisErrors{none, none};
    const auto& before = facts.study.traced() ? part.following.error_mm : nowhere;
    for (std::size_t n = 0; n < errors.x_mm.size(); ++n) {
      const double alpha =
          kTwoPi * static_cast<double>(n) / static_cast<double>(errors.x_mm.size());
      errors.x_mm[n] += fit::closed_at(correction.x_mm, sensed(facts, alpha));
    }
    TRY(auto again, fit::following_contour(errors, facts.options));
    std::vector<double> change = std::move(again.error.error_mm);
    for (std::size_t m = 0; m < change.size(); ++m) change[m] -= before[m];
    out.push_back(std::move(change));
  }
  return out;
}

}  // namespace

core::Result<XCorrection> x_correction(const record::RunRecord& record,
                                       const FeatureResult& result) {
  if (const auto why = barred(result)) return core::fail(Code::kMeaning, *why);
  const auto& facts = std::get<ContourResult>(result.analysis->found);
  if (const auto why = barred(facts)) return core::fail(Code::kMeaning, *why);
  const UncertaintyOptions options = uncertainty_options(record);
  TRY(const auto following_u_mm, mean_following_u(facts, options));
  TRY(const auto task, record::task_of<record::ContourTask>(result.feature.settings));
  const auto asked = task.correction.value_or(record::ContourCorrectionTask());
  XCorrection out;
  fill_rows(facts, asked, following_u_mm, out);
  for (const double x : out.x_mm) {
    if (!asked.limit_um || std::abs(x) <= *asked.limit_um * core::kMicrometre) continue;
    return core::fail(Code::kMeaning,
                      core::phrase("the correction reaches {} um, beyond its limit of {} um: look "
                                   "for the cause, or raise correction.limit_um",
                                   core::um(x), core::shortest(*asked.limit_um)));
  }
  TRY(const auto change_mm, changes(facts, out));
  for (std::size_t i = 0; i < change_mm.size(); ++i) {
    const fit::ContourError& total = facts.study.parts[i].pin.contour;
    std::vector<double> after = total.error_mm;
    for (std::size_t m = 0; m < after.size(); ++m) after[m] += change_mm[i][m];
    out.before_mm = std::max(out.before_mm, total.peak_to_valley_mm);
    out.after_mm = std::max(out.after_mm, fit::peak_to_valley(after));
  }
  const UncertaintyStatus gain = gain_interval(facts, change_mm, options);
  if (!gain.result()) return core::fail(Code::kMeaning, gain.why());
  out.gain = gain.result()->sampled;
  if (out.gain.low_mm <= 0.0) {
    return core::fail(
        Code::kMeaning,
        core::phrase("the predicted gain is not significant: {} um, interval {} to {} um",
                     core::um(out.gain.estimate_mm), core::um(out.gain.low_mm),
                     core::um(out.gain.high_mm)));
  }
  return out;
}

}  // namespace rondure::evaluation
