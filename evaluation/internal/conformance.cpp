#include "evaluation/internal/conformance.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/numbers.h"
#include "core/units.h"
#include "core/watch.h"
#include "evaluation/harmonic_mask.h"
#include "evaluation/internal/file_digits.h"
#include "evaluation/interval/internal/form_interval.h"
#include "evaluation/part/contacts.h"
#include "evaluation/part/find.h"
#include "evaluation/part/internal/families.h"
#include "evaluation/part/internal/layout.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/gates.h"
#include "evaluation/results/internal/deviation.h"
#include "evaluation/results/measured_cloud.h"
#include "fit/sizes/sizes.h"
#include "record/tasks/form_facts.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using core::micrometres;

using record::Form;

/// What a file can state wrong, as in prepared(): points of different heights in one layer, a tip
/// that leaves the surface no radius.
core::Result<void> check_file(const FeatureResult& result) {
  if (result.feature.strategy != record::Strategy::kPointsFile) return {};
  const auto& cylinder = result.ls_cylinder;
  if (cylinder && result.tip_radius_mm) {
    const fit::Material material{result.feature.side == record::Side::kInside,
                                 *result.tip_radius_mm};
    if (auto done = fit::check_material(material, cylinder->radius_mm); !done) return done;
  }
  const fit::Axis& axis = cylinder ? cylinder->axis : result.section_axis;
  for (const LayerResult& layer : result.layers) {
    // A layer may be square to the axis, or flat in the file where the part stands aslant.
    std::vector<double> along_mm;
    std::vector<double> z_mm;
    for (const std::size_t row : layer.rows) {
      const Eigen::Vector3d& tip = result.cloud[row].tip_mm;
      along_mm.push_back((tip - axis.point_mm).dot(axis.direction));
      z_mm.push_back(tip.z());
    }
    if (along_mm.empty() || check_thickness(result, layer.layer, z_mm)) continue;
    if (auto done = check_thickness(result, layer.layer, along_mm); !done) return done;
  }
  return {};
}

/// The value of a characteristic, if what proves it is present.
core::Result<Deviation> value_of(const FeatureResult& result,
                                 const record::Characteristic& characteristic) {
  if (result.failure) return core::fail(*result.failure);
  TRY_DO(check_file(result));
  return characteristic.form == Form::kRoundness
             ? worst_section(result, characteristic.reference)
             : cylinder_deviation(result, characteristic.reference);
}

core::Phrase sampling_words(const FeatureResult& result,
                            const record::Characteristic& characteristic) {
  const record::Feature& feature = result.feature;
  core::Phrase text = feature.layers > 0
                          ? core::phrase("{} x {} points", feature.layers, feature.points_per_layer)
                          : core::phrase("{} points", result.cloud.size());
  const auto sampling = record::task_of<record::SamplingSettings>(feature.settings);
  const bool scanned = sampling && sampling->sampling_method == record::SamplingMethod::kScan;
  if (scanned) text = core::phrase("{}, scanned", text);
  if (result.merged) {
    text = core::phrase("{} in {} poses, merged {}", text, result.merged->poses.size(),
                        result.merged->joint ? core::phrase("with their errors solved for")
                                             : core::phrase("by kinematics"));
  }
  const bool by_layer =
      characteristic.form == Form::kRoundness || characteristic.form == Form::kHarmonicLimits;
  if (by_layer && result.layers.size() > 1) text = joined(text, core::phrase("worst layer"));
  if (!result.cloud.empty() && result.cloud.front().repeats > 1) {
    return joined(text, core::phrase("mean of {} touches per point", result.cloud.front().repeats));
  }
  if (const int passes = passes_of(result.cloud); passes > 1) {
    return joined(text, core::phrase("{} passes at places of their own, not averaged", passes));
  }
  return text;
}

core::Phrase tip_words(const FeatureResult& result) {
  return result.tip_radius_mm ? core::phrase("r_tip {:.4f} mm", *result.tip_radius_mm)
                              : core::phrase("r_tip unknown");
}

