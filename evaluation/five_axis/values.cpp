#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/five_axis/result.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/rotary/internal/axis_extreme.h"
#include "evaluation/rotary/internal/combined_field.h"
#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation {
namespace {

using core::kMicrometre;
using core::um;
using record::Form;
using record::Indication;
using Error = Indication::AxisError;

constexpr double kMrad = 1e3;  // of a rad: angles are held in mrad
constexpr double kLeastNoise_mm = 1e-9;

/// What the declared slides add to a shift [mm], or to a tilt [mrad].
double slides_mm(const FiveAxisResult& facts, bool angle) {
  if (!facts.task.uncertainty) return 0.0;
  const record::HeadInfluencesTask& said = *facts.task.uncertainty;
  const double tilt = record::u_of(said.slides_urad) * core::kMicroradian;
  if (angle) return kMrad * tilt;
  return std::hypot(record::u_of(said.slides_um) * kMicrometre, tilt * facts.lever_mm);
}

core::Result<HeadLocation> location_of(const FiveAxisResult& facts, Error error) {
  for (const HeadLocation& one : locations_of(facts)) {
    if (one.error == error) return one;
  }
  return core::fail(
      core::Code::kShortArc,
      core::phrase("the stations span less than 45 deg, so that the place of the axis "
                   "is not told from its motion errors; their sum is in the table"));
}

/// One error over the stations of an axis; at C = A = 0 it is 0 by definition.
AxisCurve curve_of(const FiveAxisResult& facts, const record::Characteristic& asked) {
  const bool of_c = asked.indication.axis == Indication::Axis::kC;
  const fit::RotaryStudy& study = of_c ? facts.study.c : facts.study.a;
  const auto place = static_cast<Eigen::Index>(asked.indication.error.value_or(Error::kX));
  const double scale = place < 3 ? 1.0 : kMrad;
  const double factor = std::max(1.0, study.s0);
  AxisCurve out;
  out.noises = {{"reference-pose", facts.study.reference_modes.cols()}, {"slides", 1}};
  for (const fit::RotaryTableRow& row : study.table.rows) {
    const auto modes = facts.study.modes_at(study.table.axis, row.angle_rad);
    if (row.covariance.isZero(0.0)) continue;  // the reference itself
    Eigen::VectorXd common(modes.cols() + 1);
    common << scale * factor * modes.row(place).transpose(), slides_mm(facts, place >= 3);
    out.angle_rad.push_back(row.angle_rad);
    out.found_mm.push_back(scale * row.errors(place));
    out.u_mm.push_back(std::max(kLeastNoise_mm, scale * std::sqrt(row.covariance(place, place))));
    out.common_mm.push_back(std::move(common));
    out.redundancy.push_back(least_redundancy(study, row.angle_rad));
  }
  return out;
}

std::vector<InfluenceStatement> declaration_of(const FiveAxisResult& facts, Form form) {
  const auto reading = core::phrase(
      "reading of the nest, its reference at C = A = 0 included: u = {} um", um(facts.noise_mm));
  std::vector<InfluenceStatement> out = {{"ball-centre", true, reading}};
  if (form == Form::kLeftRms || form == Form::kLeftLargest) {
    out.push_back({"other-poses", false,
                   core::phrase("errors in poses that were not measured: not covered, the value "
                                "is that of these poses")});
    return out;
  }
  out.push_back({"slides", true,
                 core::phrase("slides, up to {} um at the pivot and {} urad",
                              um(slides_mm(facts, false)), um(slides_mm(facts, true)))});
  out.push_back({"tool-data", false,
                 core::phrase("tool data of the first ball: not covered, locations are relative to "
                              "them")});
  return out;
}

UncertaintyStatus location_interval(const FiveAxisResult& facts,
                                    const record::Characteristic& asked,
                                    const UncertaintyOptions& options) {
  const Error error = asked.indication.error.value_or(Error::kXOC);
  const auto found = location_of(facts, error);
  if (!found) return UncertaintyStatus::none(found.error().said());
  const double by_slides = slides_mm(facts, record::is_angle(error));
  const bool has_sign = asked.lower_mm.has_value();
  TrialValues values;
  values.unit = unit_of(asked);
  values.signed_value = has_sign;
  values.as_measured_mm = has_sign ? found->value_mm : std::abs(found->value_mm);
  const int trials = std::max(2000, options.least_trials);
  for (int t = 0; t < trials; ++t) {
    const auto which = static_cast<std::uint64_t>(error);
    const double drawn = found->value_mm +
                         found->u_mm * normal_draw(options.seed, "head.location", which, t) +
                         by_slides * normal_draw(options.seed, "head.slides", which, t);
    values.values_mm.push_back(has_sign ? drawn : std::abs(drawn));
  }
  auto stated =
      statement_of_trials(std::move(values), {{"ball-centre", found->u_mm}, {"slides", by_slides}},
                          declaration_of(facts, asked.form), options);
  return stated ? UncertaintyStatus::stated(*std::move(stated), options.coverage)
                : UncertaintyStatus::none(stated.error().said());
}

}  // namespace

