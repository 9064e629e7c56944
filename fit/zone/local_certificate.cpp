#include "fit/zone/local_certificate.h"

#include <algorithm>
#include <cmath>

#include "core/decompositions.h"

namespace rondure::fit {
namespace {

/// Raises the outer rows so far that only they can be the maximum, whatever the direction.
constexpr double kLift = 64.0;
constexpr double kGrowthNoise = 1e-9;
/// A move is level if it changes the distances of the contacts by less than this part of its size.
constexpr double kLevel = 1e-9;

template <int K>
using ContactRows = std::span<const ContactRow<K>>;

/// Growth of the linearised zone on the face x_k = sign of the unit box.
template <int K>
double growth_on_face(ContactRows<K> outer, ContactRows<K> inner, const ZoneWeights& weights, int k,
                      double sign) {
  ZoneRows<K - 1> rows;
  const auto add = [&](const ContactRow<K>& contact, double lift) {
    Eigen::Matrix<double, K - 1, 1> gradient;
    for (int j = 0; j < K - 1; ++j) gradient(j) = contact.gradient(j < k ? j : j + 1);
    rows.push_back(lift + sign * contact.gradient(k), gradient);
  };
  for (const auto& contact : outer) add(contact, kLift);
  for (const auto& contact : inner) add(contact, 0.0);
  return solve_zone_program<K - 1>(rows, 1.0, weights).value - weights.outer * kLift;
}

template <int K>
const ContactRow<K>& row_of(ContactRows<K> rows, std::size_t index) {
  return *std::ranges::find(rows, index, &ContactRow<K>::index);
}

using Columns = Eigen::Matrix<double, 4, 2 * static_cast<int>(Contacts::kCapacity)>;

/// Unit move of most negative curvature of w among the moves in the first `unknowns` directions
/// that are orthogonal to all columns; zero if the curvature is positive on all of them.
Eigen::Vector4d least_curved(const Eigen::Matrix4d& w, Columns columns, int unknowns) {
  // Gram-Schmidt with the largest column first: the space held by the columns and the padding.
  Eigen::Matrix4d held = Eigen::Matrix4d::Zero();
  for (int k = unknowns; k < 4; ++k) held(k, k) = 1.0;
  const double least = kLevel * std::sqrt(columns.colwise().squaredNorm().maxCoeff());
  int free = unknowns;
  for (; free > 0; --free) {
    Eigen::Index largest = 0;
    const double size = std::sqrt(columns.colwise().squaredNorm().maxCoeff(&largest));
    if (!(size > least)) break;
    Eigen::Vector4d q = columns.col(largest) / size;
    q = (q - held * q).normalized();
    held += q * q.transpose();
    for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k) -= q * q.dot(columns.col(k));
  }
  if (free == 0) return Eigen::Vector4d::Zero();
  // The held space gets a larger curvature than any of w, so the least one is that of a level move.
  const Eigen::Matrix4d level = Eigen::Matrix4d::Identity() - held;
  const Eigen::Matrix4d bounded = level * w * level + (1.0 + 2.0 * w.norm()) * held;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> curvature(bounded);
  if (curvature.eigenvalues()(0) > 0.0) return Eigen::Vector4d::Zero();
  return curvature.eigenvectors().col(0);
}

}  // namespace

template <int K>
Eigen::Matrix<double, K, 1> curvature_descent(std::span<const Contact> outer,
                                              std::span<const Contact> inner,
                                              ContactRows<K> outer_rows, ContactRows<K> inner_rows,
                                              const ZoneWeights& weights) {
  // Padded to four unknowns, as Eigen's decompositions take half a minute to compile for each size.
  Eigen::Matrix4d w = Eigen::Matrix4d::Zero();
  Columns differences = Columns::Zero();
  Eigen::Index column = 0;
  const auto collect = [&](std::span<const Contact> side, ContactRows<K> rows, double weight) {
    for (const Contact& c : side) {
      const ContactRow<K>& contact = row_of(rows, c.index);
      w.template topLeftCorner<K, K>() += weight * c.multiplier * contact.hessian;
      differences.col(column++).template head<K>() =
          contact.gradient - row_of(rows, side[0].index).gradient;
    }
  };
  collect(outer, outer_rows, weights.outer);
  collect(inner, inner_rows, -weights.inner);
  return least_curved(w, differences, K).template head<K>();
}

template <int K>
double first_order_growth(ContactRows<K> outer, ContactRows<K> inner, const ZoneWeights& weights) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < K; ++k) {
    least = std::min({least, growth_on_face<K>(outer, inner, weights, k, 1.0),
                      growth_on_face<K>(outer, inner, weights, k, -1.0)});
  }
  return least;
}

