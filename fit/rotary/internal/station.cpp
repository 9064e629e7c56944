#include "fit/rotary/internal/station.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/LU>

#include "core/decompositions.h"
#include "core/statistics.h"
#include "fit/geometry/registration.h"
#include "fit/rotary/ball_setup.h"

namespace rondure::fit {
namespace {

Matrix36 c_rows(double l, double h, double c_rad) {
  const double s = std::sin(c_rad);
  const double c = std::cos(c_rad);
  Matrix36 out;
  out << 1.0, 0.0, 0.0, 0.0, -l, -h * c,  //
      0.0, 1.0, 0.0, l, 0.0, -h * s,      //
      0.0, 0.0, 1.0, h * c, h * s, 0.0;
  return out;
}

Matrix36 a_rows(double l, double h, double a_rad) {
  const double s = std::sin(a_rad);
  const double c = std::cos(a_rad);
  Matrix36 out;
  out << 1.0, 0.0, 0.0, 0.0, -l * c + h * s, -h * c - l * s,  //
      0.0, 1.0, 0.0, -h * s + l * c, 0.0, 0.0,                //
      0.0, 0.0, 1.0, h * c + l * s, 0.0, 0.0;
  return out;
}

}  // namespace

std::array<Eigen::Vector3d, 3> PublishedSetups::of_c() const {
  return {{{0.0, h1_mm, -l1_mm}, {0.0, h2_mm, -l1_mm}, {0.0, h1_mm, -l2_mm}}};
}

std::array<Eigen::Vector3d, 3> PublishedSetups::of_a() const {
  return {{{0.0, h1_mm, -l1_mm}, {0.0, h2_mm, -l1_mm}, {0.0, h2_mm, -l2_mm}}};
}

PublishedMatrix published_c_matrix(const PublishedSetups& setups, double c_rad) {
  PublishedMatrix out;
  out << c_rows(setups.l1_mm, setups.h1_mm, c_rad), c_rows(setups.l1_mm, setups.h2_mm, c_rad),
      c_rows(setups.l2_mm, setups.h1_mm, c_rad);
  return out;
}

PublishedMatrix published_a_matrix(const PublishedSetups& setups, double a_rad) {
  PublishedMatrix out;
  out << a_rows(setups.l1_mm, setups.h1_mm, a_rad), a_rows(setups.l1_mm, setups.h2_mm, a_rad),
      a_rows(setups.l2_mm, setups.h2_mm, a_rad);
  return out;
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The linear equations of a station: unknowns (shift of the centroid, l times rotation), so that
/// all six are lengths of one size.
struct Equations {
  Vector3d centroid = Vector3d::Zero();
  double length = 1.0;
  std::vector<Matrix36> rows;     ///< One per ball.
  std::vector<Matrix3d> weights;  ///< Inverse covariances.
  Matrix6 inverse = Matrix6::Zero();
  Matrix6 back = Matrix6::Identity();  ///< Map from the unknowns to (t; w) at the origin.

  /// Change of the unknowns per discrepancy of ball i.
  [[nodiscard]] Eigen::Matrix<double, 6, 3> gain(std::size_t i) const {
    return inverse * rows[i].transpose() * weights[i];
  }
};

Equations equations_at(const std::vector<Vector3d>& places, std::span<const StationBall> balls) {
  Equations out;
  const auto n = static_cast<double>(places.size());
  for (const Vector3d& p : places) out.centroid += p / n;
  double squares = 0.0;
  for (const Vector3d& p : places) squares += (p - out.centroid).squaredNorm() / n;
  out.length = std::sqrt(squares);
  Matrix6 normal = Matrix6::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) {
    Matrix36 rows;
    rows << Matrix3d::Identity(), -cross_matrix(places[i] - out.centroid) / out.length;
    out.rows.push_back(rows);
    out.weights.emplace_back((balls[i].measured_mm2 + balls[i].nominal_mm2).inverse());
    normal += rows.transpose() * out.weights[i] * rows;
  }
  out.inverse = core::inverse_ldlt(normal);
  out.back.topRightCorner<3, 3>() = cross_matrix(out.centroid) / out.length;
  out.back.bottomRightCorner<3, 3>() = Matrix3d::Identity() / out.length;
  return out;
}

std::vector<Vector3d> nominal_places(std::span<const StationBall> balls) {
  std::vector<Vector3d> out;
  for (const StationBall& ball : balls) out.push_back(ball.nominal_mm);
  return out;
}

bool alike_in_all_directions(std::span<const StationBall> balls) {
  return std::ranges::all_of(balls, [](const StationBall& ball) {
    const Matrix3d c = ball.measured_mm2 + ball.nominal_mm2;
    const double mean = c.trace() / 3.0;
    return (c - mean * Matrix3d::Identity()).norm() <= 1e-12 * mean;
  });
}

/// Least squares of the full model with full weights, from a rigid registration.
Eigen::Isometry3d refined_motion(Eigen::Isometry3d motion, std::span<const StationBall> balls) {
  for (int pass = 0; pass < 20; ++pass) {
    std::vector<Vector3d> places;
    for (const StationBall& ball : balls) places.emplace_back(motion * ball.nominal_mm);
    const Equations at = equations_at(places, balls);
    Vector6 step = Vector6::Zero();
    for (std::size_t i = 0; i < balls.size(); ++i)
      step += at.gain(i) * (balls[i].measured_mm - places[i]);
    const Vector3d turn = step.tail<3>() / at.length;
    const Eigen::Isometry3d about_centroid = Eigen::Translation3d(at.centroid + step.head<3>()) *
                                             error_motion(Vector3d::Zero(), turn) *
                                             Eigen::Translation3d(-at.centroid);
    motion = about_centroid * motion;
    if (step.norm() <= 1e-15 * at.length) break;
  }
  return motion;
}

/// The motion that maps the nominal balls to the measured ones.
core::Result<Eigen::Isometry3d> exact_motion(std::span<const StationBall> balls) {
  std::vector<Vector3d> measured;
  std::vector<double> weights;
  for (const StationBall& ball : balls) {
    measured.push_back(ball.measured_mm);
    weights.push_back(1.0 / (ball.measured_mm2 + ball.nominal_mm2).trace());
  }
  TRY(const auto found, rigid_registration(nominal_places(balls), measured, weights));
  if (alike_in_all_directions(balls)) return found.motion;
  return refined_motion(found.motion, balls);
}

Vector6 linear_errors(const Equations& at, std::span<const StationBall> balls) {
  Vector6 sum = Vector6::Zero();
  for (std::size_t i = 0; i < balls.size(); ++i)
    sum += at.gain(i) * (balls[i].measured_mm - balls[i].nominal_mm);
  return at.back * sum;
}

Vector6 printed_errors(const PublishedMatrix& printed, std::span<const StationBall> balls) {
  Eigen::Matrix<double, 9, 1> dp;
  for (std::size_t i = 0; i < 3; ++i) {
    dp.segment<3>(3 * static_cast<Eigen::Index>(i)) = balls[i].measured_mm - balls[i].nominal_mm;
  }
  PublishedMatrix scaled = printed;
  scaled.rightCols<3>() /= 100.0;
  const Matrix6 normal = scaled.transpose() * scaled;
  Vector6 out = core::solve_ldlt(normal, Vector6(scaled.transpose() * dp));
  out.tail<3>() /= 100.0;
  return out;
}

void state_covariance(const Equations& at, std::span<const StationBall> balls, RotaryStation& out) {
  out.errors.covariance = at.back * at.inverse * at.back.transpose();
  Matrix6 measured = Matrix6::Zero();
  for (std::size_t i = 0; i < balls.size(); ++i) {
    measured += at.gain(i) * balls[i].measured_mm2 * at.gain(i).transpose();
  }
  out.measured_covariance = at.back * measured * at.back.transpose();
}

/// Fills in residuals, chi-square and redundancy of a solution.
void state_fit(const Equations& at, std::span<const StationBall> balls, bool linear,
               RotaryStation& out) {
  const Eigen::Isometry3d motion = error_motion(out.errors.t_mm, out.errors.w_rad);
  out.chi2 = 0.0;
  out.residuals_mm.clear();
  out.redundancy.clear();
  out.balls.clear();
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vector3d& p = balls[i].nominal_mm;
    const Vector3d adjusted =
        linear ? Vector3d(p + out.errors.t_mm + out.errors.w_rad.cross(p)) : Vector3d(motion * p);
    const Vector3d v = balls[i].measured_mm - adjusted;
    out.chi2 += v.dot(at.weights[i] * v);
    out.residuals_mm.push_back(v);
    out.redundancy.emplace_back(Vector3d::Ones() - (at.rows[i] * at.gain(i)).diagonal());
    out.balls.push_back(balls[i].ball);
  }
}

