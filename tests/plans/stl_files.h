#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include "core/units.h"

namespace rondure::test {

/// A surface of triangles, written here without any function of the program.
struct Soup {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::size_t, 3>> corners;

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    corners.push_back({points.size(), points.size() + 1, points.size() + 2});
    points.insert(points.end(), {a, b, c});
  }
};

/// Wall and ends of a cylinder about z; `rows` of facets along it.
inline Soup cylinder_soup(double radius, double from, double to, int facets, int rows = 1) {
  Soup out;
  const auto at = [&](int k, double z) {
    const double theta = core::kTwoPi * (k % facets) / facets;
    return Eigen::Vector3d(radius * std::cos(theta), radius * std::sin(theta), z);
  };
  for (int k = 0; k < facets; ++k) {
    for (int row = 0; row < rows; ++row) {
      const double low = from + (to - from) * row / rows;
      const double high = from + (to - from) * (row + 1) / rows;
      out.add(at(k, low), at(k + 1, low), at(k + 1, high));
      out.add(at(k, low), at(k + 1, high), at(k, high));
    }
    out.add({0, 0, from}, at(k + 1, from), at(k, from));
    out.add({0, 0, to}, at(k, to), at(k + 1, to));
  }
  return out;
}

/// The surface as a text STL file.
inline std::string stl_text(const Soup& soup, double unit_mm = 1.0) {
  std::string out = "solid body\n";
  for (const auto& triangle : soup.corners) {
    out += "facet normal 0 0 0\n outer loop\n";
    for (const std::size_t k : triangle) {
      const Eigen::Vector3d p = soup.points[k] / unit_mm;
      out += fmt::format("  vertex {} {} {}\n", p.x(), p.y(), p.z());
    }
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid body\n";
}

}  // namespace rondure::test
