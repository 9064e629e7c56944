#include "tests/evaluation/shaft_oracle.h"

namespace rondure::test::shaft {

using Eigen::VectorXd;
/// Two directions square to an axis: the first is the coordinate axis least along it, made square.
std::pair<Vector3d, Vector3d> square_to(const Vector3d& w) {
  int least = 0;
  for (const int k : {1, 2}) {
    if (std::abs(w[k]) < std::abs(w[least])) least = k;
  }
  const Vector3d first = (Vector3d::Unit(least) - w[least] * w).normalized();
  return {first, w.cross(first)};
}

Eigen::Isometry3d tilted(double x, double y, double z, double tilt_x, double tilt_y) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translation() = Vector3d(x, y, z);
  out.linear() =
      (Eigen::AngleAxisd(tilt_x, Vector3d::UnitX()) * Eigen::AngleAxisd(tilt_y, Vector3d::UnitY()))
          .toRotationMatrix();
  return out;
}

namespace {

/// The axis after a move: shift along both directions and, with four numbers, tilt times `reach`.
Line moved(const Line& axis, const VectorXd& x, int moves, double reach) {
  const auto [e1, e2] = square_to(axis.direction);
  Line out = axis;
  out.point += x[0] * e1 + x[1] * e2;
  if (moves == 4) out.direction = (out.direction + (x[2] * e1 + x[3] * e2) / reach).normalized();
  return out;
}

/// How the distance of a point changes with the move.
VectorXd change(const Line& axis, const Vector3d& p, int moves, double reach) {
  const auto [e1, e2] = square_to(axis.direction);
  const Vector3d u = axis.away(p).normalized();
  VectorXd out(moves);
  out[0] = -u.dot(e1);
  out[1] = -u.dot(e2);
  if (moves == 4) out.tail(2) = axis.height(p) / reach * out.head(2);
  return out;
}

struct Start {
  Line axis;
  double reach = 1.0;
};

/// The axis at the mean height of the points.
Start start_of(const std::vector<Points>& groups, Line axis) {
  double sum = 0.0;
  double count = 0.0;
  for (const auto& points : groups) {
    for (const auto& p : points) {
      sum += axis.height(p);
      count += 1.0;
    }
  }
  axis.point += sum / count * axis.direction;
  double reach = 0.0;
  for (const auto& points : groups) {
    for (const auto& p : points) reach = std::max(reach, std::abs(axis.height(p)));
  }
  return {axis, std::max(reach, 1.0)};
}

}  // namespace

Round least_squares(const std::vector<Points>& groups, const Line& near, int moves) {
  auto [axis, reach] = start_of(groups, near);
  const auto radii = static_cast<int>(groups.size());
  VectorXd x;
  for (int round = 0; round < 20; ++round) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(moves + radii, moves + radii);
    VectorXd right = VectorXd::Zero(moves + radii);
    for (int g = 0; g < radii; ++g) {
      for (const auto& p : groups[static_cast<std::size_t>(g)]) {
        VectorXd row = VectorXd::Zero(moves + radii);
        row.head(moves) = change(axis, p, moves, reach);
        row[moves + g] = -1.0;
        normal += row * row.transpose();
        right -= row * axis.distance(p);
      }
    }
    x = normal.ldlt().solve(right);
    axis = moved(axis, x, moves, reach);
    if (x.head(moves).norm() < 1e-14) break;
  }
  Round out{axis, {}, {}};
  for (int g = 0; g < radii; ++g) out.outer.push_back(x[moves + g]);
  out.inner = out.outer;
  return out;
}

