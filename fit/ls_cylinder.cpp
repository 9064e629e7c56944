#include "fit/ls_cylinder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "core/units.h"
#include "fit/cylinder_frame.h"
#include "fit/cylinder_start.h"
#include "fit/ls_circle.h"
#include "fit/points.h"

namespace rondure::fit {
namespace {

constexpr int kIterationLimit = 300;

// Squared extents below this share are round-off of the sums: 3e-8 of the largest extent.
constexpr double kFlat = 1e-15;

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Points = std::span<const Eigen::Vector3d>;

struct Sums {
  Matrix5 matrix = Matrix5::Zero();
  Vector5 right = Vector5::Zero();
  double squares = 0.0;
};

Sums sums_at(Points points, const CylinderFrame& frame, double radius) {
  Sums out;
  for (const Eigen::Vector3d& p : points) {
    const ContactRow<4> row = frame.contact_row(p, 0);
    Vector5 g;
    g << row.gradient, -1.0;
    const double residual = row.distance - radius;
    out.matrix.selfadjointView<Eigen::Lower>().rankUpdate(g);
    out.right -= g * residual;
    out.squares += residual * residual;
  }
  out.matrix.triangularView<Eigen::StrictlyUpper>() = out.matrix.transpose();
  return out;
}

struct State {
  CylinderFrame frame;
  double radius = 0.0;
  Sums sums;
};

/// Levenberg-Marquardt until the step is round-off.
/// @return Whether it settled.
bool settle(Points points, State& state) {
  double damping = 1e-6;
  double last_step = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kIterationLimit; ++i) {
    Matrix5 damped = state.sums.matrix;
    damped.diagonal() *= 1.0 + damping;
    const Vector5 step = damped.ldlt().solve(state.sums.right);
    if (!step.allFinite()) return false;
    const double size = step.cwiseAbs().maxCoeff();
    const double scale = std::abs(state.radius) + state.frame.half_length_mm();
    State next{state.frame.moved(step.head<4>()), state.radius + step(4), {}};
    next.sums = sums_at(points, next.frame, next.radius);
    // Near the end the sum of squares is constant to round-off; there a shrinking step is progress.
    const bool rounding = size <= 1e-7 * scale;
    if (next.sums.squares <= state.sums.squares || rounding) {
      state = next;
      damping = rounding ? 0.0 : damping * 0.1;
      if (size <= 1e-15 * scale || (size <= 1e-12 * scale && size >= 0.5 * last_step)) return true;
      last_step = size;
      continue;
    }
    damping = std::max(10.0 * damping, 1e-6);
    if (damping > 1e12) return false;
  }
  return false;
}

/// Start from the algebraic circle of the projection along a direction.
core::Result<State> start(Points points, const Eigen::Vector3d& direction) {
  const auto frame = across(direction);
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& p : points) flat.emplace_back(frame.transpose() * p);
  const auto circle = algebraic_circle(flat);
  if (!circle) return core::fail(circle.error());
  const double half = half_extent(points, direction);
  State state{
      CylinderFrame({frame * circle->center_mm, direction}, half > 0.0 ? half : circle->radius_mm),
      circle->radius_mm,
      {}};
  state.sums = sums_at(points, state.frame, state.radius);
  return state;
}

LsCylinder finish(Points points, const State& state, const Eigen::Vector3d& mean) {
  LsCylinder out;
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const double r = state.frame.distance(p);
    low = std::min(low, r);
    high = std::max(high, r);
  }
  Axis axis = state.frame.axis();
  axis.point_mm += mean;
  out.axis = conventional(axis, mean);
  out.radius_mm = state.radius;
  out.deviation_mm = high - low;
  out.rms_mm = std::sqrt(state.sums.squares / static_cast<double>(points.size()));
  return out;
}

core::Result<void> check_rank(Points points) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += p * p.transpose();
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  if (spread(1) <= kFlat * spread(2)) {
    return core::fail(core::Code::kCollinear, "the points lie on one straight line");
  }
  if (spread(0) <= kFlat * spread(2)) {
    return core::fail(core::Code::kRank,
                      "all points lie in one plane: the tilt of a cylinder is undetermined, only "
                      "roundness can be given (fit circle)");
  }
  return {};
}

}  // namespace

core::Result<LsCylinder> ls_cylinder(Points points_mm,
                                     const std::optional<Eigen::Vector3d>& near_direction) {
  if (auto checked = check_points(points_mm); !checked) return core::fail(checked.error());
  if (distinct_points(points_mm, 5) < 5) {
    return core::fail(core::Code::kTooFewPoints,
                      fmt::format("a cylinder needs at least 5 different points, there are {}",
                                  distinct_points(points_mm, 5)));
  }
  const Eigen::Vector3d mean = mean_point(points_mm);
  std::vector<Eigen::Vector3d> points;
  points.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) points.emplace_back(p - mean);
  if (auto ranked = check_rank(points); !ranked) return core::fail(ranked.error());

  const auto directions = near_direction
                              ? std::vector<Eigen::Vector3d>{near_direction->normalized()}
                              : start_directions(points);
  const State* best = nullptr;
  std::vector<State> settled;
  settled.reserve(directions.size());
  core::Error last{core::Code::kNotConverged, "the least-squares cylinder did not settle", {}};
  for (const Eigen::Vector3d& direction : directions) {
    auto state = start(points, direction);
    if (!state) {
      last = state.error();
      continue;
    }
    if (!settle(points, *state)) continue;
    settled.push_back(*state);
    if (best == nullptr || settled.back().sums.squares < best->sums.squares) best = &settled.back();
  }
  if (best == nullptr) return core::fail(last);
  return finish(points, *best, mean);
}

}  // namespace rondure::fit
