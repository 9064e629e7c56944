#include "fit/geometry/internal/hull_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rondure::fit {
namespace {

struct Edge {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
};

/// The edges between neighbours by angle; a single vertex gives one edge of length 0.
std::vector<Edge> edges(std::vector<Eigen::Vector2d>& vertices) {
  std::ranges::sort(vertices, [](const auto& a, const auto& b) {
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Edge> out;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    out.push_back({vertices[i], vertices[(i + 1) % vertices.size()]});
  }
  return out;
}

/// Keeps the closest pair of a vertex and a point of an edge.
void offer(const Eigen::Vector2d& vertex, const Edge& edge, bool vertex_first, HullDistance& best) {
  const Eigen::Vector2d along = edge.b - edge.a;
  const double length2 = along.squaredNorm();
  const double t =
      length2 > 0.0 ? std::clamp((vertex - edge.a).dot(along) / length2, 0.0, 1.0) : 0.0;
  const Eigen::Vector2d foot = edge.a + t * along;
  const double distance = (vertex - foot).norm();
  if (distance >= best.distance) return;
  best.distance = distance;
  best.on_first = vertex_first ? vertex : foot;
  best.on_second = vertex_first ? foot : vertex;
  best.vertices = t == 0.0 || t == 1.0;
}

}  // namespace

bool segments_cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d) {
  return twice_area(a, b, c) * twice_area(a, b, d) < 0.0 &&
         twice_area(c, d, a) * twice_area(c, d, b) < 0.0;
}

HullDistance hull_distance(std::vector<Eigen::Vector2d> first,
                           std::vector<Eigen::Vector2d> second) {
  const std::vector<Edge> first_edges = edges(first);
  const std::vector<Edge> second_edges = edges(second);
  HullDistance best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Edge& e : first_edges) {
    for (const Edge& f : second_edges) {
      if (segments_cross(e.a, e.b, f.a, f.b)) return {0.0, e.a, e.a, false};
      offer(e.a, f, true, best);
      offer(f.a, e, false, best);
    }
  }
  return best;
}

}  // namespace rondure::fit
