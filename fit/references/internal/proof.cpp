#include "fit/references/internal/proof.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/units.h"
#include "fit/geometry/points.h"
#include "fit/geometry/scan.h"
#include "fit/proof/axis_cover.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kProofBlock = 128;

}  // namespace

template <class Frame>
ProvenZone<Frame> prove_zone(std::span<const typename Frame::Point> points,
                             const typename Frame::Point& origin, const Frame& frame,
                             const ZoneWeights& weights, double round_off) {
  constexpr int K = Frame::kUnknowns;
  BlockScan blocks;
  blocks.block = kProofBlock;
  scan_blocks(points, frame.place(origin), blocks);
  ProvenZone<Frame> out;
  out.zone = {std::sqrt(blocks.all.low), std::sqrt(blocks.all.high)};
  const double slack = 16.0 * round_off;
  const double high = out.zone.high - slack;
  const double low = out.zone.low + slack;
  std::vector<ContactRow<K>> outer;
  std::vector<ContactRow<K>> inner;
  for (std::size_t k = 0; k < blocks.low.size(); ++k) {
    // Skips a block whose squares, with a margin for their rounding, exclude a contact.
    if (std::sqrt(blocks.high[k]) < high - slack && std::sqrt(blocks.low[k]) > low + slack)
      continue;
    const std::size_t end = std::min((k + 1) * kProofBlock, points.size());
    for (std::size_t i = k * kProofBlock; i < end; ++i) {
      const typename Frame::Point p = points[i] - origin;
      const double r = frame.distance(p);
      if (weights.outer > 0.0 && r >= high) outer.push_back(frame.contact_row(p, i));
      if (weights.inner > 0.0 && r <= low) inner.push_back(frame.contact_row(p, i));
    }
  }
  out.proof = prove_local<K>(outer, inner, out.zone.width(), weights);
  return out;
}

template ProvenZone<CenterFrame<2>> prove_zone(PlanePoints, const Eigen::Vector2d&,
                                               const CenterFrame<2>&, const ZoneWeights&, double);
template ProvenZone<CenterFrame<3>> prove_zone(SpacePoints, const Eigen::Vector3d&,
                                               const CenterFrame<3>&, const ZoneWeights&, double);
template ProvenZone<CylinderFrame> prove_zone(SpacePoints, const Eigen::Vector3d&,
                                              const CylinderFrame&, const ZoneWeights&, double);

namespace {

/// Most descents on the points nearest to the sides of a zone; each starts at the last result.
constexpr int kClosePasses = 10;

/// Angle between two lines [rad].
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::asin(std::min(1.0, a.cross(b).norm()));
}

/// Searches the axes of one reference, one scope after the other.
class ScopeSearcher {
 public:
  ScopeSearcher(SpacePoints points, const CylinderProofOptions& options, const ZoneWeights& weights,
                const AxisReach& reach, CylinderZoneFitter& fitter)
      : points_(points), options_(options), weights_(weights), reach_(reach), fitter_(fitter) {}

  /// Searches one scope.
  /// @return Whether the certificate is now global.
  bool run(const AxisScope& scope, AxisProof& proof) const {
    const auto directions = directions_of(scope, proof.half_length);
    for (int restart = 0; restart < kRestartLimit; ++restart) {
      if (proof.certificate.kind == Certificate::Kind::kNone) return false;
      if (auto reason = outside(proof, scope); !reason.empty()) {
        proof.certificate.reason = reason;
        return false;
      }
      const LocalProof<4>& local = proof.proven.proof;
      const double value = weights_.value(proof.proven.zone);
      const auto search =
          search_axes(points_, proof.axis, proof.half_length,
                      {value, local.growth, local.outer, local.inner, weights_, reach_}, directions,
                      options_.search);
      proof.boxes += search.boxes;
      if (!search.better) {
        proof.certificate.reason = search.reason;
        if (!search.proven) return false;
        const double gap = std::max(proof.certificate.gap_mm, value - search.lower_mm);
        proof.certificate = {
            Certificate::Kind::kGlobal, scope_text(scope, proof.half_length), gap, {}};
        return true;
      }
      AxisProof next = prove_axis(points_, descended(*search.better), weights_);
      if (const auto& known = options_.candidates;
          known && angle_between(next.axis.direction, known->nominal) > known->cone_rad) {
        proof.certificate.reason = core::Phrase(
            fmt::format("a better axis leans {:.3g} deg from the normal of the layers",
                        angle_between(next.axis.direction, known->nominal) / core::kDegree));
        return false;
      }
      if (!(weights_.value(next.proven.zone) < value)) {
        proof.certificate.reason = core::Phrase(fmt::format(
            "a better axis was met, its optimum was not reached; better by {:.3g} mm at least",
            value - value_about(*search.better)));
        return false;
      }
      if (!take(std::move(next), proof)) return false;
    }
    proof.certificate.reason =
        core::Phrase(fmt::format("{} better axes were met, one after the other", kRestartLimit));
    return false;
  }

