#pragma once

#include <string>

#include "core/result.h"
#include "evaluation/prediction/predict.h"
#include "plans/forecast/forecast.h"
#include "plans/plan.h"

namespace rondure::app {

/// A sampling of a feature, as its plan spells it.
struct Sampling {
  int layers = 0;
  int points_per_layer = 0;
  int repeats = 0;  ///< Touches of every point of the final cloud.

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

/// A sampling that was tried.
struct SamplingCandidate {
  Sampling sampling;
  int touches = 0;                       ///< Of the whole run.
  double time_s = 0.0;                   ///< Of the whole run, as forecast() predicts it.
  double expanded_mm = 0.0;              ///< Predicted U, the largest of its characteristics.
  double nine_of_ten_expanded_mm = 0.0;  ///< U that nine of ten parts do not exceed.
  bool meets = false;                    ///< Whether that U is not above the target.
  bool confirmed = false;                ///< Predicted with the full number of simulated parts.
  int stated = 0;                        ///< Characteristics whose interval is predicted.
  std::string missing;                   ///< Why another has none; empty: each has one.
  std::string out_of_reach;  ///< Not empty: why it cannot be touched, or loses an interval that the
                             ///< plan has; no numbers then.
};

/// The smallest number of repeats to propose: 2 if the run derives the repeatability from them.
[[nodiscard]] int least_repeats(const plans::Plan& plan);

/// One layout of one feature: its path is planned once, its repeats are varied.
class SamplingLayout {
 public:
  /// @param sampling  Its repeats are ignored.
  SamplingLayout(plans::Plan plan, std::size_t feature, const Sampling& sampling);

  /// The forecast with the fewest repeats, or why the layout cannot be touched.
  [[nodiscard]] const core::Result<plans::Forecast>& forecast() const { return forecast_; }

  /// A candidate, without its U.
  [[nodiscard]] SamplingCandidate candidate(int repeats) const;

  /// Predicts the U of a candidate of this layout.
  /// @return  The prediction with the largest U of its characteristics; `why` when none has one.
  core::Result<evaluation::Prediction> predict(evaluation::Measurand measurand,
                                               const evaluation::PredictionOptions& options,
                                               SamplingCandidate& candidate) const;

 private:
  [[nodiscard]] plans::Forecast repeated(int repeats) const;

  plans::Plan plan_;
  std::size_t feature_;
  Sampling sampling_;
  core::Result<plans::Forecast> forecast_;
  double again_s_ = 0.0;  ///< Time of one more final cloud.
};

}  // namespace rondure::app
