#pragma once

#include <optional>
#include <string>

#include "evaluation/interval/internal/declared.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Simulated inspections of parts not yet touched: a feature of an error-free record, with
/// simulated deviations of parts and simulated errors.
class TrialInspection {
 public:
  /// @return  The inspection; or why the feature has no cloud: kNoPoints when it is not touched.
  [[nodiscard]] static core::Result<TrialInspection> of(const record::RunRecord& expected,
                                                        int feature);

  /// The points of an error-free inspection.
  [[nodiscard]] const FormCloud& nominal() const { return nominal_; }
  [[nodiscard]] const FeatureResult& result() const { return result_; }

  /// The evaluation result of a simulated cloud, as far as its uncertainty needs it.
  [[nodiscard]] FeatureResult result_of(const FormCloud& simulated,
                                        const record::Characteristic& asked) const;
  /// The value of a simulated cloud: of all points, or of its worst section [mm].
  [[nodiscard]] double value_mm(const FormCloud& simulated,
                                const record::Characteristic& asked) const;

  /// Sets the repeatability of a touch, for a run that would determine it from its repeats [mm].
  void assume_repeatability(double sigma_mm) { result_.repeat_sigma_mm = sigma_mm; }

 private:
  FeatureResult result_;
  FormCloud nominal_;
};

/// The assumed form of the parts, as an absolute spectrum whose `source` describes it: as declared,
/// or of a documented size. See predict().
[[nodiscard]] core::Result<FormSpectrum> expected_form(const TrialInspection& rehearsal,
                                                       const Declared& declared,
                                                       const record::Characteristic& asked);

}  // namespace rondure::evaluation
