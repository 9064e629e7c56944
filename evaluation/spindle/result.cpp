#include "evaluation/spindle/result.h"

#include <algorithm>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/internal/deviation.h"

namespace rondure::evaluation {
namespace {

using core::Code;
using core::um;
using record::Form;

fit::CircleReference circle_of(record::Reference reference) {
  switch (reference) {
    case record::Reference::kLeastSquares:
      return fit::CircleReference::kLs;
    case record::Reference::kMinimumZone:
      return fit::CircleReference::kMz;
    case record::Reference::kMinimumCircumscribed:
      return fit::CircleReference::kMc;
    case record::Reference::kMaximumInscribed:
      return fit::CircleReference::kMi;
  }
  return fit::CircleReference::kMz;
}

const fit::Roundness* roundness_about(const fit::RoundnessEvaluation& evaluation,
                                      fit::CircleReference reference) {
  for (const fit::Roundness& value : evaluation.values) {
    if (value.reference == reference) return &value;
  }
  return nullptr;
}

/// Readings that contradict what is stated, or are none, falsify everything.
std::optional<core::Phrase> contradiction_of(const SpindleResult& facts) {
  if (facts.void_because || facts.separation.contradictions.empty()) return facts.void_because;
  return facts.separation.contradictions.front().said();
}

/// Harmonics that were dropped falsify part and motion.
std::optional<core::Phrase> loss_of(const SpindleResult& facts) {
  if (auto contradiction = contradiction_of(facts)) return contradiction;
  if (facts.separation.unrecovered.empty()) return std::nullopt;
  return core::phrase("{} harmonics were not recovered", facts.separation.unrecovered.size());
}

/// Whether noise hides a harmonic from its limit.
bool weak(const fit::RecoveredHarmonic& h, double limit_mm) {
  return h.recovered && h.sigma_mm > kWeakShare * limit_mm;
}

core::Phrase weak_reason(const fit::RecoveredHarmonic& h, double limit_mm) {
  return core::phrase(
      "the standard uncertainty of harmonic {}, {:.3g} um, is above a quarter of the limit of {:g} "
      "um: record more revolutions or choose a layout with less gain there",
      h.order, core::micrometres(h.sigma_mm), core::micrometres(limit_mm));
}

core::Result<AnalysisValue> roundness_value(const SpindleResult& facts,
                                            const record::Characteristic& asked) {
  const bool rms = asked.form == Form::kRoundnessRms;
  const auto reference = rms ? fit::CircleReference::kLs : circle_of(asked.reference);
  const fit::Roundness* found = roundness_about(facts.roundness, reference);
  if (found == nullptr) {
    return core::fail(Code::kReferenceAbsent,
                      core::phrase("the profile has no such reference circle"));
  }
  AnalysisValue out;
  out.value_mm = rms ? found->parameters->rms_mm : found->total_mm;
  out.void_because = loss_of(facts);
  out.unseen_mm = passed_beyond_mm(facts, rms);
  if (!out.void_because && asked.tolerance_mm) out.void_because = beyond_the_band(facts, asked);
  if (!out.void_because && asked.tolerance_mm) {
    for (const fit::RecoveredHarmonic& h : facts.separation.harmonics) {
      if (!out.void_because && weak(h, *asked.tolerance_mm)) {
        out.void_because = weak_reason(h, *asked.tolerance_mm);
      }
    }
  }
  if (rms || !found->range) return out;
  out.value_mm = deciding_mm(*found->range, asked.tolerance_mm);
  if (!out.void_because) out.void_because = undecided_range(*found->range, asked.tolerance_mm);
  return out;
}

/// The harmonic that is nearest to its limit, or farthest beyond it.
core::Result<AnalysisValue> mask_value(const SpindleResult& facts,
                                       const record::Characteristic& asked) {
  AnalysisValue out;
  out.void_because = contradiction_of(facts);
  double worst = -1.0;
  for (const record::HarmonicLimit& line : asked.harmonic_limits) {
    for (const fit::RecoveredHarmonic& h : facts.separation.harmonics) {
      if (h.order < line.first || h.order > line.last) continue;
      if (!h.known()) {
        out.void_because = core::phrase("harmonic {} was not recovered", h.order);
        continue;
      }
      if (!out.void_because && weak(h, line.amplitude_mm)) {
        out.void_because = weak_reason(h, line.amplitude_mm);
      }
      if (h.amplitude_mm / line.amplitude_mm <= worst) continue;
      worst = h.amplitude_mm / line.amplitude_mm;
      out.value_mm = h.amplitude_mm;
      out.limit_mm = line.amplitude_mm;
      out.harmonic = h.order;
      out.detail = core::phrase("harmonic {} is nearest to its limit", h.order);
    }
    const int highest = facts.separation.harmonics.back().order;
    if (line.last > highest) {
      out.void_because = core::phrase(
          "the mask reaches to harmonic {}, {} is the highest recovered", line.last, highest);
    }
  }
  if (worst < 0.0) {
    return core::fail(Code::kMeaning,
                      core::phrase("the mask names no harmonic that was recovered"));
  }
  return out;
}

core::Phrase few_turns_reason(const SpindleResult& facts) {
  return core::phrase(
      "asynchronous motion of {} turns is reported, not judged: it grows with the turns; record at "
      "least {}",
      facts.separation.revolutions, kLeastAsynchronousTurns);
}

core::Result<AnalysisValue> motion_value(const SpindleResult& facts,
                                         const record::Characteristic& asked) {
  const Form form = asked.form;
  AnalysisValue out;
  const auto greater = [&](double x_mm, double y_mm) {
    out.value_mm = std::max(x_mm, y_mm);
    out.detail = x_mm >= y_mm ? core::phrase("direction X") : core::phrase("direction Y");
  };
  if (form == Form::kMotionTotal) greater(facts.x.total_mm, facts.y.total_mm);
  if (form == Form::kMotionSynchronous) greater(facts.x.synchronous_mm, facts.y.synchronous_mm);
  if (form == Form::kMotionAsynchronous) {
    if (!facts.x.asynchronous_mm) {
      return core::fail(Code::kSampling,
                        "one revolution shows no asynchronous motion; record more");
    }
    greater(*facts.x.asynchronous_mm, *facts.y.asynchronous_mm);
    out.void_because = contradiction_of(facts);  // does not depend on the part
    if (!out.void_because && asked.toleranced() &&
        facts.separation.revolutions < kLeastAsynchronousTurns) {
      out.void_because = few_turns_reason(facts);
    }
    return out;
  }
  out.void_because = loss_of(facts);
  if (!out.void_because) out.void_because = drift_because(facts, asked);
  if (!out.void_because) out.void_because = form_in_motion(facts, out.value_mm, asked);
  if (form == Form::kMotionTotal && !out.void_because && asked.toleranced()) {
    out.void_because = one_turn_of_total(facts);
  }
  return out;
}

core::Result<AnalysisValue> measured_value(const SpindleResult& facts,
                                           const record::Characteristic& asked) {
  switch (asked.form) {
    case Form::kRoundness:
    case Form::kRoundnessRms:
      return roundness_value(facts, asked);
    case Form::kHarmonicLimits:
      return mask_value(facts, asked);
    case Form::kMotionTotal:
    case Form::kMotionSynchronous:
    case Form::kMotionAsynchronous:
      return motion_value(facts, asked);
    default:
      return core::fail_with(Code::kMeaning, "a spindle has no {}", name_of(asked.form));
  }
}

}  // namespace

std::optional<double> false_oval_mm(const SpindleResult& facts) {
  if (!facts.probe_range_mm || !facts.influences || !facts.influences->quadratic_1) {
    return std::nullopt;
  }
  const double q_per_mm = 4.0 * facts.influences->quadratic_1->value / *facts.probe_range_mm;
  const double c_mm = facts.separation.eccentricity_mm;
  return 0.5 * q_per_mm * c_mm * c_mm;
}

std::optional<double> limit_of_oval_mm(const record::Characteristic& asked) {
  if (asked.form == Form::kMotionAsynchronous) return std::nullopt;  // the same in every revolution
  if (asked.form != Form::kHarmonicLimits) return asked.tolerance_mm;
  std::optional<double> out;
  for (const record::HarmonicLimit& line : asked.harmonic_limits) {
    if (line.first > 2 || line.last < 2) continue;
    out = std::min(out.value_or(line.amplitude_mm), line.amplitude_mm);
  }
  return out;
}

std::optional<core::Phrase> oval_reason(const SpindleResult& facts,
                                        const record::Characteristic& asked) {
  const auto oval_mm = false_oval_mm(facts);
  const auto limit_mm = limit_of_oval_mm(asked);
  if (!oval_mm || !limit_mm || *oval_mm <= kOvalShare * *limit_mm) return std::nullopt;
  return core::phrase(
      "by the eccentricity of {:.3g} um the declared non-linearity of the probes (quadratic_1) "
      "makes an oval of {:.3g} um that the part may not have, more than a twentieth of the limit "
      "of {:g} um: centre the part, or use probes with less non-linearity",
      core::micrometres(facts.separation.eccentricity_mm), core::micrometres(*oval_mm),
      core::micrometres(*limit_mm));
}

core::Result<AnalysisValue> value_of(const SpindleResult& facts,
                                     const record::Characteristic& asked) {
  auto out = measured_value(facts, asked);
  if (out && !out->void_because) out->void_because = oval_reason(facts, asked);
  return out;
}

core::Phrase filter_text(const SpindleResult& facts) {
  const fit::FilterOptions& filter = facts.roundness.filter;
  if (filter.filter == fit::ProfileFilter::kNone) {
    return core::phrase("unfiltered");
  }
  return core::phrase("gaussian low pass {:g} UPR", filter.cutoff_upr);
}

core::Phrase sampling_text(const SpindleResult& facts) {
  const auto turns = static_cast<std::size_t>(facts.separation.revolutions);
  return core::phrase(
      "{} of {} samples",
      turns == 1 ? core::phrase("{} revolution", turns) : core::phrase("{} revolutions", turns),
      facts.separation.profile.r_mm.size());
}

ValueOperator operator_of(const SpindleResult& facts, const record::Characteristic& asked,
                          const core::Phrase& temperature) {
  const bool part = asked.form == Form::kRoundness || asked.form == Form::kRoundnessRms;
  const fit::ThreeProbeResult& s = facts.separation;
  const auto angles = s.layout.angles_rad();
  const core::Phrase how = core::phrase(
      "three probes at 0, {:.4f}, {:.4f} deg; {}; harmonics 2 to {}", angles[1] / core::kDegree,
      angles[2] / core::kDegree, sampling_text(facts), s.harmonics.back().order);
  const bool unfiltered = asked.form == Form::kHarmonicLimits;
  const core::Phrase reference =
      part         ? core::as_it_is(reference_of(asked))
      : unfiltered ? core::phrase("amplitudes")
                   : core::phrase(
                         "ISO 230-7, fixed direction, about the least-squares centre of the mean "
                         "revolution");
  return {ReferenceTerm(reference),
          FilterTerm(part         ? filter_text(facts)
                     : unfiltered ? core::phrase("before the filter")
                                  : core::phrase("unfiltered")),
          SamplingTerm(how),
          TipTerm(s.tip_width_mm > 0.0
                      ? core::phrase("displacement probes, width of {:g} mm taken out of the part",
                                     s.tip_width_mm)
                      : core::phrase("displacement probes")),
          TemperatureTerm(temperature)};
}

}  // namespace rondure::evaluation
