#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numeric>
#include <span>
#include <utility>

#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/spindle/result.h"

namespace rondure::evaluation {
namespace {

using core::micrometres;
using core::phrase;
using Outcome = Gate::Outcome;
using record::Form;

constexpr std::size_t kSteadyRows = 8;
/// Movement of another probe, in steps of the resolution of the steady one, that it would have
/// seen.
constexpr double kSurelySeen = 10.0;
constexpr double kNormal999 = 3.0902;
/// Share of the range of a probe that counts; beyond, it may be clipped or bent.
constexpr double kUsableRange = 0.9;
/// Of a tolerance, what undulations above the highest recovered may add.
constexpr double kBeyondShare = 0.1;
/// Of a tolerance, what drift may do to motion.
constexpr double kDriftShare = 0.1;
/// Standard uncertainties of a declared drift that its interval holds.
constexpr double kSeenDrift = 3.0;
/// Standard uncertainties from which on an amplitude is no noise: in 50 one of 5000 times.
constexpr double kStandsOut = 5.0;
/// Times the rms, the peak to valley of many undulations at most.
constexpr double kOfMany = 6.0;

/// 0.999 quantile of chi square, by Wilson and Hilferty: within 1 % from two degrees of freedom on.
double chi2_999(double freedom) {
  const double share = 2.0 / (9.0 * freedom);
  return freedom * std::pow(1.0 - share + kNormal999 * std::sqrt(share), 3.0);
}

Gate first_harmonic_gate(const SpindleResult& facts) {
  Gate out{.code = "first-harmonic", .condition = {}};
  if (facts.declares_probes()) {
    out.condition = phrase("chi2 of the first harmonic with the declared gains and angles");
    out.found = facts.first_harmonic->chi2;
    out.limit = fit::kFirstHarmonicLimit;
    if (!(*out.found > *out.limit)) return out;
    out.outcome = Outcome::kVoids;
    out.reason = phrase(
        "the readings contradict the declared gains and angles of the probes: chi2 of the first "
        "harmonic is {:.1f}, the limit {:.1f}; calibrate gains and angles, look for drift within a "
        "revolution, or declare what is known of them",
        *out.found, *out.limit);
    return out;
  }
  const fit::ThreeProbeResult& s = facts.separation;
  out.condition = phrase("content of the weighted sum at one undulation, against noise");
  out.found = micrometres(s.first_harmonic_mm);
  out.limit = micrometres(s.first_harmonic_limit_mm);
  out.unit = "um";
  if (!(*out.found > *out.limit)) return out;
  out.outcome = Outcome::kVoids;
  out.reason = phrase(
      "the weighted sum holds {:.4g} um at one undulation, where it must vanish (limit {:.4g} um): "
      "calibrate gains and angles of the probes, or declare their uncertainties",
      *out.found, *out.limit);
  return out;
}

Gate blind_gate(const SpindleResult& facts) {
  const fit::FirstHarmonic& first = *facts.first_harmonic;
  Gate out{.code = "k1-blind",
           .condition = phrase("least error of gains and angles that the first harmonic shows"),
           .limit = first.prior_lambda};
  if (std::isfinite(first.u_lambda)) out.found = 3.0 * first.u_lambda;
  // An eccentricity that turns the wrong way is there: no advice to mount the part off centre.
  if (!first.blind() || facts.separation.turns_against_work()) return out;
  // Without declarations nothing vouches for the probes: no rule gives a verdict, nor does simple
  // acceptance.
  out.outcome = facts.declares_probes() ? Outcome::kWarns : Outcome::kVoids;
  if (auto reason = blind_on_an_arm(facts)) {
    out.outcome = Outcome::kVoids;
    out.reason = *std::move(reason);
    return out;
  }
  out.reason =
      facts.declares_probes()
          ? phrase(
                "the eccentricity of {:.3g} um is too small to show errors of gains and angles: "
                "the "
                "interval rests on their certificates alone; mount the part 5 to 20 um off centre",
                micrometres(facts.separation.eccentricity_mm))
          : phrase(
                "the eccentricity of {:.3g} um is too small to show errors of gains and angles, "
                "and "
                "none are declared: a wrong gain goes unnoticed; mount the part 5 to 20 um off "
                "centre and declare gain_1 and angle_deg",
                micrometres(facts.separation.eccentricity_mm));
  return out;
}

/// Probes that a declared influence may bring nearly in line: no interval bounds what that does.
Gate layout_gate(const SpindleResult& facts) {
  Gate out{.code = "layout",
           .condition = phrase("greatest noise gain within two standard uncertainties of an angle "
                               "or the arm"),
           .found = facts.gain_within,
           .limit = facts.greatest_gain};
  if (*out.found <= *out.limit) return out;
  out.outcome = Outcome::kVoids;
  out.reason = phrase(
      "within two standard uncertainties of what is declared, angles of probes or arm, the noise "
      "gain of a harmonic reaches {:.3g}, the limit is {:g}: the probes come too close to one "
      "line; know angles and arm better, or choose another layout",
      facts.gain_within, facts.greatest_gain);
  return out;
}

/// Drift that is not linear, slip or temperature: the part differs from revolution to revolution by
/// more than noise.
Gate turns_gate(const SpindleResult& facts) {
  const fit::ThreeProbeResult& s = facts.separation;
  Gate out{.code = "turns", .condition = phrase("chi2 of the part between the revolutions")};
  const std::vector<double>& scatter = s.scatter_mm;
  if (scatter.empty()) {
    out.condition = phrase("chi2 of the part between the revolutions: one revolution only");
    return out;
  }
  const double each = 2.0 * (s.revolutions - 1);
  const auto orders = static_cast<double>(scatter.size());
  double base = s.noise_mm * s.noise_mm;
  double widened = 1.0;
  if (s.noise_estimated) {
    // The mean scatter is the estimate itself; the median over the harmonics is what the bulk of
    // them says. Its own standard deviation widens the limit.
    std::vector<double> squares;
    for (const double one : scatter) squares.push_back(one * one);
    const double median_of_unit = std::pow(1.0 - 2.0 / (9.0 * each), 3.0);
    base = core::upper_median(std::move(squares)) / median_of_unit;
    widened += kNormal999 * 1.44 / std::sqrt(orders * (s.revolutions - 1));
  }
  // A noise that is declared as 0 does not excuse revolutions that differ.
  constexpr double kLeastNoise_mm = 1e-6 * core::kMicrometre;
  base = std::max(base, kLeastNoise_mm * kLeastNoise_mm);
  double chi2 = 0.0;
  for (const double one : scatter) chi2 += each * one * one / base;
  out.found = chi2;
  out.limit = widened * chi2_999(each * orders);
  const double mean =
      std::sqrt(std::inner_product(scatter.begin(), scatter.end(), scatter.begin(), 0.0) / orders);
  constexpr double kLeastScatter_mm = 1e-3 * core::kMicrometre;  // better than any probe
  if (chi2 <= *out.limit || mean < kLeastScatter_mm) return out;
  out.outcome = Outcome::kVoids;
  out.reason = phrase(
      "the part differs from revolution to revolution by more than noise: chi2 {:.0f}, limit "
      "{:.0f}; look for drift of the probes, slip of the drive and changing temperature, and "
      "measure again",
      chi2, *out.limit);
  return out;
}

/// Revolutions that agree better than the declared noise allows: it hides errors from the gates
/// above.
Gate small_scatter_gate(const SpindleResult& facts) {
  const fit::ThreeProbeResult& s = facts.separation;
  Gate out{.code = "u-too-large",
           .condition = phrase("scatter of the revolutions over the declared noise, at least")};
  const std::vector<double>& scatter = s.scatter_mm;
  if (s.noise_estimated || scatter.empty() || !(s.noise_mm > 0.0)) return out;
  const double squares = std::inner_product(scatter.begin(), scatter.end(), scatter.begin(), 0.0);
  const double freedom = 2.0 * (s.revolutions - 1) * static_cast<double>(scatter.size());
  const double share = 2.0 / (9.0 * freedom);
  out.found = std::sqrt(squares / static_cast<double>(scatter.size())) / s.noise_mm;
  out.limit =
      std::pow(std::max(0.0, 1.0 - share - kNormal999 * std::sqrt(share)), 1.5);  // 0.001 of chi2
  if (*out.found >= *out.limit) return out;
  out.outcome = Outcome::kWarns;
  out.reason = phrase(
      "the revolutions scatter by {:.2g} of the declared noise of {:.3g} um: it is too large, and "
      "hides errors of gains and angles",
      *out.found, micrometres(s.noise_mm));
  return out;
}

/// Largest standard uncertainty of an amplitude in parts of the limits that are asked for.
Gate weak_gate(const SpindleResult& facts,
               std::span<const record::Characteristic> characteristics) {
  Gate out{.code = "weak-harmonic",
           .condition = phrase("greatest standard uncertainty of an amplitude over its limit"),
           .limit = kWeakShare};
  const fit::RecoveredHarmonic* weakest = nullptr;
  double its_limit_mm = 0.0;
  const auto look = [&](const fit::RecoveredHarmonic& h, double limit_mm) {
    if (!h.recovered || !(h.sigma_mm / limit_mm > out.found.value_or(-1.0))) return;  // 0/0 is none
    out.found = h.sigma_mm / limit_mm;
    weakest = &h;
    its_limit_mm = limit_mm;
  };
  for (const record::Characteristic& asked : characteristics) {
    const bool part = asked.form == Form::kRoundness || asked.form == Form::kRoundnessRms;
    for (const fit::RecoveredHarmonic& h : facts.separation.harmonics) {
      if (part && asked.tolerance_mm) look(h, *asked.tolerance_mm);
      for (const record::HarmonicLimit& line : asked.harmonic_limits) {
        if (h.order >= line.first && h.order <= line.last) look(h, line.amplitude_mm);
      }
    }
  }
  if (!(out.found.value_or(0.0) > kWeakShare)) return out;
  out.outcome = Outcome::kVoids;
  out.reason = phrase(
      "the standard uncertainty of harmonic {}, {:.2g} um, is more than a quarter of its limit of "
      "{:g} um: record more revolutions or choose a layout with less gain there",
      weakest->order, micrometres(weakest->sigma_mm), micrometres(its_limit_mm));
  return out;
}

Gate suppressed_gate(const SpindleResult& facts) {
  const auto lost = facts.separation.unrecovered.size();
  Gate out{.code = "suppressed",
           .condition = phrase("harmonics that were not recovered"),
           .found = static_cast<double>(lost),
           .limit = 0.0};
  if (lost == 0) return out;
  out.outcome = Outcome::kVoids;
  out.reason = phrase(
      "{} harmonics were not recovered, and no bound of their amplitudes is stated: part and "
      "synchronous motion may be greater; choose a layout with less gain there",
      lost);
  return out;
}

/// A gate that voids where there is a reason.
Gate voided(Gate out, std::optional<core::Phrase> reason) {
  if (reason) {
    out.outcome = Outcome::kVoids;
    out.reason = *std::move(reason);
  }
  return out;
}

/// The filter of the profile passes more than is recovered.
Gate band_gate(const SpindleResult& facts, const record::Characteristic& asked) {
  const double lost_mm = passed_beyond_mm(facts, asked.form == Form::kRoundnessRms);
  return voided({.code = "band",
                 .condition = phrase("what the filter passes above the highest harmonic recovered, "
                                     "limit T/10"),
                 .found = micrometres(lost_mm),
                 .limit = micrometres(kBeyondShare * *asked.tolerance_mm),
                 .unit = "um"},
                beyond_the_band(facts, asked));
}

/// The greatest drift of a probe in a turn.
double drift_a_turn_mm(const SpindleResult& facts) {
  double out = 0.0;
  for (const double one_mm : facts.separation.drift_mm) out = std::max(out, std::abs(one_mm));
  return out;
}

/// The same in the turns that a motion is made of.
double drift_mm(const SpindleResult& facts, Form form) {
  return drift_a_turn_mm(facts) * (form == Form::kMotionTotal ? facts.separation.revolutions : 1);
}

/// Longest run of equal readings of a channel in which another one moves.
struct SteadyRun {
  std::size_t channel = 0;
  std::size_t first = 0;
  std::size_t rows = 0;
};

double spread(std::span<const double> values) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return *greatest - *least;
}

/// Whether a channel that stands still in these rows should have moved, because another one does.
bool others_move(const fit::ProbeReadings& readings, const SteadyRun& run, double resolution) {
  for (std::size_t i = 0; i < readings.h_mm.size(); ++i) {
    if (i == run.channel) continue;
    const auto rows = std::span(readings.h_mm[i]).subspan(run.first, run.rows);
    if (spread(rows) > kSurelySeen * resolution) return true;
  }
  return false;
}

/// Least step of a channel; 0 where it is constant.
double resolution_of(const std::vector<double>& h) {
  double out = spread(h);
  for (std::size_t m = 1; m < h.size(); ++m) {
    if (h[m] != h[m - 1]) out = std::min(out, std::abs(h[m] - h[m - 1]));
  }
  return out;
}

SteadyRun longest_steady(const fit::ProbeReadings& readings) {
  SteadyRun longest;
  for (std::size_t i = 0; i < readings.h_mm.size(); ++i) {
    const std::vector<double>& h = readings.h_mm[i];
    const double resolution = resolution_of(h);
    std::size_t first = 0;
    for (std::size_t m = 1; m <= h.size(); ++m) {
      if (m < h.size() && h[m] == h[first]) continue;
      const SteadyRun run{i, first, m - first};
      if (run.rows > std::max<std::size_t>(longest.rows, 1) &&
          others_move(readings, run, resolution)) {
        longest = run;
      }
      first = m;
    }
  }
  return longest;
}

/// Rows in which no probe moves, although their steps are fine: the acquisition stood still while
/// the work turned on. None: rows 0.
SteadyRun standstill(const fit::ProbeReadings& readings) {
  constexpr double kLeastTurn_rad = core::kTwoPi / 16.0;  // fine steps do not skip so much
  const auto& h = readings.h_mm;
  const std::size_t count = h[0].size();
  bool fine = false;
  bool moves = false;
  for (const std::vector<double>& one : h) {
    fine = fine || spread(one) > kSurelySeen * resolution_of(one);
    moves = moves || spread(one) > 0.0;
  }
  if (!moves) return {0, 0, count};
  SteadyRun longest;
  std::size_t first = 0;
  for (std::size_t m = 1; fine && m <= count; ++m) {
    const auto stays = [&](const std::vector<double>& one) { return one[m] == one[first]; };
    if (m < count && std::all_of(h.begin(), h.end(), stays)) continue;
    const double turned = std::abs(readings.alpha_rad[m - 1] - readings.alpha_rad[first]);
    if (turned > kLeastTurn_rad && m - first > longest.rows) longest = {0, first, m - first};
    first = m;
  }
  return longest;
}

Gate disconnect_gate(const fit::ProbeReadings& readings) {
  SteadyRun run = longest_steady(readings);
  const SteadyRun still = standstill(readings);
  const bool all = still.rows >= kSteadyRows && still.rows > run.rows;
  if (all) run = still;
  Gate out{.code = "disconnect",
           .condition = phrase("equal readings of a channel in a row while another one moves"),
           .found = static_cast<double>(run.rows),
           .limit = static_cast<double>(kSteadyRows - 1)};
  if (run.rows < kSteadyRows) return out;
  out.outcome = Outcome::kVoids;
  if (all) {
    out.reason = phrase(
        "no probe moves in {} readings from row {} on: the acquisition stood still, or the probes "
        "do not touch; measure again",
        run.rows, run.first);
    return out;
  }
  out.reason = phrase(
      "probe {} reads the same {} times from row {} on while another one moves: it is "
      "disconnected, stuck or at the end of its range; leave out these rows or measure again",
      run.channel + 1, run.rows, run.first);
  return out;
}

/// Gross readings, readings that contradict the stated arm, and readings in another unit.
Gate readings_gate(const SpindleResult& facts, const fit::ProbeReadings& readings) {
  constexpr double kLeastSpread_mm = 0.1 * core::kMicrometre;  // no part turns so true
  const fit::ThreeProbeResult& s = facts.separation;
  Gate out{.code = "readings",
           .condition = phrase("contradictions between the readings, their neighbours and the arm"),
           .found = 0.0,
           .limit = 0.0};
  bool skip = !facts.declares_probes() && s.first_harmonic_mm > s.first_harmonic_limit_mm;
  for (const core::Error& one : s.contradictions) {
    // The first harmonic, which has its own gate, follows the gross readings.
    if (skip && one.code != core::Code::kOutliers) {
      skip = false;
      continue;
    }
    if (*out.found == 0.0) out.reason = one.said();
    *out.found += 1.0;
  }
  double widest_mm = 0.0;
  for (const std::vector<double>& h : readings.h_mm) widest_mm = std::max(widest_mm, spread(h));
  if (*out.found == 0.0 && widest_mm < kLeastSpread_mm) {
    out.found = 1.0;
    out.reason = phrase(
        "the probes read over {:.3g} um in all: readings in mm look so, as do probes that do not "
        "touch; give H1_um, H2_um and H3_um in um, or mount the part 5 to 20 um off centre",
        micrometres(widest_mm));
  }
  if (*out.found > 0.0) out.outcome = Outcome::kVoids;
  return out;
}

/// Readings near the end of the range of a probe.
Gate range_gate(const SpindleResult& facts) {
  const double half_um = 0.5 * core::micrometres(*facts.probe_range_mm);
  Gate out{.code = "range",
           .condition = phrase("greatest reading of a probe, limit 90 % of its range to one side"),
           .found = core::micrometres(facts.greatest_reading_mm),
           .limit = kUsableRange * half_um,
           .unit = "um"};
  if (*out.found <= *out.limit) return out;
  out.outcome = Outcome::kVoids;
  out.reason = phrase(
      "a probe reads {:.4g} um, beyond 90 % of its range of {:g} um to either side (limit {:.4g} "
      "um): set the probes to the middle of their range, centre the part, and measure again",
      *out.found, half_um, *out.limit);
  return out;
}

/// An oval of the readings that the part does not have: the eccentricity on bent probes. Equal
/// probes give it the phase of a true oval, which nothing in the readings contradicts.
Gate quadratic_gate(const SpindleResult& facts,
                    std::span<const record::Characteristic> characteristics) {
  Gate out{.code = "quadratic",
           .condition = phrase("false oval by the non-linearity of the probes, limit T/20"),
           .found = core::micrometres(*false_oval_mm(facts)),
           .unit = "um"};
  for (const record::Characteristic& asked : characteristics) {
    const auto limit_mm = limit_of_oval_mm(asked);
    if (!limit_mm || core::micrometres(kOvalShare * *limit_mm) >= out.limit.value_or(HUGE_VAL)) {
      continue;
    }
    out.limit = core::micrometres(kOvalShare * *limit_mm);
    if (auto reason = oval_reason(facts, asked)) {
      out.outcome = Outcome::kVoids;
      out.reason = *std::move(reason);
    }
  }
  return out;
}

Gate drift_gate(const SpindleResult& facts, const record::Characteristic& asked) {
  return voided({.code = "drift",
                 .condition = phrase("greatest drift of a probe, limit T/10"),
                 .found = micrometres(drift_mm(facts, asked.form)),
                 .limit = micrometres(kDriftShare * *asked.tolerance_mm),
                 .unit = "um"},
                drift_because(facts, asked));
}

Gate few_turns_gate(const SpindleResult& facts) {
  const int turns = facts.separation.revolutions;
  Gate out{.code = "few-turns",
           .condition = phrase("revolutions for asynchronous motion, at least"),
           .found = static_cast<double>(turns),
           .limit = static_cast<double>(kLeastAsynchronousTurns)};
  if (turns >= kLeastAsynchronousTurns) return out;
  out.outcome = Outcome::kVoids;
  out.reason = phrase(
      "asynchronous motion of {} turns is reported, not judged: it grows with the turns; record at "
      "least {}",
      turns, kLeastAsynchronousTurns);
  return out;
}

Gate total_turns_gate(const SpindleResult& facts) {
  return voided({.code = "few-turns",
                 .condition = phrase("revolutions for total motion, at least"),
                 .found = static_cast<double>(facts.separation.revolutions),
                 .limit = 2.0},
                one_turn_of_total(facts));
}

bool any_limit(std::span<const record::Characteristic> characteristics,
               std::initializer_list<Form> forms) {
  return std::any_of(characteristics.begin(), characteristics.end(),
                     [&](const record::Characteristic& asked) {
                       return asked.toleranced() &&
                              std::find(forms.begin(), forms.end(), asked.form) != forms.end();
                     });
}

}  // namespace

