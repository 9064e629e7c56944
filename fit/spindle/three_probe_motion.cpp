#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <span>

#include <Eigen/Dense>

#include "fit/spindle/axis_motion.h"
#include "fit/spindle/internal/three_probe_parts.h"

namespace rondure::fit {
namespace {

/// e^{j alpha} and e^{-j beta} of every sample, and its share of a turn of the work.
struct Turns {
  Spectrum work;
  Spectrum swing;
  std::vector<double> shares;

  Turns(std::span<const double> alpha_rad, std::span<const double> beta_rad)
      : shares(work_shares(alpha_rad)) {
    work.reserve(alpha_rad.size());
    swing.reserve(alpha_rad.size());
    for (std::size_t n = 0; n < alpha_rad.size(); ++n) {
      work.push_back(std::polar(1.0, alpha_rad[n]));
      const double beta = beta_rad[n];
      swing.push_back(beta == 0.0 ? Complex(1.0, 0.0) : std::polar(1.0, -beta));
    }
  }
};

/// The printed formulas: RX from probes 1 and 2, RY = (m1 + RX) / cos(beta), which is wrong.
Eigen::Matrix<double, 2, 3> as_published(const ProbeLayout& layout, double beta_rad) {
  const double phi2 = layout.phi2_rad();
  Eigen::Matrix<double, 2, 3> p = Eigen::Matrix<double, 2, 3>::Zero();
  p(0, 0) = -std::cos(phi2 + beta_rad) / std::sin(phi2);
  p(0, 1) = std::cos(beta_rad) / std::sin(phi2);
  p.row(1) = p.row(0);
  p(1, 0) += 1.0;
  p.row(1) /= std::cos(beta_rad);
  return p;
}

/// Fits c e^{j alpha} + c0 e^{-j beta} to RY - j RX by least squares over the work angle, to which
/// other motion, of whole cycles a turn of the work, contributes nothing.
std::array<Complex, 2> eccentric_part(const CentreMotion& motion, const Turns& turns) {
  Complex cross;
  Complex first;
  Complex second;
  for (std::size_t i = 0; i < turns.work.size(); ++i) {
    const Complex value = turns.shares[i] * Complex(motion.y_mm[i], -motion.x_mm[i]);
    cross += turns.shares[i] * std::conj(turns.work[i]) * turns.swing[i];
    first += std::conj(turns.work[i]) * value;
    second += std::conj(turns.swing[i]) * value;
  }
  // Normal equations of two unit vectors: [1, cross; conj(cross), 1].
  const double determinant = 1.0 - std::norm(cross);
  return {(first - cross * second) / determinant,
          (second - std::conj(cross) * first) / determinant};
}

void subtract(const std::array<Complex, 2>& part, const Turns& turns, CentreMotion& motion) {
  for (std::size_t i = 0; i < turns.work.size(); ++i) {
    const Complex value = part[0] * turns.work[i] + part[1] * turns.swing[i];
    motion.y_mm[i] -= value.real();
    motion.x_mm[i] += value.imag();
  }
}

}  // namespace

Spectrum shifted(const Spectrum& spectrum, double shift_rad, int derivative) {
  Spectrum turned(spectrum.size());
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    if (spectrum[k] == Complex()) continue;
    const auto order = static_cast<double>(k);
    turned[k] = spectrum[k] * std::polar(1.0, order * shift_rad);
    for (int d = 0; d < derivative; ++d) turned[k] *= Complex(0.0, order);
  }
  return turned;
}

Eigen::Matrix<double, 2, 3> motion_solver(const std::array<double, 3>& angles_rad) {
  Eigen::Matrix<double, 3, 2> n;
  for (int i = 0; i < 3; ++i) {
    const double direction = angles_rad[static_cast<std::size_t>(i)];
    n(i, 0) = std::sin(direction);
    n(i, 1) = std::cos(direction);
  }
  const Eigen::Matrix2d normal = n.transpose() * n;
  return normal.inverse() * n.transpose();
}

Eigen::Matrix<double, 2, 3> swung(const Eigen::Matrix<double, 2, 3>& p, double beta_rad) {
  return Eigen::Rotation2Dd(-beta_rad).toRotationMatrix() * p;
}

void remove_eccentricity(std::span<const double> alpha_rad, std::span<const double> beta_rad,
                         CentreMotion& motion) {
  const Turns turned(alpha_rad, beta_rad);
  subtract(eccentric_part(motion, turned), turned, motion);
}

