#pragma once

#include <optional>
#include <vector>

#include "record/run_record.h"

namespace rondure::evaluation {

/// Part temperature while a cloud was touched, or while the series of an analysis were recorded; of
/// series each counts with its mean.
struct Temperatures {
  double least_degC = 0.0;
  double greatest_degC = 0.0;
  double mean_degC = 0.0;
  /// environment.assumed_degC of the plan was used for some or all touches.
  bool declared = false;
  /// Largest change of what was measured at one place: over the touches of one point, or over the
  /// rows of one series. Different places may differ. None where no place has two values.
  std::optional<double> drift_K = {};
};

/// The declared temperature of the plan, for temperatures that were not measured.
[[nodiscard]] std::optional<double> assumed_degC(const record::RunRecord& record);

/// Part temperature of the touches; without touches (a file), the declared one. None where a
/// temperature was not measured and none is declared.
[[nodiscard]] std::optional<Temperatures> temperatures_of(
    const record::RunRecord& record, const std::vector<const record::Touch*>& touches);

/// Part temperature of the series of an analysis, from their columns temperature_degC; the declared
/// one stands for a series without, and where nothing was recorded. None where a series has none
/// and none is declared.
[[nodiscard]] std::optional<Temperatures> temperatures_of_series(const record::RunRecord& record,
                                                                 int feature);

/// Correction of a feature to 20 degC, the reference temperature of ISO 1. The journal keeps the
/// values as read; the evaluation corrects them:
///   tip  * (1 + scale expansion (scale temperature - 20))  about the machine origin, each touch,
///        / (1 + part expansion (part temperature - 20)),   the mean temperature of its cloud,
/// and the radius of the tip is divided alike, so that the radius of the part is at 20 degC.
struct ThermalCorrection {
  double part_expansion_1_K = 0.0;
  double scale_expansion_1_K = 0.0;
  double part_degC = 20.0;   ///< Mean of the final cloud.
  double scale_degC = 20.0;  ///< Mean of the final cloud.
  double factor = 1.0;       ///< Length at 20 degC over length as read.
  /// Standard uncertainty of `factor`, from those of the expansions and of both temperatures:
  ///   u^2 = (a_p u_T)^2 + (dT_p u_ap)^2 + (a_s u_T)^2 + (dT_s u_as)^2.
  double factor_uncertainty = 0.0;
};

/// Whether the plan asks for a feature at 20 degC.
[[nodiscard]] bool asks_for_20_degC(const record::Feature& feature);

/// The record with its tip centres corrected to 20 degC; none when no feature asks for it.
/// Qualification touches follow the scales alone: the reference sphere is assumed to be at 20 degC.
[[nodiscard]] std::optional<record::RunRecord> compensated(const record::RunRecord& record);

/// The correction that compensated() applies to a feature's cloud in one pose; none when the
/// feature does not ask for it, or when a temperature that it needs was neither measured nor
/// declared.
[[nodiscard]] std::optional<ThermalCorrection> thermal_correction(const record::RunRecord& record,
                                                                  int feature, int pose);

}  // namespace rondure::evaluation