VectorXd cheapest(Eigen::MatrixXd rows, VectorXd bounds, const VectorXd& cost,
                  const VectorXd& box) {
  const auto n = cost.size();
  const auto m = rows.rows();
  rows.conservativeResize(m + 2 * n, n);
  bounds.conservativeResize(m + 2 * n);
  rows.bottomRows(2 * n).setZero();
  std::vector<Eigen::Index> basis;
  for (Eigen::Index k = 0; k < n; ++k) {
    rows(m + 2 * k, k) = 1.0;
    rows(m + 2 * k + 1, k) = -1.0;
    bounds[m + 2 * k] = bounds[m + 2 * k + 1] = -box[k];
    basis.push_back(cost[k] >= 0.0 ? m + 2 * k : m + 2 * k + 1);
  }
  // A price on every unknown: no two bases cost the same, so that none comes twice. The value moves
  // by less than a picometre.
  const VectorXd price = 1e-10 * VectorXd::LinSpaced(n, 1.0, 2.0);
  VectorXd x;
  for (int step = 0; step < 500; ++step) {
    Eigen::MatrixXd held(n, n);
    VectorXd at(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      held.row(k) = rows.row(basis[static_cast<std::size_t>(k)]);
      at[k] = bounds[basis[static_cast<std::size_t>(k)]];
    }
    const Eigen::PartialPivLU<Eigen::MatrixXd> solver(held);
    x = solver.solve(at);
    Eigen::Index worst = 0;
    if ((rows * x - bounds).minCoeff(&worst) >= -1e-14) break;
    const VectorXd weight = solver.transpose().solve(cost + price);
    const VectorXd share = solver.transpose().solve(rows.row(worst).transpose());
    Eigen::Index out = -1;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (share[k] < 1e-11) continue;
      if (out < 0 || weight[k] / share[k] < weight[out] / share[out]) out = k;
    }
    if (out < 0) break;
    basis[static_cast<std::size_t>(out)] = worst;
  }
  return x;
}

/// Farthest and nearest point of each group.
Round radii_about(const Line& axis, const std::vector<Points>& groups) {
  Round out{axis, {}, {}};
  for (const auto& points : groups) {
    double low = HUGE_VAL;
    double high = 0.0;
    for (const auto& p : points) {
      low = std::min(low, axis.distance(p));
      high = std::max(high, axis.distance(p));
    }
    out.outer.push_back(high);
    out.inner.push_back(low);
  }
  return out;
}

Round extreme(const std::vector<Points>& groups, const Line& near, int moves, Least least) {
  auto [axis, reach] = start_of(groups, near);
  const auto count = static_cast<int>(groups.size());
  const auto value_of = [&](const Round& round) {
    double out = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (least != Least::kInner) out += round.outer[g];
      if (least != Least::kOuter) out -= round.inner[g];
    }
    return out;
  };
  Round best = radii_about(axis, groups);
  double trust = 0.05;
  for (int round = 0; round < 200 && trust > 1e-9; ++round) {
    const int unknowns = moves + 2 * count;
    std::vector<std::pair<VectorXd, double>> rows;
    VectorXd cost = VectorXd::Zero(unknowns);
    VectorXd box = VectorXd::Constant(unknowns, 1.0);
    box.head(moves).setConstant(trust);
    for (int g = 0; g < count; ++g) {
      const auto at = static_cast<std::size_t>(g);
      if (least != Least::kInner) cost[moves + g] = 1.0;
      if (least != Least::kOuter) cost[moves + count + g] = -1.0;
      for (const auto& p : groups[at]) {
        const double d = best.axis.distance(p) - best.inner[at];
        VectorXd row = VectorXd::Zero(unknowns);
        row.head(moves) = change(best.axis, p, moves, reach);
        if (least != Least::kOuter) {
          row[moves + count + g] = -1.0;
          rows.emplace_back(row, -d);
          row[moves + count + g] = 0.0;
        }
        if (least != Least::kInner) {
          row[moves + g] = -1.0;
          rows.emplace_back(-row, d);
        }
      }
    }
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), unknowns);
    VectorXd bounds(matrix.rows());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      matrix.row(static_cast<Eigen::Index>(i)) = rows[i].first;
      bounds[static_cast<Eigen::Index>(i)] = rows[i].second;
    }
    const VectorXd x = cheapest(matrix, bounds, cost, box);
    double now = 0.0;  // the same sum for no move
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (least != Least::kInner) now += best.outer[g] - best.inner[g];
    }
    if (cost.dot(x) > now - 1e-13) break;
    const Round next = radii_about(moved(best.axis, x, moves, reach), groups);
    if (value_of(next) < value_of(best)) {
      best = next;
      trust = std::min(0.05, 2.0 * trust);
    } else {
      trust = 0.25 * std::min(trust, x.head(moves).cwiseAbs().maxCoeff());
    }
  }
  return best;
}

Round about(const std::vector<Points>& groups, const Line& near, int moves, Reference reference) {
  switch (reference) {
    case Reference::kLeastSquares:
      return least_squares(groups, near, moves);
    case Reference::kMinimumZone:
      return extreme(groups, near, moves, Least::kZone);
    case Reference::kMinimumCircumscribed:
      return extreme(groups, near, moves, Least::kOuter);
    case Reference::kMaximumInscribed:
      return extreme(groups, near, moves, Least::kInner);
  }
  return {};
}