/// Decrease of chi-square if ball i is left out: v^T Q^-1 v, where Q is the covariance of its
/// residual. Directions in which the residual cannot vary do not count.
double normalised_residual(const Equations& at, const RotaryStation& station, std::size_t i) {
  const Matrix3d root = at.weights[i].llt().matrixL();  // weights = root root^T
  const Vector3d v = root.transpose() * station.residuals_mm[i];
  const Matrix3d redundancy = Matrix3d::Identity() - root.transpose() * at.rows[i] * at.inverse *
                                                         at.rows[i].transpose() * root;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(redundancy);
  double out = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double share = eigen.eigenvalues()(k);
    if (share > 1e-6) out += std::pow(eigen.eigenvectors().col(k).dot(v), 2) / share;
  }
  return out;
}

bool determined(std::span<const StationBall> balls) {
  std::vector<std::string> names;
  for (const StationBall& ball : balls) names.push_back(ball.ball);
  return check_setup(nominal_places(balls), names).has_value();
}

/// Solves once with the balls given. `at` receives the equations.
/// @return Whether there is a solution.
bool solve_once(std::span<const StationBall> balls, const RotaryOptions& options,
                const std::optional<PublishedMatrix>& printed, Equations& at, RotaryStation& out) {
  if (!determined(balls)) return false;
  at = equations_at(nominal_places(balls), balls);
  const bool linear = options.solver != RotaryOptions::Solver::kExact;
  if (linear) {
    const Vector6 x = printed ? printed_errors(*printed, balls) : linear_errors(at, balls);
    out.errors.t_mm = x.head<3>();
    out.errors.w_rad = x.tail<3>();
  } else {
    const auto motion = exact_motion(balls);
    if (!motion) return false;
    out.errors.t_mm = motion->translation();
    out.errors.w_rad = rotation_vector(motion->linear());
  }
  state_covariance(at, balls, out);
  state_fit(at, balls, linear, out);
  out.condition = setup_condition(nominal_places(balls));
  out.dof = 3 * static_cast<int>(balls.size()) - 6;
  out.chi2_limit = core::chi_square_quantile(options.outlier_probability, out.dof);
  return true;
}

}  // namespace

RotaryStation solve_station(std::vector<StationBall> balls, const RotaryOptions& options,
                            const std::optional<PublishedMatrix>& printed) {
  RotaryStation out;
  Equations at;
  if (!solve_once(balls, options, printed, at, out)) {
    out.undetermined = true;
    return out;
  }
  while (out.chi2 > out.chi2_limit) {
    out.flagged = true;
    if (!options.remove_outliers || balls.size() < 5) break;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < balls.size(); ++i) sizes.push_back(normalised_residual(at, out, i));
    const auto worst = std::ranges::max_element(sizes) - sizes.begin();
    std::vector<StationBall> rest = balls;
    rest.erase(rest.begin() + worst);
    RotaryStation next;
    next.removed = out.removed;
    next.removed.push_back(balls[static_cast<std::size_t>(worst)].ball);
    if (!solve_once(rest, options, printed, at, next)) break;
    out = std::move(next);
    balls = std::move(rest);
  }
  return out;
}

}  // namespace rondure::fit
