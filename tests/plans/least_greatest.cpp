#include "tests/plans/least_greatest.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/decompositions.h"

namespace rondure::plans {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// log(sum(exp(sharpness * value))) / sharpness, summed over the groups, with its derivatives.
struct Bound {
  double value = 0.0;
  VectorXd gradient;
  MatrixXd hessian;
};

Bound bound_of(const std::vector<Functions>& groups, Eigen::Index unknowns, double sharpness_1_mm) {
  Bound out{0.0, VectorXd::Zero(unknowns), MatrixXd::Zero(unknowns, unknowns)};
  for (const Functions& group : groups) {
    const double greatest = group.value.maxCoeff();
    VectorXd share = ((group.value.array() - greatest) * sharpness_1_mm).exp();
    const double sum = share.sum();
    share /= sum;
    const VectorXd gradient = group.gradient.transpose() * share;
    out.value += greatest + std::log(sum) / sharpness_1_mm;
    out.gradient += gradient;
    out.hessian +=
        sharpness_1_mm * (group.gradient.transpose() * share.asDiagonal() * group.gradient -
                          gradient * gradient.transpose());
  }
  return out;
}

}  // namespace

std::optional<VectorXd> least_greatest(const Groups& groups, VectorXd start) {
  constexpr double kSharpest_1_mm = 1e10;
  constexpr double kSettled_mm = 1e-9;
  constexpr int kSteps = 60;
  VectorXd x = std::move(start);
  double expected_mm = 1.0;
  for (double sharpness = 1e2; sharpness <= kSharpest_1_mm; sharpness *= 3.0) {
    double damping = 1e-9;
    Bound at = bound_of(groups(x), x.size(), sharpness);
    for (int i = 0; i < kSteps; ++i) {
      MatrixXd damped = at.hessian;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-15 * at.hessian.diagonal().maxCoeff() + 1e-300;
      const VectorXd step = -core::solve_ldlt(damped, at.gradient);
      expected_mm = -0.5 * at.gradient.dot(step);
      if (!step.allFinite() || expected_mm < 1e-3 * kSettled_mm) break;
      const Bound next = bound_of(groups(x + step), x.size(), sharpness);
      if (next.value < at.value) {
        x += step;
        at = next;
        damping = std::max(1e-9, 0.1 * damping);
      } else {
        damping *= 10.0;
        if (damping > 1e12) break;
      }
    }
  }
  if (!(std::abs(expected_mm) < kSettled_mm)) return std::nullopt;
  return x;
}

}  // namespace rondure::plans