std::vector<HeadLocation> locations_of(const FiveAxisResult& facts) {
  std::vector<HeadLocation> out;
  const auto add = [&](Error error, double value, double u, double unit) {
    out.push_back({error, unit * value, unit * u});
  };
  if (const auto& c = facts.study.c.offset) {
    add(Error::kXOC, c->d_mm.x(), c->d_u_mm.x(), 1.0);
    add(Error::kYOC, c->d_mm.y(), c->d_u_mm.y(), 1.0);
    add(Error::kAOC, c->e_rad.x(), c->e_u_rad.x(), kMrad);
    add(Error::kBOC, c->e_rad.y(), c->e_u_rad.y(), kMrad);
  }
  if (const auto& a = facts.study.a.offset) {
    add(Error::kYOA, a->d_mm.y(), a->d_u_mm.y(), 1.0);
    add(Error::kZOA, a->d_mm.z(), a->d_u_mm.z(), 1.0);
    add(Error::kBOA, a->e_rad.y(), a->e_u_rad.y(), kMrad);
    add(Error::kCOA, a->e_rad.z(), a->e_u_rad.z(), kMrad);
  }
  return out;
}

core::Result<AnalysisValue> value_of(const FiveAxisResult& facts,
                                     const record::Characteristic& asked) {
  AnalysisValue out;
  out.void_because = facts.withheld;
  if (asked.form == Form::kLocation) {
    TRY(const auto found, location_of(facts, asked.indication.error.value_or(Error::kXOC)));
    out.value_mm = asked.lower_mm ? found.value_mm : std::abs(found.value_mm);
    return out;
  }
  if (asked.form == Form::kAxisError) {
    const AxisCurve curve = curve_of(facts, asked);
    const AxisExtreme extreme = axis_extreme(curve.found_mm, middle_of(asked));
    out.value_mm = axis_value_mm(asked, extreme);
    out.detail = core::phrase("at {:.1f} deg", core::degrees(curve.angle_rad[extreme.station]));
    return out;
  }
  if (facts.combined.empty()) {
    return core::fail(core::Code::kNoPoints, "no pose of both axes was measured");
  }
  const bool rms = asked.form == Form::kLeftRms;
  out.value_mm = rms ? facts.left().rms_mm : facts.left().max_mm;
  if (facts.gain) {
    out.detail = core::phrase("{} um rms without the table, {} um forecast with it",
                              um(facts.gain->before.rms_mm), um(facts.gain->forecast_mm));
  } else {
    out.detail = core::phrase("{} um rms before compensation, {} um expected",
                              um(facts.study.before.rms_mm), um(facts.study.expected_mm));
  }
  return out;
}

std::vector<UncertaintyStatus> intervals_of(const FiveAxisResult& facts,
                                            std::span<const record::Characteristic> characteristics,
                                            const UncertaintyOptions& options) {
  const auto& said = facts.task.uncertainty;
  if (!said || !said->ball_um || !said->slides_um || !said->slides_urad) {
    return std::vector<UncertaintyStatus>(
        characteristics.size(), UncertaintyStatus::none(core::phrase(
                                    "the errors of the slides look like those of the head: declare "
                                    "`ball_um`, `slides_um` and `slides_urad` in `uncertainty` of "
                                    "`five_axis`, 0 where one is known to be none")));
  }
  std::vector<UncertaintyStatus> out;
  std::optional<ResidualTrials> trials;
  for (const record::Characteristic& asked : characteristics) {
    if (asked.form == Form::kLocation) {
      out.push_back(location_interval(facts, asked, options));
    } else if (asked.form == Form::kAxisError) {
      out.push_back(axis_error_interval(curve_of(facts, asked), asked,
                                        declaration_of(facts, asked.form), options));
    } else if (facts.combined.empty()) {
      out.push_back(UncertaintyStatus::none(core::phrase("no pose of both axes was measured")));
    } else {
      const bool rms = asked.form == Form::kLeftRms;
      if (!trials) trials = residual_trials(facts.combined, facts.noise_mm, options);
      out.push_back(residual_interval(rms ? facts.left().rms_mm : facts.left().max_mm, rms, *trials,
                                      declaration_of(facts, asked.form), options));
    }
  }
  return out;
}

ValueOperator operator_of(const FiveAxisResult& facts, const record::Characteristic& asked,
                          const core::Phrase& temperature) {
  const core::Phrase what =
      asked.form == Form::kLocation    ? core::phrase("fit over the stations, C = A = 0 among them")
      : asked.form == Form::kAxisError ? core::phrase("largest over the stations, from C = A = 0")
      : asked.form == Form::kLeftRms
          ? core::phrase("rms distance of balls in poses of both axes from their prediction")
          : core::phrase("largest distance of balls in poses of both axes from their prediction");
  return {ReferenceTerm(what), FilterTerm(filter_text(facts)), SamplingTerm(sampling_text(facts)),
          TipTerm(core::phrase("readings as given")), TemperatureTerm(temperature)};
}

core::Phrase filter_text(const FiveAxisResult& /*facts*/) { return core::phrase("unfiltered"); }

core::Phrase sampling_text(const FiveAxisResult& facts) {
  return core::phrase("{} set-ups, {} readings", facts.task.balls.size(), facts.readings);
}

}  // namespace rondure::evaluation
