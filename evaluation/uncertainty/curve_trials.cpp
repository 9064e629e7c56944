#include "evaluation/uncertainty/curve_trials.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/noise.h"
#include "core/numbers.h"
#include "core/statistics.h"
#include "evaluation/uncertainty/internal/statement.h"

namespace rondure::evaluation {
namespace {

using core::Code;

enum CurveStream : std::uint64_t { kCoreStream = 31, kPoolStream, kNormalStream, kUniformStream };

/// FNV-1a: the same name gives the same key on every machine, unlike std::hash.
std::uint64_t key_of(std::string_view id) {
  std::uint64_t key = 0xcbf29ce484222325ULL;
  for (const char c : id) key = (key ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return key;
}

std::uint64_t key_of(int trial) {
  assert(trial >= 0);
  return static_cast<std::uint64_t>(trial);
}

// ---- Core and pool -----------------------------------------------------------------------------

constexpr double kFalseAlarms =
    10.0;                            // one curve of noise in ten has a coefficient that stands out
constexpr double kBadlyKnown = 2.5;  // medians of the uncertainties
constexpr double kCrowded = 0.25;    // share of a group that stands out
constexpr std::size_t kFewInGroups = 12;  // up to so many coefficients make one group

/// The coefficients of a curve as they are judged: both parts of a harmonic together.
struct Harmonics {
  std::vector<std::vector<std::size_t>> rows;
  std::vector<int> group;
};

Harmonics harmonics_of(const MeasuredCurve& curve) {
  Harmonics out;
  std::map<int, std::size_t> place_of;
  for (std::size_t k = 0; k < curve.found_mm.size(); ++k) {
    if (!curve.order.empty()) {
      const auto [place, is_new] = place_of.try_emplace(curve.order[k], out.rows.size());
      if (!is_new) {
        out.rows[place->second].push_back(k);
        continue;
      }
    }
    out.rows.push_back({k});
    out.group.push_back(curve.group[k]);
  }
  if (out.rows.size() <= kFewInGroups) std::fill(out.group.begin(), out.group.end(), 0);
  return out;
}

bool stands_out(const MeasuredCurve& curve, const std::vector<std::size_t>& rows,
                std::size_t count) {
  double squares_1 = 0.0;
  for (const std::size_t k : rows) {
    const double ratio = curve.found_mm[k] / curve.u_mm[k];
    squares_1 += ratio * ratio;
  }
  return squares_1 > 2.0 * std::log(kFalseAlarms * static_cast<double>(count));
}

/// Which coefficients belong to the core.
std::vector<bool> core_of(const MeasuredCurve& curve, const Harmonics& harmonics) {
  std::vector<bool> core(curve.found_mm.size(), false);
  if (curve.field || core.empty()) return core;
  for (std::size_t k = 0; k < curve.always_core.size(); ++k) core[k] = curve.always_core[k];
  struct Share {
    double all = 0.0;
    double out = 0.0;
  };
  std::map<int, Share> share_of;
  std::vector<bool> out(harmonics.rows.size(), false);
  for (std::size_t h = 0; h < harmonics.rows.size(); ++h) {
    if (core[harmonics.rows[h].front()]) continue;  // says nothing of the others of its group
    out[h] = stands_out(curve, harmonics.rows[h], harmonics.rows.size());
    Share& share = share_of[harmonics.group[h]];
    share.all += 1.0;
    share.out += out[h] ? 1.0 : 0.0;
  }
  const double badly_mm = kBadlyKnown * core::median(curve.u_mm);
  for (std::size_t h = 0; h < harmonics.rows.size(); ++h) {
    const Share share = share_of[harmonics.group[h]];
    const bool crowded = share.out > kCrowded * share.all;
    for (const std::size_t k : harmonics.rows[h]) {
      if (out[h] || crowded || curve.u_mm[k] > badly_mm) core[k] = true;
    }
  }
  return core;
}

// ---- The power of a pool -----------------------------------------------------------------------

constexpr std::size_t kFewInPool = 20;  // real components, for which a wider prior holds
constexpr double kZeroOfMany = 0.5;     // prior probability that there is nothing but noise
constexpr double kZeroOfFew = 0.1;
constexpr double kReach = 10.0;  // of the prior of few, in mean squares
constexpr double kFarReach = 100.0;
constexpr double kLeastPower = 1e-4;  // in mean squared uncertainties: less is as good as none
constexpr double kNegligible = 30.0;  // logarithm of a probability beside the greatest
constexpr int kCells = 400;

/// The logarithms of the likelihood of a pool and of the prior, of its power.
class PowerDensity {
 public:
  PowerDensity(const MeasuredCurve& curve, const std::vector<std::size_t>& rows)
      : few_(rows.size() < kFewInPool) {
    for (const std::size_t k : rows) {
      found2_.push_back(curve.found_mm[k] * curve.found_mm[k]);
      noise2_.push_back(curve.u_mm[k] * curve.u_mm[k]);
    }
    noise_mm2_ = core::mean(noise2_);
    // Two or three coefficients may all be small by chance: that is no limit of their power.
    mean_mm2_ = std::max(core::mean(found2_), noise_mm2_);
    zero_1_ = curve.field ? 0.0 : few_ ? kZeroOfFew : kZeroOfMany;
  }

  [[nodiscard]] double zero_1() const { return zero_1_; }
  [[nodiscard]] double log_least() const { return std::log(kLeastPower * noise_mm2_); }
  [[nodiscard]] double log_most() const {
    return std::log((few_ ? kReach : kFarReach) * mean_mm2_);
  }

  [[nodiscard]] double log_likelihood(double power_mm2) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < found2_.size(); ++i) {
      const double variance_mm2 = power_mm2 + noise2_[i];
      sum -= 0.5 * (std::log(variance_mm2) + found2_[i] / variance_mm2);
    }
    return sum;
  }

