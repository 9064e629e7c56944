#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fit/rotary/axes.h"
#include "fixture/error_model.h"
#include "reports/analysis.h"

namespace rondure::reports {

/// What is left at one combined pose.
struct CombinedPose {
  core::Pose pose;  ///< As the fixture read it.
  std::size_t points = 0;
  double rms_mm = 0.0;
  double max_mm = 0.0;
  double tilt_rad = 0.0;       ///< Turn that is left.
  double before_rms_mm = 0.0;  ///< Against the nominal kinematics.
};

/// Everything found of the fixture.
struct RotaryFacts {
  fit::RotaryStudy alpha;
  fit::RotaryStudy beta;
  std::vector<std::string> balls;
  std::size_t poses = 0;
  std::size_t touches = 0;
  double touch_sigma_mm = 0.0;  ///< Pooled scatter of a touch about its ball.
  double center_u_mm = 0.0;     ///< Root mean square standard uncertainty of a centre coordinate.
  double condition = 0.0;       ///< Of all balls; see fit::BallSetup.
  std::vector<CombinedPose> combined;
  fixture::Calibration calibration;
};

/// Calibration of the fixture. evaluate_rotary.cpp measures, rotary_result.cpp judges; rotary_json
/// and html_rotary.cpp write. fixture-calibration.json is calibration_file().
class RotaryResult final : public AnalysisResult {
 public:
  explicit RotaryResult(RotaryFacts facts) : facts_(std::move(facts)) {}

  [[nodiscard]] core::Result<AnalysisValue> value_of(
      const record::Characteristic& characteristic) const override;
  [[nodiscard]] ValueOperator operator_of(const record::Characteristic& characteristic,
                                          const std::string& temperature) const override;
  [[nodiscard]] std::string filter_text() const override;
  [[nodiscard]] std::string sampling_text() const override;
  [[nodiscard]] nlohmann::ordered_json json() const override;
  [[nodiscard]] std::string html(const record::RunRecord& record, int feature) const override;
  [[nodiscard]] std::vector<SummaryLine> summary() const override;
  /// The calibration as other runs read it.
  [[nodiscard]] std::string calibration_file() const override;

 private:
  RotaryFacts facts_;
};

/// One axis as a report shows it: key, name and which study it is.
struct AxisFacts {
  const char* key = "";
  const char* name = "";
  const fit::RotaryStudy* study = nullptr;
  const fixture::StationMotion* motion = nullptr;
};
[[nodiscard]] std::vector<AxisFacts> axes_of(const RotaryFacts& facts);

}  // namespace rondure::reports
