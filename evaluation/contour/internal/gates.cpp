#include "evaluation/contour/internal/gates.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;
using Outcome = Gate::Outcome;

constexpr double kEccentricity = 0.2;  ///< mm
constexpr double kShareOfTolerance = 1.0 / 20.0;
constexpr double kUnknownPhase = 2.0 * kDegree;  ///< Limit where u of the zero is not declared.
constexpr double kSearched = 8.0 * kDegree;      ///< The window of fit::correlation_offset().
constexpr double kDeviations = 3.0;
constexpr double kLikeness = 0.9;

void void_first(std::optional<core::Phrase>& curve, const core::Phrase& reason) {
  if (!curve) curve = reason;
}
void void_rest(ContourResult& facts, const core::Phrase& reason) {
  void_first(facts.rest_void, reason);
}
void void_following(ContourResult& facts, const core::Phrase& reason) {
  void_first(facts.following_void, reason);
  void_rest(facts, reason);
}
/// Without traces f is read from t.
void void_total(ContourResult& facts, const core::Phrase& reason) {
  void_first(facts.total_void, reason);
  void_rest(facts, reason);
  if (!facts.study.traced()) void_first(facts.following_void, reason);
}

Gate stroke_unchecked(const ContourResult& facts) {
  Gate out{"stroke-unchecked", core::phrase("positions of X recorded with every trace")};
  const auto unchecked =
      std::ranges::find_if(facts.study.parts, [](const auto& part) { return !part.positions; });
  if (unchecked == facts.study.parts.end()) return out;
  out.outcome = Outcome::kWarns;
  out.reason = core::phrase(
      "the traces have no positions of X (d_cmd_mm): a wrong crank radius changes f, and nothing "
      "shows it");
  return out;
}

std::optional<double> least_tolerance(std::span<const record::Characteristic> asked) {
  std::optional<double> out;
  for (const record::Characteristic& one : asked) {
    if (one.form != record::Form::kContourDeviation || !one.tolerance_mm) continue;
    out = std::min(out.value_or(*one.tolerance_mm), *one.tolerance_mm);
  }
  return out;
}

/// A gauge that drifts over its turn: the step where the rows close, beside roughness and noise.
Gate seam(std::span<const record::Characteristic> asked, ContourResult& facts) {
  constexpr double kRough = 8.0;
  double step_mm = 0.0;
  double limit_mm = kShareOfTolerance * least_tolerance(asked).value_or(0.0);
  for (const fit::ContourPartResult& part : facts.study.parts) {
    for (const fit::MeasuredContour* one : {&part.pin, part.main ? &*part.main : &part.pin}) {
      if (one->seam_mm > kRough * one->rough_mm) step_mm = std::max(step_mm, one->seam_mm);
    }
  }
  Gate out{"seam", core::phrase("step between last and first row of a gauge, limit T/20"),
           step_mm / kMicrometre, limit_mm / kMicrometre, "um"};
  if (limit_mm == 0.0 || step_mm <= limit_mm) return out;
  out.outcome = Outcome::kVoids;
  out.reason = core::phrase(
      "the gauge does not come back: its last row stands {:.3g} um beside the first, more than a "
      "twentieth of the tolerance, {:.3g} um: let it warm up, or look for play",
      step_mm / kMicrometre, limit_mm / kMicrometre);
  void_total(facts, out.reason);
  return out;
}

