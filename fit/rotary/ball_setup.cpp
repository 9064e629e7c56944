#include "fit/rotary/ball_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/decompositions.h"

namespace rondure::fit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Balls about their centroid.
struct Spread {
  Vector3d centroid = Vector3d::Zero();
  double squares = 0.0;                     ///< Sum of |q|^2.
  Matrix3d products = Matrix3d::Zero();     ///< Sum of q q^T.
  Vector3d eigenvalues = Vector3d::Zero();  ///< Eigenvalues of the products, ascending.
};

Spread spread_of(SpacePoints p) {
  Spread out;
  const auto n = static_cast<double>(p.size());
  for (const Vector3d& one : p) out.centroid += one / n;
  for (const Vector3d& one : p) {
    const Vector3d q = one - out.centroid;
    out.squares += q.squaredNorm();
    out.products += q * q.transpose();
  }
  out.eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix3d>(out.products, Eigen::EigenvaluesOnly)
                        .eigenvalues()
                        .cwiseMax(0.0);
  return out;
}

/// Second singular value of the centred balls divided by the first.
double flatness(const Spread& s) {
  return s.eigenvalues(2) > 0.0 ? std::sqrt(s.eigenvalues(1) / s.eigenvalues(2)) : 0.0;
}

/// Condition at the centroid, where translations and rotations decouple: n I and M / l^2.
double condition_of(const Spread& s, double n) {
  const double l2 = s.squares / n;
  if (!(l2 > 0.0)) return kInfinity;
  const Vector3d m = (Vector3d::Constant(s.squares) - s.eigenvalues) / l2;
  const double least = std::min(n, m.minCoeff());
  return least > 1e-24 * n ? std::sqrt(std::max(n, m.maxCoeff()) / least) : kInfinity;
}

/// The two balls farthest apart.
std::pair<std::size_t, std::size_t> farthest(SpacePoints p) {
  std::pair<std::size_t, std::size_t> out = {0, 0};
  double best = -1.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      if ((p[i] - p[j]).norm() <= best) continue;
      best = (p[i] - p[j]).norm();
      out = {i, j};
    }
  }
  return out;
}

/// Distance from the line through the balls at which a further ball beside their centroid gives a
/// good condition, rounded up to two digits.
double distance_that_cures(SpacePoints p, const Vector3d& along) {
  std::vector<Vector3d> with(p.begin(), p.end());
  const Vector3d foot = spread_of(p).centroid;
  const Vector3d beside = along.unitOrthogonal();
  with.push_back(foot);
  const auto condition_at = [&](double distance) {
    with.back() = foot + distance * beside;
    return condition_of(spread_of(with), static_cast<double>(with.size()));
  };
  double high = 1e-3 * along.norm();
  while (condition_at(high) > kConditionWarning && high < 1e3 * along.norm()) high *= 1.05;
  const double step = std::pow(10.0, std::floor(std::log10(high)) - 1.0);
  return std::ceil(high / step) * step;
}

core::Error too_few(SpacePoints p, std::span<const std::string> names) {
  const auto [i, j] = farthest(p);
  if (p.size() == 2 && (p[i] - p[j]).norm() > 0.0) {
    return {core::Code::kTooFewPoints,
            fmt::format("2 balls leave the turn about the line through them undetermined, at least "
                        "3 are needed: add a ball off the line through {} and {}, at least {:g} mm "
                        "from it",
                        names[i], names[j], distance_that_cures(p, p[j] - p[i]))};
  }
  return {core::Code::kTooFewPoints,
          fmt::format("{} ball{}, at least 3 not on one line are needed; 4 to 6 round the part are "
                      "better, because a wrong one can then be found",
                      p.size(), p.size() == 1 ? "" : "s")};
}

}  // namespace

double setup_condition(SpacePoints p_mm) {
  const Spread s = spread_of(p_mm);
  if (!(s.eigenvalues(1) > 1e-12 * s.eigenvalues(2))) return kInfinity;
  return condition_of(s, static_cast<double>(p_mm.size()));
}

core::Result<void> check_setup(SpacePoints p_mm, std::span<const std::string> names) {
  if (p_mm.size() < 3) return core::fail(too_few(p_mm, names));
  const Spread s = spread_of(p_mm);
  const double ratio = flatness(s);
  const double condition = condition_of(s, static_cast<double>(p_mm.size()));
  if (ratio >= 1e-3 && condition <= kConditionLimit) return {};
  const auto [i, j] = farthest(p_mm);
  const Vector3d along = p_mm[j] - p_mm[i];
  if (!(along.norm() > 0.0)) {
    return core::fail(core::Code::kCollinear, "all balls stand at one place; spread them");
  }
  return core::fail_with(
      core::Code::kCollinear,
      "the {} balls lie on one line (spread across it over spread along it {:.2g}, least 0.001; "
      "condition {}, limit {:g}), so that the turn about it is not determined: add a ball off the "
      "line through {} and {}, at least {:g} mm from it",
      p_mm.size(), ratio,
      std::isfinite(condition) ? fmt::format("{:.3g}", condition) : "without a bound",
      kConditionLimit, names[i], names[j], distance_that_cures(p_mm, along));
}

}  // namespace rondure::fit
