#include <cmath>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/interval/internal/declared.h"
#include "evaluation/results/chain.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/gates.h"
#include "evaluation/wheel/internal/measured_axis.h"
#include "evaluation/wheel/internal/unseen.h"
#include "evaluation/wheel/result.h"
#include "record/tasks/settings.h"
#include "record/tasks/wheel.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::kMicrometre;
using core::um;
using record::GroundSurfaceTask;
using record::WheelTask;

fit::WheelPointErrors point_errors(const record::WheelInfluencesTask& said) {
  return {record::u_of(said.point_um) * kMicrometre, record::u_of(said.scale_ppm) * 1e-6,
          record::u_of(said.threshold_um) * kMicrometre, record::u_of(said.wear_um) * kMicrometre};
}

core::Result<fit::WheelSurface> formula_or_table(const GroundSurfaceTask& task) {
  switch (task.form) {
    case GroundSurfaceTask::Form::kTable:
      return fit::WheelSurface::table(task.table_x_mm, task.table_z_mm);
    case GroundSurfaceTask::Form::kPolynomial:
      return fit::WheelSurface::polynomial({task.coefficients});
    case GroundSurfaceTask::Form::kAsphere:
      break;
  }
  const auto& radius = task.vertex_radius_mm;
  return fit::WheelSurface::asphere({radius ? 1.0 / *radius : 0.0, task.conic, task.even_terms});
}

core::Result<fit::WheelSurface> surface_of(const GroundSurfaceTask& task) {
  auto out = formula_or_table(task);
  std::vector<double> depth = task.removal_depth_um;
  if (!out || depth.empty()) return out;
  for (double& d : depth) d *= kMicrometre;
  return out->less(task.removal_x_mm, std::move(depth));
}

fit::WheelPathOptions path_options(const WheelTask& wheel, const fit::WheelSurface& surface) {
  const GroundSurfaceTask& task = *wheel.surface;
  fit::WheelPathOptions out;
  out.from_mm = task.from_mm;
  out.to_mm = task.to_mm;
  out.step_mm = task.step_mm;
  if (task.cusp_um) out.cusp_mm = *task.cusp_um * kMicrometre;
  out.least_contact_rad = task.wheel_arc_from_deg * kDegree;
  out.greatest_contact_rad = task.wheel_arc_to_deg * kDegree;
  if (const auto whole = surface.range_mm()) {
    out.surface_from_mm = whole->first;
    out.surface_to_mm = whole->second;
  }
  if (!wheel.program) return out;
  out.lowest_point = wheel.program->lowest_point == record::Switch::kOn;
  if (wheel.program->surface_from_mm) out.surface_from_mm = wheel.program->surface_from_mm;
  if (wheel.program->surface_to_mm) out.surface_to_mm = wheel.program->surface_to_mm;
  return out;
}

core::Result<std::optional<fit::WheelPathTask>> path_task(const WheelTask& wheel) {
  if (!wheel.surface) return std::nullopt;
  const GroundSurfaceTask& task = *wheel.surface;
  TRY(auto surface, surface_of(task));
  const auto options = path_options(wheel, surface);
  fit::WheelPathTask out{std::move(surface), options, fit::RadiusChoice::kMean,
                         task.repeatability_um * kMicrometre, task.touch_off_mm};
  if (task.radius == GroundSurfaceTask::Radius::kEffective) {
    out.radius = fit::RadiusChoice::kEffective;
  }
  return out;
}

std::vector<Eigen::Vector2d> points_of(const record::Series& series) {
  const auto x = series.column("x").value_or(std::vector<double>());
  const auto z = series.column("z").value_or(std::vector<double>());
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < std::min(x.size(), z.size()); ++i) out.emplace_back(x[i], z[i]);
  return out;
}

core::Result<AnalysisValue> departure(const WheelResult& facts,
                                      const record::Characteristic& asked) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  const std::optional<double>& nominal_mm = facts.task.wheel.nominal_radius_mm;
  if (!nominal_mm) return core::fail(core::Code::kMissingKey, "there is no nominal radius");
  AnalysisValue out;
  const double departure_mm = facts.judged_radius_mm() - *nominal_mm;
  out.value_mm = has_signed_limits(asked) ? departure_mm : std::abs(departure_mm);
  out.detail = facts.expansion_1_K
                   ? core::phrase("R {:.6f} mm at 20 degC, nominal {:g} mm",
                                  facts.judged_radius_mm(), *nominal_mm)
                   : core::phrase("R {:.6f} mm, nominal {:g} mm", m.radius_mm, *nominal_mm);
  if (auto warm = not_at_20_degC(facts, asked)) {
    out.void_because = *std::move(warm);
  } else if (!m.radius_void_because.empty()) {
    out.void_because = m.radius_void_because;
  } else if (auto reason = form_moves_radius(m, radius_tolerance_mm(asked))) {
    out.void_because = *std::move(reason);
  }
  return out;
}