/// The eccentricity of the pin on the gauge: e^2/(2 r) of it stays in t.
std::vector<Gate> eccentric_gauge(std::span<const record::Characteristic> asked,
                                  ContourResult& facts) {
  double largest_mm = 0.0;
  for (const fit::ContourPartResult& part : facts.study.parts) {
    largest_mm = std::max(largest_mm, part.pin.contour.base_center_mm.norm());
  }
  const bool exact = facts.options.error.base == fit::BaseCircle::kGeometric;
  std::vector<Gate> out;
  Gate place{"eccentric-gauge", core::phrase("eccentricity of a pin on the gauge"), largest_mm,
             kEccentricity, "mm"};
  if (!exact && largest_mm > kEccentricity) {
    place.outcome = Outcome::kVoids;
    place.reason = core::phrase(
        "a pin stands {:.3g} mm beside the axis of the gauge, limit {:g} mm: centre it, or take "
        "base_circle geometric",
        largest_mm, kEccentricity);
    void_total(facts, place.reason);
  }
  out.push_back(std::move(place));
  const std::optional<double> tolerance_mm = least_tolerance(asked);
  if (!tolerance_mm) return out;
  const double error_mm =
      exact ? 0.0 : largest_mm * largest_mm / (2.0 * facts.options.geometry.pin_radius_mm);
  const double limit_mm = kShareOfTolerance * *tolerance_mm;
  Gate share{"eccentricity-error",
             core::phrase("error of the base circle by the eccentricity, limit T/20"),
             error_mm / kMicrometre, limit_mm / kMicrometre, "um"};
  if (error_mm > limit_mm) {
    share.outcome = Outcome::kVoids;
    share.reason = core::phrase(
        "the eccentricity of a pin adds {:.3g} um to t, more than a twentieth of its tolerance, "
        "{:.3g} um: centre it, or take base_circle geometric",
        error_mm / kMicrometre, limit_mm / kMicrometre);
    void_total(facts, share.reason);
  }
  out.push_back(std::move(share));
  return out;
}

/// Whether the contours of the gauge are filtered here.
bool filters(const fit::ContourStudyOptions& options) {
  return !options.prefiltered && options.error.filter.filter != fit::ProfileFilter::kNone;
}

/// Contours are filtered once: here, or by the gauge at the cut-off that is stated.
Gate filter_of_gauge(ContourResult& facts) {
  const double stated_upr = facts.options.error.filter.cutoff_upr;
  const bool by_gauge = facts.options.prefiltered;
  Gate out{"filter-twice", core::phrase("contours filtered once")};
  if (by_gauge) {
    out.code = "gauge-filter";
    out.condition = core::phrase(
        "cut-off of the gauge by the fall of noise and roughness, against the one stated");
    out.limit = stated_upr;
    out.unit = "UPR";
  }
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const fit::FilterTrace& trace = facts.study.parts[i].pin.filter;
    if (by_gauge && trace.passed && !out.found) out.found = trace.passed->cutoff_upr;
    const bool twice = filters(facts.options) && trace.filtered;
    if (!twice && !(by_gauge && trace.other_than(stated_upr))) continue;
    out.outcome = Outcome::kVoids;
    if (by_gauge) out.found = trace.passed->cutoff_upr;
    out.reason =
        twice
            ? core::phrase(
                  "part {}: above three times the cut-off only {:.2g} um rms are left; the gauge "
                  "has filtered already, and the filter would act twice: say filter "
                  "done-by-gauge",
                  facts.names[i], trace.upper_rms_mm / kMicrometre)
            : core::phrase(
                  "part {}: noise and roughness fall as after a Gaussian filter of {:.0f} UPR, the "
                  "plan says that the gauge has filtered at {:g} UPR: state its cut-off "
                  "(cutoff_upr), or measure with that of the plan",
                  facts.names[i], *out.found, stated_upr);
    void_total(facts, out.reason);
    break;
  }
  return out;
}

/// A gauge that reads less than any pin has, or more, was read in the wrong unit.
Gate gauge_unit(ContourResult& facts) {
  Gate out{"gauge-unit", core::phrase("contours of more than 0.05 um and less than 1 mm")};
  const auto doubt = std::ranges::find_if(facts.study.warnings, [](const core::Error& one) {
    return one.code == Code::kUnits && !one.where.ends_with("/axes");
  });
  if (doubt == facts.study.warnings.end()) return out;
  out.outcome = Outcome::kVoids;
  out.reason = core::Phrase(doubt->what);
  void_total(facts, out.reason);
  return out;
}

