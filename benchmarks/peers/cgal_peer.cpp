#include "benchmarks/peers/cgal_peer.h"

#include <cmath>
#include <vector>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Gmpzf.h>
#include <CGAL/Min_annulus_d.h>
#include <CGAL/Min_sphere_annulus_d_traits_2.h>
#include <CGAL/Min_sphere_of_points_d_traits_2.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Simple_cartesian.h>

namespace rondure::benchmarks {
namespace {

template <class Point>
std::vector<Point> converted(std::span<const Eigen::Vector2d> points_mm) {
  std::vector<Point> out;
  out.reserve(points_mm.size());
  for (const Eigen::Vector2d& p : points_mm) out.emplace_back(p.x(), p.y());
  return out;
}

using Plain = CGAL::Simple_cartesian<double>;

}  // namespace

double cgal_annulus_width_mm(std::span<const Eigen::Vector2d> points_mm) {
  using Traits = CGAL::Min_sphere_annulus_d_traits_2<Plain, CGAL::Gmpzf, double>;
  const auto points = converted<Plain::Point_2>(points_mm);
  const CGAL::Min_annulus_d<Traits> annulus(points.begin(), points.end());
  const double scale = CGAL::to_double(annulus.squared_radii_denominator());
  const double outer = CGAL::to_double(annulus.squared_outer_radius_numerator()) / scale;
  const double inner = CGAL::to_double(annulus.squared_inner_radius_numerator()) / scale;
  return std::sqrt(outer) - std::sqrt(inner);
}

double cgal_smallest_circle_mm(std::span<const Eigen::Vector2d> points_mm) {
  using Traits = CGAL::Min_sphere_of_points_d_traits_2<Plain, double>;
  const auto points = converted<Plain::Point_2>(points_mm);
  CGAL::Min_sphere_of_spheres_d<Traits> circle(points.begin(), points.end());
  return circle.radius();
}

std::size_t cgal_delaunay_triangles(std::span<const Eigen::Vector2d> points_mm) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto points = converted<Kernel::Point_2>(points_mm);
  const CGAL::Delaunay_triangulation_2<Kernel> triangulation(points.begin(), points.end());
  return triangulation.number_of_faces();
}

}  // namespace rondure::benchmarks
