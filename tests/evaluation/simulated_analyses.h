#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "record/run_record.h"
#include "record/tasks/contour.h"
#include "record/tasks/spindle.h"
#include "record/tasks/wheel.h"

// Runs of spindles, wheels, contours and ball plates for the tests of their gates and intervals.
// They are made by plain formulas of the method specification, without code of the fits, of the
// evaluation or of the simulated machine, so that an error there is not repeated here.

namespace rondure::reports {

/// Draws exactly as the method specification makes those of its worked cases: splitmix64, two draws
/// for one normal by Box-Muller.
class Normals {
 public:
  explicit Normals(std::uint64_t seed) : state_(seed) {}
  [[nodiscard]] double uniform();  ///< In [0, 1).
  [[nodiscard]] double normal();
  [[nodiscard]] double phase_rad();  ///< Uniform over a turn.

 private:
  std::uint64_t state_;
};

/// amplitude cos(order angle - phase).
struct Wave {
  double order = 0.0;  ///< Undulations of a turn; not whole: it differs from turn to turn.
  double amplitude_um = 0.0;
  double phase_rad = 0.0;
};
[[nodiscard]] double sum_um(const std::vector<Wave>& waves, double angle_rad);

/// A declared influence, normal with this standard uncertainty.
[[nodiscard]] record::Influence declared(double standard_uncertainty);

/// A characteristic about the least-squares reference.
[[nodiscard]] record::Characteristic asked(record::Form form,
                                           std::optional<double> tolerance_um = std::nullopt);

/// A run and the truth of its characteristics, in their order.
struct Inspection {
  record::RunRecord run;
  std::vector<double> truth_um;
};

// ---- Three probes -------------------------------------------------------------------------------

/// A crank pin on a swing arm under three probes: specification, section 2.1 to first order.
struct SimulatedSpindle {
  double crank_mm = 49.0;
  double wheel_mm = 299.88;
  double pin_mm = 24.56;
  std::array<double, 3> places_rad = {};  ///< True places of the probes.
  std::array<double, 3> gains_1 = {1.0, 1.0, 1.0};
  std::array<double, 3> zeros_um = {1.2, -0.7, 0.4};
  std::vector<Wave> profile;   ///< Over theta; orders 2 and above.
  std::vector<Wave> motion_x;  ///< Over alpha; orders 2 and above.
  std::vector<Wave> motion_y;
  std::vector<Wave> asynchronous_x;  ///< Over alpha, orders that are not whole.
  std::vector<Wave> asynchronous_y;
  double eccentricity_um = 6.0;
  double eccentricity_rad = 0.0;
  double noise_um = 0.0;
  int turns = 4;
  int samples_per_turn = 512;

  [[nodiscard]] double beta_rad(double alpha_rad) const;
  [[nodiscard]] double reading_um(std::size_t probe, double alpha_rad) const;
};

/// Stated places of the probes: 0 and these, from P1 [deg].
[[nodiscard]] std::array<double, 3> stated_places_deg(record::SpindleTask::Layout layout);

/// Profile, motion and eccentricity of the worked cases S-1 to S-4, probes at their stated places.
[[nodiscard]] SimulatedSpindle worked_spindle(record::SpindleTask::Layout layout);

/// The settings that belong to it; nothing is declared.
[[nodiscard]] record::SpindleTask spindle_task(record::SpindleTask::Layout layout,
                                               const SimulatedSpindle& world);

/// A run of it, the order of draws: turn, probe, sample.
[[nodiscard]] record::RunRecord spindle_run(const SimulatedSpindle& world,
                                            const record::SpindleTask& task, Normals& draws);

/// Peak to valley of the profile after a Gaussian low pass of 50 UPR; its root mean square; the
/// greater peak to valley of X and Y, eccentricity and zeros fitted out; the greatest spread of the
/// turns at one angle, of X or of Y.
[[nodiscard]] double true_roundness_um(const SimulatedSpindle& world);
[[nodiscard]] double true_roundness_rms_um(const SimulatedSpindle& world);
[[nodiscard]] double true_synchronous_um(const SimulatedSpindle& world);
[[nodiscard]] double true_asynchronous_um(const SimulatedSpindle& world);

// ---- Wheel --------------------------------------------------------------------------------------

/// Points of the edge of a wheel at rest: the worked cases W-1 to W-3.
struct SimulatedWheel {
  double radius_mm = 49.9832;
  Eigen::Vector2d axis_mm = {12.004, -7.0};
  double eccentricity_um = 5.0;
  double eccentricity_rad = 0.0;
  std::vector<Wave> lobes;
  std::vector<double> places_rad;  ///< Of the points, about the centre of the wheel.
  double point_um = 0.4;           ///< Noise along the radius.
  double axis_um = 0.5;            ///< Error of each coordinate of the stated axis.
  std::optional<std::size_t> proud_point;
  double proud_um = 0.0;
};
[[nodiscard]] SimulatedWheel worked_wheel(std::vector<double> places_rad);
/// 16 points about the whole turn; 8 points from 240 to 300 deg.
[[nodiscard]] std::vector<double> whole_turn();
[[nodiscard]] std::vector<double> short_arc();

constexpr double kNominalRadius_mm = 49.5;  // far enough for a departure that is never near 0

/// The order of draws: the points, then the axis.
[[nodiscard]] record::RunRecord wheel_run(const SimulatedWheel& world, record::WheelTask task,
                                          Normals& draws);
/// Of the noise-free points about the true axis; about their least-squares circle. The latter holds
/// for lobes whose sums with one undulation vanish over the points.
[[nodiscard]] double true_run_out_um(const SimulatedWheel& world);
[[nodiscard]] double true_wheel_roundness_um(const SimulatedWheel& world);

// ---- Contour ------------------------------------------------------------------------------------

/// Ground crank pins: specification, sections 2 and 5 of the contour to first order.
struct SimulatedContour {
  double crank_mm = 49.0;
  double wheel_mm = 299.88;
  double pin_mm = 24.56;
  std::vector<Wave> x_error;           ///< Over alpha, shown by the trace.
  std::vector<Wave> c_error;           ///< The same, in urad.
  std::vector<double> c_scale;         ///< Of each part.
  std::vector<std::vector<Wave>> own;  ///< What does not follow the axes, of each part, over beta.
  std::vector<Wave> x_unseen;          ///< Errors of the encoders, in no trace.
  std::vector<Wave> c_unseen;          ///< In urad.
  // Of the gauge, one draw for all parts.
  double gain_1 = 1.0;
  double phase_rad = 0.0;
  std::vector<Wave> gauge_form;
  double gauge_um = 0.1;  ///< Noise of a reading.
  double c_trace_mdeg = 0.02;
  double x_trace_um = 0.05;

  [[nodiscard]] double contour_um(std::size_t part, double beta_rad) const;
};

[[nodiscard]] record::RunRecord contour_run(const SimulatedContour& world,
                                            const record::ContourTask& task, Normals& draws);
/// The greatest peak to valley of the parts, and their spread, after a Gaussian low pass of 50 UPR.
struct ContourTruth {
  double deviation_um = 0.0;
  double spread_um = 0.0;
};
[[nodiscard]] ContourTruth true_contour(const SimulatedContour& world);

// ---- Fixture ------------------------------------------------------------------------------------

/// A ball plate touched in a fixture without errors, at one temperature of the part, under limits
/// of 18 to 22 degC.
[[nodiscard]] record::RunRecord ball_plate_run(double temperature_degC, Normals& draws);

}  // namespace rondure::reports
