#include "evaluation/uncertainty/internal/point_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;

using Rows = std::vector<std::size_t>;

/// Whether rows of equal distance from the middle of a face are circles: the points of a grid have
/// such rows as well, of four and eight, which show no undulations of the face.
bool on_circles(const std::vector<Rows>& layers) {
  const auto [least, most] = std::ranges::minmax_element(layers, {}, &Rows::size);
  return layers.size() == 1 || (least->size() >= 5 && 4 * least->size() >= 3 * most->size());
}

/// Rows in layers by height; empty where the heights show no layers.
std::vector<Rows> height_layers(const FormCloud& cloud) {
  Rows order(cloud.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (cloud.kind == FormKind::kRoundness) return {order};
  if (cloud.kind == FormKind::kSections) {
    std::vector<Rows> sections;
    for (const std::size_t i : order) {
      sections.resize(static_cast<std::size_t>(cloud.points[i].section) + 1);
      sections.back().push_back(i);
    }
    return sections;
  }
  const auto height = [&](std::size_t i) { return cloud.points[i].height_mm; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return height(a) < height(b); });
  double largest = 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    largest = std::max(largest, height(order[i]) - height(order[i - 1]));
  }
  // A tilted part spreads the heights of a layer, by less than the spacing of the layers.
  std::vector<Rows> layers(1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && height(order[i]) - height(order[i - 1]) > 0.25 * largest) layers.emplace_back();
    layers.back().push_back(order[i]);
  }
  for (const Rows& layer : layers) {
    const double extent = height(layer.back()) - height(layer.front());
    if (layer.size() < 3 || extent > 0.5 * largest) return {};
  }
  if (cloud.kind == FormKind::kFlatness && !on_circles(layers)) return {};
  return layers;
}

std::vector<double> sorted_angles(const FormCloud& cloud, const Rows& rows) {
  std::vector<double> angles;
  for (const std::size_t i : rows) {
    const double turned = std::fmod(cloud.points[i].angle_rad, core::kTwoPi);
    angles.push_back(turned < 0.0 ? turned + core::kTwoPi : turned);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

/// The largest gap and its end, in sorted angles within one turn.
std::pair<double, double> largest_gap(const std::vector<double>& angles) {
  double gap = angles.front() + core::kTwoPi - angles.back();
  double end = angles.front();
  for (std::size_t i = 1; i < angles.size(); ++i) {
    if (angles[i] - angles[i - 1] <= gap) continue;
    gap = angles[i] - angles[i - 1];
    end = angles[i];
  }
  return {gap, end};
}

/// Turns that the points make along the axis; 0 where they do not go round it.
double turns_of(const FormCloud& cloud) {
  Rows order(cloud.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cloud.points[a].height_mm < cloud.points[b].height_mm;
  });
  double net = 0.0;
  double way = 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const double step = std::remainder(
        cloud.points[order[i]].angle_rad - cloud.points[order[i - 1]].angle_rad, core::kTwoPi);
    net += step;
    way += std::abs(step);
  }
  return std::abs(net) > 0.8 * way ? std::abs(net) / core::kTwoPi : 0.0;
}

bool even_steps(const std::vector<double>& angles) {
  const double step = core::kTwoPi / static_cast<double>(angles.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double apart = angles[i] - angles.front() - static_cast<double>(i) * step;
    if (std::abs(apart) > 1e-8) return false;
  }
  return true;
}

/// The largest gap that still counts as a closed section: a missing touch between steps that may be
/// uneven or, in a dense scan, the few neighbouring points that drop out.
double closed_gap(int points_per_layer) {
  const double step = core::kTwoPi / std::max(1, points_per_layer);
  return std::max(2.5 * step, std::min(5.5 * step, 10.0 * core::kDegree));
}

}  // namespace

PointLayout layout_of(const FormCloud& cloud, const Eigen::VectorXd& root_weights) {
  PointLayout out;
  const Index n = static_cast<Index>(cloud.points.size());
  const auto layers = height_layers(cloud);
  Rows all(cloud.points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  if (!layers.empty()) {
    out.layers = static_cast<int>(layers.size());
    std::size_t least = layers.front().size();
    out.regular = cloud.passes == 1 && root_weights.minCoeff() == root_weights.maxCoeff();
    for (const Rows& layer : layers) {
      least = std::min(least, layer.size());
      const double extent =
          cloud.points[layer.back()].height_mm - cloud.points[layer.front()].height_mm;
      out.regular = out.regular && layer.size() == layers.front().size() &&
                    (layers.size() == 1 || extent < 1e-9) &&
                    even_steps(sorted_angles(cloud, layer));
    }
    // Passes at different places form bunches: together they resolve what one of them does.
    out.points_per_layer = std::max(1, static_cast<int>(least) / std::max(1, cloud.passes));
  } else {
    out.layered = false;
    const double turns = turns_of(cloud);
    const double count = static_cast<double>(n);
    out.layers = turns >= 2.0 ? static_cast<int>(turns)
                              : std::max(2, static_cast<int>(std::sqrt(count / 4.0)));
    out.points_per_layer = static_cast<int>(n) / out.layers;
  }
  out.angle.resize(n);
  for (Index i = 0; i < n; ++i) out.angle[i] = cloud.points[static_cast<std::size_t>(i)].angle_rad;
  if (cloud.kind == FormKind::kFlatness && !out.layered) return out;
  const auto angles = sorted_angles(cloud, all);
  const auto [gap, end] = largest_gap(angles);
  if (gap < closed_gap(out.points_per_layer)) return out;
  out.regular = false;
  out.arc_rad = core::kTwoPi - gap;
  for (double& angle : out.angle) {
    double from = std::fmod(angle - end, core::kTwoPi);
    if (from < -1e-12) from += core::kTwoPi;
    angle = std::numbers::pi * from / std::max(*out.arc_rad, 1e-9);
  }
  return out;
}

}  // namespace rondure::evaluation
