// Shafts with planted deviations: every characteristic against its definition (methods, drawing
// sections 2 to 5), computed here from the points or from the planted surface.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/results/finding.h"
#include "fit/geometry/axis.h"
#include "tests/core/full.h"
#include "tests/evaluation/drawing_part.h"
#include "tests/evaluation/points_run.h"

namespace rondure::evaluation {
namespace {

using record::Characteristic;
using record::Form;
using record::Reference;
using record::Shape;
using record::Side;
using Indication = record::Indication;
using Association = Indication::Association;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::Layers;
using Points = std::vector<Vector3d>;

constexpr double kDefinition = 1e-9;  // mm
/// An answer that compare_extremes() has.
constexpr double kElsewhere = std::numeric_limits<double>::quiet_NaN();

// ---- What is planted.

struct Line {
  Vector3d point = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitZ();

  [[nodiscard]] double height(const Vector3d& p) const { return (p - point).dot(direction); }
  [[nodiscard]] Vector3d away(const Vector3d& p) const { return p - point - height(p) * direction; }
  [[nodiscard]] double distance(const Vector3d& p) const { return away(p).norm(); }
};

/// Two directions square to an axis: the first is the coordinate axis least along it, made square.
std::pair<Vector3d, Vector3d> square_to(const Vector3d& w) {
  int least = 0;
  for (const int k : {1, 2}) {
    if (std::abs(w[k]) < std::abs(w[least])) least = k;
  }
  const Vector3d first = (Vector3d::Unit(least) - w[least] * w).normalized();
  return {first, w.cross(first)};
}

/// A surface about its own axis, which stands in the frame of the shaft.
struct Turned {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();  // of the axis, in the machine
  double radius = 0.0;
  double cone = 0.0;    // radius at the upper end less that in the middle
  double barrel = 0.0;  // radius in the middle less that at the ends
  double bend = 0.0;    // centre in the middle off that at the ends
  double lobe[6] = {};  // amplitudes of 2 to 5
  double phase[6] = {};
  double length = 0.0;
  double start_rad = 0.0;
  int layers = 0;
  int points = 0;
  bool reversed = false;  // the first layer is the one at the greatest height

  [[nodiscard]] Vector3d at(int layer, double angle) const {
    const double q = 2.0 * layer / (layers - 1) - 1.0;
    double r = radius + cone * q - barrel * q * q;
    for (const int k : {2, 3, 4, 5})
      r += lobe[k] * std::cos(k * angle - phase[k] * (1.0 + 0.1 * q));
    return place * Vector3d(r * std::cos(angle) + bend * (1.0 - q * q), r * std::sin(angle),
                            0.5 * q * length);
  }
  [[nodiscard]] Layers sampled() const {
    Layers out;
    for (int j = 0; j < layers; ++j) {
      auto& layer = out.emplace_back();
      for (int i = 0; i < points; ++i) {
        layer.push_back(at(reversed ? layers - 1 - j : j, start_rad + core::kTwoPi * i / points));
      }
    }
    return out;
  }
  [[nodiscard]] Line axis() const { return {place.translation(), place.linear().col(2)}; }
};

Eigen::Isometry3d tilted(double x, double y, double z, double tilt_x, double tilt_y) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translation() = Vector3d(x, y, z);
  out.linear() =
      (Eigen::AngleAxisd(tilt_x, Vector3d::UnitX()) * Eigen::AngleAxisd(tilt_y, Vector3d::UnitY()))
          .toRotationMatrix();
  return out;
}

// ---- Least squares, and linear programmes step by step.

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

/// Groups of points about one axis, a radius each.
struct Round {
  Line axis;
  std::vector<double> outer;  // of least squares the radii, and `inner` the same
  std::vector<double> inner;