namespace {

/// What a filter leaves of the readings above the highest harmonic recovered: most of a peak to
/// valley, or the rms.
double beyond_mm(const SpindleResult& result, const fit::FilterOptions& filter, bool rms) {
  const bool filters = filter.filter != fit::ProfileFilter::kNone;
  double sum_mm = 0.0;
  double power_mm2 = 0.0;
  for (const fit::RecoveredHarmonic& h : result.separation.beyond) {
    if (!h.recovered || h.amplitude_mm <= kStandsOut * h.sigma_mm) continue;
    const double left = filters ? std::exp2(-std::pow(h.order / filter.cutoff_upr, 2.0)) : 1.0;
    sum_mm += 2.0 * left * h.amplitude_mm;
    power_mm2 += 0.5 * std::pow(left * h.amplitude_mm, 2.0);
  }
  const double rms_mm = std::sqrt(power_mm2);
  return rms ? rms_mm : std::min(sum_mm, kOfMany * rms_mm);
}

}  // namespace

double passed_beyond_mm(const SpindleResult& result, bool rms) {
  return beyond_mm(result, result.roundness.filter, rms);
}

std::optional<core::Phrase> form_in_motion(const SpindleResult& result, double value_mm,
                                           const record::Characteristic& asked) {
  fit::FilterOptions none;
  none.filter = fit::ProfileFilter::kNone;
  constexpr double kGain = 2.0;  // of a motion over form that is not taken out
  const double form_mm = beyond_mm(result, none, false);
  const bool may_conform = asked.tolerance_mm && value_mm > *asked.tolerance_mm &&
                           value_mm - kGain * form_mm <= *asked.tolerance_mm;
  if (!may_conform) return std::nullopt;
  const int highest = result.separation.harmonics.back().order;
  return phrase(
      "the readings hold undulations above {} of up to {:.3g} um, which may be form of the part "
      "and are counted as motion: raise highest_order to {}",
      highest, micrometres(form_mm), 2 * highest);
}

