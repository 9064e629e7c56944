#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "fit/geometry/swing_arm.h"
#include "fit/profiles/closed_profile.h"
#include "fit/profiles/profile_filter.h"
#include "fit/spindle/probe_layout.h"

namespace rondure::fit {

/// Readings of three probes in order of time, over one revolution or more.
struct ProbeReadings {
  std::vector<double> alpha_rad;            ///< Rotation of the work, increasing, not wrapped.
  std::vector<double> beta_rad;             ///< Measured swing of the arm; empty: from SwingArm.
  std::array<std::vector<double>, 3> h_mm;  ///< Positive when the surface moves outward [mm].
};

/// Settings of separate_three_probe().
struct ThreeProbeOptions {
  /// kAuto: for more than 10 um of motion. Needs the radius of the part.
  enum class SecondOrder { kAuto, kOff, kOn };
  /// kAsPublished: RY by the printed formula, which is wrong; for comparison only.
  enum class Motion { kLeastSquares, kAsPublished };

  int samples = 1024;              ///< N of a revolution; >= 2 highest + 2. 0: as many as recorded.
  int highest = 50;                ///< Harmonics 2..highest are recovered; >= 2.
  double greatest_gain = 100.0;    ///< A harmonic with a greater gain is not recovered; >= 1.
  double warn_gain = 25.0;         ///< A harmonic with a greater gain is named in a warning.
  std::optional<double> noise_mm;  ///< Standard deviation of a reading; none: estimated.
  double tip_width_mm = 0.0;       ///< Of tips or spots, 2 b; needs the radius of the part.
  SecondOrder second_order = SecondOrder::kAuto;
  Motion motion = Motion::kLeastSquares;
  /// false: content at one undulation above its limit is no contradiction, because the caller
  /// compares it with the declared errors of gains and angles (first_harmonic.h).
  bool judge_first_harmonic = true;
};

/// One harmonic of the part.
struct RecoveredHarmonic {
  int order = 2;
  bool recovered = false;     ///< false: 0 in the profile; its motion-like share is in the motion.
  double amplitude_mm = 0.0;  ///< A in r = sum A cos(k theta - phase).
  std::optional<double> phase_rad;  ///< Absent below three standard uncertainties.
  double transfer = 0.0;            ///< |G|.
  double gain = 0.0;                ///< Noise gain g.
  double sigma_mm = 0.0;            ///< Standard uncertainty of the amplitude, g s sqrt(2/n).
  /// What the width of the tips left of it, 2 J1(x)/x with x = k b / R: amplitude and sigma are
  /// divided by it. 0: x is above 2.5, the order is void.
  double tip = 1.0;

  [[nodiscard]] bool known() const { return recovered && tip > 0.0; }
};

/// Motion of the part's centre, X and Y over the samples of one revolution [mm].
struct CentreMotion {
  std::vector<double> x_mm;
  std::vector<double> y_mm;
};

/// Part and motion, separated. theta_rad[n] = start + 2 pi n / N.
struct ThreeProbeResult {
  ProbeLayout layout;
  int revolutions = 1;
  std::size_t readings = 0;            ///< Rows used.
  bool interpolated = false;           ///< Resampled to uniform theta by even_samples().
  UniformProfile profile = {};         ///< r(theta) without harmonics 0 and 1.
  std::vector<double> alpha_rad = {};  ///< Work angle of each sample, in the first revolution.
  std::vector<double> beta_rad = {};
  std::vector<RecoveredHarmonic> harmonics = {};  ///< 2..highest.
  std::vector<int> unrecovered = {};              ///< Harmonics above the greatest gain.
  /// What the readings hold from there to twice the highest order, as far as the samples leave it
  /// unchanged. It is not in the profile, although a filter may pass it.
  std::vector<RecoveredHarmonic> beyond = {};
  std::optional<PassedFilter> passed = {};  ///< That the readings have passed, by their fall.

