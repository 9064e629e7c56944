#include "fit/profiles/filter_selftest.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/profiles/profile_filter.h"

namespace rondure::fit {
namespace {

std::vector<std::complex<double>> unit_circle(std::size_t count) {
  std::vector<std::complex<double>> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = std::polar(1.0, -core::kTwoPi * static_cast<double>(i) / static_cast<double>(count));
  }
  return out;
}

std::complex<double> harmonic_of(const std::vector<double>& r, std::size_t n,
                                 const std::vector<std::complex<double>>& circle) {
  std::complex<double> sum = 0.0;
  std::size_t at = 0;
  for (const double value : r) {
    sum += value * circle[at];
    at += n;
    if (at >= r.size()) at -= r.size();
  }
  return sum;
}

}  // namespace

double FilterSelfTest::greatest_difference() const {
  double out = 0.0;
  for (const TransmissionRow& row : rows) out = std::max(out, row.difference);
  return out;
}

bool FilterSelfTest::passed() const { return !rows.empty() && greatest_difference() <= kTolerance; }

core::Result<FilterSelfTest> filter_selftest(double cutoff_upr) {
  if (!(cutoff_upr >= 1.0 && cutoff_upr <= 1e4)) {
    return core::fail(
        core::Code::kBadOption,
        fmt::format("the cut-off is {} UPR; the self-test takes 1 to 10000", cutoff_upr));
  }
  FilterSelfTest out;
  out.cutoff_upr = cutoff_upr;
  const auto highest = static_cast<std::size_t>(std::floor(3.0 * cutoff_upr));
  out.samples = 7 * static_cast<std::size_t>(std::ceil(3.0 * cutoff_upr));
  std::vector<double> impulse(out.samples, 0.0);
  impulse[0] = 1.0;
  const auto response =
      filter_closed(impulse, {ProfileFilter::kGaussian, PassBand::kLow, cutoff_upr});
  if (!response) return core::fail(response.error());
  const auto circle = unit_circle(out.samples);
  for (std::size_t n = 1; n <= highest; ++n) {
    const auto found = harmonic_of(response->r_mm, n, circle);
    const double ratio = static_cast<double>(n) / cutoff_upr;
    const double expected = std::pow(2.0, -(ratio * ratio));
    out.rows.push_back({static_cast<int>(n), found.real(), expected, std::abs(found - expected)});
  }
  return out;
}

}  // namespace rondure::fit