  [[nodiscard]] double width(const Points& points) const {
    double least = HUGE_VAL;
    double most = 0.0;
    for (const auto& p : points) {
      least = std::min(least, axis.distance(p));
      most = std::max(most, axis.distance(p));
    }
    return most - least;
  }
};

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

/// Least cost * x with rows * x >= bounds: exchange of one row of the basis in each step.
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

/// Least sum of widths, of outer radii, or greatest sum of inner radii.
enum class Least { kZone, kOuter, kInner };

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

// ---- Definitions.

double range(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

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

struct Fitted {
  double slope = 0.0;
  std::vector<double> off;  // square to the line
};
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

struct Generatrix {
  std::vector<double> h;
  std::vector<double> d;
};

/// What a cylinder is by its own points.
struct Oracle {
  Turned planted;
  Layers layers;
  double side = 1.0;
  double tip = 0.0;
  Points all = {};
  Line axis = {};              // least squares
  std::vector<Round> circles;  // least squares, each section
  Points centers = {};
  std::vector<double> two_point = {};
  std::vector<Generatrix> lines = {};

  Oracle(Turned turned, bool inside, double tip_mm)
      : planted(std::move(turned)),
        layers(planted.sampled()),
        side(inside ? -1.0 : 1.0),
        tip(tip_mm) {
    for (const auto& layer : layers) all.insert(all.end(), layer.begin(), layer.end());
    axis = least_squares({all}, planted.axis(), 4).axis;
    for (const auto& layer : layers) {
      circles.push_back(section(layer, Reference::kLeastSquares));
      centers.push_back(circles.back().axis.point);
      add_two_point(layer);
    }
    // 105 points carry 15 undulations: the planted surface every 10 deg, else the points.
    const bool dense = planted.points >= 105;
    const int count = dense ? 36 : planted.points;
    for (int i = 0; i < count; ++i) {
      Generatrix line;
      for (int j = 0; j < planted.layers; ++j) {
        const Vector3d p = dense ? at_angle(j, core::kTwoPi * i / 36.0)
                                 : layers[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
        line.h.push_back(axis.height(p));
        line.d.push_back(axis.distance(p));
      }
      lines.push_back(std::move(line));
    }
  }

  /// A circle of one section, about the least-squares direction.
  [[nodiscard]] Round section(const Points& layer, Reference reference) const {
    return about({layer}, axis, 2, reference);
  }
  void add_two_point(const Points& layer) {
    const double r = tip * side;
    const std::size_t half = layer.size() / 2;
    const Line& center = circles.back().axis;
    for (std::size_t i = 0; i < half; ++i) {
      two_point.push_back(center.distance(layer[i]) + center.distance(layer[i + half]) - 2.0 * r);
    }
  }
  /// The planted surface of a layer where its angle about the least-squares axis is this one.
  [[nodiscard]] Vector3d at_angle(int layer, double angle) const {
    const int planted_layer = planted.reversed ? planted.layers - 1 - layer : layer;
    const auto [e1, e2] = square_to(axis.direction);
    const auto angle_of = [&, &first = e1, &second = e2](double t) {
      const Vector3d u = axis.away(planted.at(planted_layer, t));
      return std::atan2(u.dot(second), u.dot(first));
    };
    // The planted angle may run the other way round.
    const double sense = axis.direction.dot(planted.axis().direction) > 0.0 ? 1.0 : -1.0;
    double t = 0.0;
    for (int i = 0; i < 20; ++i) {
      t += sense * std::remainder(angle - angle_of(t), core::kTwoPi);
    }
    return planted.at(planted_layer, t);
  }
  [[nodiscard]] double diameter(double r) const { return 2.0 * (r - side * tip); }
  [[nodiscard]] double size(const Points& points, int moves, Indication::Size size) const {
    using Size = Indication::Size;
    const Reference reference = size == Size::kGG   ? Reference::kLeastSquares
                                : size == Size::kGN ? Reference::kMinimumCircumscribed
                                : size == Size::kGX ? Reference::kMaximumInscribed
                                                    : Reference::kMinimumZone;
    const Round round = about({points}, axis, moves, reference);
    if (size == Size::kGN) return diameter(round.outer[0]);
    if (size == Size::kGX) return diameter(round.inner[0]);
    return diameter(0.5 * (round.outer[0] + round.inner[0]));
  }
  [[nodiscard]] double rank(Indication::Rank rank) const {
    using Rank = Indication::Rank;
    std::vector<double> all_sizes = two_point;
    std::sort(all_sizes.begin(), all_sizes.end());
    const std::size_t n = all_sizes.size();
    const double mean =
        std::accumulate(all_sizes.begin(), all_sizes.end(), 0.0) / static_cast<double>(n);
    switch (rank) {
      case Rank::kSX:
        return all_sizes.back();
      case Rank::kSN:
        return all_sizes.front();
      case Rank::kSA:
        return mean;
      case Rank::kSM:
        return 0.5 * (all_sizes[n / 2] + all_sizes[(n - 1) / 2]);
      case Rank::kSD:
        return 0.5 * (all_sizes.front() + all_sizes.back());
      case Rank::kSR:
        return all_sizes.back() - all_sizes.front();
      case Rank::kSQ:
        for (double& d : all_sizes) d -= mean;
        return root_mean_square(all_sizes);
    }
    return 0.0;
  }
  /// Of deviations from a least-squares circle or cylinder.
  [[nodiscard]] double parameter(const Points& points, const Round& round,
                                 Indication::Parameter parameter) const {
    std::vector<double> e;
    for (const auto& p : points) e.push_back(side * (round.axis.distance(p) - round.outer[0]));
    const auto [low, high] = std::minmax_element(e.begin(), e.end());
    switch (parameter) {
      case Indication::Parameter::kTotal:
        return *high - *low;
      case Indication::Parameter::kPeak:
        return *high;
      case Indication::Parameter::kValley:
        return -*low;
      case Indication::Parameter::kRms:
        return root_mean_square(e);
    }
    return 0.0;
  }
};

// ---- The questions, with their answers.

struct PlantedQuestion {
  Characteristic asked;
  std::vector<double> judged;
  std::vector<double> local = {};  // every section or circle, in any order; empty: not looked at
};

class Questions {
 public:
  PlantedQuestion& add(const std::string& id, Form form, std::vector<double> judged,
                       Reference reference = Reference::kLeastSquares) {
    PlantedQuestion& out = all_.emplace_back();
    out.asked.id = id;
    out.asked.form = form;
    out.asked.reference = reference;
    out.judged = std::move(judged);
    return out;
  }
  /// The worst of several.
  PlantedQuestion& worst(const std::string& id, Form form, const std::vector<double>& local,
                         Reference reference = Reference::kLeastSquares) {
    PlantedQuestion& out =
        add(id, form, {*std::max_element(local.begin(), local.end())}, reference);
    out.local = local;
    return out;
  }
  [[nodiscard]] const std::vector<PlantedQuestion>& all() const { return all_; }
  [[nodiscard]] std::vector<Characteristic> asked() const {
    std::vector<Characteristic> out;
    for (const auto& question : all_) out.push_back(question.asked);
    return out;
  }

 private:
  std::vector<PlantedQuestion> all_;
};

constexpr Reference kReferences[] = {Reference::kLeastSquares, Reference::kMinimumZone,
                                     Reference::kMinimumCircumscribed,
                                     Reference::kMaximumInscribed};
constexpr Indication::Parameter kParameters[] = {
    Indication::Parameter::kPeak, Indication::Parameter::kValley, Indication::Parameter::kRms};

std::string words(const std::string& name, auto word) {
  return name + " " + std::string(record::name_of(word));
}

void ask_sizes(const Oracle& of, Questions& out) {
  using Size = Indication::Size;
  using Rank = Indication::Rank;
  for (const Size size : {Size::kGG, Size::kGN, Size::kGX, Size::kGC}) {
    const bool least_squares_size = size == Size::kGG;
    out.add(words("d", size), Form::kDiameter,
            {least_squares_size ? of.size(of.all, 4, size) : kElsewhere})
        .asked.indication.size = size;
    if (size == Size::kGX) {
      auto& any = out.add("d ACS GX", Form::kDiameter, {kElsewhere, kElsewhere});
      any.asked.indication.size = size;
      any.asked.indication.section = Indication::Section::kACS;
      continue;
    }
    std::vector<double> sections;
    for (const auto& layer : of.layers) sections.push_back(of.size(layer, 2, size));
    auto& any = out.add(words("d ACS", size), Form::kDiameter,
                        {*std::max_element(sections.begin(), sections.end()),
                         *std::min_element(sections.begin(), sections.end())});
    any.local = sections;
    any.asked.indication.size = size;
    any.asked.indication.section = Indication::Section::kACS;
    auto& second = out.add(words("d SCS", size), Form::kDiameter, {sections[1], sections[1]});
    second.asked.indication.size = size;
    second.asked.indication.section = Indication::Section::kSCS;
    second.asked.indication.section_layers = {2.0};
  }
  for (const Rank rank :
       {Rank::kSX, Rank::kSN, Rank::kSA, Rank::kSM, Rank::kSD, Rank::kSR, Rank::kSQ}) {
    out.add(words("d", rank), Form::kDiameter, {of.rank(rank)}).asked.indication.rank = rank;
  }
  out.add("d LP", Form::kDiameter, {of.rank(Rank::kSX), of.rank(Rank::kSN)});
  const bool inside = of.side < 0.0;
  auto& envelope = out.add("d E", Form::kDiameter, {});
  envelope.asked.indication.requirement = Indication::Requirement::kEnvelope;
  envelope.judged = {kElsewhere, of.rank(inside ? Rank::kSX : Rank::kSN)};
}

void ask_form(const Oracle& of, Questions& out) {
  const Round cylinder = least_squares({of.all}, of.axis, 4);
  for (const Reference reference : kReferences) {
    const bool ls = reference == Reference::kLeastSquares;
    out.add(words("CYLt", reference), Form::kCylindricity,
            {ls ? cylinder.width(of.all) : kElsewhere}, reference);
    out.add(words("RONt", reference), Form::kRoundness, {kElsewhere}, reference);
  }
  for (const auto parameter : kParameters) {
    out.add(words("CYL", parameter), Form::kCylindricity,
            {of.parameter(of.all, cylinder, parameter)})
        .asked.indication.parameter = parameter;
    std::vector<double> sections;
    for (std::size_t j = 0; j < of.layers.size(); ++j) {
      sections.push_back(of.parameter(of.layers[j], of.circles[j], parameter));
    }
    out.worst(words("RON", parameter), Form::kRoundness, sections).asked.indication.parameter =
        parameter;
  }
}

void ask_lines(const Oracle& of, Questions& out) {
  std::vector<double> ls;
  std::vector<double> mz;
  std::vector<double> peak;
  std::vector<double> taper;
  std::vector<double> parallel;
  std::vector<double> heights;
  for (const auto& p : of.all) heights.push_back(of.axis.height(p));
  const double length = range(heights);
  const std::size_t half = of.lines.size() / 2;
  const auto apart = [](const Generatrix& from, const Generatrix& line) {
    const double slope = regression(from.h, from.d).slope;
    std::vector<double> off;
    for (std::size_t j = 0; j < line.h.size(); ++j) off.push_back(line.d[j] + slope * line.h[j]);
    return range(off) / std::hypot(1.0, slope);
  };
  for (std::size_t i = 0; i < of.lines.size(); ++i) {
    const Generatrix& line = of.lines[i];
    const Fitted fitted = regression(line.h, line.d);
    ls.push_back(range(fitted.off));
    mz.push_back(least_width(line.h, line.d));
    const auto [low, high] = std::minmax_element(fitted.off.begin(), fitted.off.end());
    peak.push_back(of.side > 0.0 ? *high : -*low);
    if (i >= half) continue;
    const Generatrix& other = of.lines[i + half];
    taper.push_back(0.5 * std::abs(fitted.slope + regression(other.h, other.d).slope) * length);
    parallel.push_back(std::max(apart(line, other), apart(other, line)));
  }
  out.worst("STRt ls", Form::kStraightness, ls);
  out.worst("STRt mz", Form::kStraightness, mz, Reference::kMinimumZone);
  out.worst("STRp", Form::kStraightness, peak).asked.indication.parameter =
      Indication::Parameter::kPeak;
  out.worst("taper", Form::kTaper, taper);
  out.worst("parallelism of generatrices", Form::kGeneratrixParallelism, parallel);
  out.add("STRt median line", Form::kStraightness, {least_cylinder(of.centers, of.axis)},
          Reference::kMinimumZone)
      .asked.indication.of = Indication::Of::kMedianLine;
}

Characteristic& to(PlantedQuestion& question, const std::string& datum, Association association) {
  question.asked.indication.datum = {datum};
  question.asked.indication.association = association;
  return question.asked;
}

/// Location, orientation and run-out of a cylinder about a datum axis.
void ask_about_axis(const Oracle& of, const std::string& datum, Association association,
                    const Line& axis, Questions& out) {
  const std::string name = words(" to " + datum, association);
  std::vector<double> off;
  for (const auto& c : of.centers) off.push_back(2.0 * axis.distance(c));
  to(out.worst("coaxiality" + name, Form::kCoaxiality, off), datum, association);
  auto& first = out.add("concentricity" + name, Form::kConcentricity, {off[0]});
  to(first, datum, association).indication.section = Indication::Section::kSCS;
  first.asked.indication.section_layers = {1.0};
  to(out.add("parallelism" + name, Form::kParallelism, {round_zone(of.centers, axis.direction)}),
     datum, association);
  const Round about_datum{axis, {}, {}};
  std::vector<double> sections;
  for (const auto& layer : of.layers) sections.push_back(about_datum.width(layer));
  to(out.worst("run-out" + name, Form::kRunOut, sections), datum, association);
  to(out.add("total run-out" + name, Form::kTotalRunOut, {about_datum.width(of.all)}), datum,
     association);
}

/// A face of circles about the axis of the shaft.
struct Face {
  Layers circles;
  std::vector<double> radii;
  Vector3d outward;  // to the side without material
};

double range_along(const Points& points, const Vector3d& w) {
  std::vector<double> out;
  for (const auto& p : points) out.push_back((p - points[0]).dot(w));
  return range(out);
}

/// Normal of the least-squares plane, or of the two nearest planes that hold the points.
Vector3d normal_of(const Points& points, const Vector3d& outward, Reference reference) {
  Vector3d mean = Vector3d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Vector3d n = outward;
  for (int round = 0; round < 10; ++round) {
    const auto [e1, e2] = square_to(n);
    VectorXd tilt;
    if (reference == Reference::kLeastSquares) {
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      Vector3d right = Vector3d::Zero();
      for (const auto& p : points) {
        const Vector3d row((p - mean).dot(e1), (p - mean).dot(e2), 1.0);
        normal += row * row.transpose();
        right += row * (p - mean).dot(n);
      }
      tilt = -normal.ldlt().solve(right);
    } else {
      Eigen::MatrixXd rows(static_cast<Eigen::Index>(2 * points.size()), 4);
      VectorXd bounds(rows.rows());
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(2 * i);
        const Vector3d q = points[i] - mean;
        // Tilts are per 100 mm, so that all unknowns are lengths alike.
        rows.row(at) << -0.01 * q.dot(e1), -0.01 * q.dot(e2), 1.0, 0.0;
        rows.row(at + 1) << 0.01 * q.dot(e1), 0.01 * q.dot(e2), 0.0, -1.0;
        bounds[at] = q.dot(n);
        bounds[at + 1] = -q.dot(n);
      }
      VectorXd cost(4);
      cost << 0.0, 0.0, 1.0, -1.0;
      tilt = 0.01 * cheapest(rows, bounds, cost, VectorXd::Constant(4, 1.0));
    }
    n = (n + tilt[0] * e1 + tilt[1] * e2).normalized();
    if (tilt.head(2).norm() < 1e-15) break;
  }
  return n;
}

void ask_face(const Face& face, Association association, const Line& axis, Questions& out) {
  Points all;
  for (const auto& circle : face.circles) all.insert(all.end(), circle.begin(), circle.end());
  const std::string datum = "A-B";
  const std::string name = words(" to A-B", association);
  std::vector<double> circles;
  for (const auto& circle : face.circles) circles.push_back(range_along(circle, axis.direction));
  using Direction = Indication::Direction;
  to(out.worst("axial run-out" + name, Form::kRunOut, circles), datum, association)
      .indication.direction = Direction::kAxial;
  auto& one = out.add("axial run-out of a circle" + name, Form::kRunOut, {circles[1]});
  to(one, datum, association).indication.direction = Direction::kAxial;
  one.asked.indication.radius_mm = face.radii[1];
  const double total = range_along(all, axis.direction);
  to(out.add("axial total run-out" + name, Form::kTotalRunOut, {total}), datum, association)
      .indication.direction = Direction::kAxial;
  to(out.add("perpendicularity" + name, Form::kPerpendicularity, {total}), datum, association);
}

void ask_flatness(const Face& face, Questions& out) {
  Points all;
  for (const auto& circle : face.circles) all.insert(all.end(), circle.begin(), circle.end());
  const Vector3d ls = normal_of(all, face.outward, Reference::kLeastSquares);
  Vector3d mean = Vector3d::Zero();
  for (const auto& p : all) mean += p / static_cast<double>(all.size());
  std::vector<double> e;
  for (const auto& p : all) e.push_back((p - mean).dot(ls));
  const auto [low, high] = std::minmax_element(e.begin(), e.end());
  const double values[] = {*high, -*low, root_mean_square(e)};
  out.add("FLTt ls", Form::kFlatness, {range(e)});
  for (std::size_t i = 0; i < 3; ++i) {
    out.add(words("FLT", kParameters[i]), Form::kFlatness, {values[i]}).asked.indication.parameter =
        kParameters[i];
  }
  const Vector3d mz = normal_of(all, face.outward, Reference::kMinimumZone);
  out.add("FLTt mz", Form::kFlatness, {range_along(all, mz)}, Reference::kMinimumZone);
}

// ---- The shafts.

/// Random numbers between limits.
class Drawn {
 public:
  explicit Drawn(std::uint64_t seed) : noise_(20261123, {19, seed}) {}
  double in(double low, double high) { return low + (high - low) * noise_.uniform(); }
  double either(double most) { return in(-most, most); }
  int whole(int low, int high) {
    return std::min(high, static_cast<int>(std::floor(in(low, high + 1.0))));
  }

 private:
  core::KeyedNoise noise_;
};

/// A common pose; its axis is not square to machine z, so that layers have an order.
Eigen::Isometry3d common_pose(Drawn& drawn) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translation() = Vector3d(drawn.either(200.0), drawn.either(200.0), drawn.either(200.0));
  do {
    const Vector3d about(drawn.either(1.0), drawn.either(1.0), drawn.either(1.0));
    out.linear() = Eigen::AngleAxisd(drawn.either(3.1), about.normalized()).toRotationMatrix();
  } while (std::abs(out.linear()(2, 2)) < 0.3);
  return out;
}

Turned planted(Drawn& drawn, const Eigen::Isometry3d& pose, double low, double high,
               const Eigen::Isometry3d& own, bool perfect) {
  Turned out;
  out.radius = drawn.in(8.0, 40.0);
  out.length = high - low;
  out.layers = drawn.whole(3, 7);
  out.points = 2 * drawn.whole(6, 60);
  out.start_rad = drawn.in(0.0, core::kTwoPi);
  out.place = pose * own;
  // Of an axis along machine x or y the layers count along that.
  Eigen::Index along = 0;
  out.reversed =
      pose.linear().col(2).cwiseAbs().maxCoeff(&along) > 0.0 && pose.linear()(along, 2) < 0.0;
  if (perfect) return out;
  out.cone = drawn.either(0.004);
  out.barrel = drawn.either(0.003);
  out.bend = drawn.either(0.003);
  for (const int k : {2, 3, 4, 5}) {
    out.lobe[k] = drawn.in(0.0002, 0.003);
    out.phase[k] = drawn.in(0.0, core::kTwoPi);
  }
  return out;
}

Face planted_face(Drawn& drawn, const Eigen::Isometry3d& pose, double height) {
  Face out;
  const int circles = drawn.whole(3, 7);
  const int points = drawn.whole(12, 120);
  const double start = drawn.in(0.0, core::kTwoPi);
  const double tilt = drawn.either(1e-4);
  const double saucer = drawn.either(0.003);
  const double wave = drawn.either(0.002);
  const double turn = drawn.in(0.0, core::kTwoPi);
  for (int j = 0; j < circles; ++j) {
    const double q = 10.0 + 20.0 * j / (circles - 1);
    auto& circle = out.circles.emplace_back();
    out.radii.push_back(q);
    for (int i = 0; i < points; ++i) {
      const double t = start + core::kTwoPi * i / points;
      const double h = tilt * q * std::cos(t - turn) + saucer * q * q / 900.0 +
                       wave * q / 30.0 * std::cos(2.0 * t + turn) +
                       0.3 * wave * std::cos(3.0 * t - 2.0 * turn);
      circle.push_back(pose * Vector3d(q * std::cos(t), q * std::sin(t), height + h));
    }
  }
  out.outward = pose.linear().col(2);
  return out;
}

void compare(const FeatureResult& found, const std::vector<PlantedQuestion>& questions) {
  ASSERT_EQ(found.characteristics.size(), questions.size());
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const CharacteristicResult& one = found.characteristics[i];
    const PlantedQuestion& question = questions[i];
    SCOPED_TRACE(found.feature.id + ": " + question.asked.id);
    EXPECT_TRUE(one.value_mm()) << one.reason.english();
    if (!one.value_mm()) continue;
    std::vector<double> judged = {*one.value_mm()};
    std::vector<double> local;
    if (one.finding) {  // CYLt and RONt without other indications have none
      judged.clear();
      for (const JudgedValue& value : one.finding->judged) judged.push_back(value.value_mm);
      for (const LocalValue& value : one.finding->local) local.push_back(value.value_mm);
    }
    EXPECT_EQ(judged.size(), question.judged.size());
    for (std::size_t k = 0; k < std::min(judged.size(), question.judged.size()); ++k) {
      if (std::isnan(question.judged[k])) continue;
      EXPECT_NEAR(judged[k], question.judged[k], kDefinition);
    }
    if (question.local.empty()) continue;
    std::vector<double> want = question.local;
    std::sort(local.begin(), local.end());
    std::sort(want.begin(), want.end());
    EXPECT_EQ(local.size(), want.size());
    for (std::size_t k = 0; k < std::min(local.size(), want.size()); ++k) {
      EXPECT_NEAR(local[k], want[k], kDefinition);
    }
  }
}

