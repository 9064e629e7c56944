#include "fit/spindle/separation_model.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/decompositions.h"
#include "core/units.h"
#include "fit/spindle/internal/three_probe_parts.h"

namespace rondure::fit {
namespace {

constexpr double kMostNumbers = 4e6;        ///< 32 MB; trials of more take minutes.
constexpr std::size_t kPerUndulation = 12;  ///< A peak is missed by 3.4 % of its amplitude at most.

/// Columns 1, cos, sin, cos 2, sin 2, ... up to an order.
Eigen::MatrixXd waves(const std::vector<double>& angles_rad, int highest) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(angles_rad.size()), 2 * highest + 1);
  for (Eigen::Index n = 0; n < out.rows(); ++n) {
    const double angle = angles_rad[static_cast<std::size_t>(n)];
    out(n, 0) = 1.0;
    for (int k = 1; k <= highest; ++k) {
      out(n, 2 * k - 1) = std::cos(k * angle);
      out(n, 2 * k) = std::sin(k * angle);
    }
  }
  return out;
}

/// A ramp from -1/2 to 1/2 over the turn.
std::vector<double> ramp(const std::vector<double>& alpha_rad) {
  std::vector<double> out;
  for (const double alpha : alpha_rad) {
    out.push_back((alpha - alpha_rad.front()) / core::kTwoPi - 0.5);
  }
  return out;
}

Eigen::Map<const Eigen::VectorXd> vector_of(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// Every so many-th value, so that about `wanted` remain.
std::vector<double> thinned(const std::vector<double>& values, std::size_t wanted) {
  const std::size_t rows = std::min(values.size(), wanted);
  std::vector<double> out;
  for (std::size_t m = 0; m < rows; ++m) out.push_back(values[m * values.size() / rows]);
  return out;
}

}  // namespace

core::Result<SeparationModel> SeparationModel::of(const ThreeProbeResult& result) {
  const auto samples = static_cast<double>(result.alpha_rad.size());
  const double columns = 2.0 * result.harmonics.back().order + 1.0;
  if (samples * columns > kMostNumbers) {
    return core::fail(core::Code::kSampling,
                      core::phrase("{} samples with {} harmonics are too many for trials; reduce "
                                   "the samples of a revolution",
                                   result.alpha_rad.size(), result.harmonics.back().order));
  }
  return SeparationModel(result);
}

SeparationModel::SeparationModel(const ThreeProbeResult& result) : result_(result) {
  const int highest = result.harmonics.back().order;
  const std::size_t count = result.alpha_rad.size();
  // The swing makes the work angles uneven; three samples an undulation keep the fit well posed.
  highest_motion_ = std::max(2, std::min(highest, static_cast<int>((count - 1) / 3)));
  work_ = waves(result.alpha_rad, highest_motion_);
  const Eigen::MatrixXd normal = work_.transpose() * work_;
  normal_inverse_ = core::inverse_ldlt(normal);
  const std::size_t rows = kPerUndulation * static_cast<std::size_t>(highest);
  std::vector<double> theta;
  for (std::size_t n = 0; n < count; ++n) theta.push_back(result.profile.angle_rad(n));
  places_rad_ = thinned(theta, rows);
  profile_waves_ = waves(places_rad_, highest).rightCols(2 * (highest - 1));
  const Eigen::MatrixXd sparse = waves(thinned(result.alpha_rad, rows), highest_motion_);
  // A constant and one cycle a turn are not error motion; over the work the rest is free of them.
  motion_waves_ = sparse.rightCols(2 * (highest_motion_ - 1));
  const std::vector<double> over_turn = ramp(result.alpha_rad);
  ramp_ = vector_of(over_turn);
  turn_waves_.resize(sparse.rows(), sparse.cols() + 1);
  turn_waves_ << sparse, vector_of(thinned(over_turn, rows));
}

SpindleCurves SeparationModel::at(const ProbeErrors& q) const {
  return separate(result_.mean_readings_mm, result_.drift_mm, q);
}

SpindleCurves SeparationModel::of_readings(
    const std::array<std::vector<double>, 3>& readings_mm) const {
  return separate(readings_mm, {0.0, 0.0, 0.0}, ProbeErrors::Zero());
}

Eigen::VectorXd SeparationModel::over_work(const std::vector<double>& values) const {
  return normal_inverse_ * (work_.transpose() * vector_of(values));
}

Eigen::VectorXd SeparationModel::over_turn(const std::vector<double>& values) const {
  const auto all = vector_of(values);
  // Over half of the shortest wave, which the waves do not follow anyhow.
  const Eigen::Index few = std::max<Eigen::Index>(1, all.size() / (2 * highest_motion_));
  const double height = all.tail(few).mean() - all.head(few).mean();
  Eigen::VectorXd out(work_.cols() + 1);
  out << normal_inverse_ * (work_.transpose() * (all - height * ramp_)), height;
  return out;
}

