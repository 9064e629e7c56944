#include "fit/profiles/harmonics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>

#include <Eigen/Core>

#include "core/decompositions.h"
#include "core/units.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

/// The harmonic r = c cos(k theta) + s sin(k theta).
Harmonic harmonic_of(int number, double c, double s, double sigma) {
  Harmonic out{number, std::hypot(c, s), std::nullopt};
  if (out.amplitude_mm >= 3.0 * sigma && out.amplitude_mm > 0.0) out.phase_rad = std::atan2(s, c);
  return out;
}

double amplitude_sigma(double noise, std::size_t points) {
  return noise * std::sqrt(2.0 / static_cast<double>(points));
}

/// Checks K against the number of points.
core::Result<void> check_harmonics(std::size_t points, const HarmonicOptions& options) {
  if (options.highest < 1 || !(options.noise_mm >= 0.0)) {
    return core::fail_with(core::Code::kBadOption,
                           "harmonics 1 to {} with a noise of {} mm; the highest is at least 1 and "
                           "the noise not negative",
                           options.highest, options.noise_mm);
  }
  const auto highest = static_cast<std::size_t>(options.highest);
  if (points == 0 || highest > (points - 1) / 2) {
    return core::fail_with(core::Code::kBadOption,
                           "{} points determine harmonics up to {}, {} are asked for", points,
                           points == 0 ? 0 : (points - 1) / 2, highest);
  }
  if (7 * highest > points && !options.override_sampling) {
    return core::fail_with(core::Code::kSampling,
                           "harmonic {} needs {} points (7 per undulation), there are {}: ask for "
                           "harmonics up to {}; the check can be overridden",
                           highest, 7 * highest, points, points / 7);
  }
  return {};
}

core::Result<void> check_harmonic_gap(const AngularProfile& profile, int highest) {
  const double gap_deg = profile.largest_gap_rad / core::kDegree;
  if (gap_deg >= 90.0) {
    return core::fail_with(core::Code::kNotFullSection,
                           "the profile has a gap of {:.1f} deg; harmonics exist only for a closed "
                           "profile, with every gap below 90 deg",
                           gap_deg);
  }
  if (gap_deg * highest >= 180.0) {
    return core::fail_with(core::Code::kSampling,
                           "the profile has a gap of {:.4g} deg, which hides half an undulation of "
                           "harmonic {}; ask for harmonics below {:.0f}",
                           gap_deg, highest, std::ceil(180.0 / gap_deg));
  }
  return {};
}

/// 1, cos(theta), sin(theta), cos(2 theta), ... at one angle.
void fill_basis(double theta, Eigen::Ref<Eigen::VectorXd> row) {
  const std::complex<double> turn(std::cos(theta), std::sin(theta));
  std::complex<double> power = turn;
  row(0) = 1.0;
  for (Eigen::Index k = 1; 2 * k < row.size(); ++k, power *= turn) {
    row(2 * k - 1) = power.real();
    row(2 * k) = power.imag();
  }
}

/// Solves by normal equations, summed in blocks. They are well conditioned, because gaps are below
/// half an undulation.
Eigen::VectorXd least_squares(const AngularProfile& profile, int highest) {
  constexpr std::size_t kBlock = 256;
  const std::size_t n = profile.r_mm.size();
  const Eigen::Index terms = 2 * highest + 1;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
  Eigen::MatrixXd basis(terms, static_cast<Eigen::Index>(kBlock));
  const double level = profile.r_mm.front();
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const auto count = static_cast<Eigen::Index>(std::min(kBlock, n - begin));
    Eigen::VectorXd values(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t row = begin + static_cast<std::size_t>(i);
      fill_basis(profile.theta_rad[row], basis.col(i));
      values(i) = profile.r_mm[row] - level;
    }
    normal.noalias() += basis.leftCols(count) * basis.leftCols(count).transpose();
    right.noalias() += basis.leftCols(count) * values;
  }
  Eigen::VectorXd x = core::solve_ldlt(normal, right);
  x(0) += level;
  return x;
}

}  // namespace

std::optional<double> Harmonic::crest_rad() const {
  if (!phase_rad) return std::nullopt;
  return *phase_rad / number;
}

core::Result<HarmonicTable> harmonics(const UniformProfile& profile,
                                      const HarmonicOptions& options) {
  const std::size_t n = profile.r_mm.size();
  TRY_DO(check_harmonics(n, options));
  const auto f = spectrum(profile.r_mm);
  const double scale = 2.0 / static_cast<double>(n);
  HarmonicTable out;
  out.mean_mm = f[0].real() / static_cast<double>(n);
  out.amplitude_sigma_mm = amplitude_sigma(options.noise_mm, n);
  for (int k = 1; k <= options.highest; ++k) {
    const auto turned = scale * f[static_cast<std::size_t>(k)] *
                        std::polar(1.0, -static_cast<double>(k) * profile.start_rad);
    out.harmonics.push_back(harmonic_of(k, turned.real(), -turned.imag(), out.amplitude_sigma_mm));
  }
  return out;
}

core::Result<HarmonicTable> harmonic_fit(const AngularProfile& profile,
                                         const HarmonicOptions& options) {
  const std::size_t n = profile.r_mm.size();
  TRY_DO(check_harmonics(n, options));
  TRY_DO(check_harmonic_gap(profile, options.highest));
  const Eigen::VectorXd x = least_squares(profile, options.highest);
  HarmonicTable out;
  out.mean_mm = x(0);
  out.amplitude_sigma_mm = amplitude_sigma(options.noise_mm, n);
  for (int k = 1; k <= options.highest; ++k) {
    out.harmonics.push_back(harmonic_of(k, x(2 * k - 1), x(2 * k), out.amplitude_sigma_mm));
  }
  return out;
}

UniformProfile profile_of(const HarmonicTable& table, std::size_t samples) {
  const auto count = static_cast<double>(samples);
  Spectrum half(samples / 2 + 1);
  half[0] = count * table.mean_mm;
  for (const Harmonic& h : table.harmonics) {
    const auto k = static_cast<std::size_t>(h.number);
    assert(2 * k < samples);
    if (h.phase_rad) half[k] = std::polar(0.5 * count * h.amplitude_mm, -*h.phase_rad);
  }
  return {0.0, series_of(half, samples)};
}

}  // namespace rondure::fit