ValueOperator operator_of(const FeatureResult& result,
                          const record::Characteristic& characteristic) {
  return {ReferenceTerm(core::as_it_is(reference_of(characteristic))),
          FilterTerm(core::phrase("unfiltered")),
          SamplingTerm(sampling_words(result, characteristic)), TipTerm(tip_words(result)),
          TemperatureTerm(temperature_words(result))};
}

/// Why the probe cannot vouch for a touched feature.
std::optional<core::Phrase> probe_fault(const record::RunRecord& record,
                                        const std::optional<fit::ProbeTip>& probe) {
  const record::Artefact& limits = record.artefact;
  if (!probe) return core::phrase("the probe was not qualified");
  if (!(std::abs(probe->radius_mm - limits.nominal_tip_radius_mm) <= limits.radius_tolerance_mm)) {
    return core::phrase("the effective tip radius {:.6f} mm is not within {:g} um of {:g} mm",
                        probe->radius_mm, micrometres(limits.radius_tolerance_mm),
                        limits.nominal_tip_radius_mm);
  }
  if (!(probe->form_mm <= limits.form_limit_mm)) {
    return core::phrase("the probing form {:.3f} um is above its limit of {:g} um",
                        micrometres(probe->form_mm), micrometres(limits.form_limit_mm));
  }
  return std::nullopt;
}

/// Why a column cannot vouch for the touches of a feature: it was approached across its axis alone.
std::optional<core::Phrase> column_fault(const record::RunRecord& record,
                                         const FeatureResult& result) {
  const auto said =
      record::task_of<record::QualificationSettings>(record.settings, "qualification/");
  if (!said || said->artefact != record::ReferenceArtefact::kColumn) return std::nullopt;
  double steepest_1 = 0.0;
  for (const record::PoseVisit& visit : record.poses) {
    const record::Feature& of = record.features[static_cast<std::size_t>(visit.feature)];
    if (!visit.final_cloud || of.id != result.feature.id) continue;
    for (const record::Touch& touch : record.touches) {
      if (touch.purpose != record::Touch::Purpose::kMeasure || touch.pose != visit.id) continue;
      steepest_1 = std::max(steepest_1, std::abs(touch.approach.z()));
    }
  }
  const double slope_deg = std::asin(std::min(1.0, steepest_1)) / core::kDegree;
  if (slope_deg <= said->column_slope_deg) return std::nullopt;
  return core::phrase(
      "the tip was qualified on a column, from its side, and touches of the feature come {:.1f} "
      "deg "
      "from the horizontal, more than {:g} deg; qualify it on a sphere",
      slope_deg, said->column_slope_deg);
}

/// Least-squares radius of the tip centres of a feature that has one nominal diameter.
std::optional<double> centre_radius_mm(const FeatureResult& result) {
  if (result.ls_cylinder) return result.ls_cylinder->radius_mm;
  if (result.ls_sphere) return result.ls_sphere->radius_mm;
  const bool circle = result.feature.shape == record::Shape::kCircle;
  if (circle && !result.layers.empty() && result.layers.front().ls) {
    return result.layers.front().ls->radius_mm;
  }
  return std::nullopt;
}

/// Why points of a file are not those of the nominal: they lie more than 1 % and more than 1 mm off
/// its diameter. Where the tip is unknown, one of up to 10 mm is allowed for.
std::optional<core::Phrase> nominal_fault(const FeatureResult& result) {
  constexpr double kShare = 0.01;
  constexpr double kLeast_mm = 1.0;
  constexpr double kUnknownTip_mm = 10.0;
  const double nominal_mm = result.feature.nominal_diameter_mm;
  const auto radius_mm = centre_radius_mm(result);
  if (result.feature.strategy != record::Strategy::kPointsFile || !(nominal_mm > 0.0) ||
      !radius_mm) {
    return std::nullopt;
  }
  const fit::Material material{result.feature.side == record::Side::kInside,
                               result.tip_radius_mm.value_or(0.0)};
  const double found_mm = material.diameter_mm(*radius_mm);
  const double allowed_mm =
      std::max(kShare * nominal_mm, kLeast_mm) + (result.tip_radius_mm ? 0.0 : kUnknownTip_mm);
  if (std::abs(found_mm - nominal_mm) <= allowed_mm) return std::nullopt;
  constexpr double kInch_mm = 25.4;
  if (std::abs(nominal_mm / found_mm / kInch_mm - 1.0) > 0.1) {
    return core::phrase(
        "the points show a diameter of {:.4g} mm, nominal is {:g} mm: check the unit of the file, "
        "the tip, the side and nominal.diameter_mm",
        found_mm, nominal_mm);
  }
  return core::phrase(
      "the points show a diameter of {:.4g} mm, nominal is {:g} mm: is the file in inches? Give "
      "points in mm, or correct nominal.diameter_mm",
      found_mm, nominal_mm);
}