template <int K>
LocalProof<K> prove_local(ContactRows<K> outer, ContactRows<K> inner, double reach_mm,
                          const ZoneWeights& weights) {
  // Distances relative to one contact keep their digits. The multipliers of each side sum to 1, so
  // a common value only shifts the result.
  const double base = inner.empty() ? outer.front().distance : inner.front().distance;
  ZoneRows<K> rows;
  for (const auto& c : outer) rows.push_back(c.distance - base, c.gradient);
  for (const auto& c : inner) rows.push_back(c.distance - base, c.gradient);
  const auto step = solve_zone_program<K>(rows, std::max(reach_mm, 1e-9), weights);

  LocalProof<K> proof;
  Eigen::Matrix<double, K, 1> imbalance = Eigen::Matrix<double, K, 1>::Zero();
  double supported = 0.0;
  bool sides_kept =
      step.outer.empty() == (weights.outer == 0.0) && step.inner.empty() == (weights.inner == 0.0);
  for (const Contact& c : step.outer) {
    sides_kept = sides_kept && c.index < outer.size();
    imbalance += weights.outer * c.multiplier * rows.gradient(c.index);
    supported += weights.outer * c.multiplier * rows.distances()[c.index];
    if (sides_kept) proof.outer.push_back({outer[c.index].index, c.multiplier});
  }
  for (const Contact& c : step.inner) {
    sides_kept = sides_kept && c.index >= outer.size();
    imbalance -= weights.inner * c.multiplier * rows.gradient(c.index);
    supported -= weights.inner * c.multiplier * rows.distances()[c.index];
    if (sides_kept) proof.inner.push_back({inner[c.index - outer.size()].index, c.multiplier});
  }
  if (!sides_kept) return proof;
  double claimed = 0.0;
  const auto distance = [&](const ContactRow<K>& c) { return c.distance - base; };
  if (!outer.empty()) claimed += weights.outer * extremes_of(outer, distance).high;
  if (!inner.empty()) claimed -= weights.inner * extremes_of(inner, distance).low;
  proof.gap_mm = claimed - supported + imbalance.template lpNorm<1>() * reach_mm;
  proof.growth = first_order_growth<K>(outer, inner, weights);
  proof.strict = proof.growth > kGrowthNoise;
  if (proof.strict) return proof;
  proof.descent = curvature_descent<K>(proof.outer, proof.inner, outer, inner, weights);
  proof.strict = proof.descent.isZero();
  return proof;
}

template <int K>
Certificate certify_local(const LocalProof<K>& proof, double width_mm, double round_off_mm,
                          core::Phrase scope) {
  Certificate out;
  out.scope = std::move(scope);
  out.gap_mm = std::max(proof.gap_mm, 0.0);
  const double limit = std::max(1e-10 * width_mm, 8.0 * round_off_mm);
  if (!(proof.gap_mm <= limit)) {
    out.reason =
        std::isfinite(proof.gap_mm)
            ? core::phrase(
                  "the contacts leave a gap of {:.3g} mm to the lower bound, {:.3g} mm is allowed",
                  proof.gap_mm, limit)
            : core::phrase("the contacts give no lower bound");
    return out;
  }
  if (!proof.strict) {
    out.reason = core::phrase("the contacts hold the zone to first order only");
    return out;
  }
  out.kind = Certificate::Kind::kLocal;
  out.reason = core::phrase("other regions were not searched");
  return out;
}

template double first_order_growth<2>(ContactRows<2>, ContactRows<2>, const ZoneWeights&);
template Eigen::Matrix<double, 2, 1> curvature_descent<2>(std::span<const Contact>,
                                                          std::span<const Contact>, ContactRows<2>,
                                                          ContactRows<2>, const ZoneWeights&);
template LocalProof<2> prove_local<2>(ContactRows<2>, ContactRows<2>, double, const ZoneWeights&);
template Certificate certify_local<2>(const LocalProof<2>&, double, double, core::Phrase);
template Eigen::Matrix<double, 3, 1> curvature_descent<3>(std::span<const Contact>,
                                                          std::span<const Contact>, ContactRows<3>,
                                                          ContactRows<3>, const ZoneWeights&);
template LocalProof<3> prove_local<3>(ContactRows<3>, ContactRows<3>, double, const ZoneWeights&);
template Certificate certify_local<3>(const LocalProof<3>&, double, double, core::Phrase);
template Eigen::Matrix<double, 4, 1> curvature_descent<4>(std::span<const Contact>,
                                                          std::span<const Contact>, ContactRows<4>,
                                                          ContactRows<4>, const ZoneWeights&);
template LocalProof<4> prove_local<4>(ContactRows<4>, ContactRows<4>, double, const ZoneWeights&);
template Certificate certify_local<4>(const LocalProof<4>&, double, double, core::Phrase);

}  // namespace rondure::fit
