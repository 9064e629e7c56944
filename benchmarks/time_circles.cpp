#include "benchmarks/peers/alglib_peer.h"
#include "benchmarks/peers/cgal_peer.h"
#include "benchmarks/sections.h"
#include "benchmarks/timing.h"

namespace rondure::benchmarks {
namespace {

constexpr std::size_t kAlglibLimit = 10'000;

void register_peers(const Rotation& rotation) {
  register_call<CircleSet>("mc/circle", rotation, [](const CircleSet& set) {
    return own_fit(set, fit::kMinimumCircumscribed);
  });
  register_peer<CircleSet>("cgal-annulus/circle", rotation, [](const CircleSet& set) {
    return cgal_annulus_width_mm(set.points_mm);
  });
  register_call<CircleSet>("cgal-sphere/circle", rotation, [](const CircleSet& set) {
    return cgal_smallest_circle_mm(set.points_mm);
  });
  if (rotation.points > kAlglibLimit) return;
  register_peer<CircleSet>("alglib-fitspheremz/circle", rotation, [](const CircleSet& set) {
    return alglib_zone_width_mm(set.points_mm);
  });
}

}  // namespace

void register_circles(const Extent& extent) {
  for (const std::size_t points : {20, 100, 1'000, 10'000, 100'000}) {
    if (points >= extent.large()) break;
    const Rotation rotation{Variant::kScanOrder, points, 0, extent.seeds()};
    register_zone<CircleSet>("mz/circle", rotation);
    register_peers(rotation);
  }
  register_call<CircleSet>(
      "cgal-delaunay/circle", {Variant::kScanOrder, 20, 0, extent.seeds()},
      [](const CircleSet& set) { return cgal_delaunay_triangles(set.points_mm); });
  for (const std::size_t points : {36, 360, 3'600}) {
    register_zone<CircleSet>("mz/circle", {Variant::kScanOrder, points, 0, extent.seeds()});
  }
  for (unsigned seed = 0; seed < extent.seeds(); ++seed) {
    register_zone<CircleSet>("mz/circle", {Variant::kScanOrder, extent.large(), seed, 1});
  }
  if (extent.full) {
    register_zone<CircleSet>("mz/circle", {Variant::kScanOrder, 10'000'000, 0, 1});
  }
}

}  // namespace rondure::benchmarks
