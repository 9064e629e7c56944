#include "fit/zone/internal/quadratic_program.h"

#include <cmath>
#include <limits>

#include "core/decompositions.h"

namespace rondure::fit {
namespace {

constexpr int kExchanges = 500;
/// A normal whose part independent of the active ones is a smaller share (squared) depends on them.
constexpr double kDependentShare = 1e-22;

/// Lower Cholesky factor; a handful of unknowns needs no library.
Eigen::MatrixXd factor_of(const Eigen::MatrixXd& h) {
  const Eigen::Index n = h.rows();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      double sum = h(i, j);
      for (Eigen::Index k = 0; k < j; ++k) sum -= out(i, k) * out(j, k);
      out(i, j) = i == j ? std::sqrt(sum) : sum / out(j, j);
    }
  }
  return out;
}

Eigen::VectorXd forward(const Eigen::MatrixXd& lower, Eigen::VectorXd v) {
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    for (Eigen::Index k = 0; k < i; ++k) v(i) -= lower(i, k) * v(k);
    v(i) /= lower(i, i);
  }
  return v;
}

Eigen::VectorXd backward(const Eigen::MatrixXd& lower, Eigen::VectorXd v) {
  for (Eigen::Index i = v.size() - 1; i >= 0; --i) {
    for (Eigen::Index k = i + 1; k < v.size(); ++k) v(i) -= lower(k, i) * v(k);
    v(i) /= lower(i, i);
  }
  return v;
}

/// The active limits, in coordinates in which H is the identity.
class ActiveLimits {
 public:
  explicit ActiveLimits(Eigen::Index unknowns) : normals_(unknowns, 0) {}

  [[nodiscard]] Eigen::Index size() const { return normals_.cols(); }
  void append(std::size_t row, const Eigen::VectorXd& normal, double multiplier) {
    normals_.conservativeResize(Eigen::NoChange, size() + 1);
    normals_.col(size() - 1) = normal;
    rows.push_back(row);
    multipliers.push_back(multiplier);
  }
  void drop(Eigen::Index i) {
    const Eigen::Index behind = size() - i - 1;
    const Eigen::MatrixXd rest = normals_.rightCols(behind);
    normals_.middleCols(i, behind) = rest;
    normals_.conservativeResize(Eigen::NoChange, size() - 1);
    rows.erase(rows.begin() + i);
    multipliers.erase(multipliers.begin() + i);
  }
  /// Splits a normal into active ones, with the coefficients returned, and the rest.
  Eigen::VectorXd split(Eigen::VectorXd& rest) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
    if (size() == 0) return out;
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(normals_);
    for (int pass = 0; pass < 2; ++pass) {  // the second pass removes the rounding of the first
      const Eigen::VectorXd more = core::solve_qr(factors, rest);
      out += more;
      rest -= normals_ * more;
    }
    return out;
  }
  /// The point nearest to `free` on which all active limits hold exactly.
  Eigen::VectorXd settle(const Eigen::VectorXd& free, const Eigen::VectorXd& limits) {
    if (size() == 0) return free;
    Eigen::VectorXd missing(size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      missing(i) = limits(static_cast<Eigen::Index>(rows[static_cast<std::size_t>(i)])) -
                   normals_.col(i).dot(free);
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(normals_);
    const Eigen::MatrixXd upper = factors.matrixQR().topRows(size());
    Eigen::VectorXd v = missing;
    for (Eigen::Index i = 0; i < size(); ++i) {
      for (Eigen::Index k = 0; k < i; ++k) v(i) -= upper(k, i) * v(k);
      v(i) /= upper(i, i);
    }
    for (Eigen::Index i = size() - 1; i >= 0; --i) {
      for (Eigen::Index k = i + 1; k < size(); ++k) v(i) -= upper(i, k) * v(k);
      v(i) /= upper(i, i);
    }
    for (Eigen::Index i = 0; i < size(); ++i) multipliers[static_cast<std::size_t>(i)] = v(i);
    return free + normals_ * v;
  }

  std::vector<std::size_t> rows;
  std::vector<double> multipliers;

 private:
  Eigen::MatrixXd normals_;
};

/// Lets a violated limit enter. @return Whether that is possible, and within the exchanges left.
bool enter_limit(std::size_t row, const Eigen::VectorXd& normal, double limit, Eigen::VectorXd& y,
                 ActiveLimits& active, int& exchanges) {
  double multiplier = 0.0;
  while (++exchanges <= kExchanges) {
    Eigen::VectorXd rest = normal;
    const Eigen::VectorXd share = active.split(rest);
    const bool dependent = rest.squaredNorm() <= kDependentShare * normal.squaredNorm();
    const double infinite = std::numeric_limits<double>::infinity();
    const double full = dependent ? infinite : (limit - normal.dot(y)) / rest.dot(normal);
    double step = full;
    Eigen::Index leaving = -1;
    for (Eigen::Index i = 0; i < active.size(); ++i) {
      const double most = active.multipliers[static_cast<std::size_t>(i)] / share(i);
      if (share(i) > 0.0 && most < step) {
        step = most;
        leaving = i;
      }
    }
    if (!std::isfinite(step)) return false;
    if (!dependent) y += step * rest;
    for (Eigen::Index i = 0; i < active.size(); ++i) {
      active.multipliers[static_cast<std::size_t>(i)] -= step * share(i);
    }
    multiplier += step;
    if (leaving < 0) {
      active.append(row, normal, multiplier);
      return true;
    }
    active.drop(leaving);
  }
  return false;
}

}  // namespace

QuadraticStep solve_quadratic_program(const Eigen::MatrixXd& hessian,
                                      const Eigen::VectorXd& gradient,
                                      const Eigen::MatrixXd& normals, const Eigen::VectorXd& limits,
                                      double tolerance) {
  const Eigen::MatrixXd lower = factor_of(hessian);
  const Eigen::VectorXd free = -forward(lower, gradient);
  Eigen::VectorXd y = free;
  ActiveLimits active(gradient.size());
  QuadraticStep out;
  int exchanges = 0;
  while (true) {
    out.x = backward(lower, y);
    if (normals.rows() == 0) break;
    Eigen::Index row = 0;
    const double slack = (normals * out.x - limits).minCoeff(&row);
    if (!(slack < -tolerance)) break;
    if (!enter_limit(static_cast<std::size_t>(row), forward(lower, normals.row(row).transpose()),
                     limits(row), y, active, exchanges)) {
      return out;
    }
  }
  out.x = backward(lower, active.settle(free, limits));
  out.active = active.rows;
  out.multipliers = active.multipliers;
  out.solved = out.x.allFinite();
  return out;
}

}  // namespace rondure::fit
