#pragma once

#include <array>

#include "fit/rotary/errors.h"

// The matrices of CN105479268A for the swivel axes C (about Z) and A (about X) of a five-axis head,
// for comparison: identify_rotary_axis() takes any balls.

namespace rondure::fit {

/// Vertical (L) and horizontal (H) distances of the ball from the point where the axes meet, two
/// each; the head hangs, so that a ball stands at (0, H, -L).
struct PublishedSetups {
  double l1_mm = 0.0;
  double l2_mm = 0.0;
  double h1_mm = 0.0;
  double h2_mm = 0.0;

  /// The three setups the C matrix has: (L1, H1), (L1, H2), (L2, H1).
  [[nodiscard]] std::array<Eigen::Vector3d, 3> of_c() const;
  /// Those of the A matrix: (L1, H1), (L1, H2), (L2, H2).
  [[nodiscard]] std::array<Eigen::Vector3d, 3> of_a() const;
};

/// The A matrix has an entry without its operator, "-H sin A  L cos A" (row Y, column al).
enum class PublishedSigns {
  kRestored,   ///< -H sin A + L cos A, which is equation dp = t + w x p.
  kAsPrinted,  ///< Read as it stands, as a product: wrong at every angle.
};

using PublishedMatrix = Eigen::Matrix<double, 9, 6>;

/// Rows X, Y, Z of the three setups; columns X, Y, Z, al, be, ga.
[[nodiscard]] PublishedMatrix published_c_matrix(const PublishedSetups& setups, double c_rad);
[[nodiscard]] PublishedMatrix published_a_matrix(const PublishedSetups& setups, double a_rad,
                                                 PublishedSigns signs = PublishedSigns::kRestored);

}  // namespace rondure::fit