  /// Posterior density over the logarithm of the power, up to a common factor.
  [[nodiscard]] double log_density(double log_power) const {
    const double power_mm2 = std::exp(log_power);
    const double both_mm2 = power_mm2 + noise_mm2_;
    const double prior = few_ ? -std::log(both_mm2 * std::log1p(kReach * mean_mm2_ / noise_mm2_))
                              : std::log(noise_mm2_) - 2.0 * std::log(both_mm2);
    return std::log1p(-zero_1_) + prior + log_power + log_likelihood(power_mm2);
  }

 private:
  std::vector<double> found2_;
  std::vector<double> noise2_;
  double noise_mm2_ = 0.0;
  double mean_mm2_ = 0.0;
  double zero_1_ = 0.0;
  bool few_;
};

/// Density at the middles of equal cells.
std::vector<double> at_middles(const PowerDensity& density, double from, double step) {
  std::vector<double> out;
  for (int i = 0; i < kCells; ++i) out.push_back(density.log_density(from + (i + 0.5) * step));
  return out;
}

}  // namespace

CurveDraws::PoolPower::PoolPower(const MeasuredCurve& curve, const std::vector<std::size_t>& rows) {
  const PowerDensity density(curve, rows);
  const double first = density.log_least();
  const double wide = (density.log_most() - first) / kCells;
  // Of many coefficients the power is known so well that the first grid is too wide for it: the
  // second one covers the cells that count.
  const std::vector<double> coarse = at_middles(density, first, wide);
  const double top = *std::max_element(coarse.begin(), coarse.end());
  const auto counts = [&](double value) { return value > top - kNegligible; };
  const auto low = std::find_if(coarse.begin(), coarse.end(), counts) - coarse.begin();
  const auto high = coarse.rend() - std::find_if(coarse.rbegin(), coarse.rend(), counts);
  const auto lowest = std::max<std::ptrdiff_t>(low - 1, 0);
  const auto highest = std::min<std::ptrdiff_t>(high + 1, kCells);
  log_first_ = first + static_cast<double>(lowest) * wide;
  step_ = static_cast<double>(highest - lowest) * wide / kCells;
  const std::vector<double> fine = at_middles(density, log_first_, step_);
  const double zero =
      density.zero_1() > 0.0 ? std::log(density.zero_1()) + density.log_likelihood(0.0) : -HUGE_VAL;
  const double most = std::max(zero, *std::max_element(fine.begin(), fine.end()));
  cumulative_.push_back(std::exp(zero - most));
  for (const double value : fine) {
    cumulative_.push_back(cumulative_.back() + step_ * std::exp(value - most));
  }
  const double total = cumulative_.back();
  for (double& sum : cumulative_) sum /= total;
}

double CurveDraws::PoolPower::at(double uniform) const {
  if (uniform < cumulative_.front()) return 0.0;
  const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, uniform);
  const double before = *(above - 1);
  const double inside = *above > before ? (uniform - before) / (*above - before) : 0.5;
  const auto cell = static_cast<double>(above - cumulative_.begin() - 1);
  return std::exp(log_first_ + (cell + inside) * step_);
}

