#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/wheel/surface.h"

namespace rondure::fit {

/// A surface at many places, for questions about all of it: where it is most hollow, which place is
/// nearest to a point. Answers are refined on the surface itself between neighbouring places.
class SurfaceSamples {
 public:
  /// An answer: where, and what was asked for.
  struct Place {
    double x_mm = 0.0;
    double value = 0.0;
  };

  /// 2000 even places over a range, and five to a step of the surface's tables. The surface must
  /// outlive the samples.
  /// @return kSurface.
  static core::Result<SurfaceSamples> over(const WheelSurface& surface, double from_mm,
                                           double to_mm);

  /// The greatest curvature k_s [1/mm]: the deepest hollow.
  [[nodiscard]] Place greatest_curvature() const;
  [[nodiscard]] double least_curvature_per_mm() const;

  /// Least distance of the surface from a point [mm]; `beyond_mm` where it is not nearer. Blocks of
  /// places farther off than the best are passed over by their boxes.
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
