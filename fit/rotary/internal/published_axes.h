#pragma once

#include <array>

#include "fit/rotary/errors.h"

// The matrices of CN105479268A for the swivel axes C (about Z) and A (about X) of a five-axis head.
// For comparison only: identify_rotary_axis() accepts any arrangement of balls.

namespace rondure::fit {

/// Two vertical (L) and two horizontal (H) distances of the ball from the intersection of the axes.
/// The head hangs, so that a ball is at (0, H, -L).
struct PublishedSetups {
  double l1_mm = 0.0;
  double l2_mm = 0.0;
  double h1_mm = 0.0;
  double h2_mm = 0.0;

  /// The three setups of the C matrix: (L1, H1), (L1, H2), (L2, H1).
  [[nodiscard]] std::array<Eigen::Vector3d, 3> of_c() const;
  /// The three setups of the A matrix: (L1, H1), (L1, H2), (L2, H2).
  [[nodiscard]] std::array<Eigen::Vector3d, 3> of_a() const;
};

using PublishedMatrix = Eigen::Matrix<double, 9, 6>;

/// Rows X, Y, Z of the three setups; columns X, Y, Z, al, be, ga.
[[nodiscard]] PublishedMatrix published_c_matrix(const PublishedSetups& setups, double c_rad);
/// Row Y, column al is printed without its operator, "-H sin A  L cos A"; it is -H sin A + L cos A.
[[nodiscard]] PublishedMatrix published_a_matrix(const PublishedSetups& setups, double a_rad);

}  // namespace rondure::fit