/// Extreme circles and cylinders. Distances bend with the move, so that there are several lowest
/// places some nanometres apart, which a search here need not tell from each other: the value is
/// reached about the reported axis, and no place that is found here is better.
void compare_extremes(const FeatureResult& found, const Oracle& of) {
  SCOPED_TRACE(found.feature.id);
  const auto one = [&](const std::string& id) -> const CharacteristicResult& {
    return *std::find_if(found.characteristics.begin(), found.characteristics.end(),
                         [&](const auto& c) { return c.characteristic.id == id; });
  };
  const auto value = [&](const std::string& id) { return one(id).value_mm().value_or(NAN); };
  ASSERT_TRUE(found.mz_cylinder && found.mc_cylinder && found.mi_cylinder);
  const auto reported = [&](const fit::Axis& axis) {
    return radii_about({axis.point_mm, axis.direction}, {of.all});
  };
  const Round mz = reported(found.mz_cylinder->axis);
  const Round mc = reported(found.mc_cylinder->axis);
  const Round mi = reported(found.mi_cylinder->axis);
  EXPECT_NEAR(value("CYLt mz"), mz.outer[0] - mz.inner[0], kDefinition);
  EXPECT_NEAR(value("CYLt mc"), mc.outer[0] - mc.inner[0], kDefinition);
  EXPECT_NEAR(value("CYLt mi"), mi.outer[0] - mi.inner[0], kDefinition);
  EXPECT_NEAR(value("d GC"), of.diameter(0.5 * (mz.outer[0] + mz.inner[0])), kDefinition);
  // These sizes have a search of their own, which may end at another of the lowest places.
  constexpr double kPlaces = 1e-6;
  EXPECT_NEAR(value("d GN"), of.diameter(mc.outer[0]), kPlaces);
  EXPECT_NEAR(value("d GX"), of.diameter(mi.inner[0]), kPlaces);
  EXPECT_EQ(value("d E"), value(of.side > 0.0 ? "d GN" : "d GX"));
  const Round narrow = extreme({of.all}, of.axis, 4, Least::kZone);
  EXPECT_LE(mz.outer[0] - mz.inner[0], narrow.outer[0] - narrow.inner[0] + kDefinition);
  const double outer = extreme({of.all}, of.axis, 4, Least::kOuter).outer[0];
  EXPECT_LE(mc.outer[0], outer + kDefinition);
  EXPECT_LE(value("d GN"), of.diameter(outer) + kDefinition);
  const double inner = extreme({of.all}, of.axis, 4, Least::kInner).inner[0];
  EXPECT_LE(inner - mi.inner[0], kDefinition);
  EXPECT_GE(value("d GX"), of.diameter(inner) - kDefinition);

  // Without other indications RONt is that of sections square to the minimum-zone axis.
  double worst = 0.0;
  double worst_zone = 0.0;
  const auto& any = one("d ACS GX").finding;
  ASSERT_TRUE(any && any->local.size() == of.layers.size());
  for (std::size_t j = 0; j < of.layers.size(); ++j) {
    worst = std::max(
        worst, about({of.layers[j]}, mz.axis, 2, Reference::kLeastSquares).width(of.layers[j]));
    const Round zone = extreme({of.layers[j]}, mz.axis, 2, Least::kZone);
    worst_zone = std::max(worst_zone, zone.outer[0] - zone.inner[0]);
    EXPECT_GE(any->local[j].value_mm,
              of.size(of.layers[j], 2, Indication::Size::kGX) - kDefinition);
  }
  EXPECT_NEAR(value("RONt ls"), worst, kDefinition);
  EXPECT_LE(value("RONt mz"), worst_zone + kDefinition);
}

