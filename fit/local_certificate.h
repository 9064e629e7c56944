#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "fit/certificate.h"

namespace rondure::fit {

/// A contact at the reported centre or axis: its true distance with first and second derivative.
template <int K>
struct ContactRow {
  std::size_t index = 0;
  double distance = 0.0;
  Eigen::Matrix<double, K, 1> gradient = Eigen::Matrix<double, K, 1>::Zero();
  Eigen::Matrix<double, K, K> hessian = Eigen::Matrix<double, K, K>::Zero();
};

/// Evidence that a zone is a local minimum.
template <int K>
struct LocalProof {
  std::vector<Contact> outer;  ///< Multipliers >= 0, sum 1.
  std::vector<Contact> inner;
  double gap_mm = std::numeric_limits<double>::infinity();  ///< Zone minus its lower bound nearby.
  double growth = 0.0;  ///< sigma: least first-order growth per mm (max norm of the move).
  bool strict = false;  ///< growth > 0, or positive curvature where it vanishes.
  /// Where not strict: the unit move of most negative curvature, along which the zone shrinks.
  Eigen::Matrix<double, K, 1> descent = Eigen::Matrix<double, K, 1>::Zero();
};

/// Tests the contacts of a zone for a local minimum: finds multipliers with
/// sum lam J_h = sum mu J_l, the least first-order growth sigma, and, where sigma vanishes, the
/// sign of the curvature on the directions left free.
///
/// @param outer, inner  Contacts, not empty; unknowns scaled to mm.
/// @param reach_mm      B: weight of a remaining imbalance of the multipliers in the gap.
/// Source: methods, certificates section 1.
template <int K>
[[nodiscard]] LocalProof<K> prove_local(const std::vector<ContactRow<K>>& outer,
                                        const std::vector<ContactRow<K>>& inner, double reach_mm);

/// Turns a proof into the certificate of a result.
/// @param width_mm  Reported zone; a gap above 1e-10 of it (or above round-off) proves nothing.
/// @param round_off_mm  Size of rounding errors in the distances.
template <int K>
[[nodiscard]] Certificate certify_local(const LocalProof<K>& proof, double width_mm,
                                        double round_off_mm, std::string scope);

}  // namespace rondure::fit
