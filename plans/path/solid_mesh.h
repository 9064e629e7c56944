#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::plans {

/// The parallelogram start + s along + t up, 0 <= s, t <= 1, swept by a straight limb of the tool
/// on a straight move. `along` or `up` may be zero or parallel: then it is a segment or a point.
struct Sweep {
  Eigen::Vector3d start_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d up_mm = Eigen::Vector3d::Zero();
};

/// Questions whether a sweep comes too near to a solid.
struct Questions {
  std::size_t asked = 0;
  std::size_t on_meshes = 0;  ///< Answered by the tree of a mesh; the others in closed form.
};

/// Those of this thread since it began: differences count. They stand for the thread, since they
/// change no path, and every signature of the planner would carry them otherwise.
[[nodiscard]] Questions& questions_of_thread();

/// A surface of triangles of any shape, as CAD writes it: a soup whose triangles share no corners,
/// look to either side, and may leave gaps. Corners within a millionth of its size are joined, the
/// triangles are turned to look to one side, and borders that meet are stitched.
class SolidMesh {
 public:
  static constexpr std::size_t kMostTriangles = 2'000'000;

  /// @param points_mm  Corners of triangles.
  /// @param corners    Numbers of three points for each triangle. Those without area are dropped.
  /// @return kNoPoints without a triangle that has an area, kOutOfRange for more than
  ///         kMostTriangles, kUnits for a size below 1 mm or above 5000 mm. O(n log n).
  [[nodiscard]] static core::Result<std::shared_ptr<const SolidMesh>> build(
      std::span<const Eigen::Vector3d> points_mm,
      std::span<const std::array<std::size_t, 3>> corners);
  /// A box about the origin.
  [[nodiscard]] static core::Result<std::shared_ptr<const SolidMesh>> box(
      const Eigen::Vector3d& size_mm);
  ~SolidMesh();

  [[nodiscard]] std::size_t triangles() const;
  /// Whether the surface has no border; only then is there an inside.
  [[nodiscard]] bool is_closed() const;
  /// The corners of its triangles.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points_mm() const;
  /// Greatest distance of the facets from a round wall through their corners: half the width of a
  /// facet times the tangent of a quarter of the turn to its neighbour. Edges with a turn of more
  /// than 45 deg are those of the body. 96 facets of radius 92 mm: 0.049 mm.
  [[nodiscard]] double sag_mm() const;
  /// Distance of a point from the surface, also from inside.
  [[nodiscard]] double distance_mm(const Eigen::Vector3d& point_mm) const;
  /// Whether any point of the sweep is closer to the surface than `room_mm`, or its start is inside
  /// a closed one. Never false when one is; true at most 1e-3 mm outside that limit, and where
  /// 200 000 distances do not decide. By halving: what lies around the middle of a piece is
  /// nearer to it than half its longer diagonal.
  [[nodiscard]] bool meets(const Sweep& sweep, double room_mm) const;
  /// The lines that a person sees from a direction: borders, edges with a turn of more than 30 deg,
  /// and edges between a triangle that looks to the viewer and one that looks away.
  [[nodiscard]] std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> outline_mm(
      const Eigen::Vector3d& towards_viewer) const;

 private:
  struct Impl;
  explicit SolidMesh(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rondure::plans
