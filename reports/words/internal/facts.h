#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/decision/decision.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/section.h"
#include "record/tasks/run.h"

namespace rondure::reports {

/// A limit in `unit` as the plan states it, to 1e-9 of the unit. The sum of a nominal diameter and
/// a deviation, and um that became mm, differ from the plan in their last digits.
[[nodiscard]] inline std::optional<double> limit_in(core::ValueUnit unit,
                                                    const std::optional<double>& limit_mm) {
  constexpr double kStepsPerUnit = 1e9;
  if (!limit_mm) return std::nullopt;
  const double limit = unit == core::ValueUnit::kMm ? *limit_mm : core::micrometres(*limit_mm);
  return core::on_grid(limit, kStepsPerUnit);
}

/// A judged value of a simulated run beside what it is without errors of measurement.
struct HeldAgainstTruth {
  std::string name;  ///< Of the characteristic, with that of the value where it has several.
  evaluation::StatedValue found;
  double truth_mm = 0.0;  ///< As all numbers of `found`.
  std::optional<double> u_mm = {};

  /// The estimate, which `u` belongs to, without one the quoted value; where that is only a bound,
  /// the value as read.
  [[nodiscard]] double found_mm() const {
    if (found.bound() != evaluation::StatedValue::Bound::kNone) return found.value_mm();
    return u_mm && found.statement() ? found.statement()->estimate_mm : found.quoted_mm();
  }
  [[nodiscard]] double difference_mm() const { return found_mm() - truth_mm; }
  /// Nothing without an uncertainty.
  [[nodiscard]] std::optional<double> difference_over_u() const {
    return u_mm && *u_mm > 0.0 ? std::optional(difference_mm() / *u_mm) : std::nullopt;
  }
};

/// In the order of the plan; empty where the truth is not known, as of every real run.
[[nodiscard]] std::vector<HeldAgainstTruth> held_against_truth(
    const evaluation::CharacteristicResult& result);
[[nodiscard]] std::vector<HeldAgainstTruth> held_against_truth(
    const evaluation::FeatureResult& feature);

/// Laboratory, order and customer of a run.
[[nodiscard]] record::HeadSettings people_of(const record::RunRecord& record);

/// "4 x 7 points" for a regular cloud, "500 points" otherwise.
[[nodiscard]] std::string pattern_of(const evaluation::FeatureResult& feature);
/// "3 touches per point", "1 to 3 touches per point"; empty for a points file.
[[nodiscard]] std::string repeats_of(const evaluation::FeatureResult& feature);
/// "Layer 1"; "All points, seen along the axis".
[[nodiscard]] std::string title_of(const evaluation::Section& section);
/// How much the fixture adds to CYLt, in one sentence; where it is not known, with the reason.
[[nodiscard]] core::Phrase share_in_words(const evaluation::MergedPoses& merged);
/// The statement of a certificate, in one sentence.
[[nodiscard]] core::Phrase sentence_of(const fit::Certificate& certificate);

/// The headline of a run that did not finish, in place of its verdict: "INCOMPLETE: 9 of 10
/// judged", and that it does not conform where that is proven. None of a finished run.
[[nodiscard]] std::optional<std::string> incomplete_headline(
    const record::RunRecord& record, const evaluation::Evaluation& evaluation);

/// The missing parts of a run that did not finish, one sentence each.
[[nodiscard]] std::vector<std::string> missing_parts(const record::RunRecord& record,
                                                     const evaluation::Evaluation& evaluation);

/// The name of the decision rule in words: "simple acceptance".
[[nodiscard]] std::string rule_in_words(const record::Header& header);
/// The rule of the verdict, with its formula and the value that it judges; or why it is unknown.
/// None where that reason is not known in the language of the report.
[[nodiscard]] std::optional<std::string> rule_sentence(const evaluation::Evaluation& evaluation);

/// The rule in words, with its formula: "ISO 14253-1: conforms where y + 1 (hi - y) <= T, ...".
[[nodiscard]] std::string in_words(const evaluation::DecisionRule& rule);

/// The rule of a characteristic that has its own, in words; empty where that of the run holds.
[[nodiscard]] std::string own_rule_in_words(const record::Characteristic& asked);

/// Why values of an analysis have no interval: each reason once.
struct AbsentInterval {
  core::Phrase why;
  std::vector<std::string> ids;  ///< Of the characteristics that it concerns, as the plan has them.
};
[[nodiscard]] std::vector<AbsentInterval> absent_intervals(
    const evaluation::FeatureResult& feature);

/// "8.93 [8.71, 9.14]", "<= 9.14" where only that is known, the value as measured without an
/// interval; um, of an index a plain number.
/// @param at_most  The sign of an upper bound.
[[nodiscard]] std::string with_interval(const evaluation::ContourNumber& number,
                                        std::string_view at_most);
/// The effective radius of a wheel with its interval, where points may be missing only its lower
/// end, or why there is no interval.
[[nodiscard]] core::Phrase effective_radius_in_words(const evaluation::WheelResult& facts);

}  // namespace rondure::reports