  std::vector<CentreMotion> motion =
      {};                         ///< One per revolution, without eccentricity and probe zeros.
  CentreMotion mean_motion = {};  ///< Their mean: the synchronous part.
  CentreMotion mean_motion_before = {};  ///< Mean before removal of eccentricity and zeros.
  double eccentricity_mm = 0.0;          ///< |c| of c e^{j alpha}; includes motion of that shape.
  double eccentricity_rad = 0.0;         ///< Its direction on the part: a cos + b sin, atan2(b, a).
  /// Amplitude of what turns once a turn against the work. An eccentric part does so where the
  /// probe angles are counted in the wrong sense.
  double against_work_mm = 0.0;

  double tip_width_mm = 0.0;  ///< Taken out of the profile; 0: not stated.
  double noise_mm = 0.0;      ///< s: stated or estimated.
  /// Estimated from the scatter of the revolutions; for a single one, from the weighted sum above
  /// the highest harmonic.
  bool noise_estimated = false;
  double profile_sigma_mm = 0.0;  ///< rms standard uncertainty of r.
  /// Content of the weighted sum at k = 1, where it must vanish, over the weight norm. Above its
  /// limit (3 standard uncertainties), angles, gains or theta are wrong. A value below the limit
  /// proves nothing.
  double first_harmonic_mm = 0.0;
  double first_harmonic_limit_mm = 0.0;
  /// The relative gain error (or angle error [rad]) of any one probe that the eccentricity surely
  /// raises above that limit; a smaller error may go unnoticed. Infinite without eccentricity.
  double least_error_shown = std::numeric_limits<double>::infinity();
  double residual_rms_mm =
      0.0;  ///< Residual of the redundant equation, over the weight norm, without k = 0.
  int second_order_passes = 0;
  /// Mean revolution of each probe on the samples, corrected to the first order: the input of
  /// separation_model.h.
  std::array<std::vector<double>, 3> mean_readings_mm = {};
  /// Increase of each probe per revolution; 0 for a single one.
  std::array<double, 3> drift_mm = {0.0, 0.0, 0.0};
  /// Standard deviation of a reading from the differences between the revolutions, for each
  /// harmonic 2..highest of the weighted sum; empty for a single revolution.
  std::vector<double> scatter_mm = {};
  /// Readings that contradict the stated probes, arm or angles, and invalid readings. They are also
  /// in `warnings`. If there is any, part and motion must not be judged.
  std::vector<core::Error> contradictions = {};
  std::vector<core::Error> warnings = {};

  /// Whether more than 1 um, and five times the eccentricity, turns against the work.
  [[nodiscard]] bool turns_against_work() const {
    return against_work_mm > std::max(1e-3, 5.0 * eccentricity_mm);
  }
};

/// Separates the form of a part from the motion of its centre with three probes.
///
/// The readings are resampled to N uniform values of theta = alpha + beta by a periodic spline over
/// all revolutions, with a low pass for more than N readings per revolution. The revolutions are
/// averaged, and H = H1 + k2 H2 + k3 H3 is divided by G(k), with the true angles, in the frequency
/// domain. The motion follows from H_i(theta) - r(theta + Phi_i) by least squares over the three
/// probes; the best fit of c e^{j alpha} + c0 e^{-j beta} (eccentricity, probe zeros) over the work
/// angle is removed: over theta, to which the swing of a tracked pin adds, it would take motion.
/// The width of the tips is taken out of the profile, not out of the motion.
///
/// @return kRank (layout); the errors of check_swing_arm(); kSampling (lengths differ, too few
///         readings, highest above N/2 - 1, or no data to estimate the noise); kNotFinite (row);
///         kAngleOrder (theta not increasing, row); kNotFullSection (less than one revolution);
///         kUnits (motion too large compared with the part for the second order); kBadOption.
///         Angles in degrees instead of radians are not detected. O(M log M): 1e5 samples in some
///         20 ms.
/// Source: methods, roundness A.2 to A.8.
[[nodiscard]] core::Result<ThreeProbeResult> separate_three_probe(
    const ProbeReadings& readings, const SwingArm& arm, const ProbeLayout& layout,
    const ThreeProbeOptions& options = {});

}  // namespace rondure::fit
