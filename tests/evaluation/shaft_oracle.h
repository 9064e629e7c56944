#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "core/units.h"
#include "record/indication.h"
#include "record/run_record.h"
#include "tests/evaluation/drawing_part.h"

/// Cylinders of a shaft with planted deviations, and what each is by the definitions (methods,
/// drawing sections 2 to 5), computed from its points or the planted surface without the program's
/// fits.
namespace rondure::test::shaft {

using Eigen::Vector3d;
using record::Indication;
using record::Reference;
using Points = std::vector<Vector3d>;

struct Line {
  Vector3d point = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitZ();

  [[nodiscard]] double height(const Vector3d& p) const { return (p - point).dot(direction); }
  [[nodiscard]] Vector3d away(const Vector3d& p) const { return p - point - height(p) * direction; }
  [[nodiscard]] double distance(const Vector3d& p) const { return away(p).norm(); }
};

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

/// Two directions square to an axis.
[[nodiscard]] std::pair<Vector3d, Vector3d> square_to(const Vector3d& w);
[[nodiscard]] Eigen::Isometry3d tilted(double x, double y, double z, double tilt_x, double tilt_y);

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

/// Least squares by Gauss and Newton; `moves` is 2 for a circle, 4 for a cylinder.
[[nodiscard]] Round least_squares(const std::vector<Points>& groups, const Line& near, int moves);
/// Least cost * x with rows * x >= bounds: exchange of one row of the basis in each step.
[[nodiscard]] Eigen::VectorXd cheapest(Eigen::MatrixXd rows, Eigen::VectorXd bounds,
                                       const Eigen::VectorXd& cost, const Eigen::VectorXd& box);
/// Farthest and nearest point of each group.
[[nodiscard]] Round radii_about(const Line& axis, const std::vector<Points>& groups);
/// Least sum of widths, of outer radii, or greatest sum of inner radii.
enum class Least { kZone, kOuter, kInner };
[[nodiscard]] Round extreme(const std::vector<Points>& groups, const Line& near, int moves,
                            Least least);
[[nodiscard]] Round about(const std::vector<Points>& groups, const Line& near, int moves,
                          Reference reference);

[[nodiscard]] double range(const std::vector<double>& values);
[[nodiscard]] double root_mean_square(const std::vector<double>& values);
/// Diameter of the least circle round some points, seen along an axis.
[[nodiscard]] double round_zone(const Points& centers, const Vector3d& along);
/// Diameter of the least cylinder round some points near an axis.
[[nodiscard]] double least_cylinder(const Points& points, const Line& near);

struct Fitted {
  double slope = 0.0;
  std::vector<double> off;  // square to the line
};
[[nodiscard]] Fitted regression(const std::vector<double>& h, const std::vector<double>& d);
/// Least width of a profile.
[[nodiscard]] double least_width(const std::vector<double>& h, const std::vector<double>& d);

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

}  // namespace rondure::test::shaft
