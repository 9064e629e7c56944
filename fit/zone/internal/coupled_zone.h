#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/column_extremes.h"
#include "fit/zone/ending.h"
#include "fit/zone/internal/quadratic_program.h"

namespace rondure::fit {

/// One bound of a coupled zone, over the rows [begin, end): an upper one, whose greatest value is
/// to be small, or a lower one, whose least value is to be great.
struct CoupledBound {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool upper = true;

  [[nodiscard]] double sign() const { return upper ? 1.0 : -1.0; }
};

/// A measure of a point with its derivatives in the unknowns of a place.
struct MeasuredRow {
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

/// A contact of a coupled zone.
struct CoupledContact {
  std::size_t row = 0;
  std::size_t bound = 0;
  double multiplier = 0.0;  ///< Those of one bound sum to 1.
};

/// The equations of Newton's method at the optimum of a coupled zone: unknowns are the moves of the
/// place, those of the bounds, and the multipliers.
class OptimumEquations {
 public:
  OptimumEquations(Eigen::Index place, Eigen::Index bounds, std::size_t contacts);

  /// Sets contact i, of a bound that is now at `value`.
  void set(std::size_t i, const CoupledContact& contact, double sign, const MeasuredRow& row,
           double value);
  /// @return The unknowns; nothing if the equations are singular.
  [[nodiscard]] std::optional<Eigen::VectorXd> solution() const;
  /// The least unknowns that come nearest to the equations, for contacts that depend on each other.
  [[nodiscard]] Eigen::VectorXd least_solution() const;

 private:
  Eigen::Index place_ = 0;
  Eigen::Index primal_ = 0;
  Eigen::MatrixXd system_;
  Eigen::VectorXd right_;
};

/// A symmetric matrix without the part of its negative eigenvalues.
Eigen::MatrixXd without_negative_part(const Eigen::MatrixXd& matrix);

/// Orthonormal columns that span what is orthogonal to all columns of a matrix.
Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& normals);

/// The part of a vector in the span of orthonormal columns.
Eigen::VectorXd part_along(const Eigen::MatrixXd& columns, const Eigen::VectorXd& v);

/// Least eigenvalue of a symmetric matrix in the span of orthonormal columns.
double least_curvature(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& columns);

template <class Model>
struct CoupledZone {
  Model model;
  Eigen::VectorXd bounds;
  std::vector<CoupledContact> contacts;    ///< Unless converged, of the longest step from here.
  ZoneEnding ending = ZoneEnding::kLimit;  ///< kConverged: a local minimum to second order.
  bool rests = false;  ///< Not converged, but no step from here falls by 1e-9 mm.
};

/// Minimises the sum of upper bounds minus the sum of lower ones over a place that all share: a
/// common datum (a radius for each feature), a zone of several features, the zone of a cone.
///
/// Every step linearises the measures and solves a quadratic programme with the curvature that the
/// contacts of the last step have, and a proximal term, whose reach grows with success. Without the
/// curvature, steps along a valley that hardly falls would end where they climb its sides. The
/// contacts of a step then start Newton's method on the equations of
/// the optimum, which ends the search where all points obey the bounds, the multipliers are >= 0
/// and no direction along the contacts descends.
///
/// Model: kUnknowns; size(); value(row); row(row) -> MeasuredRow; moved(step) -> Model;
/// strayed(from); scale_mm(). All unknowns are in mm.
///
/// Source: methods, drawing sections 3.3 and 9.2.
template <class Model>
class CoupledDescent {
 public:
  CoupledDescent(const Model& start, std::vector<CoupledBound> bounds)
      : bounds_(std::move(bounds)), state_{start, {}, {}, ZoneEnding::kLimit}, start_(start) {}

