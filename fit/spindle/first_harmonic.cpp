#include "fit/spindle/first_harmonic.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "core/units.h"
#include "fit/spindle/internal/three_probe_parts.h"

namespace rondure::fit {
namespace {

/// Means of values times e^{-j k theta}.
class Means {
 public:
  explicit Means(const ThreeProbeResult& result) {
    const std::size_t count = result.profile.r_mm.size();
    for (std::size_t n = 0; n < count; ++n)
      turns_.push_back(std::polar(1.0, -result.profile.angle_rad(n)));
  }

  /// @param value  Value of a sample.
  template <class Value>
  [[nodiscard]] Complex first(const Value& value) const {
    Complex sum;
    for (std::size_t n = 0; n < turns_.size(); ++n) sum += turns_[n] * value(n);
    return sum / static_cast<double>(turns_.size());
  }
  /// The mean of values times e^{+j theta}.
  template <class Value>
  [[nodiscard]] Complex minus_first(const Value& value) const {
    Complex sum;
    for (std::size_t n = 0; n < turns_.size(); ++n) sum += std::conj(turns_[n]) * value(n);
    return sum / static_cast<double>(turns_.size());
  }

 private:
  Spectrum turns_;
};

void set(Eigen::Matrix<double, 2, kProbeErrors>& matrix, int column, Complex value) {
  matrix(0, column) = value.real();
  matrix(1, column) = value.imag();
}

}  // namespace

FirstHarmonic observe_first_harmonic(const ThreeProbeResult& result,
                                     const ProbeErrorCovariance& prior) {
  const Means means(result);
  const auto& w = result.layout.weights();
  const auto angles = result.layout.angles_rad();
  const CentreMotion motion = motion_without_zeros(result);
  const auto zeta = [&](std::size_t n) {
    return Complex(motion.y_mm[n], -motion.x_mm[n]) * std::polar(1.0, result.beta_rad[n]);
  };
  const Complex plus = means.first(zeta);
  const Complex minus = std::conj(means.minus_first(zeta));
  const auto ramp = [&](std::size_t n) {
    return (result.alpha_rad[n] - result.alpha_rad[0]) / core::kTwoPi;
  };
  const Complex ramp_1 = means.first(ramp);
  const std::size_t count = result.alpha_rad.size();
  const double step = 2.0 * core::kTwoPi / static_cast<double>(count);

  FirstHarmonic out;
  Eigen::Matrix<double, 2, 6> lambda;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto& h = result.mean_readings_mm[at];
    out.sum_mm +=
        w[at] * (means.first([&](std::size_t n) { return h[n]; }) - result.drift_mm[at] * ramp_1);
    const Complex turn = w[at] * std::polar(1.0, angles[at]);  // a weight may be below 0
    const Complex sideways = Complex(0.0, 1.0) * turn;
    set(out.sensitivity, kFirstGain + i, 0.5 * (plus * turn + minus * std::conj(turn)));
    set(out.sensitivity, kFirstAngle + i, 0.5 * (plus * sideways + minus * std::conj(sideways)));
    lambda.col(i) << turn.real(), turn.imag();
    lambda.col(3 + i) << sideways.real(), sideways.imag();
    // With several revolutions the ramp of the weighted sum has been removed.
    if (result.revolutions == 1) set(out.sensitivity, kFirstDrift + i, w[at] * ramp_1);
    const auto slope = [&](std::size_t n) {
      return (h[(n + 1) % count] - h[(n + count - 1) % count]) / step;
    };
    const Complex cosine = w[at] * means.first([&](std::size_t n) {
      return slope(n) * std::cos(result.alpha_rad[n]);
    });
    const Complex sine = w[at] * means.first([&](std::size_t n) {
      return slope(n) * std::sin(result.alpha_rad[n]);
    });
    out.sensitivity.col(kFirstEncoder) += Eigen::Vector2d(cosine.real(), cosine.imag());
    out.sensitivity.col(kFirstEncoder + 1) += Eigen::Vector2d(sine.real(), sine.imag());
  }
  // The limit is three standard uncertainties of an amplitude over the weight norm, and not below
  // what probes can do at all; a part of H(1) is half of an amplitude.
  out.u_mm = result.first_harmonic_limit_mm / 3.0 * result.layout.weight_norm() / 2.0;
  out.u_lambda = result.eccentricity_mm > 0.0 ? 2.0 * out.u_mm / result.eccentricity_mm
                                              : std::numeric_limits<double>::infinity();
  const Eigen::Matrix<double, 6, 6> probes = prior.topLeftCorner<6, 6>();
  out.prior_lambda = std::sqrt(0.5 * (lambda * probes * lambda.transpose()).trace());

  const Eigen::Vector2d found(out.sum_mm.real(), out.sum_mm.imag());
  const Eigen::Matrix2d expected = out.sensitivity * prior * out.sensitivity.transpose() +
                                   out.u_mm * out.u_mm * Eigen::Matrix2d::Identity();
  if (!(expected.determinant() > 0.0)) {  // readings of 0 throughout
    out.covariance = prior;
    return out;
  }
  const Eigen::Matrix2d inverse = expected.inverse();
  out.gain = prior * out.sensitivity.transpose() * inverse;
  out.mean = out.gain * found;
  out.covariance = prior - out.gain * out.sensitivity * prior;
  out.chi2 = found.dot(inverse * found);
  return out;
}

}  // namespace rondure::fit
