#include "plans/path/solid_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <fmt/format.h>

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using Inside = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;

constexpr double kLeastSize_mm = 1.0;
constexpr double kGreatestSize_mm = 5000.0;
constexpr double kJoined_1 = 1e-6;   // of the size: corners that are one
constexpr double kFine_mm = 1e-3;    // half diagonal of a piece that is not halved again
constexpr int kMostAsked = 200'000;  // distances of one sweep
constexpr double kRound_rad = 0.25 * std::numbers::pi;  // turn between facets of a round wall
constexpr double kSharp_rad = std::numbers::pi / 6.0;   // turn at an edge that is drawn

Point at(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Vector3d place(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// An edge of the surface with what lies on its two sides.
struct Edge {
  Vector3d from_mm;
  Vector3d to_mm;
  std::optional<Vector3d> normal;        ///< Of the triangle on its left; none beyond a border.
  std::optional<Vector3d> other_normal;  ///< On its right.
  double width_mm = 0.0;                 ///< Height above the edge of the higher of the triangles.

  /// The turn from one triangle to the other; none at a border.
  [[nodiscard]] std::optional<double> turn_rad() const {
    if (!normal || !other_normal) return std::nullopt;
    return std::atan2(normal->cross(*other_normal).norm(), normal->dot(*other_normal));
  }
};

std::vector<Edge> edges_of(const Mesh& mesh) {
  std::vector<Edge> out;
  out.reserve(mesh.number_of_edges());
  for (const auto edge : mesh.edges()) {
    const auto half = mesh.halfedge(edge);
    Edge made{place(mesh.point(mesh.source(half))), place(mesh.point(mesh.target(half))), {}, {}};
    const Vector3d along = made.to_mm - made.from_mm;
    for (const auto side : {half, mesh.opposite(half)}) {
      if (mesh.is_border(side)) continue;
      const Vector3d apex = place(mesh.point(mesh.target(mesh.next(side))));
      const double sign = side == half ? 1.0 : -1.0;
      const Vector3d area = sign * along.cross(apex - made.from_mm);
      (side == half ? made.normal : made.other_normal) = area.normalized();
      made.width_mm = std::max(made.width_mm, area.norm() / along.norm());
    }
    out.push_back(made);
  }
  return out;
}

/// Joins the points that lie within `near_mm` of an earlier one: CAD that computes a corner anew
/// for each of its triangles rounds it differently.
void join(std::vector<Point>& points, std::vector<std::array<std::size_t, 3>>& soup,
          double near_mm) {
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, std::vector<std::size_t>> cells;
  std::vector<std::size_t> kept(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto cell_of = [&](int k) {
      return static_cast<std::int64_t>(std::floor(points[i][k] / near_mm));
    };
    const Cell own = {cell_of(0), cell_of(1), cell_of(2)};
    kept[i] = i;
    for (int k = 0; k < 27 && kept[i] == i; ++k) {
      const auto found =
          cells.find({own[0] + k % 3 - 1, own[1] + k / 3 % 3 - 1, own[2] + k / 9 - 1});
      if (found == cells.end()) continue;
      for (const std::size_t other : found->second) {
        if (CGAL::squared_distance(points[i], points[other]) > near_mm * near_mm) continue;
        kept[i] = other;
        break;
      }
    }
    if (kept[i] == i) cells[own].push_back(i);
  }
  for (auto& triangle : soup) {
    for (std::size_t& corner : triangle) corner = kept[corner];
  }
}

core::Error not_built(const std::exception& reason) {
  return {core::Code::kSyntax,
          fmt::format("no surface can be made of its triangles ({})", reason.what()),
          {}};
}

}  // namespace

struct SolidMesh::Impl {
  Mesh mesh;
  Tree tree;
  std::unique_ptr<Inside> inside;  ///< Of a closed surface.
  std::vector<Edge> edges;
  std::vector<Vector3d> points_mm;
  Vector3d low_mm = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high_mm = -low_mm;

  [[nodiscard]] double distance_mm(const Vector3d& p) const {
    return std::sqrt(CGAL::to_double(tree.squared_distance(at(p))));
  }
  /// Whether a piece of a sweep is nearer than `room_mm`.
  [[nodiscard]] bool nearer(const Sweep& s, double room_mm, int& asked) const {
    const Vector3d middle = s.start_mm + 0.5 * (s.along_mm + s.up_mm);
    const double half_mm =
        0.5 * std::max((s.along_mm + s.up_mm).norm(), (s.along_mm - s.up_mm).norm());
    const Vector3d outside = (low_mm - middle).cwiseMax(middle - high_mm).cwiseMax(0.0);
    if (outside.norm() > room_mm + half_mm) return false;
    if (++asked > kMostAsked) return true;
    const double off_mm = distance_mm(middle);
    if (off_mm > room_mm + half_mm) return false;
    if (off_mm <= room_mm || half_mm < kFine_mm) return true;
    Sweep first = s;
    Sweep second = s;
    const bool along = s.along_mm.squaredNorm() >= s.up_mm.squaredNorm();
    Vector3d& side = along ? first.along_mm : first.up_mm;
    side *= 0.5;
    second.start_mm += side;
    (along ? second.along_mm : second.up_mm) = side;
    return nearer(first, room_mm, asked) || nearer(second, room_mm, asked);
  }
};

SolidMesh::SolidMesh(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SolidMesh::~SolidMesh() = default;

Questions& questions_of_thread() {
  thread_local Questions out;
  return out;
}

core::Result<std::shared_ptr<const SolidMesh>> SolidMesh::build(
    std::span<const Vector3d> points_mm, std::span<const std::array<std::size_t, 3>> corners) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  if (corners.size() > kMostTriangles) {
    return core::fail_with(core::Code::kOutOfRange,
                           "the surface has {} triangles, the limit is {}: export it coarser",
                           corners.size(), kMostTriangles);
  }
  auto impl = std::make_unique<Impl>();
  try {
    std::vector<Point> points;
    for (const Vector3d& p : points_mm) points.push_back(at(p));
    std::vector<std::array<std::size_t, 3>> soup(corners.begin(), corners.end());
    const CGAL::Bbox_3 box = CGAL::bbox_3(points.begin(), points.end());
    const double across_mm =
        std::max({box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin()});
    if (across_mm > 0.0) join(points, soup, kJoined_1 * across_mm);
    std::erase_if(soup, [&](const auto& triangle) {
      const auto& [a, b, c] = triangle;
      return CGAL::collinear(points[a], points[b], points[c]);
    });
    pmp::repair_polygon_soup(points, soup);
    pmp::orient_polygon_soup(points, soup);
    pmp::polygon_soup_to_polygon_mesh(points, soup, impl->mesh);
    pmp::stitch_borders(impl->mesh);
    if (impl->mesh.number_of_faces() == 0) {
      return core::fail(core::Code::kNoPoints, "the surface has no triangle with an area");
    }
    impl->edges = edges_of(impl->mesh);
    for (const auto corner : impl->mesh.vertices()) {
      impl->points_mm.push_back(place(impl->mesh.point(corner)));
      impl->low_mm = impl->low_mm.cwiseMin(impl->points_mm.back());
      impl->high_mm = impl->high_mm.cwiseMax(impl->points_mm.back());
    }
    impl->tree.insert(faces(impl->mesh).first, faces(impl->mesh).second, impl->mesh);
    impl->tree.build();
    impl->tree.accelerate_distance_queries();
    if (CGAL::is_closed(impl->mesh)) impl->inside = std::make_unique<Inside>(impl->tree);
  } catch (const std::exception& reason) {
    return core::fail(not_built(reason));
  }
  const double size_mm = (impl->high_mm - impl->low_mm).maxCoeff();
  if (!(size_mm >= kLeastSize_mm && size_mm <= kGreatestSize_mm)) {
    return core::fail_with(core::Code::kUnits,
                           "the surface is {:.4g} mm across, expected {:g} to {:g} mm; check its "
                           "unit",
                           size_mm, kLeastSize_mm, kGreatestSize_mm);
  }
  return std::shared_ptr<const SolidMesh>(new SolidMesh(std::move(impl)));
}

core::Result<std::shared_ptr<const SolidMesh>> SolidMesh::box(const Vector3d& size_mm) {
  std::vector<Vector3d> points;
  for (int k = 0; k < 8; ++k) {
    points.emplace_back(
        size_mm.cwiseProduct(Vector3d(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5)));
  }
  // Two triangles for each face; build() turns them to look outward.
  constexpr std::array<std::array<std::size_t, 3>, 12> kFaces = {{{0, 1, 2},
                                                                  {3, 1, 2},
                                                                  {4, 5, 6},
                                                                  {7, 5, 6},
                                                                  {0, 1, 4},
                                                                  {5, 1, 4},
                                                                  {2, 3, 6},
                                                                  {7, 3, 6},
                                                                  {0, 2, 4},
                                                                  {6, 2, 4},
                                                                  {1, 3, 5},
                                                                  {7, 3, 5}}};
  return build(points, kFaces);
}

std::size_t SolidMesh::triangles() const { return impl_->mesh.number_of_faces(); }

bool SolidMesh::is_closed() const { return impl_->inside != nullptr; }

const std::vector<Vector3d>& SolidMesh::points_mm() const { return impl_->points_mm; }

double SolidMesh::sag_mm() const {
  double out = 0.0;
  for (const Edge& edge : impl_->edges) {
    const auto turn_rad = edge.turn_rad();
    if (!turn_rad || *turn_rad > kRound_rad) continue;
    out = std::max(out, 0.5 * edge.width_mm * std::tan(0.25 * *turn_rad));
  }
  return out;
}

double SolidMesh::distance_mm(const Vector3d& point_mm) const {
  return impl_->distance_mm(point_mm);
}

bool SolidMesh::meets(const Sweep& sweep, double room_mm) const {
  ++questions_of_thread().asked;
  try {
    int asked = 0;
    const bool near = impl_->nearer(sweep, room_mm, asked);
    if (asked > 0) ++questions_of_thread().on_meshes;
    if (near) return true;
    const bool within = (sweep.start_mm.array() >= impl_->low_mm.array()).all() &&
                        (sweep.start_mm.array() <= impl_->high_mm.array()).all();
    return within && impl_->inside &&
           (*impl_->inside)(at(sweep.start_mm)) != CGAL::ON_UNBOUNDED_SIDE;
  } catch (const std::exception&) {
    return true;
  }
}

std::vector<std::pair<Vector3d, Vector3d>> SolidMesh::outline_mm(
    const Vector3d& towards_viewer) const {
  std::vector<std::pair<Vector3d, Vector3d>> out;
  for (const Edge& edge : impl_->edges) {
    const auto turn_rad = edge.turn_rad();
    const bool seen =
        !turn_rad || *turn_rad > kSharp_rad ||
        edge.normal->dot(towards_viewer) * edge.other_normal->dot(towards_viewer) < 0.0;
    if (seen) out.emplace_back(edge.from_mm, edge.to_mm);
  }
  return out;
}

}  // namespace rondure::plans
