#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/interval/internal/declared.h"
#include "evaluation/part/internal/chart.h"
#include "evaluation/part/surface.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The assumed deviations of a surface from its nominal one.
struct AssumedSurface {
  FormSpectrum form;      ///< Absolute; `source` describes it.
  double place_mm = 0.0;  ///< Standard deviation of each shift, and of each tilt at its ends [mm].
};

/// A surface of an error-free record.
struct RehearsedSurface {
  std::vector<std::size_t> rows;  ///< Outside of windows.
  /// Its points, free of errors; or why nothing is simulated of it.
  core::Result<Chart> chart = core::fail(core::Code::kNoPoints, "the feature is not touched");
  Declared declared;          ///< Where there is a chart.
  std::string repeatability;  ///< As it is assumed, in words, where the run would determine it.
};

/// Simulated inspections of parts not yet touched: the surfaces of an error-free record, with
/// simulated deviations of parts and simulated errors.
class Rehearsal {
 public:
  /// @param expected  As of predict(), with influences declared; must outlive it.
  explicit Rehearsal(const record::RunRecord& expected);

  /// One for each feature.
  [[nodiscard]] const std::vector<RehearsedSurface>& surfaces() const { return surfaces_; }
  /// The expected qualification, with the uncertainty of the tip radius that a run would find.
  [[nodiscard]] const std::optional<fit::ProbeTip>& probe() const { return probe_; }

  /// The assumed form for one characteristic of a feature with a chart; see predict().
  [[nodiscard]] core::Result<AssumedSurface> assumed(std::size_t feature,
                                                     const record::Characteristic& asked) const;
  /// The part on which all characteristics are simulated that share their trials; see predict().
  /// Empty for features without a chart.
  [[nodiscard]] std::vector<std::optional<AssumedSurface>> assumed_part() const;

  /// One inspection of a part: all features of the record, evaluated as far as their trials need
  /// it. Features of which nothing is assumed stay nominal.
  [[nodiscard]] core::Result<std::vector<FeatureResult>> inspected(
      std::span<const std::optional<AssumedSurface>> part, std::uint64_t seed) const;

 private:
  [[nodiscard]] std::string assume_repeatability(FeatureResult& nominal) const;
  void assume_probe();
  [[nodiscard]] core::Result<double> mean_value_mm(std::size_t feature,
                                                   const AssumedSurface& assumed,
                                                   const record::Characteristic& asked) const;

  const record::RunRecord& record_;
  std::vector<RehearsedSurface> surfaces_;
  std::vector<FeatureResult> nominal_;
  std::vector<MeasuredSurface> part_;  ///< Of `nominal_`.
  std::optional<fit::ProbeTip> probe_;
};

}  // namespace rondure::evaluation
