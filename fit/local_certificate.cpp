#include "fit/local_certificate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "fit/zone_program.h"

namespace rondure::fit {
namespace {

/// Lifts the outer rows so far that only they can be the maximum, whatever the direction.
constexpr double kLift = 64.0;
constexpr double kGrowthNoise = 1e-9;

template <int K>
using Rows = std::vector<ContactRow<K>>;

/// Growth of the linearised zone on the face x_k = sign of the unit box.
template <int K>
double growth_on_face(const Rows<K>& outer, const Rows<K>& inner, int k, double sign) {
  std::vector<ZoneRow<K - 1>> rows;
  const auto add = [&](const ContactRow<K>& contact, double lift) {
    ZoneRow<K - 1> row;
    row.distance = lift + sign * contact.gradient(k);
    for (int j = 0; j < K - 1; ++j) row.gradient(j) = contact.gradient(j < k ? j : j + 1);
    rows.push_back(row);
  };
  for (const auto& contact : outer) add(contact, kLift);
  for (const auto& contact : inner) add(contact, 0.0);
  return solve_zone_program<K - 1>(rows, 1.0).width - kLift;
}

template <int K>
double least_growth(const Rows<K>& outer, const Rows<K>& inner) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < K; ++k) {
    least = std::min(
        {least, growth_on_face<K>(outer, inner, k, 1.0), growth_on_face<K>(outer, inner, k, -1.0)});
  }
  return least;
}

template <int K>
const ContactRow<K>& row_of(const Rows<K>& rows, std::size_t index) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const ContactRow<K>& row) { return row.index == index; });
}

/// Tests the curvature of the Lagrangian on the moves that leave the binding contacts level: sets
/// `strict` when it is positive on all of them, `descent` to the worst of them otherwise.
template <int K>
void test_curvature(const Rows<K>& outer, const Rows<K>& inner, LocalProof<K>& proof) {
  Eigen::Matrix<double, K, K> w = Eigen::Matrix<double, K, K>::Zero();
  std::vector<Eigen::Matrix<double, K, 1>> level;
  const auto collect = [&](const std::vector<Contact>& side, const Rows<K>& rows, double sign) {
    for (const Contact& c : side) {
      const ContactRow<K>& row = row_of(rows, c.index);
      w += sign * c.multiplier * row.hessian;
      level.push_back(row.gradient - row_of(rows, side.front().index).gradient);
    }
  };
  collect(proof.outer, outer, 1.0);
  collect(proof.inner, inner, -1.0);
  Eigen::Matrix<double, Eigen::Dynamic, K> differences(static_cast<Eigen::Index>(level.size()), K);
  for (std::size_t i = 0; i < level.size(); ++i) {
    differences.row(static_cast<Eigen::Index>(i)) = level[i].transpose();
  }
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(differences, Eigen::ComputeFullV);
  svd.setThreshold(1e-9);
  const Eigen::Index rank = svd.rank();
  proof.strict = rank == K;
  if (proof.strict) return;
  const Eigen::MatrixXd free = svd.matrixV().rightCols(K - rank);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> curvature(free.transpose() * w * free);
  proof.strict = curvature.eigenvalues()(0) > 0.0;
  if (!proof.strict) proof.descent = free * curvature.eigenvectors().col(0);
}

}  // namespace

template <int K>
LocalProof<K> prove_local(const Rows<K>& outer, const Rows<K>& inner, double reach_mm) {
  // Distances relative to the inner contacts keep their digits; the sum of the multipliers of each
  // side is 1, so a common value cancels.
  const double base = inner.front().distance;
  std::vector<ZoneRow<K>> rows;
  for (const auto& c : outer) rows.push_back({c.distance - base, c.gradient});
  for (const auto& c : inner) rows.push_back({c.distance - base, c.gradient});
  const auto step = solve_zone_program<K>(rows, std::max(reach_mm, 1e-9));

  LocalProof<K> proof;
  Eigen::Matrix<double, K, 1> imbalance = Eigen::Matrix<double, K, 1>::Zero();
  double supported = 0.0;
  bool sides_kept = !step.outer.empty() && !step.inner.empty();
  for (const Contact& c : step.outer) {
    sides_kept = sides_kept && c.index < outer.size();
    imbalance += c.multiplier * rows[c.index].gradient;
    supported += c.multiplier * rows[c.index].distance;
    if (sides_kept) proof.outer.push_back({outer[c.index].index, c.multiplier});
  }
  for (const Contact& c : step.inner) {
    sides_kept = sides_kept && c.index >= outer.size();
    imbalance -= c.multiplier * rows[c.index].gradient;
    supported -= c.multiplier * rows[c.index].distance;
    if (sides_kept) proof.inner.push_back({inner[c.index - outer.size()].index, c.multiplier});
  }
  if (!sides_kept) return proof;
  double high = -std::numeric_limits<double>::infinity();
  double low = std::numeric_limits<double>::infinity();
  for (const auto& c : outer) high = std::max(high, c.distance - base);
  for (const auto& c : inner) low = std::min(low, c.distance - base);
  proof.gap_mm = high - low - supported + imbalance.template lpNorm<1>() * reach_mm;
  proof.growth = least_growth<K>(outer, inner);
  proof.strict = proof.growth > kGrowthNoise;
  if (!proof.strict) test_curvature<K>(outer, inner, proof);
  return proof;
}

template <int K>
Certificate certify_local(const LocalProof<K>& proof, double width_mm, double round_off_mm,
                          std::string scope) {
  Certificate out;
  out.scope = std::move(scope);
  out.gap_mm = std::max(proof.gap_mm, 0.0);
  const double limit = std::max(1e-10 * width_mm, 8.0 * round_off_mm);
  if (!(proof.gap_mm <= limit)) {
    out.reason = fmt::format(
        "the contacts leave a gap of {:.3g} mm to the lower bound, {:.3g} mm is allowed",
        proof.gap_mm, limit);
    return out;
  }
  if (!proof.strict) {
    out.reason = "the contacts hold the zone to first order only";
    return out;
  }
  out.kind = Certificate::Kind::kLocal;
  out.reason = "other regions were not searched";
  return out;
}

template struct LocalProof<2>;
template struct LocalProof<4>;
template LocalProof<2> prove_local<2>(const Rows<2>&, const Rows<2>&, double);
template LocalProof<4> prove_local<4>(const Rows<4>&, const Rows<4>&, double);
template Certificate certify_local<2>(const LocalProof<2>&, double, double, std::string);
template Certificate certify_local<4>(const LocalProof<4>&, double, double, std::string);

}  // namespace rondure::fit
