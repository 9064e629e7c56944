#pragma once

namespace rondure::core {

/// Angles of the two-axis fixture: phi_alpha about the base-fixed axis (machine X), phi_beta about
/// the hoop-carried axis (machine Y while alpha = 0) [rad].
struct Pose {
  double alpha_rad = 0.0;
  double beta_rad = 0.0;

  friend bool operator==(const Pose&, const Pose&) = default;
};

}  // namespace rondure::core
