#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/data/corrections.h"
#include "reports/history/earlier_results.h"
#include "reports/words/callouts.h"

namespace rondure::evaluation {
struct ContourResult;
struct FiveAxisResult;
struct RotaryResult;
struct SpindleResult;
struct WheelResult;
}  // namespace rondure::evaluation

namespace rondure::reports {

/// The parts of the page, in their order.
/// @param kind  Kind of page, printed after the name of the program.
/// @param evaluation  Null while a run goes on: probe, calibration and temperature stay empty.
[[nodiscard]] std::string head_section(const record::RunRecord& record, const std::string& kind,
                                       const evaluation::Evaluation* evaluation = nullptr);
/// Page one: answer, table of the call-outs, the worst of them drawn, what the values rest on,
/// foot.
[[nodiscard]] std::string verdict_section(const record::RunRecord& record,
                                          const evaluation::Evaluation& evaluation,
                                          const std::vector<Callout>& callouts);
/// The call-out that page one draws; null: none has points.
[[nodiscard]] const Callout* drawn_callout(const std::vector<Callout>& callouts);
/// @param detail  What is folded otherwise is open.
/// @param drawn   Page one has drawn the feature: its map is not drawn again.
[[nodiscard]] std::string feature_section(const record::RunRecord& record, std::size_t index,
                                          const evaluation::FeatureResult& feature, bool detail,
                                          bool drawn, const FeatureCorrections& corrections);
/// The body of an analysed feature: the drawing that shows the matter, key numbers with their words
/// explained, other drawings, tables. `record` gives the hidden truth of a simulation.
[[nodiscard]] std::string analysis_part(const evaluation::SpindleResult& facts,
                                        const record::RunRecord& record, int feature);
[[nodiscard]] std::string analysis_part(const evaluation::WheelResult& facts,
                                        const record::RunRecord& record, int feature);
[[nodiscard]] std::string analysis_part(const evaluation::ContourResult& facts,
                                        const record::RunRecord& record, int feature);
[[nodiscard]] std::string analysis_part(const evaluation::RotaryResult& facts,
                                        const record::RunRecord& record, int feature);
/// @param exact  What a simulation gives without errors of measurement; null: no simulation.
[[nodiscard]] std::string analysis_part(const evaluation::FiveAxisResult& facts,
                                        const record::RunRecord& record, int feature,
                                        const evaluation::FiveAxisResult* exact);
/// Stands above the key numbers of an analysis: which of them are as read.
[[nodiscard]] std::string as_read_note();
/// All intervals in one table, the influences and the rule with its statements; empty without any.
[[nodiscard]] std::string uncertainties_section(const evaluation::Evaluation& evaluation,
                                                const std::vector<Callout>& callouts);
/// The conditions that were checked before values were judged, passed or not; empty without any.
[[nodiscard]] std::string gates_section(const evaluation::FeatureResult& feature);
/// The verdict of a call-out with its reason, risks, own rule and operator.
[[nodiscard]] std::string verdict_in_words(const evaluation::CharacteristicResult& result);
/// The heading of a feature: "Feature land-A"; of an analysis what it is about.
[[nodiscard]] std::string feature_title(const record::Feature& feature);
/// Whether something on the page needs kDrawingStyle.
[[nodiscard]] bool has_findings(const evaluation::Evaluation& evaluation);
/// "Coax: 4.3 um about the one-sided datum, 6.2 um about the equalised one", without a full stop;
/// empty where no datum of the value rocks.
[[nodiscard]] std::string values_about_datum(const evaluation::CharacteristicResult& result);
/// How the values of a feature came about: verdict, local values, numbers, datums, points left out,
/// warnings, pictures.
/// @param failing  Those that do not conform, are undecided or void; else all others.
[[nodiscard]] std::string callouts_section(const evaluation::FeatureResult& feature,
                                           const record::RunRecord& record, bool failing);
/// Harmonics of dense sections with the limits of a mask, and those beyond it; empty for sparse
/// sections.
[[nodiscard]] std::string harmonics_section(const evaluation::FeatureResult& feature);
/// Table of the poses of a feature; empty when it has none.
[[nodiscard]] std::string pose_table(const evaluation::FeatureResult& feature);
[[nodiscard]] std::string probe_section(const record::RunRecord& record,
                                        const evaluation::Evaluation& evaluation);
[[nodiscard]] std::string decisions_section(const record::RunRecord& record);
/// Run charts with earlier results; empty without any.
[[nodiscard]] std::string history_section(const record::RunRecord& record,
                                          const evaluation::Evaluation& evaluation,
                                          const EarlierResults& earlier);
[[nodiscard]] std::string provenance_section(const record::RunRecord& record);

/// Combination of the clouds of several poses, and the fixture's contribution.
[[nodiscard]] std::string merged_section(const evaluation::MergedPoses& merged);
/// Why a feature has no result, and its warnings.
[[nodiscard]] std::string messages(const evaluation::FeatureResult& feature);
/// A value with small print below it.
[[nodiscard]] std::string with_note(const std::string& value, const std::string& note);

/// A paragraph that explains a word of a page; both are HTML.
[[nodiscard]] std::string explained(std::string_view word, std::string_view html);

/// What a reader opens where it is wanted, and print leaves out while it is closed; empty without
/// text.
[[nodiscard]] std::string folded(const std::string& summary, const std::string& html, bool open);
/// A paragraph in small print; `html` is used as it is.
[[nodiscard]] std::string note(const std::string& html);
/// Puts HTML in a box that scrolls on a narrow screen.
[[nodiscard]] std::string scrolling(const std::string& html);

using TableRows = std::vector<std::vector<std::string>>;
/// A table; names and cells are HTML. In a row with fewer cells than columns, the last cell spans
/// the remaining columns.
/// @param css_class  May be empty.
/// @param columns    A letter per column: 'l' text, 'r' numbers, aligned right.
/// @param caption    A <caption> from spoken_caption().
[[nodiscard]] std::string table(std::string_view css_class, std::string_view columns,
                                std::string_view caption, const std::vector<std::string>& names,
                                const TableRows& rows);
/// The name of a table for readers who do not see the heading above it; `html` is used as it is.
[[nodiscard]] std::string spoken_caption(std::string_view html);

/// "<div><dt>name</dt><dd>html</dd></div>"; both are HTML.
[[nodiscard]] std::string entry(std::string_view name, std::string_view html,
                                std::string_view css_class = {});
}  // namespace rondure::reports
