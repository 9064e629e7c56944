#include "cgal_circle.h"

#include <cmath>
#include <limits>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Min_circle_2.h>
#include <CGAL/Min_circle_2_traits_2.h>
#include <CGAL/Regular_triangulation_2.h>

namespace rondure::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_2;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel>;
using Regular = CGAL::Regular_triangulation_2<Kernel>;

std::vector<Point> exact(std::span<const Eigen::Vector2d> points_mm) {
  std::vector<Point> out;
  for (const auto& p : points_mm) out.emplace_back(p.x(), p.y());
  return out;
}

Delaunay nearest_diagram(const std::vector<Point>& points) {
  return Delaunay(points.begin(), points.end());
}

/// |c + p|^2 - 2 |p|^2 = 2 |c|^2 - |c - p|^2: the least power distance of the mirrored points with
/// weights 2 |p|^2 belongs to the farthest point, so this power diagram is the farthest-point
/// Voronoi diagram.
Regular farthest_diagram(const std::vector<Point>& points) {
  std::vector<Regular::Weighted_point> mirrored;
  for (const Point& p : points) {
    mirrored.emplace_back(Point(-p.x(), -p.y()), 2 * (p.x() * p.x() + p.y() * p.y()));
  }
  return Regular(mirrored.begin(), mirrored.end());
}

/// A Voronoi edge as segment, ray or line.
template <class Diagram>
std::vector<CGAL::Object> edges(const Diagram& diagram) {
  std::vector<CGAL::Object> out;
  for (auto e = diagram.finite_edges_begin(); e != diagram.finite_edges_end(); ++e) {
    out.push_back(diagram.dual(e));
  }
  return out;
}

/// An edge in doubles, to pass over the pairs that are clearly apart.
struct Rough {
  Eigen::Vector2d from;
  Eigen::Vector2d along;  ///< Unit vector.
  double begin;           ///< Parameters of the ends [mm].
  double end;
};

Eigen::Vector2d rough(const Point& p) { return {CGAL::to_double(p.x()), CGAL::to_double(p.y())}; }

Rough rough(const CGAL::Object& edge) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (const auto* segment = CGAL::object_cast<Kernel::Segment_2>(&edge)) {
    const Eigen::Vector2d v = rough(segment->target()) - rough(segment->source());
    return {rough(segment->source()), v.normalized(), 0.0, v.norm()};
  }
  if (const auto* ray = CGAL::object_cast<Kernel::Ray_2>(&edge)) {
    return {rough(ray->source()), (rough(ray->point(1)) - rough(ray->source())).normalized(), 0.0,
            kFar};
  }
  const auto* line = CGAL::object_cast<Kernel::Line_2>(&edge);
  return {rough(line->point(0)), (rough(line->point(1)) - rough(line->point(0))).normalized(),
          -kFar, kFar};
}

/// True unless the edges pass each other by far more than doubles err.
bool may_cross(const Rough& a, const Rough& b) {
  const double det = a.along.x() * b.along.y() - a.along.y() * b.along.x();
  if (!(std::abs(det) > 1e-6)) return true;
  const Eigen::Vector2d v = b.from - a.from;
  const double s = (v.x() * b.along.y() - v.y() * b.along.x()) / det;
  const double t = (v.x() * a.along.y() - v.y() * a.along.x()) / det;
  const double margin = 1e-7 * (1.0 + a.from.norm() + b.from.norm()) / std::abs(det);
  return s > a.begin - margin && s < a.end + margin && t > b.begin - margin && t < b.end + margin;
}

template <class A, class B>
void add_crossing(const A& a, const B& b, std::vector<Point>& out) {
  const auto common = CGAL::intersection(a, b);
  if (!common) return;
  if (const Point* p = boost::get<Point>(&*common)) out.push_back(*p);
}

template <class A>
void add_crossing(const A& a, const CGAL::Object& b, std::vector<Point>& out) {
  if (const auto* segment = CGAL::object_cast<Kernel::Segment_2>(&b))
    add_crossing(a, *segment, out);
  if (const auto* ray = CGAL::object_cast<Kernel::Ray_2>(&b)) add_crossing(a, *ray, out);
  if (const auto* line = CGAL::object_cast<Kernel::Line_2>(&b)) add_crossing(a, *line, out);
}