Gate trace_sampling(ContourResult& facts) {
  double least = facts.study.parts.front().axes.samples_per_turn;
  for (const fit::ContourPartResult& part : facts.study.parts) {
    least = std::min(least, part.axes.samples_per_turn);
  }
  Gate out{"trace-sampling",
           core::phrase("samples of the control in an undulation at the cut-off"),
           {},
           fit::kSamplesPerUndulation,
           ""};
  const fit::FilterOptions& filter = facts.options.error.filter;
  if (filter.filter == fit::ProfileFilter::kNone) return out;
  out.found = least / filter.highest_cutoff_upr();
  if (*out.found >= fit::kSamplesPerUndulation * (1.0 - 1e-9)) return out;
  out.outcome = Outcome::kVoids;
  out.reason = core::phrase(
      "the control has {:.1f} samples a turn, {:.2f} an undulation at {:g} UPR; {:g} are needed "
      "for "
      "f and n",
      least, *out.found, filter.highest_cutoff_upr(), fit::kSamplesPerUndulation);
  void_following(facts, out.reason);
  return out;
}

Gate trace_skew(ContourResult& facts) {
  Gate out{"trace-skew", core::phrase("time between the traces of C and X declared"), {}, {}, "ms"};
  const bool declared = facts.influences && facts.influences->skew_ms;
  const double u_ms = declared ? record::u_of(facts.influences->skew_ms) : 0.0;
  if (declared) out.found = u_ms;
  if (declared && (u_ms == 0.0 || facts.sampling_ms > 0.0)) return out;
  out.outcome = Outcome::kVoids;
  out.reason = declared ? core::phrase(
                              "skew_ms is declared, but not sampling_ms, which turns it into an "
                              "angle: f and n are not known")
                        : core::phrase(
                              "the time between the traces of C and X is not declared "
                              "(uncertainty/skew_ms; 0 where they are read at once): one sample "
                              "changes f by some 0.1 um, and nothing shows it");
  void_following(facts, out.reason);
  return out;
}

core::Phrase doubted(fit::AxisDoubt::Kind kind) {
  using Kind = fit::AxisDoubt::Kind;
  if (kind == Kind::kSignOfX) return core::phrase("f with the errors of X negated");
  if (kind == Kind::kSignOfC) return core::phrase("f with the errors of C negated");
  return core::phrase("f with the errors of C in radians, not degrees,");
}

Gate sense(ContourResult& facts) {
  const fit::SenseEvidence& found = facts.study.sense;
  const auto parts = static_cast<double>(found.parts);
  Gate out{"sense",
           core::phrase("parts whose contour fits another f better (negated, mirrored, one axis "
                        "negated or in radians), at most half"),
           static_cast<double>(std::max(found.negated_better, found.mirrored_better)), 0.5 * parts};
  const double given_um = found.rms_difference_mm / kMicrometre;
  const double rest_mm = found.sign_suspect()    ? found.rms_sum_mm
                         : found.sense_suspect() ? found.rms_mirrored_mm
                                                 : found.rms_difference_mm;
  if (const auto& axis = facts.study.axis; axis && axis->rms_mm < rest_mm) {
    out.found = parts;
    out.outcome = Outcome::kVoids;
    out.reason = core::phrase(
        "{} fits the mean of the parts better: rest {:.3g} um rms as given, {:.3g} um so: check "
        "the sign and unit of its columns, and of a table that was loaded",
        doubted(axis->kind), axis->given_mm / kMicrometre, axis->rms_mm / kMicrometre);
    void_following(facts, out.reason);
    return out;
  }
  if (!found.sign_suspect() && !found.sense_suspect()) return out;
  out.outcome = Outcome::kVoids;
  out.reason =
      found.sign_suspect()
          ? core::phrase(
                "the negated f fits {} of {} parts better: rest {:.3g} um rms as given, "
                "{:.3g} um with the other sign: is \"error\" right?",
                found.negated_better, found.parts, given_um, found.rms_sum_mm / kMicrometre)
          : core::phrase(
                "the mirrored f fits {} of {} parts better: rest {:.3g} um rms as given, "
                "{:.3g} um mirrored: are \"c_axis\" and \"gauge\" right?",
                found.mirrored_better, found.parts, given_um, found.rms_mirrored_mm / kMicrometre);
  void_following(facts, out.reason);  // the sign of one axis alone may be wrong
  return out;
}