/// Why a characteristic with a value is void all the same.
std::optional<core::Phrase> reason_for_void(const record::RunRecord& record,
                                            const std::optional<fit::ProbeTip>& probe,
                                            const FeatureResult& result, const Deviation& value,
                                            const record::Characteristic& characteristic) {
  if (value.exact_fit) {
    return core::phrase("a section of three different points has no roundness");
  }
  if (!value.certified) {
    return core::phrase(
        "no certificate stands behind the {}",
        core::Phrase(words_of(
            characteristic.reference,
            record::facts_of(characteristic.form).about.value_or(record::Shape::kCylinder))));
  }
  // A zone of some points is never wider than that of all: above the tolerance it is proof enough.
  const bool too_wide = characteristic.reference == record::Reference::kMinimumZone &&
                        characteristic.tolerance_mm &&
                        value.value_mm > *characteristic.tolerance_mm;
  if (value.unseen_rad > 0.0 && !too_wide) {
    return unseen_words(value.unseen_rad);
  }
  if (auto fault = nominal_fault(result)) return fault;
  if (!result.complete) return core::phrase("the run did not finish");
  if (result.feature.strategy != record::Strategy::kPointsFile) {
    if (auto fault = probe_fault(record, probe)) return fault;
    if (auto fault = column_fault(record, result)) return fault;
  }
  if (auto stale = age_fault(record, result.feature)) return stale;
  return temperature_fault(record, result);
}

/// The inputs of a verdict besides the feature itself.
struct Circumstances {
  const record::RunRecord& record;
  const core::Result<DecisionRule>& rule;
  const std::optional<fit::ProbeTip>& probe;
  double file_step_mm = 0.0;  ///< step_of_file_mm(); 0 for touched points.
};

/// The number of a value that a rule compares.
Quoting quoting_under(const core::Result<DecisionRule>& rule) {
  return {.as_read = rule && !rule->needs_interval()};
}

/// How far a value is from its nearest limit, below 0 beyond it; without limits infinite.
double margin_mm(const JudgedValue& value) {
  double out = HUGE_VAL;
  if (value.limits.upper_mm) out = std::min(out, *value.limits.upper_mm - value.value_mm);
  if (value.limits.lower_mm) out = std::min(out, value.value_mm - *value.limits.lower_mm);
  return out;
}

/// Why the value of a circle of a file has no verdict: it depends on the plane, which leans, and
/// the plan does not state which one is meant.
/// @param nominal_mm  The value about z; NaN where there is none.
std::optional<core::Phrase> lean_fault(const FeatureResult& result, const StatedValue& value,
                                       const JudgedValue& judged,
                                       const record::Characteristic& asked, double nominal_mm) {
  constexpr double kShare = 0.1;
  const bool matters = result.about_nominal && stated_plane(result.feature).empty();
  if (!matters || (!judged.limits.lower_mm && !judged.limits.upper_mm)) return std::nullopt;
  // Of a size with one limit its distance from it stands for the tolerance.
  double tolerance_mm = std::abs(margin_mm(judged));
  if (asked.tolerance_mm && (asked.lower_mm || asked.form != Form::kDiameter))
    tolerance_mm = *asked.tolerance_mm - asked.lower_mm.value_or(0.0);
  if (std::abs(judged.value_mm - nominal_mm) <= kShare * tolerance_mm) return std::nullopt;
  return core::phrase(
      "the points lie in a plane that leans {:.2f} deg from z: {} is {} {} in it and {} {} about "
      "z; "
      "state source.plane, \"points\" or \"nominal\"",
      core::degrees(std::acos(std::min(result.section_axis.direction.z(), 1.0))), judged.symbol,
      value.in_digits(judged.value_mm), core::name_of(value.unit()),
      std::isfinite(nominal_mm) ? value.in_digits(nominal_mm) : "-", core::name_of(value.unit()));
}

