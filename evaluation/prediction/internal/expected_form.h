#pragma once

#include <optional>
#include <string>

#include "evaluation/interval/internal/declared.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Inspections of parts that nobody has touched yet: a feature of a record without errors, with the
/// deviations of parts and errors that are made up.
class TrialInspection {
 public:
  /// @return  Why the feature has no cloud; kNoPoints when it is not touched.
  [[nodiscard]] static core::Result<TrialInspection> of(const record::RunRecord& expected,
                                                        int feature);

  /// The points, as an inspection without errors finds them.
  [[nodiscard]] const FormCloud& nominal() const { return nominal_; }
  [[nodiscard]] const FeatureResult& result() const { return result_; }

  /// What evaluation would make of a simulated cloud, as far as its uncertainty needs.
  [[nodiscard]] FeatureResult result_of(const FormCloud& simulated,
                                        const record::Characteristic& asked) const;
  /// The value of a simulated cloud: of all points, or of its worst section [mm].
  [[nodiscard]] double value_mm(const FormCloud& simulated,
                                const record::Characteristic& asked) const;

  /// The touch of a point where the run would find it by its repeats [mm].
  void assume_repeatability(double sigma_mm) { result_.repeat_sigma_mm = sigma_mm; }

 private:
  FeatureResult result_;
  FormCloud nominal_;
};

/// The form that parts are assumed to have, as an absolute spectrum whose `source` says so in
/// words: as declared, or of a documented size. See predict().
[[nodiscard]] core::Result<FormSpectrum> expected_form(const TrialInspection& rehearsal,
                                                       const Declared& declared,
                                                       const record::Characteristic& asked);

}  // namespace rondure::evaluation