 private:
  [[nodiscard]] Extremes zone_about(const Axis& axis) const {
    return extremes_of(points_, [&](const auto& p) { return distance_mm(axis, p); });
  }
  [[nodiscard]] double value_about(const Axis& axis) const {
    return weights_.value(zone_about(axis));
  }

  /// Descends from a better axis to its optimum. With many points the descent begins on a sample,
  /// which may lead it back to the previous optimum, worse than where it began. In that case it
  /// uses the points nearest to the sides, few enough to be worked on all at once.
  [[nodiscard]] CylinderZone descended(const Axis& better) const {
    CylinderZone out = fitter_.fit_from(points_, better, weights_);
    double value = value_about(better);
    if (points_.size() <= kAllWorked || value_about(out.place) <= value) return out;
    Axis place = better;
    for (int pass = 0; pass < kClosePasses; ++pass) {
      std::vector<Eigen::Vector3d> close(points_.begin(), points_.end());
      const Extremes sides = zone_about(place);
      const double middle = 0.5 * (sides.low + sides.high);
      const auto depth = [&](const Eigen::Vector3d& p) {
        const double r = distance_mm(place, p);
        if (minimum_zone()) return -std::abs(r - middle);
        return inscribed() ? r : -r;
      };
      std::nth_element(close.begin(), close.begin() + static_cast<std::ptrdiff_t>(kAllWorked),
                       close.end(),
                       [&](const auto& a, const auto& b) { return depth(a) < depth(b); });
      close.resize(kAllWorked);
      const CylinderZone next = fitter_.fit_from(close, place, weights_);
      const double reached = value_about(next.place);
      if (!(reached <= value)) return out;
      out = next;
      // If the zone of some points holds all points, their optimum is that of all.
      if (reached <= weights_.value({next.inner_radius_mm, next.outer_radius_mm}) +
                         1e-12 * next.outer_radius_mm) {
        return out;
      }
      value = reached;
      place = next.place;
    }
    return out;
  }

  [[nodiscard]] bool minimum_zone() const { return weights_.outer > 0.0 && weights_.inner > 0.0; }
  [[nodiscard]] bool inscribed() const { return weights_.outer == 0.0; }

  /// Half angle of the cone of axes that stay within reach over the length of the points.
  [[nodiscard]] double reached_angle(double half_length) const {
    return std::min(10.0 * core::kDegree, std::atan2(reach_.limit_mm, half_length));
  }

  [[nodiscard]] std::vector<DirectionBox> directions_of(const AxisScope& scope,
                                                        double half_length) const {
    if (inscribed()) return cover_cone(reach_.about.direction, reached_angle(half_length));
    if (scope.kind == AxisScope::Kind::kHalfSphere) return cover_half_sphere();
    return cover_cone(scope.nominal, scope.cone_rad);
  }

  /// "all directions", "within 10 deg of nominal".
  [[nodiscard]] core::Phrase scope_text(const AxisScope& scope, double half_length) const {
    if (inscribed()) {
      return core::Phrase(fmt::format("within {:.3g} deg and {:.4g} mm of the least-squares axis",
                                      reached_angle(half_length) / core::kDegree, reach_.limit_mm));
    }
    if (scope.kind == AxisScope::Kind::kHalfSphere) return core::phrase("all directions");
    return core::phrase("within {:.6g} deg of nominal", scope.cone_rad / core::kDegree);
  }

