#include "evaluation/rotary/internal/gates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/rotary/ball_setup.h"

namespace rondure::evaluation {
namespace {

using core::kMicroradian;
using Outcome = Gate::Outcome;

constexpr double kReferenceSigmas = 4.0;
constexpr double kExplained = 3.0;    // times what the calibration explains
constexpr double kDigits_mm = 1e-6;   // of touches in files and on the wire
constexpr double kRedundancy = 0.1;   // below, an error of a ball is not seen
constexpr double kOffStation = 0.33;  // of the step; exact thirds pass whatever the drive reaches
constexpr double kRangeShown = 0.5;   // of that of the stations
constexpr double kChance = 0.001;     // of a gate that fails although all is well

/// A gate that passes up to its limit.
Gate up_to(std::string code, core::Phrase condition, double found, double limit, std::string unit,
           Outcome otherwise, core::Phrase reason) {
  Gate out{std::move(code), std::move(condition), found,         limit,
           std::move(unit), Outcome::kPassed,     core::Phrase()};
  if (found <= limit) return out;
  out.outcome = otherwise;
  out.reason = std::move(reason);
  return out;
}

Gate at_least(std::string code, core::Phrase condition, double found, double limit,
              core::Phrase reason) {
  Gate out{std::move(code),  std::move(condition), found, limit, {},
           Outcome::kPassed, core::Phrase()};
  if (found >= limit) return out;
  out.outcome = Outcome::kWarns;
  out.reason = std::move(reason);
  return out;
}

Gate other_axis_gate(const PlacingFacts& placing) {
  return up_to(
      "other-axis", core::phrase("reading of the other axis while a station is measured"),
      placing.off_rad / kMicroradian, placing.off_limit_rad / kMicroradian, "urad", Outcome::kVoids,
      core::phrase("the other axis read {:.0f} urad while a station was measured, the limit is "
                   "{:.0f} urad: set it closer to 0 and calibrate again",
                   placing.off_rad / kMicroradian, placing.off_limit_rad / kMicroradian));
}

Gate drive_gate(const PlacingFacts& placing) {
  const core::Phrase condition = core::phrase("distance of a reading from its command");
  const double missed_urad = placing.missed_rad / kMicroradian;
  if (!placing.missed_limit_rad) {
    return {"drive-missed",
            condition,
            missed_urad,
            std::nullopt,
            "urad",
            Outcome::kWarns,
            core::phrase("the journal does not state the resolution of the fixture, so that a "
                         "missed command is not noticed")};
  }
  const double limit_urad = *placing.missed_limit_rad / kMicroradian;
  return up_to("drive-missed", condition, missed_urad, limit_urad, "urad", Outcome::kVoids,
               core::phrase("the fixture stood {:.0f} urad from its command, the limit is {:.0f} "
                            "urad: the drive missed it; check the drive and calibrate again",
                            missed_urad, limit_urad));
}

Gate reference_gate(const PlacingFacts& placing) {
  return up_to(
      "references",
      core::phrase("difference of a ball between two zero poses over its uncertainty"),
      placing.reference_sigmas, kReferenceSigmas, {}, Outcome::kVoids,
      core::phrase("a ball differs between two zero poses by {:.1f} times the uncertainty of the "
                   "difference, the limit is {:g}: warm-up, a loose ball or an axis that does not "
                   "return; let the machine warm up and calibrate again",
                   placing.reference_sigmas, kReferenceSigmas));
}

/// The station with the largest chi-square over its limit. All of them together fail by chance once
/// in a thousand calibrations.
Gate station_gate(std::span<const AxisFacts> axes) {
  double stations = 0.0;
  for (const AxisFacts& axis : axes) {
    stations += static_cast<double>(axis.study->stations.size());
  }
  double worst = 0.0;
  double angle_deg = 0.0;
  std::string name;
  for (const AxisFacts& axis : axes) {
    for (const fit::RotaryStation& station : axis.study->stations) {
      if (station.undetermined || station.dof <= 0) continue;
      const double ratio =
          station.chi2 / core::chi_square_quantile(1.0 - kChance / stations, station.dof);
      if (ratio <= worst) continue;
      worst = ratio;
      angle_deg = core::degrees(station.angle_rad);
      name = axis.key;
    }
  }
  return up_to("station-chi2", core::phrase("chi2 of the worst station over its limit"), worst, 1.0,
               {}, Outcome::kVoids,
               core::phrase("at station {:g} deg of axis {} the balls contradict one another: chi2 "
                            "is {:.1f} times its limit; check that no ball is loose, or declare "
                            "the uncertainty of a ball centre (ball_um)",
                            angle_deg, name, worst));
}

Gate small_residual_gate(std::span<const AxisFacts> axes) {
  double chi2 = 0.0;
  double dof = 0.0;
  for (const AxisFacts& axis : axes) {
    chi2 += axis.study->s0 * axis.study->s0 * axis.study->dof;
    dof += axis.study->dof;
  }
  const double least = dof > 0.0 ? core::chi_square_quantile(kChance, dof) : 0.0;
  return at_least("u-too-large", core::phrase("chi2 of all stations"), chi2, least,
                  core::phrase("the balls agree better than their uncertainty allows: chi2 is "
                               "{:.1f}, at least {:.1f} is expected; the uncertainty stated for a "
                               "ball centre is too large",
                               chi2, least));
}

Gate redundancy_gate(std::span<const AxisFacts> axes) {
  double least = 1.0;
  for (const AxisFacts& axis : axes) {
    for (const fit::RotaryStation& station : axis.study->stations) {
      for (const Eigen::Vector3d& r : station.redundancy) least = std::min(least, r.minCoeff());
    }
  }
  // Round-off leaves a little below 0 where a ball has no redundancy at all.
  least = std::max(0.0, least);
  return at_least("redundancy", core::phrase("least redundancy of a coordinate"), least,
                  kRedundancy,
                  core::phrase("an error of one ball is not seen by the others (redundancy {:.2f}, "
                               "at least {:g} is needed): use 4 balls or more, spread out",
                               least, kRedundancy));
}

Gate condition_gate(double condition) {
  return up_to("condition", core::phrase("condition of the balls"), condition,
               fit::kConditionWarning, {}, Outcome::kWarns,
               core::phrase("the balls lie nearly on one line (condition {:.1f}, limit {:g}): "
                            "spread them out",
                            condition, fit::kConditionWarning));
}

}  // namespace

Gate residual_gate(double rms_mm, double expected_mm) {
  // A simulation without errors explains nothing, and leaves what the digits of the touches do.
  const double ratio = rms_mm / std::max(expected_mm, kDigits_mm);
  return up_to("depends-on-both",
               core::phrase("residual at combined poses over what the uncertainty explains"), ratio,
               kExplained, {}, Outcome::kVoids,
               core::phrase("the combined poses leave {} um rms, {:.1f} times what the uncertainty "
                            "explains (limit {:g}): errors depend on both angles (gravity, play), "
                            "or something moved; no table of single axes holds them",
                            core::um(rms_mm), ratio, kExplained));
}

namespace {

/// Range of the angles that lie off the stations of an axis, over that of the stations. At a
/// station its errors were measured; what is left between stations shows off them only.
double range_shown(const fit::RotaryStudy& study, const std::vector<double>& angles_rad) {
  std::vector<double> stations_rad;
  for (const fit::RotaryTableRow& row : study.table.rows) stations_rad.push_back(row.angle_rad);
  if (stations_rad.size() < 2) return 0.0;
  std::ranges::sort(stations_rad);
  double low_rad = HUGE_VAL;
  double high_rad = -HUGE_VAL;
  for (const double angle : angles_rad) {
    const auto after = std::ranges::upper_bound(stations_rad, angle);
    if (after == stations_rad.begin() || after == stations_rad.end()) continue;
    const double before_rad = *(after - 1);
    const double off_rad = std::min(angle - before_rad, *after - angle);
    if (off_rad < kOffStation * (*after - before_rad)) continue;
    low_rad = std::min(low_rad, angle);
    high_rad = std::max(high_rad, angle);
  }
  const double whole_rad = stations_rad.back() - stations_rad.front();
  return std::max(0.0, high_rad - low_rad) / whole_rad;
}

/// The lesser of both axes.
double range_shown(const RotaryResult& facts) {
  std::vector<double> alpha_rad;
  std::vector<double> beta_rad;
  for (const CombinedPose& one : facts.combined) {
    alpha_rad.push_back(one.pose.alpha_rad);
    beta_rad.push_back(one.pose.beta_rad);
  }
  return std::min(range_shown(facts.alpha, alpha_rad), range_shown(facts.beta, beta_rad));
}

Gate between_stations_gate(const RotaryResult& facts) {
  Gate out{
      "between-stations",
      core::phrase("range of the combined poses that lie a third of the step off the stations, "
                   "over that of the stations"),
      range_shown(facts),
      kRangeShown,
      {},
      Outcome::kPassed,
      {}};
  if (auto reason = residual_not_shown(facts)) {
    out.outcome = Outcome::kBounds;
    out.reason = *std::move(reason);
  }
  return out;
}

Gate scale_gate(const RotaryResult& facts) {
  return up_to("residual-scale",
               core::phrase("scale of the errors at combined poses, lower end of its interval"),
               facts.scale_low, 1.0, {}, Outcome::kWarns,
               core::phrase("the errors at combined poses are {:.1f} times those that the "
                            "calibration explains ({:.1f} to {:.1f}): they depend on both angles; "
                            "its standard uncertainties were multiplied by {:.1f}",
                            facts.scale, facts.scale_low, facts.scale_high, facts.scale));
}

}  // namespace

std::vector<Gate> station_gates(std::span<const AxisFacts> axes, double condition) {
  return {condition_gate(condition), redundancy_gate(axes), station_gate(axes),
          small_residual_gate(axes)};
}

std::vector<Gate> rotary_gates(const RotaryResult& facts, const PlacingFacts& placing) {
  std::vector<Gate> out = {other_axis_gate(placing), drive_gate(placing)};
  for (Gate& gate : station_gates(axes_of(facts), facts.condition)) out.push_back(std::move(gate));
  if (placing.references > 1) out.push_back(reference_gate(placing));
  if (facts.combined.empty()) return out;
  out.push_back(between_stations_gate(facts));
  const fixture::Verification& v = facts.calibration.verification;
  out.push_back(residual_gate(v.rms_mm, v.expected_mm));
  out.push_back(scale_gate(facts));
  return out;
}

std::optional<core::Phrase> residual_not_shown(const RotaryResult& facts) {
  const double shown = range_shown(facts);
  if (shown >= kRangeShown) return std::nullopt;
  return core::phrase(
      "the combined poses that lie at least a third of the step off the stations cover {:.0f} % of "
      "their range, {:.0f} % are needed: what is left between the stations is not shown; choose "
      "angles between the stations of both axes",
      100.0 * shown, 100.0 * kRangeShown);
}

std::optional<core::Phrase> voided_by(const std::vector<Gate>& gates) {
  const auto at = std::find_if(gates.begin(), gates.end(),
                               [](const Gate& gate) { return gate.outcome == Outcome::kVoids; });
  if (at == gates.end()) return std::nullopt;
  return at->reason;
}

}  // namespace rondure::evaluation