void add_crossing(const CGAL::Object& a, const CGAL::Object& b, std::vector<Point>& out) {
  if (const auto* segment = CGAL::object_cast<Kernel::Segment_2>(&a))
    add_crossing(*segment, b, out);
  if (const auto* ray = CGAL::object_cast<Kernel::Ray_2>(&a)) add_crossing(*ray, b, out);
  if (const auto* line = CGAL::object_cast<Kernel::Line_2>(&a)) add_crossing(*line, b, out);
}

template <class Diagram>
void add_vertices(const Diagram& diagram, std::vector<Point>& out) {
  for (auto f = diagram.finite_faces_begin(); f != diagram.finite_faces_end(); ++f) {
    out.push_back(diagram.dual(f));
  }
}

/// A double and what it leaves out: 30 digits of an exact number.
Real real(const Kernel::FT& value) {
  const double high = CGAL::to_double(value.exact());
  return static_cast<Real>(high) + static_cast<Real>(CGAL::to_double((value - high).exact()));
}

Vector2r real(const Point& p) { return {real(p.x()), real(p.y())}; }

}  // namespace

CirclePlace cgal_min_zone(std::span<const Eigen::Vector2d> points_mm) {
  const std::vector<Point> points = exact(points_mm);
  const Delaunay nearest = nearest_diagram(points);
  const Regular farthest = farthest_diagram(points);
  std::vector<Point> vertices;
  add_vertices(nearest, vertices);
  add_vertices(farthest, vertices);
  const auto far_edges = edges(farthest);
  std::vector<Rough> far_rough;
  for (const auto& edge : far_edges) far_rough.push_back(rough(edge));
  for (const auto& near_edge : edges(nearest)) {
    const Rough near_rough = rough(near_edge);
    for (std::size_t k = 0; k < far_edges.size(); ++k) {
      if (may_cross(near_rough, far_rough[k])) add_crossing(near_edge, far_edges[k], vertices);
    }
  }
  CirclePlace best{Vector2r::Zero(), std::numeric_limits<Real>::infinity()};
  for (const Point& vertex : vertices) {
    const Vector2r center = real(vertex);
    const Reach at = reach_from(points_mm, center);
    if (at.high_mm - at.low_mm < best.value_mm) best = {center, at.high_mm - at.low_mm};
  }
  return best;
}

CirclePlace cgal_circumscribed(std::span<const Eigen::Vector2d> points_mm) {
  const std::vector<Point> points = exact(points_mm);
  const CGAL::Min_circle_2<CGAL::Min_circle_2_traits_2<Kernel>> circle(points.begin(), points.end(),
                                                                       false);
  return {real(circle.circle().center()), std::sqrt(real(circle.circle().squared_radius()))};
}

std::vector<CirclePlace> cgal_inscribed(std::span<const Eigen::Vector2d> points_mm) {
  const Delaunay nearest = nearest_diagram(exact(points_mm));
  std::vector<CirclePlace> maxima;
  for (auto f = nearest.finite_faces_begin(); f != nearest.finite_faces_end(); ++f) {
    const Point center = nearest.dual(f);
    // Held: the circumcentre is inside this triangle, or on the side it shares with another
    // triangle of the same circle.
    const auto side = nearest.triangle(f).bounded_side(center);
    if (side == CGAL::ON_UNBOUNDED_SIDE) continue;
    if (side == CGAL::ON_BOUNDARY) {
      bool shared = false;
      for (int k = 0; k < 3; ++k) {
        const auto other = f->neighbor(k);
        shared = shared || (!nearest.is_infinite(other) && nearest.dual(other) == center);
      }
      if (!shared) continue;
    }
    const Vector2r place = real(center);
    maxima.push_back({place, reach_from(points_mm, place).low_mm});
  }
  return maxima;
}

}  // namespace rondure::test