/// The offset has the noise of n in it, whatever the zero of the gauge is.
Gate phase(ContourResult& facts) {
  const fit::CorrelationOffset& offset = facts.study.offset;
  const bool declared = facts.influences && facts.influences->gauge_phase_deg;
  const double zero = declared ? kDegree * record::u_of(facts.influences->gauge_phase_deg)
                               : kUnknownPhase / kDeviations;
  const double limit = kDeviations * std::hypot(offset.u_rad, zero);
  Gate out{"phase",
           core::phrase("angle by which correlation would turn f onto t, all parts together"),
           std::abs(offset.angle_rad) / kDegree, limit / kDegree, "deg"};
  // Beyond the window of the search anything is explained, as where a correction has left no f.
  const bool explained = !offset.at_edge || limit > kSearched;
  if (explained && std::abs(offset.angle_rad) <= limit) return out;
  out.outcome = Outcome::kVoids;
  out.reason = core::phrase(
      "correlation would turn f by {:.2f} deg, more than n and the uncertainty of the zero of "
      "the gauge explain ({:.2f} deg): is phase_offset_deg right?",
      offset.angle_rad / kDegree, limit / kDegree);
  void_rest(facts, out.reason);
  return out;
}

/// A wrong scale shows in all parts alike; what n does to the slope differs from part to part.
Gate gain(ContourResult& facts) {
  Gate out{"gain",
           core::phrase("least distance of the slope of t over f from 1, over its uncertainty; 0 "
                        "where the parts differ in sign"),
           {},
           kDeviations,
           ""};
  if (facts.study.parts.size() < 2 || facts.study.sense.sense_suspect() || facts.study.axis) {
    return out;
  }
  const double sign = facts.study.sense.sign_suspect() ? -1.0 : 1.0;  // "sense" says so
  const double declared = facts.influences ? record::u_of(facts.influences->gauge_gain_1) : 0.0;
  double least = 0.0;
  double sum = 0.0;
  bool alike = true;
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const fit::ContourPartResult& part = facts.study.parts[i];
    const auto found = fit::gain_evidence({part.pin.contour.error_mm, part.following.error_mm});
    if (!found) return out;
    sum += sign * found->slope;
    const double u = std::max(std::hypot(found->u, declared), 1e-12);
    const double off = (sign * found->slope - 1.0) / u;
    alike = alike && (i == 0 || off * least > 0.0);
    if (i == 0 || std::abs(off) < std::abs(least)) least = off;
  }
  out.found = alike ? std::abs(least) : 0.0;
  if (*out.found <= kDeviations) return out;
  out.outcome = Outcome::kVoids;
  out.reason = core::phrase(
      "t is {:.3f} times f in the mean, and in all parts off 1 to the same side by more than {:g} "
      "standard uncertainties: check the gain of the gauge and the scales of the axes",
      sum / static_cast<double>(facts.study.parts.size()), kDeviations);
  void_total(facts, out.reason);  // the gauge's is in t, the axes' in f
  void_following(facts, out.reason);
  return out;
}

/// Whether pins and mains see the same sources: correlation of n with the main journal, of all
/// parts that have both.
Gate indirect(ContourResult& facts) {
  Gate out{"indirect", core::phrase("correlation of n with the main journals"), {}, kLikeness};
  std::vector<double> rest;
  std::vector<double> mains;
  for (const fit::ContourPartResult& part : facts.study.parts) {
    if (!part.main) continue;
    const auto& main = part.main->contour.error_mm;
    rest.insert(rest.end(), part.direct.rest_mm.begin(), part.direct.rest_mm.end());
    mains.insert(mains.end(), main.begin(), main.end());
  }
  if (mains.empty()) return out;
  out.found = fit::correlation_of(rest, mains);
  if (*out.found >= kLikeness) return out;
  out.outcome = Outcome::kBounds;
  out.reason = core::phrase(
      "n and the main journals correlate by {:.3f} only, {:g} is needed: f from the main journal "
      "is a bound",
      *out.found, kLikeness);
  facts.indirect_is_bound = true;
  return out;
}

