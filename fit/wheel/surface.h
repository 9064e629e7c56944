#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "core/open_spline.h"
#include "core/result.h"

namespace rondure::fit {

/// Height, slope and second derivative of a surface at one x.
struct SurfacePoint {
  double height_mm = 0.0;
  double slope = 0.0;
  double second_per_mm = 0.0;

  /// q = sqrt(1 + f'^2): length of the surface per length of x.
  [[nodiscard]] double stretch() const;
  /// k_s = f''/q^3 [1/mm], > 0 where the surface is concave.
  [[nodiscard]] double curvature_per_mm() const;
};

/// f = c x^2 / (1 + sqrt(1 - (1 + K) c^2 x^2)) + A2 x^2 + A4 x^4 + ...
struct Asphere {
  double curvature_per_mm = 0.0;   ///< c; > 0: concave.
  double conic = 0.0;              ///< K: 0 a sphere, -1 a paraboloid.
  std::vector<double> even_terms;  ///< A2, A4, A6, ... [mm^(1-2j)].
};

/// f = a0 + a1 x + a2 x^2 + ... with coefficients in mm^(1-j).
struct Polynomial {
  std::vector<double> coefficients;
};

/// A surface to be ground, z = f(x), with the material below and the wheel above. A removal depth,
/// if any, is subtracted: f = f0 - h.
class WheelSurface {
 public:
  /// @return kBadOption for coefficients that are not finite, or none.
  static core::Result<WheelSurface> polynomial(Polynomial polynomial);
  static core::Result<WheelSurface> asphere(Asphere asphere);
  /// Cubic spline through a table (x, z), which needs five points per shortest wavelength.
  /// @return kTable: fewer than 5 rows, or x not strictly ascending; kNotFinite.
  static core::Result<WheelSurface> table(std::vector<double> x_mm, std::vector<double> z_mm);

  /// This surface minus the depth h(x) >= 0 of a table.
  /// @return as table(), and kSurface for a negative depth.
  [[nodiscard]] core::Result<WheelSurface> less(std::vector<double> x_mm,
                                                std::vector<double> depth_mm) const;

  /// Height, slope and second derivative at x.
  /// @return kSurface with x: beyond the edge of the conic, outside the table, or where the removal
  ///         is below 0 between its rows.
  [[nodiscard]] core::Result<SurfacePoint> at(double x_mm) const;

  /// x of the rows of the tables, ascending; empty for formulas.
  [[nodiscard]] std::vector<double> rows_mm() const;
  /// The range of x that all tables cover [mm]; none for formulas.
  [[nodiscard]] std::optional<std::pair<double, double>> range_mm() const;

 private:
  using Form = std::variant<Polynomial, Asphere, core::OpenSpline>;
  explicit WheelSurface(Form form) : form_(std::move(form)) {}

  Form form_;
  std::optional<core::OpenSpline> removal_;
};

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
