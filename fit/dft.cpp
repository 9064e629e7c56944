#include "fit/dft.h"

#include <bit>
#include <cassert>
#include <numbers>

#include <unsupported/Eigen/FFT>

namespace rondure::fit {
namespace {

using Complex = std::complex<double>;
using Values = std::vector<Complex>;

/// Above this factor the plain transform, whose cost is N times the factor, is left.
constexpr std::size_t kLargestFactor = 100;

std::size_t largest_prime_factor(std::size_t n) {
  std::size_t largest = 1;
  for (std::size_t p = 2; p * p <= n; ++p) {
    while (n % p == 0) {
      largest = p;
      n /= p;
    }
  }
  return n > 1 ? n : largest;
}

Values plain_transform(const Values& x) {
  if (x.size() == 1) return x;
  Eigen::FFT<double> fft;
  Values out;
  fft.fwd(out, x);
  return out;
}

Values conjugated(Values x) {
  for (Complex& v : x) v = std::conj(v);
  return x;
}

/// Bluestein: k i = (k^2 + i^2 - (k - i)^2) / 2 makes the transform a convolution with a chirp.
Values chirp_transform(const Values& x) {
  const std::size_t n = x.size();
  const std::size_t padded = std::bit_ceil(2 * n - 1);
  Values chirp(n);
  for (std::size_t i = 0; i < n; ++i) {  // i^2 modulo 2n keeps the angle small, and so exact
    const auto square = static_cast<double>((i * i) % (2 * n));
    chirp[i] = std::polar(1.0, -std::numbers::pi * square / static_cast<double>(n));
  }
  Values a(padded);
  Values b(padded);
  for (std::size_t i = 0; i < n; ++i) {
    a[i] = x[i] * chirp[i];
    b[i] = b[(padded - i) % padded] = std::conj(chirp[i]);
  }
  Values product = plain_transform(a);
  const Values other = plain_transform(b);
  for (std::size_t i = 0; i < padded; ++i) product[i] *= other[i];
  const Values back = conjugated(plain_transform(conjugated(product)));
  Values out(n);
  for (std::size_t k = 0; k < n; ++k) out[k] = back[k] * chirp[k] / static_cast<double>(padded);
  return out;
}

Values transform(const Values& x) {
  return largest_prime_factor(x.size()) > kLargestFactor ? chirp_transform(x) : plain_transform(x);
}

}  // namespace

std::vector<Complex> spectrum(std::span<const double> series) {
  Values out = transform(Values(series.begin(), series.end()));
  out.resize(series.size() / 2 + 1);
  return out;
}

std::vector<double> series_of(std::span<const Complex> half, std::size_t count) {
  assert(half.size() == count / 2 + 1);
  Values conjugate(count);  // the inverse is the forward transform of the conjugate
  conjugate[0] = half[0].real();
  for (std::size_t k = 1; k < half.size(); ++k) {
    conjugate[k] = std::conj(half[k]);
    conjugate[count - k] = half[k];
  }
  if (count % 2 == 0) conjugate[count / 2] = half[count / 2].real();
  const Values x = transform(conjugate);
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = x[i].real() / static_cast<double>(count);
  return out;
}

std::array<std::vector<double>, 2> series_pair_of(std::span<const Complex> first,
                                                  std::span<const Complex> second,
                                                  std::size_t count) {
  assert(first.size() == count / 2 + 1 && second.size() == first.size());
  constexpr Complex kTurn(0.0, 1.0);
  Values conjugate(count);  // of first + j second, whose transform is real in both parts
  conjugate[0] = std::conj(first[0].real() + kTurn * second[0].real());
  for (std::size_t k = 1; k < first.size(); ++k) {
    conjugate[k] = std::conj(first[k] + kTurn * second[k]);
    conjugate[count - k] = std::conj(std::conj(first[k]) + kTurn * std::conj(second[k]));
  }
  if (count % 2 == 0) {
    const std::size_t half = count / 2;
    conjugate[half] = std::conj(first[half].real() + kTurn * second[half].real());
  }
  const Values x = transform(conjugate);
  std::array<std::vector<double>, 2> out = {std::vector<double>(count), std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    out[0][i] = x[i].real() / static_cast<double>(count);
    out[1][i] = -x[i].imag() / static_cast<double>(count);
  }
  return out;
}

}  // namespace rondure::fit
