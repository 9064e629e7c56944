#include "descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "simplex.h"

namespace rondure::test {
namespace {

using Vector = LinearProgram::Vector;
using Matrix = LinearProgram::Matrix;

/// Distances and their gradients at a place; unknowns in mm.
struct Linearised {
  Vector distance;
  Matrix gradient;  // one column a point

  [[nodiscard]] Extremes extremes() const { return {distance.minCoeff(), distance.maxCoeff()}; }
};

class Circle {
 public:
  Circle(std::span<const Eigen::Vector2d> points, Vector2r center)
      : points_(points), center_(std::move(center)) {}

  [[nodiscard]] Linearised rows() const {
    const auto n = static_cast<Eigen::Index>(points_.size());
    Linearised out{Vector(n), Matrix(2, n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vector2r v = points_[static_cast<std::size_t>(i)].cast<Real>() - center_;
      out.distance(i) = v.norm();
      out.gradient.col(i) = -v / v.norm();
    }
    return out;
  }
  void move(const Vector& step) { center_ += step; }
  [[nodiscard]] const Vector2r& center() const { return center_; }

 private:
  std::span<const Eigen::Vector2d> points_;
  Vector2r center_;
};

class Cylinder {
 public:
  Cylinder(std::span<const Eigen::Vector3d> points, const Vector3r& point,
           const Vector3r& direction)
      : points_(points), direction_(direction.normalized()), point_(point) {
    Real low = std::numeric_limits<Real>::infinity();
    Real high = -low;
    for (const auto& p : points) {
      const Real s = (p.cast<Real>() - point).dot(direction_);
      low = std::min(low, s);
      high = std::max(high, s);
    }
    point_ += direction_ * ((low + high) / 2.0L);
    half_ = (high - low) / 2.0L;
    turn();
  }

  [[nodiscard]] Linearised rows() const {
    const auto n = static_cast<Eigen::Index>(points_.size());
    Linearised out{Vector(n), Matrix(4, n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vector3r v = points_[static_cast<std::size_t>(i)].cast<Real>() - point_;
      const Real s = v.dot(direction_);
      const Vector2r q(v.dot(u_), v.dot(w_));
      out.distance(i) = q.norm();
      const Vector2r n_i = q / q.norm();
      out.gradient.col(i) << -n_i.x(), -n_i.y(), -s / half_ * n_i.x(), -s / half_ * n_i.y();
    }
    return out;
  }
  void move(const Vector& step) {
    point_ += step(0) * u_ + step(1) * w_;
    direction_ = (direction_ + step(2) / half_ * u_ + step(3) / half_ * w_).normalized();
    turn();
  }
  [[nodiscard]] const Vector3r& point() const { return point_; }
  [[nodiscard]] const Vector3r& direction() const { return direction_; }

 private:
  void turn() {
    u_ = direction_.unitOrthogonal();
    w_ = direction_.cross(u_);
  }

  std::span<const Eigen::Vector3d> points_;
  Vector3r direction_;
  Vector3r point_;
  Vector3r u_ = Vector3r::UnitX();
  Vector3r w_ = Vector3r::UnitY();
  Real half_ = 1.0L;
};

/// The dual of:  minimise H - G (or H, or -G)  with  r_i + J_i x <= H,  r_i + J_i x >= G,
/// |x|_inf <= box.  Columns: outer weights, inner weights, weights of the box. The farthest and the
/// nearest point with the box sides that oppose them are a feasible basis.
class Step {
 public:
  Step(const Linearised& at, Reference reference, Real box) : at_(at), reference_(reference) {
    const Eigen::Index n = at.distance.size();
    const Eigen::Index k = at.gradient.rows();
    const Eigen::Index sides = (outer() ? 1 : 0) + (inner() ? 1 : 0);
    mean_ = at.distance.mean();
    lp_.rows = Matrix::Zero(k + sides, sides * n + 2 * k);
    lp_.right = Vector::Zero(k + sides);
    lp_.cost = Vector::Constant(sides * n + 2 * k, box);
    Vector opposed = Vector::Zero(k);
    Eigen::Index side = 0;
    if (outer()) add_side(side++, 1.0L, opposed);
    if (inner()) add_side(side++, -1.0L, opposed);
    for (Eigen::Index j = 0; j < k; ++j) {
      lp_.rows(sides + j, sides * n + 2 * j) = 1.0L;
      lp_.rows(sides + j, sides * n + 2 * j + 1) = -1.0L;
      basis_.push_back(sides * n + 2 * j + (opposed(j) >= 0.0L ? 0 : 1));
    }
  }