core::Result<AnalysisValue> roundness(const WheelResult& facts,
                                      const record::Characteristic& characteristic) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  const bool least_squares = characteristic.reference == record::Reference::kLeastSquares;
  if (!least_squares && characteristic.reference != record::Reference::kMinimumZone) {
    return core::fail(core::Code::kReferenceAbsent,
                      "roundness of a wheel has the references mz, ls");
  }
  AnalysisValue out;
  if (least_squares) {
    // Of all points: a point that the robust variant left out of the centre is form all the same.
    TRY(const auto all, fit::ls_circle(facts.points_mm));
    out.value_mm = all.deviation_mm;
  } else if (m.zone) {
    out.value_mm = m.zone->width_mm();
  } else {
    return core::fail(core::Code::kNotConverged, core::phrase("there is no minimum zone"));
  }
  const BetweenPoints between = between_points(facts, characteristic.form);
  out.unseen_mm = between.loss_mm.value_or(0.0);
  if (auto reason = unseen_because(facts, between, characteristic)) {
    out.void_because = *std::move(reason);
    // The zone of some points is never wider than that of all, nor than their least-squares one.
    const bool proven = m.zone && m.zone->certificate.kind == fit::Certificate::Kind::kGlobal;
    out.lower_bound = !least_squares || (proven && characteristic.tolerance_mm &&
                                         m.zone->width_mm() > *characteristic.tolerance_mm);
  }
  if (!least_squares && m.zone->certificate.kind != fit::Certificate::Kind::kGlobal) {
    out.void_because =
        core::phrase("the minimum zone is not proven: {}", m.zone->certificate.reason);
    out.lower_bound = false;
  }
  return out;
}

/// Gives a wheel the axis that an earlier feature found, or says why there is none.
std::optional<core::Phrase> take_axis(const std::string& id, const EarlierWheel& earlier,
                                      WheelResult& facts) {
  const auto producer = earlier(id);
  if (!producer) return producer.error().said();
  auto axis = measured_axis(**producer, id);
  if (!axis) return axis.error().said();
  facts.task.wheel.axis_mm = axis->center_mm;
  facts.measured_axis = *std::move(axis);
  return std::nullopt;
}

/// Takes back a path that must not be ground.
void refuse_path(core::Phrase why, fit::WheelEvaluation& e) {
  e.path.reset();
  e.forecast.reset();
  e.refused = core::Error{core::Code::kMeaning, why.english(), {}, why};
}

/// Where the tolerances of run-out make a bound of it, everything that states it says so, and no
/// path rests on the effective radius.
void bound_runout(std::span<const record::Characteristic> characteristics, WheelResult& facts) {
  auto& runout = facts.evaluation.wheel.runout;
  if (!runout) return;
  for (const record::Characteristic& asked : characteristics) {
    if (asked.form != record::Form::kRunOut || !runout->bound_because.empty()) continue;
    auto reason = unseen_because(facts, between_points(facts, asked.form), asked);
    if (reason) runout->bound_because = *std::move(reason);
  }
  fit::WheelEvaluation& e = facts.evaluation;
  if (runout->bound_because.empty() || !e.path || e.radius != fit::RadiusChoice::kEffective) return;
  refuse_path(core::phrase("the effective radius is a lower bound only: {}", runout->bound_because),
              e);
}

}  // namespace

fit::WheelOptions wheel_options(const WheelTask& task, std::uint64_t seed) {
  fit::WheelOptions out;
  out.mode = task.mode == WheelTask::Mode::kEnvelope ? fit::WheelMode::kEnvelope
                                                     : fit::WheelMode::kIndexed;
  out.mean = task.center == WheelTask::Center::kAsPublished ? fit::WheelMean::kAsPublished
                                                            : fit::WheelMean::kLeastSquares;
  out.quadruples.seed = seed;
  out.quadruples.kappa_limit = task.kappa_limit;
  out.robust = task.robust == record::Switch::kOn;
  out.allow_short_arc = task.short_arc == WheelTask::ShortArc::kAllowed;
  out.nominal_radius_mm = task.nominal_radius_mm;
  if (task.axis_x_mm && task.axis_z_mm) {
    out.axis_mm = Eigen::Vector2d(*task.axis_x_mm, *task.axis_z_mm);
  }
  if (task.uncertainty && task.uncertainty->point_um) out.errors = point_errors(*task.uncertainty);
  return out;
}

