#include <vector>

#include "benchmarks/peers/ceres_peer.h"
#include "benchmarks/peers/nlopt_peer.h"
#include "benchmarks/sections.h"
#include "benchmarks/timing.h"
#include "fit/least_squares/cylinder.h"

namespace rondure::benchmarks {
namespace {

/// Least squares of at most 48 points, evenly taken: where every search starts.
fit::Axis sampled_start(const CylinderSet& set) {
  constexpr std::size_t kSample = 48;
  const std::size_t count = set.points_mm.size();
  std::vector<Eigen::Vector3d> sample;
  for (std::size_t i = 0; i < std::min(kSample, count); ++i) {
    sample.push_back(set.points_mm[i * count / std::min(kSample, count)]);
  }
  const auto fit = fit::ls_cylinder(sample, set.start_direction);
  return fit ? fit->axis : fit::Axis{sample.front(), set.start_direction};
}

/// The downhill simplex with S1 as its objective, so that the comparison is about the algorithm.
double nelder_mead_mm(const CylinderSet& set) {
  const auto width = [&](const fit::Axis& axis) { return width_about_mm(set, axis); };
  return nlopt_nelder_mead_zone(width, sampled_start(set), kHalfLength_mm).width_mm;
}

/// 24 points, start 5 deg off: the part on the shop floor.
void register_small(const Extent& extent) {
  const Rotation five{Variant::kStart5, 24, 0, extent.seeds()};
  register_zone<CylinderSet>("mz/cylinder", five);
  register_peer<CylinderSet>("nlopt-slsqp/cylinder", five, [](const CylinderSet& set) {
    return nlopt_slsqp_zone(set.points_mm, set.start_direction).width_mm;
  });
}

void register_sizes(const Extent& extent) {
  for (const std::size_t points : {24, 100, 1'000, 10'000, 100'000}) {
    if (points >= extent.large()) break;
    const Rotation rotation{Variant::kScanOrder, points, 0, extent.seeds()};
    register_zone<CylinderSet>("mz/cylinder", rotation);
    register_peer<CylinderSet>("nlopt-nelder-mead/cylinder", rotation, nelder_mead_mm);
  }
  for (const std::size_t points : {9, 12, 36, 72, 360, 3'600}) {
    register_zone<CylinderSet>("mz/cylinder", {Variant::kScanOrder, points, 0, extent.seeds()});
  }
  register_zone<CylinderSet>("mz/cylinder", {Variant::kShuffled, 100'000, 0, extent.seeds()});
}

void register_large(const Extent& extent) {
  for (unsigned seed = 0; seed < extent.seeds(); ++seed) {
    register_zone<CylinderSet>("mz/cylinder", {Variant::kScanOrder, extent.large(), seed, 1});
    register_zone<CylinderSet>("mz/cylinder", {Variant::kShuffled, extent.large(), seed, 1});
  }
  for (unsigned seed = 0; seed < std::min(5U, extent.seeds()); ++seed) {
    register_call<CylinderSet>("ls/cylinder", {Variant::kScanOrder, extent.large(), seed, 1},
                               [](const CylinderSet& set) {
                                 return fit::ls_cylinder(set.points_mm, set.start_direction);
                               });
    register_call<CylinderSet>("four/cylinder", {Variant::kScanOrder, extent.large(), seed, 1},
                               own_criteria);
  }
  const Rotation first{Variant::kScanOrder, extent.large(), 0, 1};
  register_peer<CylinderSet>("nlopt-nelder-mead/cylinder", first, nelder_mead_mm);
  register_call<CylinderSet>("ceres/cylinder", first, [](const CylinderSet& set) {
    return ceres_ls_cylinder(set.points_mm, set.start_direction);
  });
  if (extent.full) {
    register_zone<CylinderSet>("mz/cylinder", {Variant::kScanOrder, 10'000'000, 0, 1});
  }
}

}  // namespace

void register_cylinders(const Extent& extent) {
  register_small(extent);
  register_sizes(extent);
  register_large(extent);
}

}  // namespace rondure::benchmarks
