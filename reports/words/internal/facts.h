#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/decision/decision.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/section.h"

namespace rondure::reports {

/// "4 x 7 points" for a regular cloud, "500 points" otherwise.
[[nodiscard]] std::string pattern_of(const evaluation::FeatureResult& feature);
/// "3 touches a point", "1 to 3 touches a point"; empty for a points file.
[[nodiscard]] std::string repeats_of(const evaluation::FeatureResult& feature);
/// "Layer 1"; "All points, seen along the axis".
[[nodiscard]] std::string title_of(const evaluation::Section& section);
/// How much the fixture adds to CYLt, in one sentence; where it is not known, with the reason.
[[nodiscard]] core::Phrase share_in_words(const evaluation::MergedPoses& merged);
/// The statement of a certificate, in one sentence.
[[nodiscard]] core::Phrase sentence_of(const fit::Certificate& certificate);

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

}  // namespace rondure::reports
