#include "evaluation/part/internal/windows.h"

#include <algorithm>
#include <cmath>

#include "core/decompositions.h"
#include "core/phrase.h"
#include "core/statistics.h"
#include "core/units.h"

namespace rondure::evaluation {
namespace {

constexpr double kFullTurnDeg = 360.0;
constexpr int kHighestHarmonic = 15;
constexpr int kRobustSteps = 30;
constexpr double kTukey = 4.685;               // 95 % efficient for normal residuals
constexpr double kLeastProfileScaleMm = 1e-4;  // as of the outlier rule
constexpr double kSettledMm = 1e-7;

/// Angle from one direction to another, counter-clockwise, in [0, 2 pi).
double turned(double from_rad, double to_rad) {
  const double turn = std::fmod(to_rad - from_rad, core::kTwoPi);
  return turn < 0.0 ? turn + core::kTwoPi : turn;
}

/// Angle that a window spans without its guard; both ends of a turn: the whole of it.
double span_rad(const record::WindowTask& window) {
  if (!window.from_deg || !window.to_deg) return core::kTwoPi;
  const double span = std::fmod(*window.to_deg - *window.from_deg, kFullTurnDeg);
  return (span > 0.0 ? span : span + kFullTurnDeg) * core::kDegree;
}

/// Largest gap between angles, the last and the first included.
double widest_gap_rad(std::vector<double> angle_rad) {
  std::sort(angle_rad.begin(), angle_rad.end());
  double gap = angle_rad.front() + core::kTwoPi - angle_rad.back();
  for (std::size_t i = 1; i < angle_rad.size(); ++i) {
    gap = std::max(gap, angle_rad[i] - angle_rad[i - 1]);
  }
  return gap;
}

/// Residuals of the weighted least-squares series up to a harmonic.
Eigen::VectorXd residuals(std::span<const double> angle_rad, const Eigen::VectorXd& r,
                          const Eigen::VectorXd& weights, int highest) {
  const auto n = static_cast<Eigen::Index>(angle_rad.size());
  Eigen::MatrixXd columns(n, 2 * highest + 1);
  columns.col(0).setOnes();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int k = 1; k <= highest; ++k) {
      const double phase = k * angle_rad[static_cast<std::size_t>(i)];
      columns(i, 2 * k - 1) = std::cos(phase);
      columns(i, 2 * k) = std::sin(phase);
    }
  }
  const Eigen::MatrixXd weighted = columns.transpose() * weights.asDiagonal();
  const Eigen::MatrixXd normal = weighted * columns;
  const Eigen::VectorXd right = weighted * r;
  const Eigen::VectorXd terms = core::solve_ldlt(normal, right);
  return r - columns * terms;
}

}  // namespace

core::Result<void> check_window(const record::WindowTask& window) {
  if (window.from_deg.has_value() != window.to_deg.has_value()) {
    return core::fail(error_of(
        core::Code::kMeaning,
        core::phrase("window {}: from_deg and to_deg belong together; give both, or none for the "
                     "whole turn",
                     window.name)));
  }
  if (window.from_deg && *window.from_deg == *window.to_deg) {
    return core::fail(error_of(
        core::Code::kMeaning,
        core::phrase("window {}: from_deg and to_deg are both {:g}: an empty window or a whole "
                     "turn? Leave both out for the whole turn",
                     window.name, *window.from_deg)));
  }
  if (window.from_mm && window.to_mm && *window.from_mm >= *window.to_mm) {
    return core::fail(
        error_of(core::Code::kMeaning,
                 core::phrase("window {}: from_mm {:g} is not below to_mm {:g}; exchange them",
                              window.name, *window.from_mm, *window.to_mm)));
  }
  return {};
}

bool is_in(const record::WindowTask& window, const PartPlace& place, double default_guard_mm) {
  const double guard = window.guard_mm.value_or(default_guard_mm);
  if (window.from_mm && place.z_mm <= *window.from_mm - guard) return false;
  if (window.to_mm && place.z_mm >= *window.to_mm + guard) return false;
  if (!window.from_deg) return true;
  const double beside = guard / std::max(place.radius_mm, guard);  // at most 1 rad
  const double span = span_rad(window) + 2.0 * beside;
  if (span >= core::kTwoPi) return true;
  const double at = turned(*window.from_deg * core::kDegree - beside, place.angle_rad);
  return at > 0.0 && at < span;
}

core::Result<std::vector<bool>> off_profile(std::span<const double> angle_rad,
                                            std::span<const double> r_mm,
                                            const std::vector<bool>& in_window, double limit_mm) {
  const std::size_t n = r_mm.size();
  std::vector<double> outside;
  Eigen::VectorXd weights(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    if (!in_window[i]) outside.push_back(angle_rad[i]);
    weights(static_cast<Eigen::Index>(i)) = in_window[i] ? 0.0 : 1.0;
  }
  constexpr std::size_t kLeastOutside = 4;  // one more than a circle has unknowns
  if (outside.size() < kLeastOutside) {
    return core::fail(
        error_of(core::Code::kTooFewPoints,
                 core::phrase("{} points lie outside the window, {} are needed to find what lies "
                              "off the profile in it; make it smaller",
                              outside.size(), kLeastOutside)));
  }
  // A window may lose all its points: no harmonic may swing freely in it. Half of the points of a
  // sparse section stay for the scale.
  const double carried = std::min(0.5 * core::kTwoPi / widest_gap_rad(outside),
                                  0.25 * static_cast<double>(outside.size()));
  const int highest = std::clamp(static_cast<int>(carried), 1, kHighestHarmonic);
  const Eigen::Map<const Eigen::VectorXd> r(r_mm.data(), static_cast<Eigen::Index>(n));
  Eigen::VectorXd rest = residuals(angle_rad, r, weights, 1);
  for (int step = 0; step < kRobustSteps; ++step) {
    std::vector<double> apart;
    for (std::size_t i = 0; i < n; ++i) {
      if (!in_window[i]) apart.push_back(std::abs(rest(static_cast<Eigen::Index>(i))));
    }
    const double scale =
        kTukey * std::max(core::kSigmaPerMedianDeviation * core::median(std::move(apart)),
                          kLeastProfileScaleMm);
    for (Eigen::Index i = 0; i < rest.size(); ++i) {
      const double share = 1.0 - std::pow(rest(i) / scale, 2);
      weights(i) = share > 0.0 ? share * share : 0.0;
    }
    const Eigen::VectorXd next = residuals(angle_rad, r, weights, highest);
    const double moved = (next - rest).cwiseAbs().maxCoeff();
    rest = next;
    if (moved < kSettledMm) break;
  }
  std::vector<bool> out(n, false);
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = in_window[i] && std::abs(rest(static_cast<Eigen::Index>(i))) > limit_mm;
  }
  return out;
}

}  // namespace rondure::evaluation
