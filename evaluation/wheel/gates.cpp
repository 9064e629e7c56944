#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/wheel/internal/unseen.h"
#include "fit/wheel/loss.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::um;

constexpr double kLossShare = 0.1;  ///< Of the tolerance; more makes a bound.
/// Of the tolerance; what may move a radius by more voids it: form on an arc, temperature.
constexpr double kFormShare = 0.25;
constexpr double kUnknown_K = 5.0;            ///< From 20 degC, where no temperature is recorded.
constexpr double kUsualExpansion_1_K = 8e-6;  ///< Of a vitrified wheel, where none is stated.

using Outcome = Gate::Outcome;

/// A gate that passed.
Gate gate(std::string code, core::Phrase condition, std::optional<double> found,
          std::optional<double> limit, std::string unit = {}) {
  return {std::move(code), std::move(condition), found, limit,
          std::move(unit), Outcome::kPassed,     {}};
}

Gate gap_gate(const fit::WheelMeasurement& m) {
  Gate out = gate("gap", core::phrase("largest gap between neighbouring points"),
                  m.order.largest_gap_rad / kDegree, fit::kWidestGap / kDegree, "deg");
  if (m.sees_whole_turn()) return out;
  out.outcome = Outcome::kBounds;
  out.reason = core::phrase(
      "run-out, effective radius and roundness are lower bounds: measure the whole turn");
  return out;
}

Gate loss_gate(const WheelResult& facts, const record::Characteristic& asked) {
  const BetweenPoints between = between_points(facts, asked.form);
  Gate out = gate("loss-between-points",
                  asked.form == record::Form::kRunOut
                      ? core::phrase("most that run-out can lose between the points")
                      : core::phrase("most that roundness can lose between the points"),
                  std::nullopt, std::nullopt, "um");
  if (between.loss_mm) out.found = core::micrometres(*between.loss_mm);
  if (asked.tolerance_mm) out.limit = core::micrometres(kLossShare * *asked.tolerance_mm);
  if (auto reason = unseen_because(facts, between, asked)) {
    out.outcome = Outcome::kBounds;
    out.reason = *std::move(reason);
  }
  return out;
}

/// Size of the change of the radius from 20 degC to its temperature, by the stated expansion or a
/// usual one; of a temperature that is not known, by what a shop may be off.
double growth_mm(const WheelResult& facts) {
  return facts.evaluation.wheel.radius_mm * facts.expansion_1_K.value_or(kUsualExpansion_1_K) *
         std::abs(facts.above_20_K.value_or(kUnknown_K));
}

/// Quadruples, as fit decides on them: the first that does not pass gives its reason.
std::vector<Gate> quadruple_gates(const WheelResult& facts) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  const double best = m.centers.best_kappa();
  // Fewer give no wheel at all: select_centers().
  std::vector<Gate> out = {
      gate("quadruples", core::phrase("quadruples of points that give a centre, at least"),
           static_cast<double>(m.centers.accepted.size()), static_cast<double>(fit::kLeastCenters)),
      gate("conditioning", core::phrase("conditioning of the best quadruple"), best,
           fit::kWorstBestKappa),
      gate("centers-agree", core::phrase("distance of the centre of quadruples from least squares"),
           core::micrometres(m.center_apart_mm), core::micrometres(m.center_apart_limit_mm), "um")};
  if (m.radius_void_because.empty()) return out;
  Gate& failed = best > fit::kWorstBestKappa ? out[1] : out[2];
  failed.outcome = Outcome::kVoids;
  failed.reason = m.radius_void_because;
  return out;
}

