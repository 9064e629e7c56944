#include "fit/wheel/centers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/noise.h"
#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

using FourRows = std::array<std::size_t, 4>;

enum class Refusal { kNone, kShortChord, kParallel, kIllConditioned };

FourRows paired(const FourRows& r, int pairing) {
  if (pairing == 1) return {r[0], r[2], r[1], r[3]};
  if (pairing == 2) return {r[0], r[3], r[1], r[2]};
  return r;
}

/// Four different rows in ascending order. The bias of the remainder is below 1e-15 for any set of
/// points.
FourRows draw_rows(std::uint64_t& state, std::size_t n) {
  FourRows rows{};
  for (std::size_t k = 0; k < rows.size();) {
    const auto end = rows.begin() + static_cast<std::ptrdiff_t>(k);
    rows[k] = static_cast<std::size_t>(core::splitmix64(state) % n);
    if (std::find(rows.begin(), end, rows[k]) == end) ++k;
  }
  std::ranges::sort(rows);
  return rows;
}

std::vector<FourRows> all_subsets(std::size_t n) {
  std::vector<FourRows> out;
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      for (std::size_t c = b + 1; c < n; ++c) {
        for (std::size_t d = c + 1; d < n; ++d) out.push_back({a, b, c, d});
      }
    }
  }
  return out;
}

/// C(n, 4) passes 5000 between 20 and 21 points.
std::vector<FourRows> subsets(std::size_t n, std::uint64_t seed) {
  constexpr std::size_t kMostPoints = 20;
  if (n <= kMostPoints) return all_subsets(n);
  std::uint64_t state = seed;
  std::set<FourRows> seen;
  std::vector<FourRows> out;
  while (out.size() < kMostQuadruples) {
    const FourRows rows = draw_rows(state, n);
    if (seen.insert(rows).second) out.push_back(rows);
  }
  return out;
}

/// The one of the three pairings of four points with the least kappa (the first of equals).
FourPointCenter best_pairing(PlanePoints points_mm, const FourRows& rows, double radius_mm) {
  FourPointCenter best = four_point_center(points_mm, rows, radius_mm);
  for (const int pairing : {1, 2}) {
    const FourPointCenter other = four_point_center(points_mm, paired(rows, pairing), radius_mm);
    if (other.kappa < best.kappa) best = other;
  }
  return best;
}

Refusal refusal_of(const FourPointCenter& center, double radius_mm, double kappa_limit,
                   const QuadrupleOptions& options) {
  const double chord = std::min(center.first_chord_mm, center.second_chord_mm);
  if (chord < std::max(options.least_chord_mm, options.least_chord_per_radius * radius_mm)) {
    return Refusal::kShortChord;
  }
  if (center.psi_rad < options.least_angle_rad) return Refusal::kParallel;
  return center.kappa > kappa_limit ? Refusal::kIllConditioned : Refusal::kNone;
}

void sort_in(const FourPointCenter& center, Refusal refusal, WheelCenters& out) {
  if (refusal == Refusal::kShortChord) ++out.short_chord;
  if (refusal == Refusal::kParallel) ++out.parallel_chords;
  if (refusal == Refusal::kIllConditioned) ++out.ill_conditioned;
  if (refusal == Refusal::kNone) out.accepted.push_back(center);
}

WheelCenters select_systematic(PlanePoints points_mm, double radius_mm,
                               const QuadrupleOptions& options) {
  std::vector<FourPointCenter> found;
  double best = std::numeric_limits<double>::infinity();
  for (const FourRows& rows : subsets(points_mm.size(), options.seed)) {
    found.push_back(best_pairing(points_mm, rows, radius_mm));
    best = std::min(best, found.back().kappa);
  }
  WheelCenters out;
  out.kappa_limit = options.kappa_limit.value_or(std::max(5.0, 2.0 * best));
  for (const FourPointCenter& center : found) {
    sort_in(center, refusal_of(center, radius_mm, out.kappa_limit, options), out);
  }
  return out;
}

core::Result<void> check(const QuadrupleOptions& options) {
  const bool lengths = options.least_chord_mm > 0.0 && options.least_chord_per_radius >= 0.0 &&
                       options.least_chord_per_radius <= 1.0;
  const bool angle = options.least_angle_rad > 0.0 && options.least_angle_rad < core::kTwoPi / 4.0;
  if (lengths && angle && options.kappa_limit.value_or(1.0) >= 1.0) return {};
  return core::fail_with(core::Code::kBadOption,
                         "limits of quadruples: chord {} mm (above 0), {} of the radius (0 to 1), "
                         "angle {} deg (0 to 90), kappa {} (at least 1)",
                         options.least_chord_mm, options.least_chord_per_radius,
                         options.least_angle_rad / core::kDegree,
                         options.kappa_limit.value_or(1.0));
}

}  // namespace

FourPointCenter four_point_center(PlanePoints points_mm, const FourRows& rows, double radius_mm) {
  FourPointCenter out;
  out.rows = rows;
  // Relative to A, as |B|^2 - |A|^2 would lose digits for points far from the origin.
  const Eigen::Vector2d origin = points_mm[rows[0]];
  const Eigen::Vector2d a = points_mm[rows[1]] - origin;
  const Eigen::Vector2d c0 = points_mm[rows[2]] - origin;
  const Eigen::Vector2d c = points_mm[rows[3]] - points_mm[rows[2]];
  out.first_chord_mm = a.norm();
  out.second_chord_mm = c.norm();
  const double determinant = a.x() * c.y() - a.y() * c.x();
  const double product = out.first_chord_mm * out.second_chord_mm;
  if (product == 0.0 || determinant == 0.0) {
    out.kappa = std::numeric_limits<double>::infinity();
    return out;
  }
  const double sine = std::min(std::abs(determinant) / product, 1.0);
  out.psi_rad = std::atan2(std::abs(determinant), std::abs(a.dot(c)));
  out.kappa = std::sqrt(2.0) * radius_mm *
              std::hypot(1.0 / out.first_chord_mm, 1.0 / out.second_chord_mm) / sine;
  const double ka = 0.5 * a.squaredNorm();
  const double kc = c.dot(c0 + 0.5 * c);
  out.center_mm =
      origin + Eigen::Vector2d(ka * c.y() - kc * a.y(), a.x() * kc - c.x() * ka) / determinant;
  return out;
}

double WheelCenters::best_kappa() const {
  return extremes_of(accepted, &FourPointCenter::kappa).low;
}

double WheelCenters::worst_kappa() const {
  return extremes_of(accepted, &FourPointCenter::kappa).high;
}

double WheelCenters::rms_kappa() const {
  double sum = 0.0;
  for (const FourPointCenter& c : accepted) sum += c.kappa * c.kappa;
  return std::sqrt(sum / static_cast<double>(accepted.size()));
}

core::Result<WheelCenters> select_centers(PlanePoints points_mm, double radius_mm,
                                          const QuadrupleOptions& options) {
  TRY_DO(check(options));
  WheelCenters out = select_systematic(points_mm, radius_mm, options);
  if (out.accepted.size() >= kLeastCenters) return out;
  return core::fail_with(core::Code::kTooFewCenters,
                         "{} quadruples of points give a usable centre, at least {} are needed; "
                         "refused: {} for a short chord, {} for parallel chords, {} for kappa "
                         "above {:.3g}; take points over more of the circle",
                         out.accepted.size(), kLeastCenters, out.short_chord, out.parallel_chords,
                         out.ill_conditioned, out.kappa_limit);
}

}  // namespace rondure::fit