/// Against a mask, the harmonic nearest to its limit decides; that limit is the tolerance.
/// Certificates play no part.
void judge_harmonics(const Circumstances& by, const FeatureResult& result,
                     CharacteristicResult& out) {
  record::Characteristic& asked = out.characteristic;
  if (!asked.harmonic_limits.empty())
    asked.tolerance_mm = asked.harmonic_limits.front().amplitude_mm;
  out.verdict = Verdict::kVoid;
  const auto nearest = result.failure ? core::Result<MaskedHarmonic>(core::fail(*result.failure))
                                      : nearest_to_mask(result, asked);
  if (!nearest) {
    out.reason = nearest.error().said();
    return;
  }
  asked.tolerance_mm = nearest->limit_mm;
  const core::Phrase where = core::phrase("harmonic {} of layer {} is nearest to its limit",
                                          nearest->harmonic.number, nearest->harmonic.layer + 1);
  ValueOperator how(ReferenceTerm(core::phrase("amplitudes")),
                    FilterTerm(core::phrase("before the filter")),
                    SamplingTerm(sampling_words(result, asked)), TipTerm(tip_words(result)),
                    TemperatureTerm(temperature_words(result)));
  out.value.emplace(
      symbol_of(asked), nearest->harmonic.amplitude_mm, std::move(how),
      UncertaintyStatus::none(core::phrase("intervals are computed of form deviations only")));
  auto missing = reason_for_void(by.record, by.probe, result, {}, asked);
  if (!missing && result.about_nominal) {
    const auto other = nearest_to_mask(*result.about_nominal, asked);
    missing = lean_fault(result, *out.value,
                         {symbol_of(asked), nearest->harmonic.amplitude_mm, limits_of(asked)},
                         asked, other ? other->harmonic.amplitude_mm : std::nan(""));
  }
  if (missing) {
    out.reason = *missing;
    return;
  }
  apply(by.rule, out);
  out.reason = core::phrase("{} ({})", out.reason, where);
}

/// A judged value with its verdict.
struct Judged {
  StatedValue value;
  Verdict verdict = Verdict::kVoid;
  core::Phrase reason = {};
  std::optional<RuleOutcome> outcome = {};
  std::optional<GlobalRisks> risks = {};
  std::optional<double> tolerance_mm = {};  ///< Between both limits of the characteristic.
};

/// Applies a rule to a value between limits.
void judge_value(const core::Result<DecisionRule>& rule, const Limits& limits, Judged& out) {
  if (!rule) {
    out.reason = rule.error().said();
    return;
  }
  if (!limits.lower_mm && !limits.upper_mm) {
    out.verdict = Verdict::kNotToleranced;
    out.reason = core::phrase("reported only");
    return;
  }
  KnownValue known{.measured_mm = out.value.value_mm(),
                   .unit = out.value.unit(),
                   .tolerance_mm = out.tolerance_mm};
  if (const UncertaintyStatement* statement = out.value.statement()) known.statement = *statement;
  auto outcome = apply_rule(*rule, known, limits);
  if (!outcome) {
    const core::Phrase& why = out.value.uncertainty().why();
    out.reason = outcome.error().said();
    if (!why.empty()) out.reason = core::phrase("{}: {}", out.reason, why);
    return;
  }
  out.verdict = outcome->verdict;
  out.reason = outcome->sentence;
  out.risks = global_risks(*rule, known, *outcome, limits);
  out.outcome = *std::move(outcome);
}

