#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cmm/error_model.h"
#include "core/result.h"

namespace rondure::evaluation {

/// What the probe adds to a touch.
struct ProbeInfluences {
  /// Standard deviation of a single touch along its approach [mm]; normal. The mean of q repeats
  /// has it divided by sqrt(q).
  double repeatability_mm = 0.0;
  bool repeatability_known = true;  ///< false: nobody declared or found it.
  /// Degrees of freedom that stand behind it; 0: it is known.
  double degrees_of_freedom = 0.0;
  /// Way along the surface over which the errors of touches that follow one another lose 1/e of
  /// their likeness [mm]: of a scan. 0: each touch anew.
  double correlation_length_mm = 0.0;
  /// Lobes of the pre-travel: order and amplitude [mm]. The phase is taken as unknown (uniform),
  /// whatever stands in `phase_rad`.
  std::vector<cmm::PretravelLobe> lobes;
  /// Limit of the probing form error P_FTU of ISO 10360-5 [mm], where repeatability and lobes are
  /// not known: 25 touches of a sphere. Normal with P / 3.93, the mean range of 25 normal values.
  double form_limit_mm = 0.0;
  /// Standard uncertainty of the qualified tip radius [mm]; normal. Moves a radius, no form.
  double tip_radius_mm = 0.0;
};

/// What the geometry of the machine adds.
struct MachineInfluences {
  /// Term by term: each coefficient is the standard uncertainty of that coefficient (normal); a
  /// wave has its amplitude and period known and its phase unknown (uniform).
  cmm::GeometricErrors terms;
  /// Limit of the length error of ISO 10360-2: constant + length * slope. The constant: two
  /// touches, independent, rectangular, so that their difference has constant / sqrt(3). The slope:
  /// scales of three axes and three squarenesses, each rectangular within +-slope.
  double length_limit_mm = 0.0;
  double length_limit_slope = 0.0;  ///< mm/mm; 1/K of "A + L/K".
};

/// What temperature adds.
struct ThermalInfluences {
  double temperature_K = 0.0;  ///< Standard uncertainty of the mean part temperature; normal.
  double expansion_1_K = 0.0;  ///< Of the part.
  double expansion_uncertainty_1_K = 0.0;  ///< Standard uncertainty of it; normal.
  double from_reference_K = 0.0;           ///< Mean part temperature minus 20 degC.
  /// The part temperature moves by at most +- this from the first to the last touch, evenly in
  /// time; rectangular.
  double drift_K = 0.0;
  /// The reading of a fixed point moves by at most +- this from the first to the last touch, evenly
  /// in time, each machine axis; rectangular.
  Eigen::Vector3d machine_drift_mm = Eigen::Vector3d::Zero();
};

/// What the fixture adds. One pose is one rigid motion and moves no form; poses that are put
/// together, and a part that creeps while it is touched, do.
struct FixtureInfluences {
  double angle_rad = 0.0;    ///< Standard uncertainty of a pose about each machine axis; normal.
  double position_mm = 0.0;  ///< Of the pivot in a pose, along each machine axis; normal.
  double creep_rad = 0.0;    ///< At most +- this about each axis from the first to the last touch,
                             ///< evenly in time; rectangular.
  std::optional<Eigen::Vector3d> pivot_mm;  ///< Machine frame; none: the middle of the points.
};

/// What is declared about a measurement. A group that is absent was not declared: the result says
/// that it is not covered. A value of zero in a group that is there means: known to be nothing.
struct Influences {
  std::optional<ProbeInfluences> probe;
  std::optional<MachineInfluences> machine;
  std::optional<ThermalInfluences> thermal;
  std::optional<FixtureInfluences> fixture;
};

/// One line of the declaration in the manner of ISO/TS 15530-4: what the simulation covers.
struct InfluenceStatement {
  std::string name;      ///< "probe-repeatability": stable, kebab-case.
  bool covered = false;  ///< Whether the interval contains it.
  core::Phrase text;     ///< With number, unit and distribution; or why it is not covered.
};

/// kBadOption for a number that is not finite or below zero, naming it.
[[nodiscard]] core::Result<void> check_influences(const Influences& influences);

/// Every influence of a form measurement, covered or not, in a fixed order.
[[nodiscard]] std::vector<InfluenceStatement> influence_statements(const Influences& influences);

}  // namespace rondure::evaluation
