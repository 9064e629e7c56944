#include "fit/spindle/axis_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/decompositions.h"
#include "core/units.h"
#include "fit/contour/error.h"
#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

/// Least-squares fit of c + a cos + b sin to a series, over the work angle.
Eigen::Vector3d plot_centre(std::span<const double> alpha_rad, const std::vector<double>& values) {
  const std::vector<double> shares = work_shares(alpha_rad);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < alpha_rad.size(); ++n) {
    const Eigen::Vector3d row(1.0, std::cos(alpha_rad[n]), std::sin(alpha_rad[n]));
    normal += shares[n] * row * row.transpose();
    right += shares[n] * row * values[n];
  }
  return core::solve_ldlt(normal, right);
}

/// Largest difference of the revolutions at one angle.
double widest_spread(const std::vector<std::vector<double>>& turns) {
  double widest = 0.0;
  for (std::size_t n = 0; n < turns.front().size(); ++n) {
    widest =
        std::max(widest, extremes_of(turns, [&](const auto& turn) { return turn[n]; }).width());
  }
  return widest;
}

}  // namespace

std::vector<double> work_shares(std::span<const double> alpha_rad) {
  const std::size_t count = alpha_rad.size();
  std::vector<double> out(count);
  for (std::size_t n = 0; n < count; ++n) {
    const double before = n > 0 ? alpha_rad[n - 1] : alpha_rad.back() - core::kTwoPi;
    const double after = n + 1 < count ? alpha_rad[n + 1] : alpha_rad.front() + core::kTwoPi;
    out[n] = (after - before) / (2.0 * core::kTwoPi);
  }
  return out;
}

AxisMotion axis_motion(std::span<const double> alpha_rad,
                       std::span<const std::vector<double>> turns_mm) {
  assert(!turns_mm.empty() && turns_mm.front().size() == alpha_rad.size());
  AxisMotion out;
  out.turns_mm.assign(turns_mm.begin(), turns_mm.end());
  out.mean_mm.assign(alpha_rad.size(), 0.0);
  for (const auto& turn : turns_mm) {
    for (std::size_t n = 0; n < turn.size(); ++n)
      out.mean_mm[n] += turn[n] / static_cast<double>(turns_mm.size());
  }
  const Eigen::Vector3d centre = plot_centre(alpha_rad, out.mean_mm);
  out.fundamental_mm = std::hypot(centre[1], centre[2]);
  double low = 0.0;
  double high = 0.0;
  for (std::size_t n = 0; n < alpha_rad.size(); ++n) {
    const double circle =
        centre[0] + centre[1] * std::cos(alpha_rad[n]) + centre[2] * std::sin(alpha_rad[n]);
    out.mean_mm[n] -= circle;
    for (auto& turn : out.turns_mm) {
      turn[n] -= circle;
      low = std::min(low, turn[n]);
      high = std::max(high, turn[n]);
    }
  }
  out.total_mm = high - low;
  out.synchronous_mm = peak_to_valley(out.mean_mm);
  if (turns_mm.size() > 1) out.asynchronous_mm = widest_spread(out.turns_mm);
  return out;
}

}  // namespace rondure::fit
