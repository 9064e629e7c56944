#include "benchmarks/peers/nlopt_peer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <nlopt.hpp>

namespace rondure::benchmarks {
namespace {

constexpr double kRelativeStop = 1e-9;

/// The axis through (a, b, 0) with the slopes (c, d) / scale in a frame.
struct Frame {
  Eigen::Matrix3d columns = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();
  double scale_mm = 1.0;

  Frame(const Eigen::Vector3d& direction, Eigen::Vector3d origin, double scale)
      : origin_mm(std::move(origin)), scale_mm(scale) {
    columns << fit::across(direction), direction;
  }

  [[nodiscard]] fit::Axis axis(const double* x) const {
    return {origin_mm + columns * Eigen::Vector3d(x[0], x[1], 0.0),
            (columns * Eigen::Vector3d(x[2] / scale_mm, x[3] / scale_mm, 1.0)).normalized()};
  }
};

struct Epigraph {
  std::vector<Eigen::Vector3d> points;  ///< In the frame [mm].
  double scale_mm = 1.0;
  int evaluations = 0;
};

/// What Nelder and Mead minimise.
struct Search {
  const std::function<double(const fit::Axis&)>& width_mm;
  Frame frame;
  int evaluations = 0;
};

double width_about(unsigned, const double* x, double*, void* data) {
  auto& search = *static_cast<Search*>(data);
  ++search.evaluations;
  return search.width_mm(search.frame.axis(x));
}

double half_width(unsigned, const double* x, double* gradient, void*) {
  if (gradient != nullptr) {
    std::fill(gradient, gradient + 6, 0.0);
    gradient[5] = 1.0;
  }
  return x[5];
}

/// Rows 2 i and 2 i + 1: r_i - R - h <= 0 and R - r_i - h <= 0; x = a, b, c, d, R, h.
void inside_zone(unsigned, double* result, unsigned, const double* x, double* gradient,
                 void* data) {
  auto& problem = *static_cast<Epigraph*>(data);
  ++problem.evaluations;
  const Eigen::Vector3d m(x[2] / problem.scale_mm, x[3] / problem.scale_mm, 1.0);
  const double mm = m.squaredNorm();
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const Eigen::Vector3d q = problem.points[i] - Eigen::Vector3d(x[0], x[1], 0.0);
    const double along = q.dot(m) / mm;
    const Eigen::Vector3d off = q - along * m;
    const double r = off.norm();
    result[2 * i] = r - x[4] - x[5];
    result[2 * i + 1] = x[4] - r - x[5];
    if (gradient == nullptr) continue;
    double* const g = gradient + 12 * i;
    g[0] = -off.x() / r;
    g[1] = -off.y() / r;
    g[2] = -along * off.x() / r / problem.scale_mm;
    g[3] = -along * off.y() / r / problem.scale_mm;
    g[4] = -1.0;
    for (int k = 0; k < 5; ++k) g[6 + k] = -g[k];
    g[5] = g[11] = -1.0;
  }
}

/// Runs an optimiser; NLopt throws when rounding stops it, which is an end like any other here.
double run(nlopt::opt& optimiser, std::vector<double>& x) {
  double value = 0.0;
  try {
    optimiser.optimize(x, value);
  } catch (const nlopt::roundoff_limited&) {
    return value;
  } catch (const std::exception&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return value;
}

double zone_width(const std::vector<Eigen::Vector3d>& points, const double* x, double scale_mm) {
  Epigraph one{points, scale_mm};
  std::vector<double> rows(2 * points.size());
  const std::array<double, 6> at = {x[0], x[1], x[2], x[3], 0.0, 0.0};
  inside_zone(6, rows.data(), 6, at.data(), nullptr, &one);
  double low = rows[0];
  double high = rows[0];
  for (std::size_t i = 0; i < points.size(); ++i) {
    low = std::min(low, rows[2 * i]);
    high = std::max(high, rows[2 * i]);
  }
  return high - low;
}

}  // namespace

PeerZone nlopt_slsqp_zone(std::span<const Eigen::Vector3d> points_mm,
                          const Eigen::Vector3d& start_direction) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) mean += p;
  mean /= static_cast<double>(points_mm.size());
  Frame frame(start_direction, mean, 1.0);
  Epigraph problem;
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const Eigen::Vector3d& p : points_mm) {
    const Eigen::Vector3d& q = problem.points.emplace_back(frame.columns.transpose() * (p - mean));
    frame.scale_mm = std::max(frame.scale_mm, std::abs(q.z()));
    low = std::min(low, q.head<2>().norm());
    high = std::max(high, q.head<2>().norm());
  }
  problem.scale_mm = frame.scale_mm;
  nlopt::opt optimiser(nlopt::LD_SLSQP, 6);
  optimiser.set_min_objective(half_width, nullptr);
  const std::vector<double> tolerance(2 * points_mm.size(), 1e-12);
  optimiser.add_inequality_mconstraint(inside_zone, &problem, tolerance);
  optimiser.set_ftol_rel(kRelativeStop);
  optimiser.set_maxeval(500);
  std::vector<double> x = {0.0, 0.0, 0.0, 0.0, (low + high) / 2.0, (high - low) / 2.0};
  run(optimiser, x);
  return {frame.axis(x.data()), zone_width(problem.points, x.data(), frame.scale_mm),
          problem.evaluations};
}

PeerZone nlopt_nelder_mead_zone(const std::function<double(const fit::Axis&)>& width_mm,
                                const fit::Axis& start, double half_length_mm) {
  Search search{width_mm, Frame(start.direction, start.point_mm, half_length_mm)};
  nlopt::opt optimiser(nlopt::LN_NELDERMEAD, 4);
  optimiser.set_min_objective(width_about, &search);
  optimiser.set_initial_step(0.002);
  optimiser.set_ftol_rel(kRelativeStop);
  optimiser.set_maxeval(5000);
  std::vector<double> x(4, 0.0);
  const double found_mm = run(optimiser, x);
  return {search.frame.axis(x.data()), found_mm, search.evaluations};
}

}  // namespace rondure::benchmarks