Gate correlation_gate(const fit::WheelMeasurement& m,
                      std::span<const record::Characteristic> characteristics) {
  const double form_mm = m.form_in_radius_mm();
  Gate out =
      gate("form-on-an-arc", core::phrase("what lobes of orders 2 and 3 may move R by, limit T/4"),
           core::micrometres(form_mm), std::nullopt, "um");
  if (form_mm == 0.0) return out;
  out.outcome = Outcome::kWarns;
  out.reason =
      core::phrase("lobes of orders 2 and 3 may move R by {} um to each side", um(form_mm));
  for (const record::Characteristic& asked : characteristics) {
    if (asked.form != record::Form::kRadius) continue;
    const auto tolerance_mm = radius_tolerance_mm(asked);
    if (tolerance_mm) {
      const double limit_um = core::micrometres(kFormShare * *tolerance_mm);
      out.limit = std::min(out.limit.value_or(limit_um), limit_um);
    }
    if (auto reason = form_moves_radius(m, tolerance_mm)) {
      out.outcome = Outcome::kVoids;
      out.reason = *std::move(reason);
    }
  }
  return out;
}

/// The radius against what temperature makes of it: nominal radii hold at 20 degC.
Gate length_gate(const WheelResult& facts, const record::Characteristic& asked) {
  const bool corrected = facts.expansion_1_K.has_value();
  Gate out = gate("length-scale",
                  corrected ? core::phrase("correction of the radius to 20 degC")
                            : core::phrase("change of the radius by its temperature, limit T/4"),
                  std::nullopt, std::nullopt, "um");
  out.found = core::micrometres(growth_mm(facts));
  const auto tolerance_mm = radius_tolerance_mm(asked);
  if (!corrected && tolerance_mm) out.limit = core::micrometres(kFormShare * *tolerance_mm);
  if (auto reason = not_at_20_degC(facts, asked)) {
    out.outcome = Outcome::kVoids;
    out.reason = *std::move(reason);
  }
  return out;
}

/// The radius of the path against the one it is meant for.
Gate path_gate(const fit::WheelEvaluation& e) {
  const fit::WheelMeasurement& m = e.wheel;
  Gate out = gate("path-radius", core::phrase("radius of the path from the measured radius"),
                  std::nullopt, core::micrometres(2.0 * m.radius_uncertainty_mm), "um");
  if (e.path) {
    const double measured_mm = e.radius == fit::RadiusChoice::kMean
                                   ? m.radius_mm
                                   : m.effective_radius_mm().value_or(m.radius_mm);
    out.found = core::micrometres(std::abs(e.path->radius_mm - measured_mm));
  } else if (e.refused && e.refused->code == core::Code::kMeaning) {  // others are of the surface
    out.outcome = Outcome::kVoids;
    out.reason = core::phrase("there is no path: {}", e.refused->said());
  }
  return out;
}

}  // namespace

BetweenPoints between_points(const WheelResult& facts, record::Form form) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  const bool runout = form == record::Form::kRunOut && m.runout;
  const Eigen::Vector2d center_mm = runout ? m.runout->axis_mm : m.center_mm;
  BetweenPoints out;
  out.gap_rad = fit::angular_order(facts.points_mm, center_mm).largest_gap_rad;
  if (!m.sees_whole_turn()) return out;
  const double point_um = facts.declared ? record::u_of(facts.declared->point_um) : 0.0;
  const auto amplitudes =
      fit::found_amplitudes(facts.points_mm, center_mm, point_um * core::kMicrometre);
  out.held = static_cast<int>(amplitudes.size());
  // Points in four clusters hold the eccentricity, but no oval: what they miss has no bound.
  if (out.held >= kOrdersOfLobes) {
    out.loss_mm = fit::loss_in_gap_mm(out.gap_rad, amplitudes, runout ? 1 : 2);
  }
  return out;
}