std::optional<core::Phrase> beyond_the_band(const SpindleResult& result,
                                            const record::Characteristic& asked) {
  const fit::FilterOptions& filter = result.roundness.filter;
  int highest = 1;  // what wide tips leave too little of is not known
  for (const fit::RecoveredHarmonic& h : result.separation.harmonics) {
    if (h.tip > 0.0) highest = h.order;
  }
  if (filter.filter != fit::ProfileFilter::kNone && filter.cutoff_upr > highest) {
    return phrase(
        "the filter of the profile passes up to {:g} UPR, harmonics are recovered up to {} only: "
        "roundness may be greater; raise highest_order or take narrower tips, or lower cutoff_upr",
        filter.cutoff_upr, highest);
  }
  // Behind another filter of up to 2.2 times its cut-off, a filter passes less than it says.
  constexpr double kFree = 2.2;
  const double cutoff_upr =
      filter.filter == fit::ProfileFilter::kNone ? highest : filter.cutoff_upr;
  const auto& passed = result.separation.passed;
  if (passed && passed->below(kFree * cutoff_upr)) {
    return phrase(
        "noise and roughness of the readings fall as after a Gaussian filter of {:.0f} UPR, the "
        "profile is to hold up to {:g} UPR: measure with the filter of the probes off, or at three "
        "times that cut-off",
        passed->cutoff_upr, cutoff_upr);
  }
  const double lost_mm = passed_beyond_mm(result, asked.form == Form::kRoundnessRms);
  if (!asked.tolerance_mm || lost_mm <= kBeyondShare * *asked.tolerance_mm) return std::nullopt;
  return phrase(
      "the readings hold undulations above {}, of which the filter passes up to {:.3g} um, more "
      "than a tenth of the tolerance of {:g} um: raise highest_order to {}",
      highest, micrometres(lost_mm), micrometres(*asked.tolerance_mm), 2 * highest);
}

