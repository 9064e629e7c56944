#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"
#include "record/run_record.h"

namespace rondure::reports {

/// A call-out as a report for people states it, in its unit and in the digits that it deserves: two
/// of U, else a hundredth of the tolerance, and more where these would hide that a limit is passed.
struct Callout {
  const evaluation::FeatureResult* feature = nullptr;        ///< Never null.
  const evaluation::CharacteristicResult* result = nullptr;  ///< Never null.
  core::ValueUnit unit = core::ValueUnit::kUm;
  std::string symbol;     ///< "CYLt", "d GN / d LP SN".
  std::string value;      ///< "4.31", "≤ 3.2", "29.9969 / 29.9911"; empty: there is none.
  std::string expanded;   ///< U; empty where it is not stated, and of a bound.
  std::string limit;      ///< "4", "29.987 … 30", "≥ 5"; empty: none.
  std::string deviation;  ///< From the nominal size; of other values beyond the limit, else empty.
  std::string place;      ///< Where it is worst: "12.5 mm, 212°" (part z, angle from part x).
  std::string beyond;     ///< How far a limit is passed: "0.31 µm"; empty: it is not.
  std::string passed;     ///< That limit: "4 µm".
  bool below = false;     ///< It is the lower one.
  std::optional<double> share_1;         ///< Of the limit; between two, of half their distance.
  std::optional<std::size_t> worst_row;  ///< Row of the cloud where it is worst.
};

/// All call-outs: those that do not conform first, then by share of the limit.
/// @param evaluation  Must outlive them.
[[nodiscard]] std::vector<Callout> callouts_of(const evaluation::Evaluation& evaluation);

/// "≤ 30 mm, ≥ 29.987 mm".
[[nodiscard]] std::string limits_in_words(const record::Characteristic& asked,
                                          std::string_view between);

/// The sentence that page and terminal begin with: "20 of 20 conform; nearest: GPRt 4 of journal B,
/// 76 %.", "19 of 20 conform; CYLt of journal B is 0.31 µm over its limit of 4 µm."
/// @param callouts  In the order of callouts_of(). The first two that do not conform are named.
/// @param name      A call-out as page or terminal names it.
[[nodiscard]] std::string answer_in_words(const std::vector<Callout>& callouts,
                                          std::string (*name)(const Callout&));

/// What is true of all results: simulated; some are only bounds. A word and its sentence each.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> remarks_on(
    const record::RunRecord& record, const std::vector<Callout>& callouts);

/// The influences that are in U, those that are not, and why a value has no U.
/// @param say  Words of another room as page or terminal writes them.
[[nodiscard]] std::string uncertainty_in_words(const std::vector<Callout>& callouts,
                                               std::string (*say)(const core::Phrase&));

}  // namespace rondure::reports