/// A datum that rocks leaves a verdict only where the one-sided and the equalised one agree.
void agree_about_datum(const core::Result<DecisionRule>& rule, const Finding& found,
                       std::size_t index, Judged& out) {
  if (index >= found.about_equalised_mm.size() || out.verdict == Verdict::kVoid) return;
  const double other_mm = found.about_equalised_mm[index];
  Judged other{out.value.moved_to(other_mm)};
  judge_value(rule, found.judged[index].limits, other);
  if (other.verdict == out.verdict) return;
  double play_mm = 0.0;
  for (const DatumResult& datum : found.datums) play_mm = std::max(play_mm, datum.play_mm);
  const Verdict one_sided = out.verdict;
  overrule(out, Verdict::kUndecided);
  out.reason = core::phrase(
      "the datum rocks by {:.1f} um: {} {} about the one-sided datum ({}), {} {} about the "
      "equalised one ({}); support the datum at both ends, or plan the association that the "
      "drawing means",
      micrometres(play_mm), out.value.in_digits(out.value.value_mm()),
      core::name_of(out.value.unit()), core::Phrase(std::string(name_of(one_sided))),
      out.value.in_digits(other_mm), core::name_of(out.value.unit()),
      core::Phrase(std::string(name_of(other.verdict))));
}

/// Under JCGM 106 several conditions must hold together with the probability that the rule asks.
void judge_together(const core::Result<DecisionRule>& rule, const PartInterval& interval,
                    Judged& out) {
  const bool together = rule && rule->kind == DecisionRule::Kind::kJcgm106 &&
                        interval.judged.size() > 1 && interval.conformance_1 && out.outcome;
  if (!together) return;
  out.outcome->conformance_1 = interval.conformance_1;
  if (out.verdict != Verdict::kConforms || *interval.conformance_1 >= 1.0 - rule->consumer_risk_1) {
    return;
  }
  out.verdict = Verdict::kUndecided;
  out.reason = core::phrase(
      "the probability that both conditions hold is {:.4g} %, less than the {:g} % that the rule "
      "asks",
      100.0 * *interval.conformance_1, 100.0 * (1.0 - rule->consumer_risk_1));
}

/// A characteristic that find() computed: every judged value by the rule, the most severe verdict
/// is that of the characteristic; of equal ones that of the value nearest to its limit.
void judge_found(const Circumstances& by, const FeatureResult& result, FoundCharacteristic& found,
                 CharacteristicResult& out) {
  out.verdict = Verdict::kVoid;
  if (!found.finding) {
    out.reason = found.finding.error().said();
    return;
  }
  const auto finding = std::make_shared<const Finding>(*std::move(found.finding));
  out.finding = finding;
  const record::Characteristic& asked = out.characteristic;
  std::optional<Judged> worst;
  std::optional<core::Phrase> leans;
  double nearest_mm = HUGE_VAL;
  for (std::size_t i = 0; i < finding->judged.size(); ++i) {
    const JudgedValue& value = finding->judged[i];
    if (!std::isfinite(value.value_mm)) {
      out.reason = core::phrase("the computation gave no finite number");
      return;
    }
    ValueOperator how(ReferenceTerm(finding->reference), FilterTerm(finding->filter),
                      SamplingTerm(sampling_words(result, out.characteristic)),
                      TipTerm(tip_words(result)), TemperatureTerm(temperature_words(result)));
    Judged judged{StatedValue(value.symbol, value.value_mm, std::move(how),
                              found.interval.judged[i],
                              by.rule ? by.rule->measurand : Measurand::kSampledPoints,
                              unit_of(out.characteristic), quoting_under(by.rule))};
    if (asked.lower_mm && asked.tolerance_mm) {
      judged.tolerance_mm = *asked.tolerance_mm - *asked.lower_mm;
    }
    judge_value(by.rule, value.limits, judged);
    agree_about_datum(by.rule, *finding, i, judged);
    out.judged.push_back(judged.value);
    if (!leans && !found.about_nominal_mm.empty())
      leans = lean_fault(result, judged.value, value, asked, found.about_nominal_mm[i]);
    const int more = worst ? severity(judged.verdict) - severity(worst->verdict) : 1;
    if (more < 0 || (more == 0 && margin_mm(value) >= nearest_mm)) continue;
    nearest_mm = margin_mm(value);
    worst = std::move(judged);
  }
  judge_together(by.rule, found.interval, *worst);
  out.value = std::move(worst->value);
  auto missing = reason_for_void(by.record, by.probe, result, {}, out.characteristic);
  for (const DatumResult& datum : finding->datums) {
    for (const std::size_t feature : datum.features) {
      if (!missing && !is_complete(by.record, feature))
        missing = core::phrase("the run did not finish");
    }
  }
  if (!missing) missing = leans;
  if (!missing) missing = finding->no_verdict;
  if (!missing && !finding->unique && by.rule && by.rule->needs_interval()) {
    missing = core::phrase(
        "the reference circle is not unique, and the interval is that of one of several circles");
  }
  if (missing) {
    out.reason = *missing;
    return;
  }
  out.verdict = worst->verdict;
  out.reason = std::move(worst->reason);
  out.outcome = std::move(worst->outcome);
  out.risks = worst->risks;
}

