#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/spindle/probe_layout.h"

namespace rondure::fit {
namespace {

constexpr double kGrid_deg = 0.25;
constexpr double kFinest_deg = 0.001;
/// Layouts closer together than this are in the same valley.
constexpr double kNeighbour_deg = 2.0;
constexpr std::size_t kRefined = 4;  ///< Candidates refined per layout to be returned.

/// Angles of P2 and P3 from P1.
struct Place {
  double p2_deg = 0.0;
  double p3_deg = 0.0;
};

struct Candidate {
  Place place;
  double worst = 0.0;
};

/// Angle between two directions, 0..180 deg.
double apart_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 360.0));
}

bool fits(const Place& place, const LayoutSearch& search) {
  const auto within = [](double value, const std::array<double, 2>& range) {
    return value >= range[0] - 1e-9 && value <= range[1] + 1e-9;
  };
  return within(place.p2_deg, search.p2_range_deg) && within(place.p3_deg, search.p3_range_deg) &&
         apart_deg(place.p2_deg, 0.0) >= search.least_apart_deg &&
         apart_deg(place.p3_deg, 0.0) >= search.least_apart_deg &&
         apart_deg(place.p2_deg, place.p3_deg) >= search.least_apart_deg;
}

/// Least |G|^2 of the band over the squared weight norm, 1 / g^2, or 0 if two probes are in line.
/// Powers are found by multiplication, as this is the inner loop.
double inverse_worst(const Place& place, const LayoutSearch& search, double give_up_below) {
  const double a2 = place.p2_deg * core::kDegree;
  const double a3 = place.p3_deg * core::kDegree;
  const double s3 = std::sin(a3 - a2);
  if (std::abs(s3) < 1e-3 || std::abs(std::sin(a2)) < 1e-3 || std::abs(std::sin(a3)) < 1e-3) {
    return 0.0;
  }
  const double k2 = -std::sin(a3) / s3;
  const double k3 = std::sin(a2) / s3;
  const double norm2 = 1.0 + k2 * k2 + k3 * k3;
  const std::complex<double> turn2 = std::polar(1.0, a2);
  const std::complex<double> turn3 = std::polar(1.0, a3);
  std::complex<double> w2 = k2 * std::polar(1.0, search.first * a2);
  std::complex<double> w3 = k3 * std::polar(1.0, search.first * a3);
  double least = std::norm(1.0 + w2 + w3) / norm2;
  for (int order = search.first + 1; order <= search.last && least > give_up_below; ++order) {
    w2 = {w2.real() * turn2.real() - w2.imag() * turn2.imag(),
          w2.real() * turn2.imag() + w2.imag() * turn2.real()};
    w3 = {w3.real() * turn3.real() - w3.imag() * turn3.imag(),
          w3.real() * turn3.imag() + w3.imag() * turn3.real()};
    const double re = 1.0 + w2.real() + w3.real();
    const double im = w2.imag() + w3.imag();
    least = std::min(least, (re * re + im * im) / norm2);
  }
  return least;
}

/// All places of the grid that are at most 3 times worse than the best one before them.
std::vector<Candidate> scan_grid(const LayoutSearch& search) {
  const double step = search.samples > 0 ? 360.0 / search.samples : kGrid_deg;
  const auto first_of = [&](double low) { return std::ceil(low / step - 1e-9) * step; };
  std::vector<Candidate> out;
  double best = 0.0;
  for (double p2 = first_of(search.p2_range_deg[0]); p2 <= search.p2_range_deg[1] + 1e-9;
       p2 += step) {
    for (double p3 = first_of(search.p3_range_deg[0]); p3 <= search.p3_range_deg[1] + 1e-9;
         p3 += step) {
      const Place place{p2, p3};
      if (!fits(place, search)) continue;
      const double inverse = inverse_worst(place, search, best / 9.0);
      if (inverse <= best / 9.0 || inverse <= 0.0) continue;
      best = std::max(best, inverse);
      out.push_back({place, 1.0 / std::sqrt(inverse)});
    }
  }
  std::ranges::stable_sort(out, {}, &Candidate::worst);
  return out;
}

