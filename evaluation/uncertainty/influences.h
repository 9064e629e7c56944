#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cmm/error_model.h"
#include "core/result.h"

namespace rondure::evaluation {

/// Mean range of 25 normal values, as the touches of a qualification.
inline constexpr double kRangeOf25Touches = 3.93;

/// Uncertainty contributions of the probe.
struct ProbeInfluences {
  /// Standard deviation of a single touch along its approach [mm]; normal. The mean of q repeats
  /// has this value divided by sqrt(q).
  double repeatability_mm = 0.0;
  bool repeatability_known = true;  ///< false: neither declared nor determined.
  /// Degrees of freedom of the repeatability; 0: known exactly.
  double degrees_of_freedom = 0.0;
  /// Path length along the surface over which the correlation of the errors of successive touches
  /// falls to 1/e [mm]; for scans. 0: independent touches.
  double correlation_length_mm = 0.0;
  /// Lobes of the pre-travel: order and amplitude [mm]. The phase is treated as unknown (uniform),
  /// whatever `phase_rad` holds.
  std::vector<cmm::PretravelLobe> lobes;
  /// Limit of the probing form error P_FTU of ISO 10360-5 [mm], for unknown repeatability and
  /// lobes: 25 touches of a sphere. Normal with P / 3.93, where 3.93 is the mean range of 25 normal
  /// values.
  double form_limit_mm = 0.0;
  /// Standard uncertainty of the qualified tip radius [mm]; normal. Changes a radius, no form.
  double tip_radius_mm = 0.0;
  /// Standard uncertainty of the certified radius of the reference sphere [mm]; normal. It enters
  /// the tip radius, and every size of the run alike.
  double reference_sphere_mm = 0.0;
};

/// Uncertainty contributions of the machine geometry.
struct MachineInfluences {
  /// Term by term: each coefficient is the standard uncertainty of that coefficient (normal); a
  /// wave has a known amplitude and period and an unknown phase (uniform).
  cmm::GeometricErrors terms;
  /// Limit of the length error of ISO 10360-2: constant + length * slope. Constant: two
  /// independent, rectangular touches whose difference has the standard deviation constant /
  /// sqrt(3). Slope: scales of three axes and three squarenesses, each rectangular within +-slope.
  double length_limit_mm = 0.0;
  double length_limit_slope = 0.0;  ///< mm/mm; 1/K in "A + L/K".
};

/// Uncertainty contributions of temperature.
struct ThermalInfluences {
  double temperature_K = 0.0;  ///< Standard uncertainty of the mean part temperature; normal.
  double expansion_1_K = 0.0;  ///< Expansion coefficient of the part.
  double expansion_uncertainty_1_K = 0.0;  ///< Standard uncertainty of `expansion_1_K`; normal.
  double from_reference_K = 0.0;           ///< Mean part temperature minus 20 degC.
  /// Greatest change (+-) of the part temperature from the first to the last touch, linear in time;
  /// rectangular.
  double drift_K = 0.0;
  /// Greatest change (+-) of the reading of a fixed point from the first to the last touch, linear
  /// in time, for each machine axis; rectangular.
  Eigen::Vector3d machine_drift_mm = Eigen::Vector3d::Zero();
  /// Whether the drifts were declared; the temperature itself is stated by the environment.
  bool drifts_declared = true;
};

/// Uncertainty contributions of the fixture. One pose is one rigid motion and changes no form;
/// combining poses does, and so does a part that creeps while it is touched.
struct FixtureInfluences {
  double angle_rad = 0.0;  ///< Standard uncertainty of a pose about each machine axis; normal.
  /// Standard uncertainty of the pivot in a pose, along each machine axis; normal.
  double position_mm = 0.0;
  /// Greatest rotation (+-) about each axis from the first to the last touch, linear in time;
  /// rectangular.
  double creep_rad = 0.0;
  std::optional<Eigen::Vector3d> pivot_mm;  ///< Machine frame; none: the centre of the points.
};

/// What the calibration of the fixture leaves in the poses of a cloud, as displacements of the
/// body: fixture::calibration_draws(), growth_draws(). Poses share the draws, so that what is
/// common to all of them moves no form.
struct CalibrationInfluences {
  std::string id;  ///< Of the calibration.
  int poses = 1;   ///< Of the cloud.
  /// Six rows for each pose, one column for each draw; normal. Columns may be absent of one pose,
  /// which moves as a whole.
  Eigen::MatrixXd draws = {};
  /// The same for the temperature between calibration and use, half-widths; rectangular. None: the
  /// temperature of either, or the expansion of the fixture, is not known.
  std::optional<Eigen::MatrixXd> growth = {};
  double change_K = 0.0;           ///< Temperature of use less that of the calibration.
  std::optional<double> age_days;  ///< At the start of the run.
};

/// Declared uncertainty contributions of a measurement. A group that is absent was not declared:
/// the result states that it is not covered. A zero in a group that is present means: known to be
/// zero.
struct Influences {
  std::optional<ProbeInfluences> probe;
  std::optional<MachineInfluences> machine;
  std::optional<ThermalInfluences> thermal;
  std::optional<FixtureInfluences> fixture;
  bool no_fixture = false;  ///< The part stood still, without a fixture: nothing is said of one.
  std::optional<CalibrationInfluences> calibration;  ///< None: the run used none.
  /// Probing form that the qualification of this run showed: a fact, which the declaration quotes
  /// where no probing form is declared. None: nothing was touched.
  std::optional<double> probing_span_mm = {};
};

/// One line of the declaration according to ISO/TS 15530-4: whether the simulation covers an
/// influence.
struct InfluenceStatement {
  std::string name;      ///< "probe-repeatability": stable, kebab-case.
  bool covered = false;  ///< Whether the interval contains it.
  core::Phrase text;     ///< With number, unit and distribution; or why it is not covered.
};

/// kBadOption for a number that is not finite or below zero, naming it.
[[nodiscard]] core::Result<void> check_influences(const Influences& influences);

/// Every influence of a form measurement, covered or not, in a fixed order.
[[nodiscard]] std::vector<InfluenceStatement> influence_statements(const Influences& influences);

/// Whether its group is declared, with zero for it: the interval contains nothing of it.
[[nodiscard]] bool is_taken_as_zero(const InfluenceStatement& line);

/// Whether the declaration of an interval covers how the pre-travel changes with the direction:
/// lobes, or a limit of the probing form.
[[nodiscard]] bool covers_probing_form(const std::vector<InfluenceStatement>& declaration);

}  // namespace rondure::evaluation
