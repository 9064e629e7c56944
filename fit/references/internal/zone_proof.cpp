#include "fit/references/internal/zone_proof.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fit/geometry/points.h"
#include "fit/geometry/scan.h"

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

}  // namespace rondure::fit