/// Moves to a better neighbour as long as there is one, then halves the step.
Candidate refined_candidate(Candidate at, const LayoutSearch& search) {
  for (double step = kGrid_deg / 2.0; step >= kFinest_deg / 2.0;) {
    Candidate best = at;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const Place place{at.place.p2_deg + i * step, at.place.p3_deg + j * step};
        if (!fits(place, search)) continue;
        const double inverse = inverse_worst(place, search, 0.0);
        if (inverse > 0.0 && 1.0 / std::sqrt(inverse) < best.worst) {
          best = {place, 1.0 / std::sqrt(inverse)};
        }
      }
    }
    if (best.worst < at.worst) {
      at = best;
    } else {
      step /= 2.0;
    }
  }
  return at;
}

/// The best layout of each valley, at most `count`.
std::vector<Candidate> distinct(const std::vector<Candidate>& sorted, std::size_t count) {
  std::vector<Candidate> out;
  for (const Candidate& candidate : sorted) {
    const bool known = std::ranges::any_of(out, [&](const Candidate& other) {
      return apart_deg(candidate.place.p2_deg, other.place.p2_deg) < kNeighbour_deg &&
             apart_deg(candidate.place.p3_deg, other.place.p3_deg) < kNeighbour_deg;
    });
    if (!known) out.push_back(candidate);
    if (out.size() == count) break;
  }
  return out;
}

core::Result<void> check(const LayoutSearch& search) {
  const auto refuse = [](std::string what) {
    return core::fail(core::Code::kBadOption, std::move(what));
  };
  if (search.first < 2 || search.last < search.first || search.last > 1000) {
    return refuse(
        fmt::format("a band of harmonics {}..{} cannot be served; 2 <= first <= last <= "
                    "1000: harmonic 1 is eccentricity, which no layout recovers",
                    search.first, search.last));
  }
  for (const auto& range : {search.p2_range_deg, search.p3_range_deg}) {
    if (std::isfinite(range[0]) && range[0] <= range[1] && range[1] - range[0] <= 360.0) continue;
    return refuse(
        fmt::format("a range of {}..{} deg is none, or wider than a turn", range[0], range[1]));
  }
  if (search.count < 1 || search.samples < 0 || !(search.least_apart_deg >= 0.0)) {
    return refuse("count must be at least 1, samples and the least distance not below 0");
  }
  return {};
}

DesignedLayout designed(const Candidate& candidate, const LayoutSearch& search) {
  const double phi2 = candidate.place.p2_deg * core::kDegree;
  const double phi3 = candidate.place.p3_deg * core::kDegree - phi2;
  const ProbeLayout layout = *ProbeLayout::of(phi2, phi3 < 0.0 ? phi3 + core::kTwoPi : phi3);
  DesignedLayout out{layout, worst_gain(layout, search.first, search.last), 0.0};
  for (int order = search.first; order <= search.last; ++order) {
    out.rms_gain += std::pow(layout.gain(order), 2);
  }
  out.rms_gain = std::sqrt(out.rms_gain / (search.last - search.first + 1));
  return out;
}

}  // namespace

core::Result<std::vector<DesignedLayout>> design_layout(const LayoutSearch& search) {
  TRY_DO(check(search));
  const auto count = static_cast<std::size_t>(search.count);
  std::vector<Candidate> found = distinct(scan_grid(search), kRefined * count);
  if (search.samples == 0) {
    for (Candidate& candidate : found) candidate = refined_candidate(candidate, search);
    std::ranges::stable_sort(found, {}, &Candidate::worst);
  }
  std::vector<DesignedLayout> out;
  for (const Candidate& candidate : distinct(found, count))
    out.push_back(designed(candidate, search));
  if (out.empty()) {
    return core::fail(core::Code::kBadOption,
                      "no layout stands within these ranges with that distance between probes");
  }
  return out;
}

}  // namespace rondure::fit
