#include "fit/profiles/internal/dft.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>

#include <fftw3.h>

namespace rondure::fit {
namespace {

using Plan = std::unique_ptr<fftw_plan_s, void (*)(fftw_plan)>;

/// Plans without timing and without alignment, so that every run uses the same transform and gives
/// the same bits.
constexpr unsigned kFlags = FFTW_ESTIMATE | FFTW_UNALIGNED;

/// Guards the making and destroying of plans; FFTW allows only their execution in parallel.
std::mutex& planning() {
  static std::mutex mutex;
  return mutex;
}

/// Gives a plan to use on any arrays of its size. Making one takes as long as several transforms,
/// so that those of usual profiles are kept.
template <class Make, class Use>
void planned(std::size_t count, const Make& make, const Use& use) {
  constexpr std::size_t kKept = 8192;
  static std::map<std::size_t, Plan> kept;  // one for each Make, as its type differs
  if (count <= kKept) {
    const auto plan = [&] {
      const std::lock_guard lock(planning());
      const auto found = kept.find(count);
      return found != kept.end()
                 ? found->second.get()
                 : kept.emplace(count, Plan(make(), fftw_destroy_plan)).first->second.get();
    }();
    use(plan);
    return;
  }
  const auto destroy = [](fftw_plan plan) {
    const std::lock_guard lock(planning());
    fftw_destroy_plan(plan);
  };
  const auto plan = [&] {
    const std::lock_guard lock(planning());
    return Plan(make(), destroy);
  }();
  use(plan.get());
}

/// FFTW's complex number is two doubles, as std::complex is by the standard.
fftw_complex* raw(std::vector<Complex>& values) {
  return reinterpret_cast<fftw_complex*>(values.data());
}

}  // namespace

Spectrum spectrum(std::span<const double> series) {
  std::vector<double> in(series.begin(), series.end());
  std::vector<Complex> out(series.size() / 2 + 1);
  const int count = static_cast<int>(series.size());
  planned(
      series.size(), [&] { return fftw_plan_dft_r2c_1d(count, in.data(), raw(out), kFlags); },
      [&](fftw_plan plan) { fftw_execute_dft_r2c(plan, in.data(), raw(out)); });
  return out;
}

std::vector<double> series_of(std::span<const Complex> half, std::size_t count) {
  assert(half.size() == count / 2 + 1);
  std::vector<Complex> in(half.begin(), half.end());  // it is overwritten
  std::vector<double> out(count);
  const int size = static_cast<int>(count);
  planned(
      count, [&] { return fftw_plan_dft_c2r_1d(size, raw(in), out.data(), kFlags); },
      [&](fftw_plan plan) { fftw_execute_dft_c2r(plan, raw(in), out.data()); });
  for (double& x : out) x /= static_cast<double>(count);
  return out;
}

double last_untouched(std::size_t count, double kept) {
  return std::max(kept, 0.375 * static_cast<double>(count));
}

std::vector<double> decimated(std::span<const double> series, std::size_t count, double kept) {
  assert(series.size() % count == 0);
  if (series.size() == count) return {series.begin(), series.end()};
  auto f = spectrum(series);
  f.resize(count / 2 + 1);
  const double first = last_untouched(count, kept);
  const double last = 0.5 * static_cast<double>(count);
  const double scale = static_cast<double>(count) / static_cast<double>(series.size());
  for (std::size_t k = 0; k < f.size(); ++k) {
    // A step instead of the cosine would ring along the whole turn if its ends do not meet.
    const double beyond = (static_cast<double>(k) - first) / (last - first);
    f[k] *= scale * (beyond > 0.0 ? 0.5 + 0.5 * std::cos(std::numbers::pi * beyond) : 1.0);
  }
  return series_of(f, count);
}

double gaussian_transmission(double harmonic, double cutoff_upr) {
  const double ratio = harmonic / cutoff_upr;
  return std::exp2(-ratio * ratio);
}

}  // namespace rondure::fit