  CoupledZone<Model> run() {
    constexpr int kSteps = 200;
    // A longer reach would round the step by more than the distances are.
    constexpr double kFarthest = 1e3;
    constexpr double kNearest = 1e-13;
    state_.bounds = bounds_of(state_.model);
    double reach = 1.0;
    for (int i = 0; i < kSteps && reach > kNearest; ++i) {
      const auto step = proximal_step(reach);
      if (!step.solved) break;
      last_ = contacts_of(step);
      if (state_.contacts.empty()) state_.contacts = last_;
      if (polish(with_contacts(last_)) ||
          (hardly_falls(step) && (polish_valley(step) || polish_ridge()))) {
        state_.ending = ZoneEnding::kConverged;
        return state_;
      }
      const Model next = state_.model.moved(step.x.head(kPlace));
      const Eigen::VectorXd there = bounds_of(next);
      if (value_of(there) < value_of(state_.bounds)) {
        state_.model = next;
        state_.bounds = there;
        state_.contacts.clear();
        reach = std::min(4.0 * reach, kFarthest);
        if (!state_.model.strayed(start_)) continue;
        state_.ending = ZoneEnding::kStrayed;
        return state_;
      }
      reach *= 0.25;
    }
    // Contacts that nearly depend on each other may leave Newton's method nothing to end at.
    const auto step = proximal_step(kFarthest);
    state_.rests = step.solved && hardly_falls(step);
    if (state_.rests) state_.contacts = contacts_of(step);
    return state_;
  }

 private:
  static constexpr Eigen::Index kPlace = Model::kUnknowns;
  /// Distance from a bound [mm] within which all points of a ridge are in contact: that of
  /// coordinates with eight digits after the point.
  static constexpr double kAlike = 1e-8;

  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(bounds_.size()); }