std::optional<core::Phrase> unseen_because(const WheelResult& facts, const BetweenPoints& found,
                                           const record::Characteristic& characteristic) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  if (characteristic.form == record::Form::kRadius) return std::nullopt;
  if (!m.sees_whole_turn()) {
    return core::phrase(
        "the points leave {:.0f} deg of the turn unseen: what is there can only add to the "
        "deviation; measure the whole turn",
        std::max(m.order.largest_gap_rad, found.gap_rad) / kDegree);
  }
  if (!found.loss_mm) {
    return core::phrase(
        "the places of the points hold lobes up to order {} only, those up to order {} matter: the "
        "value is a lower bound; measure at least {} points evenly about the turn",
        found.held, kOrdersOfLobes, 2 * kOrdersOfLobes + 1);
  }
  const auto& tolerance_mm = characteristic.tolerance_mm;
  if (!tolerance_mm || *found.loss_mm <= kLossShare * *tolerance_mm) return std::nullopt;
  return core::phrase(
      "between points {:.1f} deg apart up to {} um may be missing, more than a tenth of the "
      "tolerance of {} um: the value is a lower bound; measure more points",
      found.gap_rad / kDegree, um(*found.loss_mm), um(*tolerance_mm));
}

bool has_signed_limits(const record::Characteristic& characteristic) {
  return characteristic.lower_mm.has_value();
}

std::optional<double> radius_tolerance_mm(const record::Characteristic& characteristic) {
  const std::optional<double>& upper_mm = characteristic.tolerance_mm;
  if (!upper_mm || !characteristic.lower_mm) return upper_mm;
  return 0.5 * (*upper_mm - *characteristic.lower_mm);
}

std::optional<core::Phrase> form_moves_radius(const fit::WheelMeasurement& wheel,
                                              const std::optional<double>& tolerance_mm) {
  const double form_mm = wheel.form_in_radius_mm();
  if (!tolerance_mm || form_mm <= kFormShare * *tolerance_mm) return std::nullopt;
  return core::phrase(
      "the points see {:.0f} deg: lobes of orders 2 and 3 may move R by {} um to each side, more "
      "than a quarter of the tolerance of {} um; measure more of the circle",
      wheel.order.coverage_rad() / kDegree, um(form_mm), um(*tolerance_mm));
}

std::optional<core::Phrase> not_at_20_degC(const WheelResult& facts,
                                           const record::Characteristic& asked) {
  const auto tolerance_mm = radius_tolerance_mm(asked);
  if (facts.expansion_1_K && !facts.above_20_K) {
    return core::phrase(
        "expansion_per_K is stated, but the temperature of the wheel was not recorded: give the "
        "points a column temperature_degC, or declare environment.assumed_degC");
  }
  if (facts.expansion_1_K || !tolerance_mm || growth_mm(facts) <= kFormShare * *tolerance_mm) {
    return std::nullopt;
  }
  if (!facts.above_20_K) {
    return core::phrase(
        "the temperature of the wheel was not recorded: 5 K change its radius by some {} um, more "
        "than a quarter of the tolerance of {} um: give the points a column temperature_degC, or "
        "declare environment.assumed_degC",
        um(growth_mm(facts)), um(*tolerance_mm));
  }
  return core::phrase(
      "the wheel was measured at {:.2f} degC, which changes its radius by some {} um, more than a "
      "quarter of the tolerance of {} um: state expansion_per_K of the wheel, or measure at 20 "
      "degC",
      20.0 + *facts.above_20_K, um(growth_mm(facts)), um(*tolerance_mm));
}

std::vector<Gate> gates_of(const WheelResult& result,
                           std::span<const record::Characteristic> characteristics) {
  const fit::WheelMeasurement& m = result.evaluation.wheel;
  std::vector<Gate> out = {gap_gate(m)};
  for (const record::Characteristic& asked : characteristics) {
    const bool runout = asked.form == record::Form::kRunOut && m.runout;
    if (runout || asked.form == record::Form::kRoundness) out.push_back(loss_gate(result, asked));
  }
  for (const record::Characteristic& asked : characteristics) {
    if (asked.form == record::Form::kRadius && asked.toleranced()) {
      out.push_back(length_gate(result, asked));
    }
  }
  for (Gate& one : quadruple_gates(result)) out.push_back(std::move(one));
  // All round, form moves the radius little, whatever the residuals are.
  if (!m.order.closed()) out.push_back(correlation_gate(m, characteristics));
  if (result.task.path) out.push_back(path_gate(result.evaluation));
  return out;
}

}  // namespace rondure::evaluation
