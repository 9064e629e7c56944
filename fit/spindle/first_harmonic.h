#pragma once

#include <complex>

#include <Eigen/Core>

#include "fit/spindle/three_probe.h"

// At one undulation the weighted sum of three probes must vanish. Errors of gains and angles leave
// a part of the eccentricity there, so that this content is an observation of them.

namespace rondure::fit {

/// Errors of the probes: relative gains of P1..P3, angles [rad] (real minus stated), drifts [mm per
/// revolution], then the cosine and sine of the encoder error at one cycle per turn [rad].
constexpr int kProbeErrors = 11;
constexpr int kFirstGain = 0;
constexpr int kFirstAngle = 3;
constexpr int kFirstDrift = 6;
constexpr int kFirstEncoder = 9;
using ProbeErrors = Eigen::Matrix<double, kProbeErrors, 1>;
using ProbeErrorCovariance = Eigen::Matrix<double, kProbeErrors, kProbeErrors>;

/// Limit of FirstHarmonic::chi2: 0.999 of chi square with two degrees of freedom.
constexpr double kFirstHarmonicLimit = 13.816;

/// The content of the weighted sum at one undulation as an observation H(1) = A q + noise of the
/// errors q of the probes.
struct FirstHarmonic {
  std::complex<double> sum_mm;  ///< H(1), the mean of H e^{-j theta}.
  Eigen::Matrix<double, 2, kProbeErrors> sensitivity =
      Eigen::Matrix<double, 2, kProbeErrors>::Zero();  ///< A: real part, imaginary part.
  double u_mm = 0.0;                       ///< Standard uncertainty of each part of H(1) by noise.
  ProbeErrors mean = ProbeErrors::Zero();  ///< q_mean: expected errors, given H(1).
  ProbeErrorCovariance covariance = ProbeErrorCovariance::Zero();  ///< S: theirs, given H(1).
  /// S0 A^T V^-1, which makes q_mean from H(1), and draws given H(1) from free draws.
  Eigen::Matrix<double, kProbeErrors, 2> gain = Eigen::Matrix<double, kProbeErrors, 2>::Zero();
  /// H(1) over its covariance by the declared errors and the noise, two degrees of freedom. Above
  /// kFirstHarmonicLimit the declared gains and angles contradict the readings.
  double chi2 = 0.0;
  double u_lambda = 0.0;      ///< Standard uncertainty with which H(1) shows Lambda.
  double prior_lambda = 0.0;  ///< Standard deviation of one part of Lambda, as declared.

  /// Whether the eccentricity is too small for H(1) to tell anything about gains and angles. Errors
  /// declared as zero have nothing to tell.
  [[nodiscard]] bool blind() const { return prior_lambda > 0.0 && 3.0 * u_lambda > prior_lambda; }
};

/// Compares the content at one undulation with the declared errors of the probes.
///
///     Lambda = sum_i w_i (g_i + j d_i) e^{j Phi_i},   zeta = (RY - j RX) e^{j beta}
///     H(1) = (zeta_1 Lambda + conj(zeta_-1 Lambda)) / 2 + noise
///
/// zeta holds the eccentricity, so that an eccentricity of some um makes every wrong gain or angle
/// visible, and one of zero hides them all.
/// @param prior  Covariance of the errors as declared.
/// Source: methods, analyses_uncertainty 2.3, 2.4.
[[nodiscard]] FirstHarmonic observe_first_harmonic(const ThreeProbeResult& result,
                                                   const ProbeErrorCovariance& prior);

}  // namespace rondure::fit
