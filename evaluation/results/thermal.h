#pragma once

#include <optional>
#include <vector>

#include "record/run_record.h"

namespace rondure::evaluation {

/// Part temperature while a cloud was touched.
struct Temperatures {
  double least_degC = 0.0;
  double greatest_degC = 0.0;
  double mean_degC = 0.0;
  bool declared = false;  ///< environment.assumed_degC of the plan stands for some or all.
};

/// What the plan declares of temperatures that nobody measured.
[[nodiscard]] std::optional<double> assumed_degC(const record::RunRecord& record);

/// Part temperature of the touches; of none (a file), what the plan declares. Nothing where one was
/// not measured and none is declared.
[[nodiscard]] std::optional<Temperatures> temperatures_of(
    const record::RunRecord& record, const std::vector<const record::Touch*>& touches);

/// Bringing a feature to 20 degC, the reference temperature of ISO 1. The journal keeps what was
/// read; this is done in the evaluation:
///   tip  * (1 + scale expansion (scale temperature - 20))  about the machine origin, each touch,
///        / (1 + part expansion (part temperature - 20)),   the mean temperature of its cloud,
/// and the radius of the tip is divided alike, so that it leaves the radius of the part at 20 degC.
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

/// Whether a feature is to be brought to 20 degC; also where its settings cannot be read.
[[nodiscard]] bool asks_for_20_degC(const record::Feature& feature);

/// The record with its tip centres brought to 20 degC; nothing when no feature asks for it.
/// Qualification touches follow the scales alone: the reference sphere is taken as at 20 degC.
[[nodiscard]] std::optional<record::RunRecord> compensated(const record::RunRecord& record);

/// What compensated() does to a feature's cloud in one pose; nothing when the feature does not ask,
/// or when a temperature that it needs was neither measured nor declared.
[[nodiscard]] std::optional<ThermalCorrection> thermal_correction(const record::RunRecord& record,
                                                                  int feature, int pose);

}  // namespace rondure::evaluation