  [[nodiscard]] Eigen::VectorXd bounds_of(const Model& model) const {
    Eigen::VectorXd out(count());
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      Extremes values;
      for (std::size_t i = bounds_[k].begin; i < bounds_[k].end; ++i) values.take(model.value(i));
      out(static_cast<Eigen::Index>(k)) = bounds_[k].upper ? values.high : values.low;
    }
    return out;
  }

  [[nodiscard]] double value_of(const Eigen::VectorXd& bounds) const {
    double out = 0.0;
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      out += bounds_[k].sign() * bounds(static_cast<Eigen::Index>(k));
    }
    return out;
  }

  [[nodiscard]] double round_off() const {
    return 64.0 * std::numeric_limits<double>::epsilon() * state_.model.scale_mm();
  }

  /// The step (place, bounds) that minimises the linearised value plus its square / (2 reach).
  QuadraticStep proximal_step(double reach) {
    rows_.clear();
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      for (std::size_t i = bounds_[k].begin; i < bounds_[k].end; ++i) rows_.push_back({i, k, 0.0});
    }
    const Eigen::Index unknowns = kPlace + count();
    Eigen::MatrixXd normals =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()), unknowns);
    Eigen::VectorXd limits(normals.rows());
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const auto at = static_cast<Eigen::Index>(r);
      const auto bound = static_cast<Eigen::Index>(rows_[r].bound);
      const double sign = bounds_[rows_[r].bound].sign();
      const auto [value, gradient] = state_.model.slope(rows_[r].row);
      normals.row(at).head(kPlace) = -sign * gradient.transpose();
      normals(at, kPlace + bound) = sign;
      limits(at) = -sign * (state_.bounds(bound) - value);
    }
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(unknowns);
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      gradient(kPlace + static_cast<Eigen::Index>(k)) = bounds_[k].sign();
    }
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Identity(unknowns, unknowns) / reach;
    hessian.topLeftCorner(kPlace, kPlace) += curvature();
    return solve_quadratic_program(hessian, gradient, normals, limits, round_off());
  }

  /// Curvature of the value along the contacts of the last step, without its negative part.
  [[nodiscard]] Eigen::MatrixXd curvature() const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kPlace, kPlace);
    for (const CoupledContact& c : last_) {
      out += c.multiplier * bounds_[c.bound].sign() * state_.model.row(c.row).hessian;
    }
    return without_negative_part(out);
  }

  [[nodiscard]] std::vector<CoupledContact> contacts_of(const QuadraticStep& step) const {
    std::vector<CoupledContact> out;
    for (std::size_t i = 0; i < step.active.size(); ++i) {
      out.push_back(rows_[step.active[i]]);
      out.back().multiplier = step.multipliers[i];
    }
    return out;
  }

  [[nodiscard]] CoupledZone<Model> with_contacts(
      const std::vector<CoupledContact>& contacts) const {
    CoupledZone<Model> out = state_;
    out.contacts = contacts;
    return out;
  }

  [[nodiscard]] bool hardly_falls(const QuadraticStep& step) const {
    constexpr double kHardly = 1e-9;  // mm
    double fall = 0.0;
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      fall -= bounds_[k].sign() * step.x(kPlace + static_cast<Eigen::Index>(k));
    }
    return fall <= kHardly;
  }

  /// Where too few contacts hold a place that the value hardly distinguishes from its neighbours,
  /// as a datum that rocks, the optimum lies where the next points come into contact.
  bool polish_valley(const QuadraticStep& step) {
    const Eigen::VectorXd& x = step.x;
    for (const double sense : {1.0, -1.0}) {
      CoupledZone<Model> at = with_contacts(last_);
      while (meet_next(sense * x, at)) {
      }
      if (at.contacts.size() > last_.size() && polish(std::move(at))) return true;
    }
    return false;
  }

  /// Where whole lines of points touch alike, as the two generatrices of an oval, no few of them
  /// hold the place: it is held by the curvature of all together, whose multipliers depend on each
  /// other.
  bool polish_ridge() {
    CoupledZone<Model> at = with_contacts({});
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      const std::size_t first = at.contacts.size();
      const double bound = at.bounds(static_cast<Eigen::Index>(k));
      for (std::size_t i = bounds_[k].begin; i < bounds_[k].end; ++i) {
        if (std::abs(at.model.value(i) - bound) <= kAlike) at.contacts.push_back({i, k, 0.0});
      }
      for (std::size_t c = first; c < at.contacts.size(); ++c) {
        at.contacts[c].multiplier = 1.0 / static_cast<double>(at.contacts.size() - first);
      }
    }
    return polish(std::move(at), kAlike);
  }

  /// Moves as far in a direction, with all contacts kept, as the next point allows.
  /// @return Whether there is such a direction and such a point, now a contact.
  bool meet_next(const Eigen::VectorXd& toward, CoupledZone<Model>& at) const {
    if (static_cast<Eigen::Index>(at.contacts.size()) >= kPlace + count()) return false;
    const Eigen::MatrixXd along = kept_moves(at);
    const Eigen::VectorXd move = part_along(along, toward);
    if (!(move.norm() > 1e-6 * toward.norm())) return false;
    double nearest = std::numeric_limits<double>::infinity();
    CoupledContact next;
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      const auto bound = static_cast<Eigen::Index>(k);
      for (std::size_t i = bounds_[k].begin; i < bounds_[k].end; ++i) {
        const bool held = std::ranges::any_of(
            at.contacts, [&](const CoupledContact& c) { return c.row == i && c.bound == k; });
        if (held) continue;
        const auto [value, gradient] = at.model.slope(i);
        const double closes =
            bounds_[k].sign() * (gradient.dot(move.head(kPlace)) - move(kPlace + bound));
        const double slack = std::max(0.0, bounds_[k].sign() * (at.bounds(bound) - value));
        if (!(closes > 0.0 && slack < nearest * closes)) continue;
        nearest = slack / closes;
        next = {i, k, 0.0};
      }
    }
    if (!std::isfinite(nearest)) return false;
    at.model = at.model.moved(nearest * move.head(kPlace));
    at.bounds += nearest * move.tail(count());
    at.contacts.push_back(next);
    return true;
  }

  /// Newton's method on some contacts. Changes the state only if it ends at a minimum.
  /// @param alike  Above 0: the contacts may depend on each other, and touch to within this [mm].
  bool polish(CoupledZone<Model> at, double alike = 0.0) {
    constexpr int kRounds = 30;
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRounds; ++round) {
      const double size = newton_step(at, alike > 0.0);
      if (!(size <= state_.model.scale_mm())) return false;
      const bool rests = size <= 1e-14 * state_.model.scale_mm() ||
                         (size <= 1e-11 * state_.model.scale_mm() && size >= 0.5 * last);
      if (rests) return accept(at, std::max(alike, round_off()));
      last = size;
    }
    return false;
  }

  /// @return The size of the step in the place; not a number if the equations are singular.
  double newton_step(CoupledZone<Model>& at, bool dependent) const {
    OptimumEquations equations(kPlace, count(), at.contacts.size());
    for (std::size_t i = 0; i < at.contacts.size(); ++i) {
      const CoupledContact& c = at.contacts[i];
      equations.set(i, c, bounds_[c.bound].sign(), at.model.row(c.row),
                    at.bounds(static_cast<Eigen::Index>(c.bound)));
    }
    const std::optional<Eigen::VectorXd> step =
        dependent ? equations.least_solution() : equations.solution();
    if (!step) return std::numeric_limits<double>::quiet_NaN();
    at.model = at.model.moved(step->head(kPlace));
    at.bounds += step->segment(kPlace, count());
    for (std::size_t i = 0; i < at.contacts.size(); ++i) {
      at.contacts[i].multiplier = (*step)(kPlace + count() + static_cast<Eigen::Index>(i));
    }
    return step->head(kPlace).cwiseAbs().maxCoeff();
  }

  bool accept(CoupledZone<Model>& at, double tolerance) {
    for (const CoupledContact& c : at.contacts) {
      if (!(c.multiplier >= 0.0)) return false;
    }
    const Eigen::VectorXd exact = bounds_of(at.model);
    if (!((exact - at.bounds).cwiseAbs().maxCoeff() <= tolerance)) return false;
    if (!(value_of(exact) <= value_of(state_.bounds) + tolerance) || !curves_up(at)) return false;
    at.bounds = exact;
    state_ = at;
    return true;
  }

  /// Moves of place and bounds that keep all contacts to first order, as orthonormal columns.
  [[nodiscard]] Eigen::MatrixXd kept_moves(const CoupledZone<Model>& at) const {
    const auto contacts = static_cast<Eigen::Index>(at.contacts.size());
    const Eigen::Index primal = kPlace + count();
    Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(primal, contacts);
    for (Eigen::Index i = 0; i < contacts; ++i) {
      const CoupledContact& c = at.contacts[static_cast<std::size_t>(i)];
      normals.col(i).head(kPlace) = -at.model.slope(c.row).second;
      normals(kPlace + static_cast<Eigen::Index>(c.bound), i) = 1.0;
    }
    return orthogonal_complement(normals);
  }

  /// Whether the value does not fall in any direction that keeps all contacts.
  [[nodiscard]] bool curves_up(const CoupledZone<Model>& at) const {
    const Eigen::Index primal = kPlace + count();
    const Eigen::MatrixXd along = kept_moves(at);
    if (along.cols() == 0) return true;
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(primal, primal);
    for (const CoupledContact& c : at.contacts) {
      curvature.topLeftCorner(kPlace, kPlace) +=
          c.multiplier * bounds_[c.bound].sign() * at.model.row(c.row).hessian;
    }
    return least_curvature(curvature, along) > 0.0;
  }

  std::vector<CoupledBound> bounds_;
  CoupledZone<Model> state_;
  Model start_;
  std::vector<CoupledContact> rows_;
  std::vector<CoupledContact> last_;  ///< Contacts of the last step.
};

}  // namespace rondure::fit