void separate_motion(const ProbeSamples& samples, const Spectrum& spectrum,
                     const ThreeProbeOptions& options, ThreeProbeResult& result) {
  const std::size_t count = samples.count;
  const auto angles = result.layout.angles_rad();
  const auto second = series_of(shifted(spectrum, angles[1], 0), count);
  const auto third = series_of(shifted(spectrum, angles[2], 0), count);
  const std::array<const std::vector<double>*, 3> part = {&result.profile.r_mm, &second, &third};
  result.motion.assign(static_cast<std::size_t>(samples.revolutions),
                       {std::vector<double>(count), std::vector<double>(count)});
  result.mean_motion = {std::vector<double>(count), std::vector<double>(count)};
  const bool published = options.motion == ThreeProbeOptions::Motion::kAsPublished;
  const Eigen::Matrix<double, 2, 3> unswung = motion_solver(angles);
  Eigen::Matrix<double, 2, 3> p = Eigen::Matrix<double, 2, 3>::Zero();
  for (std::size_t n = 0; n < count; ++n) {
    if (n == 0 || samples.beta_rad[n] != samples.beta_rad[n - 1]) {
      p = published ? as_published(result.layout, samples.beta_rad[n])
                    : swung(unswung, samples.beta_rad[n]);
    }
    for (std::size_t j = 0; j < result.motion.size(); ++j) {
      const std::size_t at = j * count + n;
      const Eigen::Vector3d m(samples.h_mm[0][at] - (*part[0])[n],
                              samples.h_mm[1][at] - (*part[1])[n],
                              samples.h_mm[2][at] - (*part[2])[n]);
      const Eigen::Vector2d xy = p * m;
      result.motion[j].x_mm[n] = xy.x();
      result.motion[j].y_mm[n] = xy.y();
      result.mean_motion.x_mm[n] += xy.x();
      result.mean_motion.y_mm[n] += xy.y();
    }
  }
  const auto turns = static_cast<double>(result.motion.size());
  for (double& x : result.mean_motion.x_mm) x /= turns;
  for (double& y : result.mean_motion.y_mm) y /= turns;
  result.mean_motion_before = result.mean_motion;
  const Turns turned(samples.alpha_rad, samples.beta_rad);
  const auto eccentric = eccentric_part(result.mean_motion, turned);
  subtract(eccentric, turned, result.mean_motion);
  for (CentreMotion& turn : result.motion) subtract(eccentric, turned, turn);
  // c = a - j b for a cos(theta) + b sin(theta) on the part.
  result.eccentricity_mm = std::abs(eccentric[0]);
  result.eccentricity_rad = -std::arg(eccentric[0]);
  Complex against;
  for (std::size_t n = 0; n < count; ++n) {
    const Complex value(result.mean_motion.y_mm[n], -result.mean_motion.x_mm[n]);
    against += turned.shares[n] * turned.work[n] * value;
  }
  result.against_work_mm = std::abs(against);
}

CentreMotion motion_without_zeros(const ThreeProbeResult& result) {
  CentreMotion out = result.mean_motion_before;
  const Turns turns(result.alpha_rad, result.beta_rad);
  Complex sum;
  Complex swing;
  for (std::size_t n = 0; n < turns.shares.size(); ++n) {
    sum += turns.shares[n] * Complex(out.y_mm[n], -out.x_mm[n]);
    swing += turns.shares[n] * turns.swing[n];
  }
  subtract({Complex(), sum / swing}, turns, out);
  return out;
}

double correct_second_order(const ProbeSamples& measured, const Spectrum& spectrum,
                            const ThreeProbeResult& result, double part_radius_mm,
                            ProbeSamples& samples) {
  constexpr int kInnerPasses = 4;
  const std::size_t count = measured.count;
  const auto angles = result.layout.angles_rad();
  const CentreMotion motion = motion_without_zeros(result);
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<std::vector<double>, 4> r;  // Taylor to the third order: shifts are some 1e-3 rad
    for (int d = 0; d < 4; ++d)
      r[static_cast<std::size_t>(d)] = series_of(shifted(spectrum, angles[i], d), count);
    for (std::size_t n = 0; n < count; ++n) {
      const double x = motion.x_mm[n];
      const double y = motion.y_mm[n];
      const double direction = angles[i] + samples.beta_rad[n];
      const double along = y * std::cos(direction) + x * std::sin(direction);
      const double across = x * std::cos(direction) - y * std::sin(direction);
      double reading = r[0][n] + along;
      for (int pass = 0; pass < kInnerPasses; ++pass) {
        const double d = -std::atan2(across, part_radius_mm + reading - along);
        const double form = r[0][n] + d * (r[1][n] + d * (r[2][n] / 2.0 + d * r[3][n] / 6.0));
        // sqrt((R + f)^2 - a^2) - R, without the cancellation of large R.
        const double rho = part_radius_mm + form;
        reading = along + form - across * across / (rho + std::sqrt(rho * rho - across * across));
      }
      const double correction = reading - (r[0][n] + along);
      if (!std::isfinite(correction)) return std::numeric_limits<double>::quiet_NaN();
      largest = std::max(largest, std::abs(correction));
      samples.mean_mm[i][n] = measured.mean_mm[i][n] - correction;
      for (std::size_t at = n; at < measured.h_mm[i].size(); at += count)
        samples.h_mm[i][at] = measured.h_mm[i][at] - correction;
    }
  }
  return largest;
}

}  // namespace rondure::fit
