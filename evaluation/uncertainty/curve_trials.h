#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/phrase.h"
#include "core/result.h"
#include "core/units.h"
#include "evaluation/uncertainty/statement.h"

// Trials of the values of an analysis (JCGM 101) that do not count noise twice. A measured curve
// holds its noise already; a trial that adds draws to it would add that noise once more. Here the
// draws stand for the true curve given the measured one.

namespace rondure::evaluation {

/// A measured curve as coefficients in a basis in which its random errors are independent: parts
/// of harmonics, contrasts over turns, orthonormal columns over scattered angles.
struct MeasuredCurve {
  std::vector<double> found_mm;  ///< Coefficients, real.
  std::vector<double> u_mm;      ///< Standard uncertainty of each; 0: known exactly.
  /// Group of each coefficient, 0 upwards: an octave of orders (2-7, 8-15, 16-31, ...). The
  /// coefficients of a group are taken for parts of one kind.
  std::vector<int> group;
  /// Number of the harmonic of which each coefficient is a part, cosine or sine: both parts of one
  /// belong to the core together. Empty: every coefficient is judged alone.
  std::vector<int> order = {};
  /// Coefficients that always belong to the core, as the eccentricity does; may be empty.
  std::vector<bool> always_core = {};
  /// A random field, as asynchronous motion: it has no core, and is never 0.
  bool field = false;
};

/// Draws of the true coefficients of a curve, given the measured ones.
///
/// A coefficient that stands out of the noise belongs to the core and is drawn about its measured
/// value: |c| > u sqrt(2 ln(10 n)) of n, with u > 2.5 medians, or in a group of which more than a
/// quarter stand out; up to 12 make one group. The others are the pool: they are drawn from their
/// posterior under a common power P of their group, w c + sqrt(w) u z with w = P / (P + u^2). P is
/// itself drawn in every trial, from its posterior: with m the mean of u^2, a priori 0 or of
/// density m / (P + m)^2, each with probability 1/2; of fewer than 20 coefficients 0 with
/// probability 1/10, else of density 1 / (P + m) up to ten times their mean square (or m).
/// Source: the common method of the sister analyses, docs/uncertainty.md.
class CurveDraws {
 public:
  /// @param curve  Vectors of one length.
  /// @param id     Name of the influence, e.g. "probe.noise". A draw of a curve depends on (seed,
  ///               id, trial) alone, never on earlier draws.
  CurveDraws(MeasuredCurve curve, std::uint64_t seed, std::string_view id);

  /// True coefficients in trial `trial` (0-based) [mm].
  [[nodiscard]] std::vector<double> draw(int trial) const;
  /// The same with the pool at 0: for UncertainTrials::core_mm.
  [[nodiscard]] std::vector<double> core_draw(int trial) const;
  /// The measured coefficients of the core, 0 elsewhere [mm].
  [[nodiscard]] const std::vector<double>& core_mm() const { return core_mm_; }

 private:
  /// The posterior of the power of a pool: a mass at 0, and equal cells of its logarithm.
  class PoolPower {
   public:
    PoolPower(const MeasuredCurve& curve, const std::vector<std::size_t>& rows);
    /// The power [mm^2] below which it stays with this probability; 0 <= uniform < 1.
    [[nodiscard]] double at(double uniform) const;

   private:
    double log_first_ = 0.0;
    double step_ = 0.0;
    std::vector<double> cumulative_;  ///< At 0, then at the upper end of each cell.
  };
  struct Pool {
    std::vector<std::size_t> rows;
    PoolPower power;
  };

  MeasuredCurve curve_;
  std::uint64_t seed_ = 0;
  std::uint64_t id_ = 0;
  std::vector<double> core_mm_;
  std::vector<bool> in_core_;
  std::vector<Pool> pools_;  ///< One for each group with coefficients outside the core.
};

/// A standard normal draw of a classical or Berkson influence: a pure function of its arguments.
/// Two features that name the same id share their draws.
/// @param instance  Which of several with this id.
[[nodiscard]] double normal_draw(std::uint64_t seed, std::string_view id, std::uint64_t instance,
                                 int trial);
/// The same, uniform with standard deviation 1: for a rectangular influence, times its standard
/// uncertainty.
[[nodiscard]] double uniform_draw(std::uint64_t seed, std::string_view id, std::uint64_t instance,
                                  int trial);

/// Values of one quantity in all trials.
struct TrialValues {
  double as_measured_mm = 0.0;
  std::vector<double> values_mm;  ///< One for each trial; not below 100.
  /// Of a convex value (peak to valley, rms, amplitude, largest of many): the values of the core
  /// alone, for the same trials. Empty: the value is linear and is not turned.
  std::vector<double> core_mm = {};
  double core_center_mm = 0.0;                  ///< The value of CurveDraws::core_mm().
  bool signed_value = false;                    ///< false: values are cut at 0.
  core::ValueUnit unit = core::ValueUnit::kUm;  ///< In notes; of kUrad the values are in mrad.
};

/// An influence alone: how the value changes with it.
struct LinearTerm {
  std::string name;       ///< Stable, kebab-case: "probe-2-gain".
  double per_u_mm = 0.0;  ///< Change of the value for +1 standard uncertainty, signed.
};

/// Change of a value for one standard uncertainty, by central differences: (f(+1) - f(-1)) / 2.
/// @param value  The value with the influence at so many standard uncertainties.
[[nodiscard]] double per_u(const std::function<double(double)>& value);

/// The statement about a value from its trials.
///
/// A convex value is turned: B = mean(core) - centre of the core, and 2 max(0, B) is taken off
/// every trial, because the trials inflate the value as the measurement did. Where an unsigned
/// value as measured is inflated by more than 25 % of it, only an upper bound is left (`at_most`,
/// note "noise-dominates"). Where linear propagation and the trials differ by more than 30 %, a
/// note says both.
/// @param terms  The budget, noise included; ranked in the result. Their root sum of squares is the
///               linear propagation.
/// @param declaration  Declared and undeclared influences.
/// @return  kBadOption for fewer than 100 trials, another number of values of the core, or an
///          option outside its range; kNotFinite names the first trial without a number.
[[nodiscard]] core::Result<UncertaintyResult> statement_of_trials(
    TrialValues values, std::vector<LinearTerm> terms, std::vector<InfluenceStatement> declaration,
    const UncertaintyOptions& options);

/// A line of a mask binds where its amplitude is above this share of its limit.
constexpr double kBindingShare = 1.0 / 3.0;

/// Options for the interval of one of `lines` lines of a mask: coverage 1 - (1 - P) / lines, at
/// most 0.999, so that the intervals of all hold together with P.
[[nodiscard]] UncertaintyOptions options_of_line(UncertaintyOptions options, std::size_t lines);

/// Gives the greatest of several amplitudes, brought to one limit, the ends of their own intervals:
/// it ends below the limit where all of them do, and begins above it where one of them does. Its
/// distribution stays that of the greatest: the share of trials below the limit is that in which
/// every amplitude holds its own. An upper bound stays as it is.
/// @param lines  Statements with options_of_line(); empty: nothing binds, nothing changes.
void hold_lines_together(std::span<const UncertaintyStatement> lines, UncertaintyResult& greatest);

}  // namespace rondure::evaluation
