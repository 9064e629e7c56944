#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

namespace rondure::plans {

/// A closed surface of revolution about z, made of plane triangles, with an exact intersection test
/// for segments and triangles. The answer is exact for the given corners; round walls are
/// approximated by facets. If the library fails, the answer is "meets".
class RevolvedMesh {
 public:
  /// @param profile_rz  Corners (r, z) of the outline in the half plane r >= 0 [mm], in order: from
  ///                    axis to axis, or around a ring (the last one is joined to the first).
  /// @param facets      Per full revolution, >= 3. A facet lies inside the circle through its
  ///                corners.
  RevolvedMesh(std::span<const Eigen::Vector2d> profile_rz, int facets);
  ~RevolvedMesh();

  [[nodiscard]] bool meets(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm) const;
  [[nodiscard]] bool meets(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm,
                           const Eigen::Vector3d& c_mm) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rondure::plans