std::optional<core::Phrase> drift_because(const SpindleResult& result,
                                          const record::Characteristic& asked) {
  const double found_mm = drift_mm(result, asked.form);
  if (!asked.tolerance_mm || found_mm <= kDriftShare * *asked.tolerance_mm) return std::nullopt;
  if (result.influences && result.influences->drift_um_per_turn) {
    const double declared_um = record::u_of(result.influences->drift_um_per_turn);
    if (micrometres(drift_a_turn_mm(result)) <= kSeenDrift * declared_um) return std::nullopt;
  }
  return phrase(
      "a probe drifts by {:.3g} um meanwhile, more than a tenth of the tolerance of {:g} um, and "
      "motion holds it: let spindle and probes warm up and measure again, or declare "
      "drift_um_per_turn",
      micrometres(found_mm), micrometres(*asked.tolerance_mm));
}

std::optional<core::Phrase> blind_on_an_arm(const SpindleResult& result) {
  const bool knows_arm = result.wheel_radius || (result.influences && result.influences->arm_mm);
  if (!result.declares_probes() || !result.arm.swings() || knows_arm ||
      !result.first_harmonic->blind()) {
    return std::nullopt;
  }
  return phrase(
      "the eccentricity of {:.3g} um is too small to show an arm of another length, and none is "
      "declared: the wear of the wheel turns the probes; declare arm_mm, take the radius from a "
      "wheel, or mount the part 5 to 20 um off centre",
      micrometres(result.separation.eccentricity_mm));
}