/// All with RONDURE_FULL=1. The first four hold every kind: on one axis or not, a shaft or a bore
/// for C.
int shafts() { return test::cases(4, 100, 200); }

}  // namespace

TEST(PlantedShafts, HaveEveryCharacteristicOfItsDefinition) {
  for (int shaft = 0; shaft < shafts(); ++shaft) {
    SCOPED_TRACE(shaft);
    Drawn drawn(static_cast<std::uint64_t>(shaft));
    const bool perfect = shaft % 2 == 0;
    const bool inside = shaft % 3 == 0;
    const double tip = drawn.in(0.5, 2.5);
    const Eigen::Isometry3d pose = common_pose(drawn);
    const auto own = [&](double z, bool straight) {
      if (straight) return tilted(0.0, 0.0, z, 0.0, 0.0);
      return tilted(drawn.either(0.01), drawn.either(0.01), z, drawn.either(1e-4),
                    drawn.either(1e-4));
    };
    const Oracle a(planted(drawn, pose, 0.0, 30.0, own(15.0, perfect), perfect), false, tip);
    const Oracle b(planted(drawn, pose, 120.0, 140.0, own(130.0, perfect), perfect), false, tip);
    const Oracle c(planted(drawn, pose, 60.0, 90.0, own(75.0, false), false), inside, tip);
    const Face d = planted_face(drawn, pose, 150.0);
    std::vector<std::pair<Association, std::pair<Line, Line>>> datums;
    const Line planted_axis{pose.translation(), pose.linear().col(2)};
    if (perfect) {
      for (const auto association :
           {Association::kOneSided, Association::kEqualised, Association::kLs}) {
        datums.push_back({association, {planted_axis, planted_axis}});
      }
    } else {
      const std::vector<Points> both = {a.all, b.all};
      datums.push_back({Association::kLs, {a.axis, least_squares(both, planted_axis, 4).axis}});
    }
    Questions of_a;
    if (!perfect) {
      ask_sizes(a, of_a);
      ask_form(a, of_a);
      ask_lines(a, of_a);
    }
    Questions of_c;
    ask_sizes(c, of_c);
    ask_form(c, of_c);
    ask_lines(c, of_c);
    Questions of_d;
    ask_flatness(d, of_d);
    for (const auto& [association, axes] : datums) {
      ask_about_axis(c, "A", association, axes.first, of_c);
      ask_about_axis(c, "A-B", association, axes.second, of_c);
      ask_face(d, association, axes.second, of_d);
    }
    Points face;
    for (const auto& circle : d.circles) face.insert(face.end(), circle.begin(), circle.end());
    for (const auto& [association, reference] :
         {std::pair{Association::kLs, Reference::kLeastSquares},
          std::pair{Association::kOneSided, Reference::kMinimumZone}}) {
      const double zone = round_zone(c.centers, normal_of(face, d.outward, reference));
      to(of_c.add(words("perpendicularity to D", association), Form::kPerpendicularity, {zone}),
         "D", association);
    }

    record::RunRecord run;
    run.header.run_id = "shaft";
    const auto add = [&](const std::string& id, Shape shape, const Layers& layers,
                         const Questions& questions, Side side = Side::kOutside) {
      record::Feature& feature = reports::add_to_points_run(run, id, shape, layers, side);
      feature.tip_radius_mm = tip;
      feature.characteristics = questions.asked();
      return &feature;
    };
    add("A", Shape::kCylinder, a.layers, of_a);
    add("B", Shape::kCylinder, b.layers, {});
    add("C", Shape::kCylinder, c.layers, of_c, inside ? Side::kInside : Side::kOutside);
    add("D", Shape::kPlane, d.circles, of_d)->settings = {
        test::text_setting("faces", d.outward.z() > 0.0 ? "up" : "down")};
    const Evaluation found = reports::evaluated(run);
    ASSERT_EQ(found.features.size(), 4U);
    compare(found.features[0], of_a.all());
    compare(found.features[2], of_c.all());
    compare(found.features[3], of_d.all());
    if (!perfect) compare_extremes(found.features[0], a);
    compare_extremes(found.features[2], c);
  }
}

}  // namespace rondure::evaluation
