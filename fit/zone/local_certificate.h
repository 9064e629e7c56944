#pragma once

#include <limits>
#include <span>

#include <Eigen/Core>

#include "fit/geometry/contacts.h"
#include "fit/geometry/zone_rows.h"
#include "fit/proof/certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Evidence that a zone is a local minimum.
template <int K>
struct LocalProof {
  Contacts outer;  ///< Multipliers >= 0, sum 1.
  Contacts inner;
  double gap_mm = std::numeric_limits<double>::infinity();  ///< Zone minus its local lower bound.
  double growth = 0.0;  ///< sigma: least first-order growth per mm (max norm of the move).
  bool strict = false;  ///< growth > 0, or positive curvature where it vanishes.
  /// If not strict: the unit move of most negative curvature, along which the zone shrinks.
  Eigen::Matrix<double, K, 1> descent = Eigen::Matrix<double, K, 1>::Zero();
};

/// Computes sigma: the least growth of  outer weight * max over `outer` - inner weight * min over
/// `inner`, both linearised, per unit move in the max norm. It is <= 0 if there is a move that
/// widens nothing to first order.
///
/// @param outer, inner  Only the gradients are used, each of size 2 at most.
/// @pre A side with weight 0 is empty, the other is not.
template <int K>
[[nodiscard]] double first_order_growth(std::span<const ContactRow<K>> outer,
                                        std::span<const ContactRow<K>> inner,
                                        const ZoneWeights& weights = kMinimumZone);

/// Tests the curvature of the Lagrangian on the moves that keep the binding contacts level.
/// @param outer, inner  The contacts that bind, with their multipliers.
/// @param outer_rows, inner_rows  Hold the rows of these contacts.
/// @return Zero if the curvature is positive on all these moves (a strict minimum), else the unit
///         move of most negative curvature, along which the zone shrinks.
template <int K>
[[nodiscard]] Eigen::Matrix<double, K, 1> curvature_descent(
    std::span<const Contact> outer, std::span<const Contact> inner,
    std::span<const ContactRow<K>> outer_rows, std::span<const ContactRow<K>> inner_rows,
    const ZoneWeights& weights);

/// Tests whether the contacts of a zone determine a local minimum. Finds multipliers with
/// outer weight * sum lam J_h = inner weight * sum mu J_l, the least first-order growth sigma, and,
/// where sigma vanishes, the sign of the curvature on the remaining free directions.
///
/// @param outer, inner  Contacts, with unknowns scaled to mm. A side with weight 0 is empty.
/// @param reach_mm      B: weight in the gap of a remaining imbalance of the multipliers.
/// Source: methods, certificates section 1.
template <int K>
[[nodiscard]] LocalProof<K> prove_local(std::span<const ContactRow<K>> outer,
                                        std::span<const ContactRow<K>> inner, double reach_mm,
                                        const ZoneWeights& weights = kMinimumZone);

/// Turns a proof into the certificate of a result.
/// @param width_mm  Width of the reported zone; a gap above 1e-10 of it (or above round-off) proves
///                  nothing.
/// @param round_off_mm  Size of the rounding errors of distances.
template <int K>
[[nodiscard]] Certificate certify_local(const LocalProof<K>& proof, double width_mm,
                                        double round_off_mm, core::Phrase scope);

}  // namespace rondure::fit
