#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/wheel/surface.h"

namespace rondure::fit {

/// Samples of a surface, to search the whole of it: for the greatest curvature, or for the place
/// nearest to a point. Results are refined on the surface itself between neighbouring samples.
class SurfaceSamples {
 public:
  /// Result of a search: place and value there.
  struct Place {
    double x_mm = 0.0;
    double value = 0.0;
  };

  /// Takes 2000 equally spaced samples of a range, and five per interval of the surface's tables.
  /// @pre The surface outlives the samples.
  /// @return kSurface where the surface has no height.
  static core::Result<SurfaceSamples> over(const WheelSurface& surface, double from_mm,
                                           double to_mm);

  /// Greatest curvature k_s of the surface [1/mm].
  [[nodiscard]] Place greatest_curvature() const;
  /// Least curvature of the samples [1/mm], not refined.
  [[nodiscard]] double least_curvature_per_mm() const;

  /// Least distance of the surface from a point [mm], or `beyond_mm` if that is less. Blocks of
  /// samples whose bounding box is farther away than the best distance are skipped.
  [[nodiscard]] Place nearest(const Eigen::Vector2d& from_mm, double beyond_mm) const;

 private:
  struct Sample {
    double x = 0.0;
    SurfacePoint surface;
  };
  struct Box {
    Eigen::Array2d low;
    Eigen::Array2d high;
  };

  explicit SurfaceSamples(const WheelSurface& surface) : surface_(&surface) {}
  void make_boxes();
  template <class Cost>
  [[nodiscard]] Place refined(std::size_t i, const Cost& cost) const;

  const WheelSurface* surface_;
  std::vector<Sample> samples_;
  std::vector<Box> boxes_;
};

}  // namespace rondure::fit