  /// The reason why the claimed axis cannot be compared with those of a scope; empty if it can.
  [[nodiscard]] core::Phrase outside(const AxisProof& proof, const AxisScope& scope) const {
    if (inscribed()) {
      if (within_reach(proof)) return {};
      return core::Phrase(fmt::format(
          "the axis lies more than {:.4g} mm from the least-squares axis", reach_.limit_mm));
    }
    if (scope.kind == AxisScope::Kind::kHalfSphere) return {};
    const double angle = angle_between(proof.axis.direction, scope.nominal.normalized());
    if (angle <= scope.cone_rad) return {};
    return core::Phrase(
        fmt::format("the axis is {:.4g} deg from nominal, the searched cone ends at {:.4g} deg",
                    angle / core::kDegree, scope.cone_rad / core::kDegree));
  }

  [[nodiscard]] bool within_reach(const AxisProof& proof) const {
    const double angle = angle_between(proof.axis.direction, reach_.about.direction);
    const double apart = distance_mm(reach_.about, proof.axis.point_mm);
    // An inscribed axis must keep the reach at its ends, a circumscribed one only in the middle.
    const double ends = inscribed() ? proof.half_length * std::tan(angle) : 0.0;
    return angle <= 10.0 * core::kDegree && apart + ends <= reach_.limit_mm;
  }

  /// Takes over the next axis of the search.
  /// @return false if the reference may not lie there.
  [[nodiscard]] bool take(AxisProof next, AxisProof& proof) const {
    if (!minimum_zone() && !within_reach(next)) {
      proof.other = next.axis;
      proof.certificate.reason =
          core::Phrase("a better axis lies outside the reach of the reference");
      return false;
    }
    next.boxes = proof.boxes;
    next.other = proof.other;
    proof = std::move(next);
    return true;
  }

  SpacePoints points_;
  const CylinderProofOptions& options_;
  ZoneWeights weights_;
  AxisReach reach_;
  CylinderZoneFitter& fitter_;
};

}  // namespace

AxisProof prove_axis(SpacePoints points_mm, const CylinderZone& found, const ZoneWeights& weights) {
  AxisProof out;
  out.axis = found.place;
  out.ending = found.ending;
  const Eigen::Vector3d& along = out.axis.direction;
  Extremes heights;
  double size = 0.0;
  for (const Eigen::Vector3d& p : points_mm) {
    heights.take((p - out.axis.point_mm).dot(along));
    size = std::max(size, p.cwiseAbs().maxCoeff());
  }
  const double round_off = distance_round_off(size);
  out.axis.point_mm += 0.5 * (heights.low + heights.high) * along;
  out.half_length = std::max(0.5 * heights.width(), round_off);
  const CylinderFrame frame({Eigen::Vector3d::Zero(), along}, out.half_length);
  out.proven = prove_zone(points_mm, out.axis.point_mm, frame, weights, round_off);
  const double width = out.proven.zone.width();
  out.certificate = certify_local<4>(out.proven.proof, width, round_off,
                                     core::Phrase("next to the least-squares axis"));
  // All points are on one cylinder to round-off. This is global, as no zone is narrower than 0.
  if (weights.outer > 0.0 && weights.inner > 0.0 && width <= 16.0 * round_off) {
    out.certificate = {Certificate::Kind::kGlobal, core::phrase("all directions"), width, {}};
  }
  return out;
}

void search_scopes(SpacePoints points_mm, const CylinderProofOptions& options,
                   const ZoneWeights& weights, const AxisReach& reach, CylinderZoneFitter& fitter,
                   AxisProof& proof) {
  const ScopeSearcher searcher(points_mm, options, weights, reach, fitter);
  for (const AxisScope& scope : options.scopes) {
    if (proof.certificate.kind == Certificate::Kind::kGlobal) return;
    if (searcher.run(scope, proof)) return;
    // The scope of an inscribed reference is always its reach, whatever the options name.
    if (weights.outer == 0.0) return;
  }
}

}  // namespace rondure::fit