/// A length as an error of a value: of an angle in mrad, over the size of the surface.
double as_value(const FeatureResult& result, const StatedValue& value, double length_mm) {
  if (value.unit() != core::ValueUnit::kUrad) return length_mm;
  Eigen::AlignedBox3d box;
  for (const CloudPoint& point : result.cloud) box.extend(point.tip_mm);
  return 1e3 * length_mm / box.diagonal().norm();
}

/// An interval that is narrower than the probing form that the run itself showed counts only what
/// was declared: where no probing form is declared, or much less of it, no verdict rests on it.
void hold_against_probe(const Circumstances& by, const FeatureResult& result,
                        CharacteristicResult& out) {
  const bool decided = out.verdict == Verdict::kConforms || out.verdict == Verdict::kDoesNotConform;
  if (!decided || !by.rule || !by.rule->needs_interval() || !by.probe ||
      result.feature.strategy == record::Strategy::kPointsFile) {
    return;
  }
  const UncertaintyStatement* known = out.value->statement();
  if (known == nullptr || covers_probing_form(out.value->uncertainty().result()->declaration)) {
    return;
  }
  const double span_mm = by.probe->form_mm;
  if (known->expanded_mm() >= as_value(result, *out.value, 0.5 * span_mm)) return;
  overrule(out, Verdict::kUndecided);
  // Rounded up, so that what is pasted is not below what was seen.
  const double limit_um = std::ceil(100.0 * micrometres(span_mm)) / 100.0;
  out.reason = core::phrase(
      "the qualification of this run shows a probing form of {:.3f} um, of which the plan declares "
      "nothing or less than two thirds, and the interval, U = {} {}, leaves no room for it: "
      "neither verdict is proven; declare {} in place of repeatability_um, or the lobes of the "
      "probe",
      micrometres(span_mm), core::um(known->expanded_mm()),
      core::name_of(core::unit_of_difference(out.value->unit())),
      core::as_it_is(
          fmt::format(R"("uncertainty": {{"probe": {{"form_limit_um": {:g}}}}})", limit_um)));
}

