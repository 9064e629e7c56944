#include "fit/contour/separation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <functional>
#include <numeric>

#include "fit/contour/error.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kPlacesPerSample = 16;
constexpr int kNewtonSteps = 20;
constexpr double kLargeOffset = 2.0 * core::kDegree;
constexpr double kCoverage95 = 1.96;

double mean_product(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size() && a.size() >= 16);
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / static_cast<double>(a.size());
}

/// The circular cross-correlation as a trigonometric polynomial: c(D) = sum Re(g_k e^{j k D}).
class CrossCorrelation {
 public:
  void add(const CurvePair& pair) {
    const auto t = spectrum(pair.total_mm);
    const auto f = spectrum(pair.following_mm);
    const double scale = 2.0 / std::pow(static_cast<double>(pair.total_mm.size()), 2);
    terms_.resize(std::max(terms_.size(), t.size()));
    powers_.resize(terms_.size());
    for (std::size_t k = 1; k < t.size(); ++k) {
      terms_[k] += scale * t[k] * std::conj(f[k]);
      powers_[k] += scale * std::norm(f[k]);
    }
    norm_total_ += mean_product(pair.total_mm, pair.total_mm);
    norm_following_ += mean_product(pair.following_mm, pair.following_mm);
  }

  /// Drops negligible terms, from the highest on.
  void shorten() {
    double greatest = 0.0;
    for (const Complex& term : terms_) greatest = std::max(greatest, std::abs(term));
    while (terms_.size() > 2 && std::abs(terms_.back()) <= 1e-14 * greatest) terms_.pop_back();
  }

  struct Value {
    double value = 0.0;
    double slope = 0.0;
    double bend = 0.0;
  };
  [[nodiscard]] Value at(double angle) const {
    const Complex turn = std::polar(1.0, angle);
    Complex power = 1.0;
    Value out;
    for (std::size_t k = 1; k < terms_.size(); ++k) {
      power *= turn;
      const Complex term = terms_[k] * power;
      const auto number = static_cast<double>(k);
      out.value += term.real();
      out.slope -= number * term.imag();
      out.bend -= number * number * term.real();
    }
    return out;
  }

  /// Uncertainty of the offset. The rest n = t - f(turned) adds k |n_k conj(f_k)| to the slope at
  /// harmonic k, in an unknown phase; the curvature of the correlation by f alone is the sum of
  /// k^2 |f_k|^2. Contributions common to all parts are added before they are squared.
  [[nodiscard]] double uncertainty(double angle) const {
    double variance = 0.0;
    double bend = 0.0;
    for (std::size_t k = 1; k < terms_.size(); ++k) {
      const auto number = static_cast<double>(k);
      const Complex rest = terms_[k] * std::polar(1.0, number * angle) - powers_[k];
      variance += 0.5 * number * number * std::norm(rest);
      bend += number * number * powers_[k];
    }
    return bend > 0.0 ? std::sqrt(variance) / bend : 0.0;
  }

  [[nodiscard]] double normalised(double value) const {
    const double norm = std::sqrt(norm_total_ * norm_following_);
    return norm > 0.0 ? value / norm : 0.0;
  }

 private:
  std::vector<Complex> terms_;
  std::vector<double> powers_;  ///< Powers of f, in the scale of the terms.
  double norm_total_ = 0.0;
  double norm_following_ = 0.0;
};

std::vector<double> mirrored(std::span<const double> curve) {
  std::vector<double> out(curve.begin(), curve.end());
  std::reverse(out.begin() + 1, out.end());
  return out;
}

/// Standard deviation of mean(a b) where the phases of all harmonics of one of them are unknown.
double product_by_chance(std::span<const double> a, std::span<const double> b) {
  const auto one = spectrum(a);
  const auto other = spectrum(b);
  const double scale = 2.0 / static_cast<double>(a.size());
  double variance = 0.0;
  for (std::size_t k = 1; k < one.size(); ++k) {
    // mean(a_k b_k) is half the product of the amplitudes times the cosine of the phase.
    const double product = scale * scale * std::abs(one[k]) * std::abs(other[k]);
    variance += product * product / 8.0;
  }
  return std::sqrt(variance);
}

std::vector<double> difference(std::span<const double> a, std::span<const double> b) {
  std::vector<double> out(a.size());
  std::ranges::transform(a, b, out.begin(), std::minus<>());
  return out;
}

}  // namespace

double correlation_of(std::span<const double> a, std::span<const double> b) {
  const double norm = std::sqrt(mean_product(a, a) * mean_product(b, b));
  return norm > 0.0 ? mean_product(a, b) / norm : 0.0;
}

