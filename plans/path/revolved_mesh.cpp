#include "plans/path/revolved_mesh.h"

#include <cmath>
#include <exception>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "core/units.h"

namespace rondure::plans {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Triangles = std::vector<Triangle>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Point at(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// The corner of a profile on facet edge `k`; the last edge is identical to the first.
Point turned(const Eigen::Vector2d& corner, int k, int facets) {
  const double theta_rad = core::kTwoPi * (k % facets) / facets;
  return {corner.x() * std::cos(theta_rad), corner.x() * std::sin(theta_rad), corner.y()};
}

void add_strip(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int facets, Triangles& out) {
  if (from.x() <= 0.0 && to.x() <= 0.0) return;  // on the axis: no surface
  for (int k = 0; k < facets; ++k) {
    const Point a = turned(from, k, facets);
    const Point b = turned(from, k + 1, facets);
    const Point c = turned(to, k, facets);
    const Point d = turned(to, k + 1, facets);
    if (from.x() > 0.0) out.emplace_back(a, b, to.x() > 0.0 ? d : c);
    if (to.x() > 0.0) out.emplace_back(a, d, c);
  }
}

}  // namespace

struct RevolvedMesh::Impl {
  Triangles triangles;
  Tree tree;

  template <class Query>
  [[nodiscard]] bool meets(const Query& query) const {
    try {
      return tree.do_intersect(query);
    } catch (const std::exception&) {
      return true;
    }
  }
};

RevolvedMesh::RevolvedMesh(std::span<const Eigen::Vector2d> profile_rz, int facets)
    : impl_(std::make_unique<Impl>()) {
  for (std::size_t i = 0; i < profile_rz.size(); ++i) {
    add_strip(profile_rz[i], profile_rz[(i + 1) % profile_rz.size()], facets, impl_->triangles);
  }
  impl_->tree.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
  impl_->tree.build();
}

RevolvedMesh::~RevolvedMesh() = default;

bool RevolvedMesh::meets(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm) const {
  return impl_->meets(Kernel::Segment_3(at(a_mm), at(b_mm)));
}

bool RevolvedMesh::meets(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm,
                         const Eigen::Vector3d& c_mm) const {
  return impl_->meets(Triangle(at(a_mm), at(b_mm), at(c_mm)));
}

}  // namespace rondure::plans