CurveDraws::CurveDraws(MeasuredCurve curve, std::uint64_t seed, std::string_view id)
    : curve_(std::move(curve)), seed_(seed), id_(key_of(id)) {
  const std::size_t count = curve_.found_mm.size();
  assert(curve_.u_mm.size() == count && curve_.group.size() == count);
  assert(curve_.always_core.empty() || curve_.always_core.size() == count);
  assert(curve_.order.empty() || curve_.order.size() == count);
  // A coefficient that is known exactly stands out of any noise. A weight needs a variance above 0.
  constexpr double kExact_mm = 1e-12;
  for (double& u_mm : curve_.u_mm) u_mm = std::max(u_mm, kExact_mm);
  const Harmonics harmonics = harmonics_of(curve_);
  in_core_ = core_of(curve_, harmonics);
  core_mm_.assign(count, 0.0);
  std::map<int, std::vector<std::size_t>> pool_of;
  for (std::size_t h = 0; h < harmonics.rows.size(); ++h) {
    for (const std::size_t k : harmonics.rows[h]) {
      if (in_core_[k]) {
        core_mm_[k] = curve_.found_mm[k];
      } else {
        pool_of[harmonics.group[h]].push_back(k);
      }
    }
  }
  for (auto& [group, rows] : pool_of) {
    const PoolPower power(curve_, rows);
    pools_.push_back({std::move(rows), power});
  }
}

std::vector<double> CurveDraws::core_draw(int trial) const {
  // A stream of its own, so that the core is the same with the pool and without it.
  core::KeyedNoise noise(seed_, {kCoreStream, id_, key_of(trial)});
  std::vector<double> out(core_mm_);
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (in_core_[k]) out[k] += curve_.u_mm[k] * noise.normal();
  }
  return out;
}

std::vector<double> CurveDraws::draw(int trial) const {
  std::vector<double> out = core_draw(trial);
  core::KeyedNoise noise(seed_, {kPoolStream, id_, key_of(trial)});
  for (const Pool& pool : pools_) {
    const double power_mm2 = pool.power.at(noise.uniform());
    for (const std::size_t k : pool.rows) {
      const double u_mm = curve_.u_mm[k];
      const double weight = power_mm2 / (power_mm2 + u_mm * u_mm);
      out[k] = weight * curve_.found_mm[k] + std::sqrt(weight) * u_mm * noise.normal();
    }
  }
  return out;
}

// ---- Other influences --------------------------------------------------------------------------

double normal_draw(std::uint64_t seed, std::string_view id, std::uint64_t instance, int trial) {
  return core::KeyedNoise(seed, {kNormalStream, key_of(id), instance, key_of(trial)}).normal();
}

double uniform_draw(std::uint64_t seed, std::string_view id, std::uint64_t instance, int trial) {
  core::KeyedNoise noise(seed, {kUniformStream, key_of(id), instance, key_of(trial)});
  return std::sqrt(3.0) * (2.0 * noise.uniform() - 1.0);
}

double per_u(const std::function<double(double)>& value) {
  return 0.5 * (value(1.0) - value(-1.0));
}

// ---- The statement -----------------------------------------------------------------------------

namespace {

constexpr std::size_t kLeastTrials = 100;
constexpr double kDominates = 0.25;  // inflation over the value as measured
constexpr double kNotLinear = 0.3;   // difference of the two propagations over the linear one

core::Result<void> check_trials(const TrialValues& trials) {
  const std::size_t count = trials.values_mm.size();
  if (count < kLeastTrials) {
    return core::fail_with(Code::kBadOption, "{} trials; an interval needs {} at least", count,
                           kLeastTrials);
  }
  if (!trials.core_mm.empty() && trials.core_mm.size() != count) {
    return core::fail_with(Code::kBadOption, "{} values of the core for {} trials",
                           trials.core_mm.size(), count);
  }
  for (std::size_t t = 0; t < count; ++t) {
    const double core_mm = trials.core_mm.empty() ? 0.0 : trials.core_mm[t];
    if (std::isfinite(trials.values_mm[t] + core_mm)) continue;
    return core::fail(Code::kNotFinite, core::phrase("trial {} has no finite value", t));
  }
  return {};
}

/// Takes off what noise adds to a convex value: the measurement added it once, the trials once
/// more. 0 where the value is linear in its draws.
/// @return  Whether at least half of the trials would be below 0 by it.
bool turn(TrialValues& trials) {
  const double inflation_mm =
      trials.core_mm.empty() ? 0.0 : core::mean(trials.core_mm) - trials.core_center_mm;
  std::size_t below = 0;
  for (double& value_mm : trials.values_mm) {
    value_mm -= 2.0 * std::max(0.0, inflation_mm);
    if (trials.signed_value) continue;
    below += value_mm < 0.0 ? 1 : 0;
    value_mm = std::max(0.0, value_mm);
  }
  return 2 * below >= trials.values_mm.size() && below > 0;
}

/// The trials as chains, in their order.
double tolerance_of(std::span<const double> values_mm, const UncertaintyOptions& options) {
  constexpr std::size_t kLeastInChain = 10;
  const std::size_t chains =
      std::min(static_cast<std::size_t>(options.chains), values_mm.size() / kLeastInChain);
  std::vector<std::span<const double>> all;
  for (std::size_t k = 0; k < chains; ++k) {
    const std::size_t first = values_mm.size() * k / chains;
    all.push_back(values_mm.subspan(first, values_mm.size() * (k + 1) / chains - first));
  }
  return numerical_tolerance_mm(all, options.coverage);
}

/// The budget, and the standard uncertainty by linear propagation.
std::pair<std::vector<BudgetLine>, double> budget_of(std::vector<LinearTerm> terms) {
  std::vector<BudgetLine> budget;
  double squares_mm2 = 0.0;
  for (LinearTerm& term : terms) {
    BudgetLine line;
    line.name = std::move(term.name);
    line.standard_uncertainty_mm = std::abs(term.per_u_mm);
    line.per_u_mm = term.per_u_mm;
    squares_mm2 += term.per_u_mm * term.per_u_mm;
    budget.push_back(std::move(line));
  }
  share_out(budget);
  return {std::move(budget), std::sqrt(squares_mm2)};
}

/// "0.312 um"; an angle in urad.
std::string with_unit(core::ValueUnit unit, fmt::format_string<const double&> digits,
                      double length_mm) {
  const double number = core::micrometres(length_mm);
  return fmt::format(digits, number) + " " +
         std::string(core::name_of(core::unit_of_difference(unit)));
}

}  // namespace