core::Result<AnalysisValue> value_of(const WheelResult& facts,
                                     const record::Characteristic& characteristic) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  if (characteristic.form == record::Form::kRadius) {
    return departure(facts, characteristic);
  }
  if (characteristic.form == record::Form::kRoundness) return roundness(facts, characteristic);
  if (!m.runout) return core::fail(core::Code::kNoAxis, m.runout_absent);
  AnalysisValue out;
  out.value_mm = m.runout->fim_mm;
  const BetweenPoints between = between_points(facts, characteristic.form);
  out.unseen_mm = between.loss_mm.value_or(0.0);
  if (auto reason = unseen_because(facts, between, characteristic)) {
    out.void_because = *std::move(reason);
    out.lower_bound = true;
  }
  return out;
}

ValueOperator operator_of(const WheelResult& facts, const record::Characteristic& characteristic,
                          const core::Phrase& temperature) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  const bool dropped = characteristic.form == record::Form::kRadius;
  const core::Phrase points =
      core::phrase("{} of {} points, {} mode", m.points - (dropped ? m.dropped.size() : 0),
                   m.points, core::Phrase(fit::name_of(m.mode)));
  core::Phrase reference = core::as_it_is(reference_of(characteristic));
  if (characteristic.form == record::Form::kRunOut) {
    reference = facts.measured_axis
                    ? core::phrase("full indicator movement about the axis of feature {}",
                                   facts.measured_axis->feature)
                    : core::phrase("full indicator movement about the given axis");
  } else if (characteristic.form != record::Form::kRoundness) {
    reference = m.mean == fit::WheelMean::kLeastSquares
                    ? core::phrase("mean distance from the least-squares centre")
                    : core::phrase("mean distance from the mean centre of {} quadruples of points",
                                   m.centers.accepted.size());
  }
  return {ReferenceTerm(reference),
          FilterTerm(dropped ? filter_text(facts) : core::phrase("unfiltered")),
          SamplingTerm(points), TipTerm(core::phrase("points as given")),
          TemperatureTerm(temperature)};
}

core::Phrase filter_text(const WheelResult& facts) {
  return facts.task.wheel.robust
             ? core::phrase("unfiltered, isolated outliers left out of centre and radius")
             : core::phrase("unfiltered");
}

core::Phrase sampling_text(const WheelResult& facts) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  return core::phrase("{} points, {} mode, {:.0f} deg", m.points,
                      core::Phrase(fit::name_of(m.mode)), m.order.coverage_rad() / kDegree);
}

core::Result<WheelResult> evaluate_wheel(const record::RunRecord& record, int index,
                                         const EarlierWheel& earlier, FeatureResult& result) {
  TRY(const auto asked, record::task_of<WheelTask>(result.feature.settings));
  TRY(auto task, path_task(asked));
  WheelResult facts;
  facts.points_mm = points_of(*record.data_of(index, "data"));
  facts.task = {wheel_options(asked, record.header.seed), std::move(task)};
  facts.declared = asked.uncertainty;
  facts.expansion_1_K = asked.expansion_per_K;
  if (result.temperatures) facts.above_20_K = result.temperatures->mean_degC - 20.0;
  std::optional<core::Phrase> chain;
  if (asked.axis_from) {
    chain = take_axis(asked.axis_from->feature, earlier, facts);
    result.gates.push_back(chain_gate(asked.axis_from->feature, chain));
  }
  TRY(auto evaluation, fit::evaluate_wheel(facts.points_mm, facts.task));
  facts.evaluation = std::move(evaluation);
  if (chain) facts.evaluation.wheel.runout_absent = *chain;
  bound_runout(result.feature.characteristics, facts);
  if (const auto stale = age_fault(record, result.feature); stale && facts.evaluation.path) {
    refuse_path(core::phrase("the radius of the wheel is out of date: {}", *stale),
                facts.evaluation);
  }
  facts.effective_radius = effective_radius_interval(facts, uncertainty_options(record));
  for (Gate& gate : gates_of(facts, result.feature.characteristics)) {
    result.gates.push_back(std::move(gate));
  }
  result.warnings = facts.evaluation.wheel.warnings;
  if (facts.evaluation.path) {
    const auto& more = facts.evaluation.path->warnings;
    result.warnings.insert(result.warnings.end(), more.begin(), more.end());
  }
  if (facts.evaluation.refused) result.warnings.push_back(*facts.evaluation.refused);
  return facts;
}

}  // namespace rondure::evaluation