/// Without traces f and n rest on what pin and main journal share.
Gate like_main(ContourResult& facts) {
  Gate out{"like-main",
           core::phrase("difference of pins and main journals declared (main_differs_um)"),
           {},
           {},
           "um"};
  if (facts.influences && facts.influences->main_differs_um) {
    out.found = record::u_of(facts.influences->main_differs_um);
    return out;
  }
  out.outcome = Outcome::kBounds;
  out.reason = core::phrase(
      "no part has traces of the axes, and uncertainty/main_differs_um does not say how far pin "
      "and "
      "main journal differ: f and n hold only if both see the same");
  facts.indirect_is_bound = true;
  return out;
}

}  // namespace

std::vector<Gate> position_gates(std::span<const fit::ContourPart> parts,
                                 const fit::ContourStudyOptions& options) {
  std::optional<fit::PositionCheck> worst;
  Gate stroke{"stroke",
              core::phrase("stroke of X against twice the crank radius"),
              {},
              fit::PositionCheck::kStrokeLimit,
              "mm"};
  Gate course{"stroke-course",
              core::phrase("rms of the positions of X off the ideal motion"),
              {},
              fit::PositionCheck::kCourseLimit,
              "mm"};
  for (const fit::ContourPart& part : parts) {
    if (!part.trace || part.trace->x_mm.empty()) continue;
    const auto turn = fit::last_turn(*part.trace, options.axes);
    if (!turn) continue;  // the study says why
    const auto found = fit::check_positions(*turn, options.geometry);
    if (!found) continue;
    const double off = std::abs(found->stroke_mm - found->expected_mm);
    stroke.found = std::max(stroke.found.value_or(0.0), off);
    course.found = std::max(course.found.value_or(0.0), found->course_mm);
    if (!worst && !found->contradiction.empty()) worst = found;
  }
  for (Gate* const gate : {&stroke, &course}) {
    if (!gate->found || *gate->found <= *gate->limit) continue;
    gate->outcome = Outcome::kVoids;
    gate->reason = core::Phrase(worst->contradiction);
  }
  return {std::move(stroke), std::move(course)};
}

std::vector<Gate> failed_gates(const core::Error& error) {
  const bool of_traces = error.where.find("/axes") != std::string::npos;
  if (!of_traces || error.code == Code::kInconsistent) return {};
  return {{"traces",
           core::phrase("traces of whole turns without a missing sample"),
           {},
           {},
           "",
           Outcome::kVoids,
           error.said()}};
}

std::vector<Gate> contour_gates(std::span<const record::Characteristic> asked,
                                ContourResult& facts) {
  std::vector<Gate> out;
  if (facts.study.traced()) out.push_back(stroke_unchecked(facts));
  for (Gate& gate : eccentric_gauge(asked, facts)) out.push_back(std::move(gate));
  out.push_back(seam(asked, facts));
  out.push_back(filter_of_gauge(facts));
  out.push_back(gauge_unit(facts));
  if (!facts.study.traced()) {
    out.push_back(like_main(facts));
    return out;
  }
  out.push_back(trace_sampling(facts));
  out.push_back(trace_skew(facts));
  out.push_back(sense(facts));
  out.push_back(phase(facts));
  out.push_back(gain(facts));
  out.push_back(indirect(facts));
  return out;
}

bool is_gate(const core::Error& warning, const fit::ContourStudyOptions& options) {
  switch (warning.code) {
    case Code::kSense:
    case Code::kAlignment:
      return true;
    case Code::kUndersampled:
      return warning.where.ends_with("/axes");
    case Code::kUnits:  // gauge_unit()
      return !warning.where.ends_with("/axes");
    case Code::kFilteredTwice:
      return warning.where.ends_with("/pin") && filters(options);
    case Code::kInconsistent:  // filter_of_gauge()
      return warning.where.ends_with("/pin");
    default:
      return false;
  }
}

}  // namespace rondure::evaluation