std::optional<core::Phrase> one_turn_of_total(const SpindleResult& result) {
  if (result.separation.revolutions > 1) return std::nullopt;
  return phrase(
      "one revolution shows no asynchronous motion, which total motion holds: record more, or ask "
      "for motion-synchronous");
}

std::vector<Gate> gates_of(const SpindleResult& result, const fit::ProbeReadings& readings,
                           std::span<const record::Characteristic> characteristics) {
  // The first that voids gives the reason: a bad reading is named before what it does to the rest.
  std::vector<Gate> out = {disconnect_gate(readings),   readings_gate(result, readings),
                           first_harmonic_gate(result), blind_gate(result),
                           layout_gate(result),         turns_gate(result),
                           small_scatter_gate(result),  weak_gate(result, characteristics),
                           suppressed_gate(result)};
  if (result.probe_range_mm) out.push_back(range_gate(result));
  if (false_oval_mm(result)) out.push_back(quadratic_gate(result, characteristics));
  for (const record::Characteristic& asked : characteristics) {
    const bool part = asked.form == Form::kRoundness || asked.form == Form::kRoundnessRms;
    if (part && asked.tolerance_mm) out.push_back(band_gate(result, asked));
    const bool motion = asked.form == Form::kMotionTotal || asked.form == Form::kMotionSynchronous;
    if (motion && asked.tolerance_mm) out.push_back(drift_gate(result, asked));
  }
  if (any_limit(characteristics, {Form::kMotionAsynchronous})) {
    out.push_back(few_turns_gate(result));
  }
  if (any_limit(characteristics, {Form::kMotionTotal})) out.push_back(total_turns_gate(result));
  return out;
}

bool voids_all(const Gate& gate) {
  return gate.code == "first-harmonic" || gate.code == "k1-blind" || gate.code == "layout" ||
         gate.code == "turns" || gate.code == "disconnect" || gate.code == "readings" ||
         gate.code == "range";
}

}  // namespace rondure::evaluation