/// Rounding in a file can hide form or make it: a verdict stands only where it is the same with the
/// value moved by as much to either side. Two points, each moved by half a diagonal of its step.
void hold_against_digits(const Circumstances& by, const FeatureResult& result,
                         CharacteristicResult& out) {
  constexpr double kShare = 0.05;  // of the limits: less is a matter of the last digit
  const bool decided = out.verdict == Verdict::kConforms || out.verdict == Verdict::kDoesNotConform;
  if (!decided || by.file_step_mm == 0.0 || out.characteristic.form == Form::kHarmonicLimits) {
    return;
  }
  const double move_mm = as_value(result, *out.value, std::sqrt(2.0) * by.file_step_mm);
  const Limits limits = limits_of(out.characteristic);
  const bool one_limit = !limits.upper_mm || !limits.lower_mm;
  const double allowed_mm = !one_limit ? *limits.upper_mm - *limits.lower_mm
                            : out.characteristic.form == Form::kDiameter
                                ? 0.0
                                : out.characteristic.tolerance_mm.value_or(0.0);
  if (move_mm <= kShare * allowed_mm) return;
  for (const double by_mm : {-move_mm, move_mm}) {
    CharacteristicResult moved = out;
    moved.value = out.value->moved_to(out.value->value_mm() + by_mm);
    apply(by.rule, moved);
    if (moved.verdict == out.verdict) continue;
    overrule(out, Verdict::kUndecided);
    out.reason = core::phrase(
        "the file writes its coordinates in steps of {:.4g} um, which can move the value by {} {}: "
        "the limit is nearer; export more digits",
        micrometres(by.file_step_mm), core::um(move_mm),
        core::name_of(core::unit_of_difference(out.value->unit())));
    return;
  }
}

void judge(const Circumstances& by, const FeatureResult& result, CharacteristicResult& out) {
  if (out.characteristic.form == Form::kHarmonicLimits) return judge_harmonics(by, result, out);
  const auto value = value_of(result, out.characteristic);
  out.verdict = Verdict::kVoid;
  if (!value) {
    out.reason = value.error().said();
    return;
  }
  if (!std::isfinite(value->value_mm)) {
    out.reason = core::phrase("the computation gave no finite number");
    return;
  }
  const std::optional<double>& limit_mm = out.characteristic.tolerance_mm;
  std::optional<core::Phrase> missing;
  out.value.emplace(symbol_of(out.characteristic),
                    value->range ? deciding_mm(*value->range, limit_mm) : value->value_mm,
                    operator_of(result, out.characteristic),
                    uncertainty_of(by.record, result, by.probe, out.characteristic),
                    by.rule ? by.rule->measurand : Measurand::kSampledPoints, core::ValueUnit::kUm,
                    quoting_under(by.rule));
  if (result.about_nominal) {
    const auto nominal = worst_section(*result.about_nominal, out.characteristic.reference);
    missing =
        lean_fault(result, *out.value,
                   {symbol_of(out.characteristic), value->value_mm, limits_of(out.characteristic)},
                   out.characteristic, nominal ? nominal->value_mm : std::nan(""));
  }
  if (!missing) missing = reason_for_void(by.record, by.probe, result, *value, out.characteristic);
  if (missing) {
    out.reason = *missing;
    return;
  }
  if (value->range) {
    auto ambiguous = undecided_range(*value->range, limit_mm);
    if (!ambiguous && by.rule && by.rule->needs_interval()) {
      ambiguous = core::Phrase(
          "the reference circle is not unique, and the interval is that of one of several circles");
    }
    if (ambiguous) {
      out.reason = *ambiguous;
      return;
    }
  }
  apply(by.rule, out);
}

}  // namespace

core::Phrase temperature_words(const FeatureResult& result) {
  if (!result.temperatures) return core::phrase("temperature not recorded");
  const double mean_degC = result.temperatures->mean_degC;
  const core::Phrase text = result.temperatures->declared
                                ? core::phrase("{:.1f} degC declared, not measured", mean_degC)
                                : core::phrase("{:.1f} degC", mean_degC);
  if (!result.thermal) return text;
  return core::phrase("{} brought to 20 degC, {:.2f} um a metre with U = {:.2f} um (k = 2)", text,
                      1e6 * (result.thermal->factor - 1.0),
                      2e6 * result.thermal->factor_uncertainty);
}

std::optional<core::Phrase> temperature_fault(const record::RunRecord& record,
                                              const FeatureResult& result) {
  for (Gate& gate : temperature_gates(record, result)) {
    if (gate.outcome == Gate::Outcome::kVoids) return std::move(gate.reason);
  }
  const bool cloud = result.feature.strategy != record::Strategy::kPointsFile &&
                     !record::is_analysis(result.feature.shape);
  if (cloud && asks_for_20_degC(result.feature) && !result.thermal) {
    return core::phrase(
        "the temperature of the scales was not measured, so nothing is brought to 20 degC: use a "
        "sensor that the machine reports, declare environment.assumed_degC, or leave "
        "scale_expansion_per_K out");
  }
  return std::nullopt;
}

