#include "benchmarks/read_and_sum.h"
#include "benchmarks/sections.h"
#include "benchmarks/timing.h"
#include "fit/geometry/scan.h"

namespace rondure::benchmarks {
namespace {

fit::Axis axis_of(const CylinderSet& set) { return {set.axis_point_mm, set.axis_direction}; }

void register_cylinder_pass(const Rotation& rotation) {
  register_call<CylinderSet>("s1/cylinder", rotation, [](const CylinderSet& set) {
    return fit::scan(set.points_mm, axis_of(set));
  });
}

void register_circle_pass(const Rotation& rotation) {
  register_call<CircleSet>("s1/circle", rotation, [](const CircleSet& set) {
    return fit::scan(set.points_mm, set.center_mm);
  });
}

}  // namespace

void register_passes(const Extent& extent) {
  for (unsigned seed = 0; seed < extent.seeds(); ++seed) {
    register_cylinder_pass({Variant::kScanOrder, extent.large(), seed, 1});
    register_cylinder_pass({Variant::kShuffled, extent.large(), seed, 1});
    register_circle_pass({Variant::kScanOrder, extent.large(), seed, 1});
  }
  for (unsigned seed = 0; seed < std::min(5U, extent.seeds()); ++seed) {
    register_call<CylinderSet>(
        "read/cylinder", {Variant::kScanOrder, extent.large(), seed, 1},
        [](const CylinderSet& set) {
          return read_and_sum({set.points_mm.front().data(), 3 * set.points_mm.size()});
        });
  }
  const std::size_t middle = extent.large() / 10;
  register_cylinder_pass({Variant::kScanOrder, middle, 0, extent.seeds()});
  register_circle_pass({Variant::kScanOrder, middle, 0, extent.seeds()});
  for (const std::size_t points : {9, 12, 20, 24, 36, 72, 100, 360, 1'000, 3'600, 10'000}) {
    if (points == middle || points >= extent.large()) continue;
    register_cylinder_pass({Variant::kScanOrder, points, 0, extent.seeds()});
    register_circle_pass({Variant::kScanOrder, points, 0, extent.seeds()});
  }
  register_cylinder_pass({Variant::kStart5, 24, 0, extent.seeds()});
  register_cylinder_pass({Variant::kShuffled, 100'000, 0, extent.seeds()});
  if (extent.full) register_cylinder_pass({Variant::kScanOrder, 10'000'000, 0, 1});
  if (extent.full) register_circle_pass({Variant::kScanOrder, 10'000'000, 0, 1});
}

}  // namespace rondure::benchmarks