ContourSeparation separate_contour(std::span<const double> total_mm,
                                   std::span<const double> following_mm) {
  ContourSeparation out;
  out.rest_mm.resize(total_mm.size());
  std::ranges::transform(total_mm, following_mm, out.rest_mm.begin(), std::minus<>());
  out.total_mm2 = mean_product(total_mm, total_mm);
  out.following_mm2 = mean_product(following_mm, following_mm);
  out.rest_mm2 = mean_product(out.rest_mm, out.rest_mm);
  out.cross_mm2 = 2.0 * mean_product(following_mm, out.rest_mm);
  out.correlation = correlation_of(following_mm, out.rest_mm);
  return out;
}

CorrelationOffset correlation_offset(std::span<const CurvePair> pairs, double window_rad) {
  CrossCorrelation correlation;
  for (const CurvePair& pair : pairs) correlation.add(pair);
  correlation.shorten();
  const std::size_t samples = pairs.empty() ? 1 : pairs.front().total_mm.size();
  const double step = core::kTwoPi / static_cast<double>(kPlacesPerSample * samples);
  const auto places = static_cast<int>(std::ceil(window_rad / step));
  CorrelationOffset out;
  int best = 0;
  double greatest = correlation.at(0.0).value;
  for (int i = -places; i <= places; ++i) {
    const double value = correlation.at(i * step).value;
    if (value <= greatest) continue;
    greatest = value;
    best = i;
  }
  out.at_edge = std::abs(best) == places;
  out.angle_rad = best * step;
  for (int i = 0; i < kNewtonSteps && !out.at_edge; ++i) {
    const auto here = correlation.at(out.angle_rad);
    if (!(here.bend < 0.0)) break;
    const double move = std::clamp(-here.slope / here.bend, -step, step);
    out.angle_rad += move;
    if (std::abs(move) < 1e-12) break;
  }
  out.correlation = correlation.normalised(correlation.at(out.angle_rad).value);
  out.u_rad = correlation.uncertainty(out.angle_rad);
  return out;
}

bool CorrelationOffset::alignment_suspect() const {
  return std::abs(angle_rad) > kLargeOffset && std::abs(angle_rad) > 3.0 * u_rad;
}

bool fits_better(const CurvePair& pair, std::span<const double> other_mm) {
  const std::vector<double> change = difference(other_mm, pair.following_mm);
  const std::vector<double> rest = difference(pair.total_mm, other_mm);
  const double gain = 2.0 * mean_product(pair.total_mm, change) - mean_product(other_mm, other_mm) +
                      mean_product(pair.following_mm, pair.following_mm);
  return gain > 2.0 * kCoverage95 * product_by_chance(rest, change) && gain > 0.0;
}

SenseEvidence sense_evidence(std::span<const CurvePair> pairs) {
  double same = 0.0;
  double other = 0.0;
  double totals = 0.0;
  double followings = 0.0;
  SenseEvidence out;
  out.parts = pairs.size();
  for (const CurvePair& pair : pairs) {
    const std::vector<double> turned_over = mirrored(pair.following_mm);
    std::vector<double> negated(pair.following_mm.begin(), pair.following_mm.end());
    for (double& v : negated) v = -v;
    out.mirrored_better += fits_better(pair, turned_over) ? 1 : 0;
    out.negated_better += fits_better(pair, negated) ? 1 : 0;
    same += mean_product(pair.total_mm, pair.following_mm);
    other += mean_product(pair.total_mm, turned_over);
    totals += mean_product(pair.total_mm, pair.total_mm);
    followings += mean_product(pair.following_mm, pair.following_mm);
  }
  const double norm = std::sqrt(totals * followings);
  if (norm <= 0.0) return out;
  const auto parts = static_cast<double>(pairs.size());
  out.as_given = same / norm;
  out.mirrored = other / norm;
  out.rms_difference_mm = std::sqrt(std::max(0.0, totals + followings - 2.0 * same) / parts);
  out.rms_sum_mm = std::sqrt(std::max(0.0, totals + followings + 2.0 * same) / parts);
  out.rms_mirrored_mm = std::sqrt(std::max(0.0, totals + followings - 2.0 * other) / parts);
  return out;
}

std::optional<GainEvidence> gain_evidence(const CurvePair& pair) {
  const double power = mean_product(pair.following_mm, pair.following_mm);
  if (power <= 0.0) return std::nullopt;
  GainEvidence out;
  out.slope = mean_product(pair.total_mm, pair.following_mm) / power;
  std::vector<double> rest(pair.total_mm.begin(), pair.total_mm.end());
  for (std::size_t m = 0; m < rest.size(); ++m) rest[m] -= out.slope * pair.following_mm[m];
  out.u = product_by_chance(rest, pair.following_mm) / power;
  return out;
}

}  // namespace rondure::fit
