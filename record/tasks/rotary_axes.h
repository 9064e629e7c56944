#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/key_spec.h"
#include "record/tasks/analysis_influences.h"

namespace rondure::record {

/// One ball of the artefact.
struct BallTask {
  std::string id;
  std::array<double, 3> center_mm = {0.0, 0.0, 0.0};  ///< Nominal, body frame.
};

struct CombinedPoseTask {
  double alpha_deg = 0.0;
  double beta_deg = 0.0;
};

/// How a feature of the type "rotary_axes" is measured and evaluated, as plan and journal spell it:
/// calibration of the fixture with balls that it carries. A member initialiser is the default of
/// its key.
struct RotaryTask {
  std::vector<BallTask> balls;
  double ball_diameter_mm = 10.0;  ///< Calibrated; held constant while centres are fitted.
  int points = 9;                  ///< Touches of each ball in each pose.
  double uncertainty_mm = 0.5;     ///< Largest distance of a ball from its nominal place.
  std::vector<double> alpha_stations_deg;
  std::vector<double> beta_stations_deg;
  std::vector<CombinedPoseTask> verification;  ///< Poses that the fit does not use.
  double valid_for_days = 365.0;
  std::optional<RotaryInfluencesTask> uncertainty;
};

template <class Visitor>
void describe(Visitor& v, BallTask& p) {
  v.text("id", p.id,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name of the ball in the report, unique."});
  v.numbers("center_mm", p.center_mm,
            within(1000.0, "Nominal centre, frame of the clamping ring."));
}

template <class Visitor>
void describe(Visitor& v, CombinedPoseTask& p) {
  const auto angle = [](std::string_view meaning) {
    return NumberSpec{.at_least = -90.0,
                      .at_most = 90.0,
                      .required = true,
                      .code = core::Code::kPoseRange,
                      .meaning = meaning};
  };
  v.number("alpha_deg", p.alpha_deg, angle("About the base-fixed axis; not 0."));
  v.number("beta_deg", p.beta_deg, angle("About the carried axis; not 0."));
}

template <class Visitor>
void describe(Visitor& v, RotaryTask& p) {
  const auto stations = [](std::string_view meaning) {
    return NumberSpec{.at_least = -90.0,
                      .at_most = 90.0,
                      .required = true,
                      .code = core::Code::kPoseRange,
                      .meaning = meaning};
  };
  v.list(
      "balls", p.balls,
      {.required = true,
       .empty_allowed = false,
       .meaning =
           "At least 3, not on one line; better 4 or more, spread around the place of the parts."});
  v.number("ball_diameter_mm", p.ball_diameter_mm,
           range(1.0, 200.0, "Calibrated diameter of the balls, held while centres are fitted."));
  v.whole("points", p.points, range(5, 100, "Touches of each ball in each pose."));
  v.number("uncertainty_mm", p.uncertainty_mm,
           range(0.0, 50.0, "Largest distance of a ball from its nominal place."));
  v.numbers("alpha_stations_deg", p.alpha_stations_deg,
            stations("Measured angles of the base-fixed axis, the carried one at 0; the zero pose "
                     "comes besides. Their ends limit the calibration."));
  v.numbers("beta_stations_deg", p.beta_stations_deg, stations("The same of the carried axis."));
  v.list("verification", p.verification,
         {.required = true,
          .empty_allowed = false,
          .meaning = "At least 5 poses of both axes, not used to find the errors: their residual "
                     "is the figure of the calibration."});
  v.number("valid_for_days", p.valid_for_days,
           above(0.0, 36'500.0, "How long other runs may use the calibration."));
  v.object("uncertainty", p.uncertainty,
           {.meaning = "Declared influences: standard uncertainty, or value and distribution. "
                       "Without them: no interval."});
}

}  // namespace rondure::record