  [[nodiscard]] Vector solve() const {
    const Vector pi = multipliers(lp_, basis_);
    return -pi.tail(at_.gradient.rows());
  }
  /// The linearised objective after a step.
  [[nodiscard]] Real promised(const Vector& step) const {
    const Vector r = at_.distance + at_.gradient.transpose() * step;
    return Extremes{r.minCoeff(), r.maxCoeff()}.value_mm(reference_);
  }

 private:
  [[nodiscard]] bool outer() const { return reference_ != Reference::kInscribed; }
  [[nodiscard]] bool inner() const { return reference_ != Reference::kCircumscribed; }

  void add_side(Eigen::Index side, Real sign, Vector& opposed) {
    const Eigen::Index n = at_.distance.size();
    const Eigen::Index k = at_.gradient.rows();
    Eigen::Index first = 0;
    (sign * at_.distance).maxCoeff(&first);
    for (Eigen::Index i = 0; i < n; ++i) {
      lp_.rows(side, side * n + i) = 1.0L;
      lp_.rows.col(side * n + i).tail(k) = -sign * at_.gradient.col(i);
      lp_.cost(side * n + i) = -sign * (at_.distance(i) - mean_);
    }
    lp_.right(side) = 1.0L;
    opposed += sign * at_.gradient.col(first);
    basis_.push_back(side * n + first);
  }

  const Linearised& at_;
  Reference reference_;
  Real mean_ = 0.0L;
  LinearProgram lp_;
  std::vector<Eigen::Index> basis_;
};

/// The trust-region loop.
template <class Place>
Extremes slide(Place& place, Reference reference, Real box) {
  Linearised at = place.rows();
  const Real least = 1e-19L * at.distance.maxCoeff();
  for (int programme = 0; programme < 600 && box > least; ++programme) {
    const Step step(at, reference, box);
    const Vector x = step.solve();
    const Real value = at.extremes().value_mm(reference);
    const Real promised = value - step.promised(x);
    if (!(promised > least)) break;
    Place moved = place;
    moved.move(x);
    Linearised there = moved.rows();
    const Real gained = value - there.extremes().value_mm(reference);
    if (gained >= 0.1L * promised) {
      place = moved;
      at = std::move(there);
      if (gained >= 0.75L * promised) box *= 2.0L;
    } else {
      box = std::min(box, x.cwiseAbs().maxCoeff()) / 2.0L;
    }
  }
  return at.extremes();
}

}  // namespace

Extremes extremes(std::span<const Eigen::Vector2d> points_mm, const Vector2r& center_mm) {
  return Circle(points_mm, center_mm).rows().extremes();
}

Extremes extremes(std::span<const Eigen::Vector3d> points_mm, const Vector3r& point_mm,
                  const Vector3r& direction) {
  return Cylinder(points_mm, point_mm, direction).rows().extremes();
}

CircleOptimum descend(std::span<const Eigen::Vector2d> points_mm, const Vector2r& center_mm,
                      Reference reference, Real reach_mm) {
  Circle place(points_mm, center_mm);
  const Extremes at = slide(place, reference, reach_mm);
  return {place.center(), at};
}

AxisOptimum descend(std::span<const Eigen::Vector3d> points_mm, const Vector3r& point_mm,
                    const Vector3r& direction, Reference reference, Real reach_mm) {
  Cylinder place(points_mm, point_mm, direction);
  const Extremes at = slide(place, reference, reach_mm);
  return {place.point(), place.direction(), at};
}

}  // namespace rondure::test
