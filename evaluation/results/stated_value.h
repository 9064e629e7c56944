#pragma once

#include <optional>
#include <string>

#include "core/units.h"
#include "evaluation/uncertainty/uncertainty.h"

namespace rondure::evaluation {

/// One term of the statement of a value, in words. The tag prevents terms from being swapped.
template <class Tag>
class Term {
 public:
  /// An empty phrase becomes "not known": nothing is left out in silence.
  explicit Term(core::Phrase words)
      : words_(words.empty() ? core::phrase("not known") : std::move(words)) {}
  [[nodiscard]] const core::Phrase& words() const { return words_; }

 private:
  core::Phrase words_;
};

using ReferenceTerm = Term<struct ReferenceTag>;  ///< "MZCY"
using FilterTerm = Term<struct FilterTag>;        ///< "unfiltered"
using SamplingTerm = Term<struct SamplingTag>;    ///< "4 x 7 points; mean of 5 touches per point"
using TipTerm = Term<struct TipTag>;              ///< "r_tip 1.9984 mm"
using TemperatureTerm = Term<struct TemperatureTag>;  ///< "20.3 degC"

/// How a value came about: the verification operator in the sense of ISO 17450-2. It cannot be
/// constructed without all of its terms.
class ValueOperator {
 public:
  ValueOperator(ReferenceTerm reference, FilterTerm filter, SamplingTerm sampling, TipTerm tip,
                TemperatureTerm temperature);
  /// "MZCY; unfiltered; 4 x 7 points; r_tip 1.9984 mm; 20.3 degC".
  [[nodiscard]] const core::Phrase& words() const { return words_; }

 private:
  core::Phrase words_;
};

/// The uncertainty of a value: an interval, or why there is none.
class UncertaintyStatus {
 public:
  [[nodiscard]] static UncertaintyStatus none(core::Phrase why);
  [[nodiscard]] static UncertaintyStatus stated(UncertaintyResult result, double coverage_1);

  /// The same uncertainty of a value that lies higher by `by_mm`.
  [[nodiscard]] UncertaintyStatus moved(double by_mm) const;
  /// The result; if none, see why().
  [[nodiscard]] const std::optional<UncertaintyResult>& result() const { return result_; }
  [[nodiscard]] const core::Phrase& why() const { return why_; }
  [[nodiscard]] double coverage_1() const { return coverage_1_; }
  /// The statement about a measurand, or nullptr.
  [[nodiscard]] const UncertaintyStatement* about(Measurand measurand) const;

 private:
  UncertaintyStatus() = default;
  std::optional<UncertaintyResult> result_;
  core::Phrase why_;
  double coverage_1_ = 0.0;
};

/// Which number of a value is the quoted one.
struct Quoting {
  /// The value as read, which a rule that takes no uncertainty into account compares; its interval
  /// stands beside it. Else the estimate.
  bool as_read = false;
  bool at_least = false;  ///< The true value is not below: a bound, never inside an interval.
};

/// A value as every report writes it: always with its operator and the status of its uncertainty.
/// Of an angle all numbers are in mrad, not mm (core::ValueUnit).
class StatedValue {
 public:
  StatedValue(std::string symbol, double value_mm, ValueOperator value_operator,
              UncertaintyStatus uncertainty, Measurand measurand = Measurand::kSampledPoints,
              core::ValueUnit unit = core::ValueUnit::kUm, Quoting quoting = {});

  /// Value as read: not corrected for any bias [mm].
  [[nodiscard]] double value_mm() const { return value_mm_; }
  /// Quoted value, the one that is compared with a limit: the estimate, which lies in the interval;
  /// of a bound the end of the interval; the value as read without an interval, or where the rule
  /// judges it [mm].
  [[nodiscard]] double quoted_mm() const;
  enum class Bound { kNone, kLower, kUpper };
  /// Whether the quoted value is only a bound of the true one.
  [[nodiscard]] Bound bound() const;
  /// Unit of the texts: mm for a size, urad for an angle, um for all else.
  [[nodiscard]] core::ValueUnit unit() const { return unit_; }
  /// A value in that unit, with as many decimals of a micrometre or microradian as the interval
  /// warrants; three without one.
  [[nodiscard]] std::string in_digits(double length_mm) const;
  [[nodiscard]] const ValueOperator& value_operator() const { return operator_; }
  [[nodiscard]] const UncertaintyStatus& uncertainty() const { return uncertainty_; }
  /// The same statement about another value, its interval moved with it.
  [[nodiscard]] StatedValue moved_to(double value_mm) const;
  /// The measurand of the printed interval.
  [[nodiscard]] Measurand measurand() const { return measurand_; }
  /// The statement about measurand(), or nullptr.
  [[nodiscard]] const UncertaintyStatement* statement() const {
    return uncertainty_.about(measurand_);
  }

  /// "8.31 um [7.60, 9.40]": the estimate with its interval; "at most 3.21 um", "at least 8.10 um"
  /// where only that is known; as read, "8.312 um", without an interval; "8.35 um, corrected 8.31
  /// [7.60, 9.40]" where the rule judges what was read.
  [[nodiscard]] core::Phrase value_text() const;
  /// "MZCY; unfiltered; ...; at the sampled points", with "no uncertainty stated" where it is so.
  [[nodiscard]] core::Phrase operator_text() const;
  /// "CYLt = 8.31 um, 95 % [7.60, 9.40]; as read 8.35 um (MZCY; unfiltered; ...; at the sampled
  /// points)"; "RONt is at most 3.21 um (95 %); as read 4.35 um (...)"; "CYLt = 8.35 um as read;
  /// corrected 8.31 um, 95 % [7.60, 9.40] (...)".
  [[nodiscard]] core::Phrase sentence() const;

 private:
  std::string symbol_;
  double value_mm_ = 0.0;
  ValueOperator operator_;
  UncertaintyStatus uncertainty_;
  Measurand measurand_;
  core::ValueUnit unit_;
  Quoting quoting_;
};

}  // namespace rondure::evaluation