core::Result<UncertaintyResult> statement_of_trials(TrialValues values,
                                                    std::vector<LinearTerm> terms,
                                                    std::vector<InfluenceStatement> declaration,
                                                    const UncertaintyOptions& options) {
  TRY_DO(check_options(options));
  TRY_DO(check_trials(values));
  // The trials as drawn hold the noise twice: their upper end is a bound under any circumstances.
  const double as_drawn_mm = statement_of(values.values_mm, options.coverage).high_mm;
  const bool nothing_left = turn(values);
  UncertaintyResult out;
  out.uncorrected_mm = values.as_measured_mm;
  out.trials = static_cast<int>(values.values_mm.size());
  const double numerical_mm = tolerance_of(values.values_mm, options);
  out.sampled = statement_of(std::move(values.values_mm), options.coverage);
  out.sampled.numerical_tolerance_mm = numerical_mm;
  out.tolerance_reached = options.tolerance_mm > 0.0 && numerical_mm <= options.tolerance_mm;
  out.noise_inflation_mm = out.uncorrected_mm - out.sampled.estimate_mm;
  // A signed value crosses 0: a share of it means nothing.
  out.sampled.at_most =
      !values.signed_value && out.noise_inflation_mm > kDominates * out.uncorrected_mm;
  // Influences so large that they take all of the value away leave no bound that rests on it.
  if (out.sampled.at_most && nothing_left) out.sampled.high_mm = as_drawn_mm;
  if (out.sampled.at_most) {
    out.notes.push_back(core::phrase(
        "noise-dominates: noise and influences make up {} of {} as measured, more than {:g} %; the "
        "value is only known to be at most {}",
        with_unit(values.unit, "{:.3f}", out.noise_inflation_mm),
        with_unit(values.unit, "{:.3f}", out.uncorrected_mm), 100.0 * kDominates,
        with_unit(values.unit, "{:.3f}", out.sampled.high_mm)));
  }
  double linear_mm = 0.0;
  std::tie(out.budget, linear_mm) = budget_of(std::move(terms));
  const double trials_mm = out.sampled.standard_uncertainty_mm;
  if (linear_mm > 0.0 && std::abs(trials_mm - linear_mm) > kNotLinear * linear_mm) {
    out.notes.push_back(core::phrase(
        "the value is not linear in its influences: the standard uncertainty is {} by the trials, "
        "{} by linear propagation; the interval is that of the trials",
        with_unit(values.unit, "{:.3g}", trials_mm), with_unit(values.unit, "{:.3g}", linear_mm)));
  }
  out.declaration = std::move(declaration);
  return out;
}

UncertaintyOptions options_of_line(UncertaintyOptions options, std::size_t lines) {
  constexpr double kMostCoverage = 0.999;
  const auto count = static_cast<double>(std::max<std::size_t>(1, lines));
  options.coverage = std::min(kMostCoverage, 1.0 - (1.0 - options.coverage) / count);
  return options;
}

void hold_lines_together(std::span<const UncertaintyStatement> lines, UncertaintyResult& greatest) {
  UncertaintyStatement& said = greatest.sampled;
  if (lines.empty() || said.at_most) return;
  double low_mm = 0.0;
  double high_mm = 0.0;
  for (const UncertaintyStatement& line : lines) {
    low_mm = std::max(low_mm, line.low_mm);
    high_mm = std::max(high_mm, line.high_mm);
  }
  said.low_mm = std::min(low_mm, said.estimate_mm);
  said.high_mm = std::max(high_mm, said.estimate_mm);
  greatest.notes.push_back(core::phrase(
      "of {} amplitudes above a third of their limits, each with its own interval, which hold "
      "together; brought to one limit",
      lines.size()));
}

}  // namespace rondure::evaluation
