#include "evaluation/correction/spindle_table.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>

#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/correction/internal/barred.h"
#include "evaluation/spindle/internal/noise_runs.h"

namespace rondure::evaluation {
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

}  // namespace rondure::evaluation