double range(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

namespace {

/// Diameter of the least circle round some points in a plane: of two or three of them.
double least_circle(const std::vector<Eigen::Vector2d>& points) {
  double best = HUGE_VAL;
  const auto take = [&](const Eigen::Vector2d& center) {
    double r = 0.0;
    for (const auto& p : points) r = std::max(r, (p - center).norm());
    best = std::min(best, 2.0 * r);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      take(0.5 * (points[i] + points[j]));
      for (std::size_t k = 0; k < j; ++k) {
        const Eigen::Vector2d a = points[j] - points[i];
        const Eigen::Vector2d b = points[k] - points[i];
        const double cross = 2.0 * (a.x() * b.y() - a.y() * b.x());
        if (std::abs(cross) < 1e-30) continue;
        take(points[i] + Eigen::Vector2d(b.y() * a.squaredNorm() - a.y() * b.squaredNorm(),
                                         a.x() * b.squaredNorm() - b.x() * a.squaredNorm()) /
                             cross);
      }
    }
  }
  return best;
}

}  // namespace

double round_zone(const Points& centers, const Vector3d& along) {
  const auto [e1, e2] = square_to(along);
  std::vector<Eigen::Vector2d> flat;
  for (const auto& c : centers) {
    flat.emplace_back((c - centers[0]).dot(e1), (c - centers[0]).dot(e2));
  }
  return least_circle(flat);
}

/// Diameter of the least cylinder round some points near an axis: cuts in the directions in which
/// a point lies outside.
double least_cylinder(const Points& points, const Line& near) {
  auto [axis, reach] = start_of({points}, near);
  double value = HUGE_VAL;
  for (int turn = 0; turn < 3; ++turn) {
    const auto [e1, e2] = square_to(axis.direction);
    std::vector<std::pair<VectorXd, double>> cuts;
    VectorXd x = VectorXd::Zero(5);
    for (int round = 0; round < 60; ++round) {
      for (const auto& p : points) {
        const double h = axis.height(p) / reach;
        Eigen::Vector2d off((p - axis.point).dot(e1), (p - axis.point).dot(e2));
        const Eigen::Vector2d place = off;
        off -= x.head<2>() + h * x.segment<2>(2);
        if (off.norm() < 1e-15) continue;
        off.normalize();
        VectorXd row(5);
        row << off, h * off, 1.0;
        cuts.emplace_back(row, off.dot(place));
      }
      Eigen::MatrixXd rows(static_cast<Eigen::Index>(cuts.size()), 5);
      VectorXd bounds(rows.rows());
      for (std::size_t i = 0; i < cuts.size(); ++i) {
        rows.row(static_cast<Eigen::Index>(i)) = cuts[i].first;
        bounds[static_cast<Eigen::Index>(i)] = cuts[i].second;
      }
      x = cheapest(rows, bounds, VectorXd::Unit(5, 4), VectorXd::Constant(5, 0.05));
      const Line found = moved(axis, x, 4, reach);
      double r = 0.0;
      for (const auto& p : points) r = std::max(r, found.distance(p));
      value = std::min(value, 2.0 * r);
      if (r - x[4] < 1e-13) break;
    }
    axis = moved(axis, x, 4, reach);
  }
  return value;
}

Fitted regression(const std::vector<double>& h, const std::vector<double>& d) {
  const auto n = static_cast<double>(h.size());
  const double mean_h = std::accumulate(h.begin(), h.end(), 0.0) / n;
  const double mean_d = std::accumulate(d.begin(), d.end(), 0.0) / n;
  double hh = 0.0;
  double hd = 0.0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    hh += (h[i] - mean_h) * (h[i] - mean_h);
    hd += (h[i] - mean_h) * (d[i] - mean_d);
  }
  Fitted out{hd / hh, {}};
  for (std::size_t i = 0; i < h.size(); ++i) {
    out.off.push_back((d[i] - mean_d - out.slope * (h[i] - mean_h)) / std::hypot(1.0, out.slope));
  }
  return out;
}

/// Least width of a profile: of two lines, one through two of the points.
double least_width(const std::vector<double>& h, const std::vector<double>& d) {
  double best = HUGE_VAL;
  for (std::size_t i = 0; i < h.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double slope = (d[i] - d[j]) / (h[i] - h[j]);
      std::vector<double> off;
      for (std::size_t k = 0; k < h.size(); ++k) off.push_back(d[k] - d[0] - slope * (h[k] - h[0]));
      best = std::min(best, range(off) / std::hypot(1.0, slope));
    }
  }
  return best;
}

}  // namespace rondure::test::shaft
