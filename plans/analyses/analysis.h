#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "plans/schema/findings.h"
#include "plans/plan.h"
#include "record/run_record.h"
#include "record/csv/series.h"

// Features whose data are series, not touches: how the plan of each is checked and where its data
// come from. README.md says how to add one.

namespace rondure::plans {

/// One file that an analysis reads.
struct SeriesFile {
  std::string series = "data";  ///< Name of the series in the journal.
  std::string file;             ///< As the plan names it.
  std::string where;            ///< JSON pointer of that name, below the feature.
  std::vector<record::WantedColumn> wanted;
  std::vector<record::ColumnName> names;
};

/// What the probes of an analysis recorded, or the simulation in their place.
struct AnalysisData {
  std::vector<record::Series> series;  ///< With the index of the feature.
  std::vector<record::TruthValue> truths;
  std::string sha256;  ///< Of the file; of several, of the lines "sha256 name"; empty: simulated.
};

/// What one type of analysis adds to the shared way.
struct AnalysisKind {
  std::string_view type;  ///< Also the key of its section in the feature and in the simulation.
  record::Shape shape;
  std::span<const std::string_view> forms;  ///< Characteristics that it has.
  bool (*is_simulated)(const SimulationPlan& simulation);
  std::vector<record::Setting> (*settings)(const FeaturePlan& feature);
  std::vector<SeriesFile> (*files)(const FeaturePlan& feature);
  /// What no single key can show; only called when the section and its keys are sound.
  void (*check)(const FeaturePlan& feature, const std::string& where, Findings& findings);
  /// @param seed  Of all noise. The data are a function of plan and seed.
  core::Result<AnalysisData> (*simulate)(const Plan& plan, std::size_t index, std::uint64_t seed);
  /// Of an analysis whose data are touches of the machine: what concerns its cell. Null: series;
  /// where it is given, is_simulated and simulate are null.
  void (*check_cell)(const Plan& plan, std::size_t index, Findings& findings) = nullptr;
};

/// Whether a plan simulates the data of an analysis: `section` is such as &SimulationPlan::spindle.
template <auto section>
[[nodiscard]] bool simulates(const SimulationPlan& simulation) {
  return (simulation.*section).has_value();
}

/// The file that the source of a feature names, as the only one of an analysis; none without
/// source.
[[nodiscard]] std::vector<SeriesFile> source_file(const FeaturePlan& feature,
                                                  std::span<const record::WantedColumn> wanted);

/// The sum of simulated harmonics, amplitude cos(order angle - phase) [um].
[[nodiscard]] double sum_of(std::span<const HarmonicPlan> harmonics, double angle_rad);

/// Whether the data of an analysis come from files: as its source says, or its own section.
[[nodiscard]] bool has_files(const FeaturePlan& feature);

/// The kind of a feature's type, or nullptr for one that is touched.
[[nodiscard]] const AnalysisKind* analysis_kind(std::string_view type);

/// Whether a feature is an analysis of touches: it needs the machine, though not as a surface.
[[nodiscard]] bool measures_by_touch(const FeaturePlan& feature);

/// The data of feature `index`, an analysis of series: from its files, or simulated.
/// @return  Errors of files and tables with their place.
[[nodiscard]] core::Result<AnalysisData> analysis_data(const Plan& plan, std::size_t index,
                                                       std::uint64_t seed);

/// Checks a feature of an analysis: its section is there and no other, its characteristics are its
/// own, its data can be read or simulated.
void check_analysis(const Plan& plan, std::size_t index, Findings& findings);

/// The kinds themselves, one file each.
[[nodiscard]] const AnalysisKind& spindle_kind();
[[nodiscard]] const AnalysisKind& wheel_kind();
[[nodiscard]] const AnalysisKind& contour_kind();
[[nodiscard]] const AnalysisKind& rotary_kind();

}  // namespace rondure::plans