std::array<double, 2> SeparationModel::motion_per_noise() const {
  const auto p = motion_solver(result_.layout.angles_rad());
  std::array<double, 2> power = {0.0, 0.0};
  for (const double beta : result_.beta_rad) {
    const Eigen::Matrix<double, 2, 3> turned = swung(p, beta);
    power[0] += turned.row(0).squaredNorm();
    power[1] += turned.row(1).squaredNorm();
  }
  const auto count = static_cast<double>(result_.beta_rad.size());
  return {std::sqrt(power[0] / count), std::sqrt(power[1] / count)};
}

SpindleCurves SeparationModel::separate(const std::array<std::vector<double>, 3>& readings_mm,
                                        const std::array<double, 3>& drift_mm,
                                        const ProbeErrors& q) const {
  const std::size_t count = result_.alpha_rad.size();
  std::array<double, 3> angles = result_.layout.angles_rad();
  for (int i = 0; i < 3; ++i) angles[static_cast<std::size_t>(i)] += q[kFirstAngle + i];
  // Weights that free the sum of all motion, from the angles between the probes.
  const double to_third = std::sin(angles[2] - angles[1]);
  const std::array<double, 3> weights = {1.0, -std::sin(angles[2] - angles[0]) / to_third,
                                         std::sin(angles[1] - angles[0]) / to_third};
  std::array<std::vector<double>, 3> h;
  std::vector<double> sum(count, 0.0);
  const double step = 2.0 * core::kTwoPi / static_cast<double>(count);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& read = readings_mm[i];
    const double gain = 1.0 + q[kFirstGain + static_cast<int>(i)];
    const double drift = q[kFirstDrift + static_cast<int>(i)];
    // Several revolutions show the drift of the sum, which is removed with its found value.
    const double of_sum = result_.revolutions > 1 ? drift_mm[i] : drift;
    for (std::size_t n = 0; n < count; ++n) {
      const double alpha = result_.alpha_rad[n];
      const double turned = (alpha - result_.alpha_rad[0]) / core::kTwoPi;
      const double late =
          q[kFirstEncoder] * std::cos(alpha) + q[kFirstEncoder + 1] * std::sin(alpha);
      const double slope = (read[(n + 1) % count] - read[(n + count - 1) % count]) / step;
      const double still = read[n] - late * slope;
      h[i].push_back((still - drift * turned) / gain);
      sum[n] += weights[i] * (still - of_sum * turned) / gain;
    }
  }
  const Spectrum f = spectrum(sum);
  Spectrum part(f.size());
  SpindleCurves out;
  out.profile_mm = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(result_.harmonics.size()));
  Eigen::Index row = 0;
  for (const RecoveredHarmonic& harmonic : result_.harmonics) {
    const auto k = static_cast<std::size_t>(harmonic.order);
    if (harmonic.recovered) {
      Complex transfer;
      for (std::size_t i = 0; i < 3; ++i)
        transfer += std::polar(1.0, harmonic.order * angles[i]) * weights[i];
      part[k] = f[k] / transfer;
      const double raised = harmonic.tip > 0.0 ? 1.0 / harmonic.tip : 0.0;
      const Complex c = 2.0 / static_cast<double>(count) * raised * part[k] *
                        std::polar(1.0, -harmonic.order * result_.profile.start_rad);
      out.profile_mm[row] = c.real();
      out.profile_mm[row + 1] = -c.imag();
    }
    row += 2;
  }
  std::array<std::vector<double>, 3> r;
  for (std::size_t i = 0; i < 3; ++i) r[i] = series_of(shifted(part, angles[i], 0), count);
  const auto p = motion_solver(angles);
  CentreMotion motion;
  for (std::size_t n = 0; n < count; ++n) {
    const Eigen::Vector3d m(h[0][n] - r[0][n], h[1][n] - r[1][n], h[2][n] - r[2][n]);
    const Eigen::Vector2d xy = swung(p, result_.beta_rad[n]) * m;
    motion.x_mm.push_back(xy.x());
    motion.y_mm.push_back(xy.y());
  }
  remove_eccentricity(result_.alpha_rad, result_.beta_rad, motion);
  const Eigen::Index kept = 2 * (highest_motion_ - 1);
  out.x_mm = over_work(motion.x_mm).tail(kept);
  out.y_mm = over_work(motion.y_mm).tail(kept);
  return out;
}

}  // namespace rondure::fit
