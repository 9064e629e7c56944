#include "fit/dft.h"

#include <cassert>
#include <memory>
#include <mutex>

#include <fftw3.h>

namespace rondure::fit {
namespace {

using Plan = std::unique_ptr<fftw_plan_s, void (*)(fftw_plan)>;

/// Nothing is timed and no alignment is used: the same transform, and the same bits, every time.
constexpr unsigned kFlags = FFTW_ESTIMATE | FFTW_UNALIGNED;

/// FFTW makes and destroys plans one at a time; it executes them side by side.
std::mutex& planning() {
  static std::mutex mutex;
  return mutex;
}

template <class Make>
void execute(const Make& make) {
  const auto destroy = [](fftw_plan plan) {
    const std::lock_guard lock(planning());
    fftw_destroy_plan(plan);
  };
  const auto planned = [&] {
    const std::lock_guard lock(planning());
    return Plan(make(), destroy);
  };
  fftw_execute(planned().get());
}

/// FFTW's complex is two doubles, as std::complex is by the standard.
fftw_complex* raw(std::vector<Complex>& values) {
  return reinterpret_cast<fftw_complex*>(values.data());
}

}  // namespace

Spectrum spectrum(std::span<const double> series) {
  std::vector<double> in(series.begin(), series.end());
  std::vector<Complex> out(series.size() / 2 + 1);
  const int count = static_cast<int>(series.size());
  execute([&] { return fftw_plan_dft_r2c_1d(count, in.data(), raw(out), kFlags); });
  return out;
}

std::vector<double> series_of(std::span<const Complex> half, std::size_t count) {
  assert(half.size() == count / 2 + 1);
  std::vector<Complex> in(half.begin(), half.end());  // is overwritten
  std::vector<double> out(count);
  const int size = static_cast<int>(count);
  execute([&] { return fftw_plan_dft_c2r_1d(size, raw(in), out.data(), kFlags); });
  for (double& x : out) x /= static_cast<double>(count);
  return out;
}

}  // namespace rondure::fit
