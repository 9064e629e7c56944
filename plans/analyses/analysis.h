#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "plans/plan.h"
#include "plans/schema/findings.h"
#include "record/csv/series.h"
#include "record/run_record.h"

// Features whose data are series, not touches: checks their plans and obtains their data. README.md
// explains how to add one.

namespace rondure::plans {

/// One file that an analysis reads.
struct SeriesFile {
  std::string series = "data";  ///< Name of the series in the journal.
  std::string file;             ///< Name in the plan.
  std::string where;            ///< JSON pointer of that name, relative to the feature.
  std::vector<record::WantedColumn> wanted;
  std::vector<record::ColumnName> names;
  /// Reads the file in place of parse_series_csv() with these columns; empty: that.
  std::function<core::Result<record::Series>(std::string_view text, const std::string& name)> read =
      {};
};

/// Data recorded by the probes of an analysis, or simulated.
struct AnalysisData {
  std::vector<record::Series> series;  ///< With the index of the feature.
  std::vector<record::TruthValue> truths;
  /// SHA-256 of the file; for several, of the lines "sha256 name"; empty: simulated.
  std::string sha256;
};

/// The part that one type of analysis adds to the shared code.
struct AnalysisKind {
  std::string_view type;  ///< Also the key of its section in the feature and in the simulation.
  record::Shape shape;
  std::span<const record::Form> forms;  ///< Its possible characteristics.
  bool (*is_simulated)(const SimulationPlan& simulation);
  std::vector<record::Setting> (*settings)(const FeaturePlan& feature);
  std::vector<SeriesFile> (*files)(const FeaturePlan& feature);
  /// Checks relations between keys; called only when the section and its keys are valid.
  void (*check)(const FeaturePlan& feature, const std::string& where, Findings& findings);
  /// @param seed    Seed of all noise. The data depend only on plan and seed.
  /// @param errors  False: what probes and gauges without errors would have recorded of the same
  ///                work, which the result is held against.
  core::Result<AnalysisData> (*simulate)(const Plan& plan, std::size_t index, std::uint64_t seed,
                                         bool errors);
  /// For an analysis of touches: checks its cell. Null for an analysis of series; when it is set,
  /// is_simulated and simulate are null.
  void (*check_cell)(const Plan& plan, std::size_t index, Findings& findings) = nullptr;
};

/// Whether a plan simulates the data of an analysis; `section` is e.g. &SimulationPlan::spindle.
template <auto section>
[[nodiscard]] bool simulates(const SimulationPlan& simulation) {
  return (simulation.*section).has_value();
}

/// The file in the source of a feature, as the only file of an analysis; empty without a source.
[[nodiscard]] std::vector<SeriesFile> source_file(const FeaturePlan& feature,
                                                  std::span<const record::WantedColumn> wanted);

/// The sum of simulated harmonics, amplitude cos(order angle - phase) [um].
[[nodiscard]] double sum_of(std::span<const HarmonicPlan> harmonics, double angle_rad);

/// Whether the data of an analysis come from files, by its source or its own section.
[[nodiscard]] bool has_files(const FeaturePlan& feature);

/// Whether the files of a feature are measured with the correction of an earlier one in the
/// control: a run asks whether it is loaded, and reads them after the answer. Until then they may
/// be missing.
[[nodiscard]] bool follows_loading(const FeaturePlan& feature);

/// The kind of a feature's type, or nullptr for a touched surface.
[[nodiscard]] const AnalysisKind* analysis_kind(record::Shape shape);

/// Whether a feature is an analysis of touches: it needs the machine, but is not a surface.
[[nodiscard]] bool measures_by_touch(const FeaturePlan& feature);

/// The data of feature `index`, an analysis of series: from its files, or simulated.
/// @return  The data, none where a file is missing that follows_loading(); errors of files and
/// tables name their place.
[[nodiscard]] core::Result<AnalysisData> analysis_data(const Plan& plan, std::size_t index,
                                                       std::uint64_t seed);

/// Checks an analysed feature: it has its own section and no other, its characteristics belong to
/// its type, its data can be read or simulated.
void check_analysis(const Plan& plan, std::size_t index, Findings& findings);

/// The kinds, one file each.
[[nodiscard]] const AnalysisKind& spindle_kind();
[[nodiscard]] const AnalysisKind& wheel_kind();
[[nodiscard]] const AnalysisKind& contour_kind();
[[nodiscard]] const AnalysisKind& rotary_kind();
[[nodiscard]] const AnalysisKind& five_axis_kind();

}  // namespace rondure::plans
