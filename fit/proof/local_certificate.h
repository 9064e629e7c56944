#pragma once

#include <limits>
#include <span>
#include <string>

#include <Eigen/Core>

#include "fit/proof/certificate.h"
#include "fit/zone/contacts.h"
#include "fit/zone/simplex.h"

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
  Contacts outer;  ///< Multipliers >= 0, sum 1.
  Contacts inner;
  double gap_mm = std::numeric_limits<double>::infinity();  ///< Zone minus its lower bound nearby.
  double growth = 0.0;  ///< sigma: least first-order growth per mm (max norm of the move).
  bool strict = false;  ///< growth > 0, or positive curvature where it vanishes.
  /// Where not strict: the unit move of most negative curvature, along which the zone shrinks.
  Eigen::Matrix<double, K, 1> descent = Eigen::Matrix<double, K, 1>::Zero();
};

/// sigma: least growth of  outer weight * max over `outer` - inner weight * min over `inner`, both
/// linearised, per unit move in the max norm; <= 0 where some move widens nothing to first order.
///
/// @param outer, inner  Only the gradients are used, each of size 2 at most. A side with weight 0
/// is
///                      empty, the other is not.
template <int K>
[[nodiscard]] double first_order_growth(std::span<const ContactRow<K>> outer,
                                        std::span<const ContactRow<K>> inner,
                                        const ZoneWeights& weights = kMinimumZone);

/// Curvature of the Lagrangian on the moves that leave the binding contacts level.
/// @param outer, inner  The contacts that bind, with their multipliers.
/// @param outer_rows, inner_rows  Hold the rows of these contacts.
/// @return Zero when it is positive on all of them: a strict minimum. Else the unit move of its
/// most
///         negative curvature, along which the zone shrinks.
template <int K>
[[nodiscard]] Eigen::Matrix<double, K, 1> curvature_descent(
    std::span<const Contact> outer, std::span<const Contact> inner,
    std::span<const ContactRow<K>> outer_rows, std::span<const ContactRow<K>> inner_rows,
    const ZoneWeights& weights);

/// Tests the contacts of a zone for a local minimum: finds multipliers with
/// outer weight * sum lam J_h = inner weight * sum mu J_l, the least first-order growth sigma, and,
/// where sigma vanishes, the sign of the curvature on the directions left free.
///
/// @param outer, inner  Contacts; unknowns scaled to mm. A side with weight 0 is empty.
/// @param reach_mm      B: weight of a remaining imbalance of the multipliers in the gap.
/// Source: methods, certificates section 1.
template <int K>
[[nodiscard]] LocalProof<K> prove_local(std::span<const ContactRow<K>> outer,
                                        std::span<const ContactRow<K>> inner, double reach_mm,
                                        const ZoneWeights& weights = kMinimumZone);

/// Turns a proof into the certificate of a result.
/// @param width_mm  Reported zone; a gap above 1e-10 of it (or above round-off) proves nothing.
/// @param round_off_mm  Size of rounding errors in the distances.
template <int K>
[[nodiscard]] Certificate certify_local(const LocalProof<K>& proof, double width_mm,
                                        double round_off_mm, std::string scope);

}  // namespace rondure::fit