void apply(const core::Result<DecisionRule>& rule, CharacteristicResult& out) {
  Judged judged{*out.value};
  judge_value(rule, limits_of(out.characteristic), judged);
  out.verdict = judged.verdict;
  out.reason = std::move(judged.reason);
  out.outcome = std::move(judged.outcome);
  out.risks = judged.risks;
}

PartFindings find_all(const record::RunRecord& record, std::span<FeatureResult> features,
                      const std::optional<fit::ProbeTip>& probe) {
  const core::Working work("evaluating the call-outs");
  PartFindings out(features.size());
  const std::vector<MeasuredSurface> part = surfaces_of(features);
  const PartState as_read(part);
  std::vector<PartQuestion> questions;
  std::vector<PartInterval*> answers;
  for (std::size_t f = 0; f < features.size(); ++f) {
    const record::Feature& feature = features[f].feature;
    out[f].resize(feature.characteristics.size());
    for (std::size_t c = 0; c < feature.characteristics.size(); ++c) {
      const record::Characteristic& asked = feature.characteristics[c];
      if (!is_found(feature, asked)) {
        const bool form = asked.form == Form::kCylindricity || asked.form == Form::kRoundness;
        if (form && !record::is_analysis(feature.shape))
          warn_of_shares(part, f, asked, features[f]);
        continue;
      }
      FoundCharacteristic& found = out[f][c].emplace(FoundCharacteristic{
          features[f].failure ? core::Result<Finding>(core::fail(*features[f].failure))
                              : find(as_read, f, asked)});
      if (!found.finding) continue;
      warn_of_shares(part, f, asked, *found.finding);
      if (features[f].about_nominal) {
        std::vector<MeasuredSurface> nominal = part;
        nominal[f] = surfaces_of({features[f].about_nominal.get(), 1}).front();
        found.about_nominal_mm =
            judged_values(find(nominal, f, asked, Proof::kNone), found.finding->judged.size());
      }
      questions.push_back({f, &asked, &*found.finding});
      answers.push_back(&found.interval);
    }
  }
  std::vector<PartInterval> intervals = intervals_of(record, features, probe, questions);
  for (std::size_t q = 0; q < intervals.size(); ++q) *answers[q] = std::move(intervals[q]);
  return out;
}

void decide(const record::RunRecord& record, const core::Result<DecisionRule>& rule,
            const std::optional<fit::ProbeTip>& probe,
            std::span<std::optional<FoundCharacteristic>> found, FeatureResult& result) {
  const double file_step_mm = result.feature.strategy == record::Strategy::kPointsFile
                                  ? step_of_file_mm(record, result.feature.id)
                                  : 0.0;
  for (std::size_t c = 0; c < result.feature.characteristics.size(); ++c) {
    CharacteristicResult out;
    out.characteristic = result.feature.characteristics[c];
    const auto& own = out.characteristic.indication.decision_rule;
    const core::Result<DecisionRule> its = own ? core::Result<DecisionRule>(rule_of(*own)) : rule;
    const Circumstances by{record, its, probe, file_step_mm};
    if (found[c]) {
      judge_found(by, result, *found[c], out);
    } else {
      judge(by, result, out);
    }
    hold_against_probe(by, result, out);
    hold_against_digits(by, result, out);
    result.characteristics.push_back(std::move(out));
  }
}

Verdict overall(const std::vector<FeatureResult>& features) {
  Verdict out = Verdict::kNotToleranced;
  const auto take = [&](Verdict verdict) {
    if (severity(verdict) > severity(out)) out = verdict;
  };
  for (const FeatureResult& feature : features) {
    if (feature.failure) take(Verdict::kVoid);
    for (const CharacteristicResult& c : feature.characteristics) {
      if (c.characteristic.toleranced()) take(c.verdict);
    }
  }
  return out;
}

}  // namespace rondure::evaluation
