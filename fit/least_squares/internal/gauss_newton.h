#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Core>

#include "core/decompositions.h"

namespace rondure::fit {

/// Sets with more points than this start from the shape fitted to a sample of this size.
inline constexpr std::size_t kStartSample = 1000;
/// In the algebraic circle, a determinant below this share of (Suu + Svv)^2 is round-off: the
/// points are on a line.
inline constexpr double kCollinearShare = 1e-12;

/// Gauss-Newton sums of residuals d with gradients g over n points: matrix = sum of g g^T, right =
/// -sum of g d, squares = sum of d^2.
template <int N>
struct NormalSums {
  Eigen::Matrix<double, N, N> matrix = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, 1> right = Eigen::Matrix<double, N, 1>::Zero();
  double squares = 0.0;
};

/// Minimises a sum of squared distances by Levenberg-Marquardt, from a rough start until the step
/// is round-off. settle() and polish() serve the circle, the sphere and the cylinder.
///
/// @param model  Has `kUnknowns`, `moved(step)` and `scale_mm()`, the size with which steps are
///               compared.
/// @param sums_at  `sums_at(model, with_matrix)` returns the NormalSums of a model.
/// @return Whether it converged; if so, `model` is the result and `squares` its sum of squares.
template <class Model, class SumsAt>
[[nodiscard]] bool settle(Model& model, double& squares, const SumsAt& sums_at) {
  using Step = Eigen::Matrix<double, Model::kUnknowns, 1>;
  constexpr int kIterationLimit = 300;
  auto sums = sums_at(model, true);
  double damping = 1e-6;
  double last = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (int i = 0; i < kIterationLimit; ++i) {
    auto damped = sums.matrix;
    damped.diagonal() *= 1.0 + damping;
    const Step step = core::solve_ldlt(damped, sums.right);
    if (!step.allFinite()) return false;
    const double size = step.cwiseAbs().maxCoeff();
    const double scale = model.scale_mm();
    const Model next = model.moved(step);
    // Near the end the sum of squares is constant to round-off. A shrinking step is then the sign
    // of progress, and its rate of shrinking gives the size of the remaining step.
    const bool rounding = size <= 1e-7 * scale;
    if (rounding && damping == 0.0) {
      stalled += size >= 0.5 * last ? 1 : 0;
      const double left = size * std::min(1.0, size / last);
      if (left <= 1e-14 * scale || (stalled > 0 && size <= 1e-12 * scale) ||
          (stalled > 9 && size <= 1e-11 * scale)) {
        squares = std::max(0.0, sums.squares - sums.right.dot(step));
        model = next;
        return true;
      }
    }
    const auto there = sums_at(next, true);
    if (rounding || there.squares <= sums.squares) {
      model = next;
      sums = there;
      damping = rounding ? 0.0 : damping * 0.1;
      last = size;
      continue;
    }
    damping = std::max(10.0 * damping, 1e-6);
    if (damping > 1e12) return false;
  }
  return false;
}

/// Minimises by Gauss-Newton from a model near the minimum, with the matrix of the first pass kept:
/// each pass reduces the error to a share of about form / radius. One pass with the matrix, then
/// passes without it, usually two in all.
///
/// @param last_step  Receives the step taken after the last pass.
/// @return Whether it converged, as settle(); false if the sums are not finite.
template <class Model, class SumsAt>
[[nodiscard]] bool polish(Model& model, double& squares, const SumsAt& sums_at,
                          Eigen::Matrix<double, Model::kUnknowns, 1>& last_step) {
  constexpr int kPassLimit = 12;
  auto sums = sums_at(model, true);
  if (!std::isfinite(sums.squares)) return false;
  const auto factors = sums.matrix.ldlt();
  double last = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < kPassLimit; ++pass) {
    if (pass > 0) sums = sums_at(model, false);
    last_step = core::solve_ldlt(factors, sums.right);
    if (!last_step.allFinite()) return false;
    const double size = last_step.cwiseAbs().maxCoeff();
    const double scale = model.scale_mm();
    model = model.moved(last_step);
    const bool slow = size >= 0.3 * last;
    if (pass > 0 &&
        (size * std::min(1.0, size / last) <= 1e-13 * scale || (slow && size <= 1e-12 * scale))) {
      squares = std::max(0.0, sums.squares - sums.right.dot(last_step));
      return true;
    }
    if (slow) return false;
    last = size;
  }
  return false;
}

}  // namespace rondure::fit
