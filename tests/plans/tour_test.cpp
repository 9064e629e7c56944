#include "plans/path/internal/tour.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "tests/plans/random_inspection.h"

namespace rondure::plans {
namespace {

using test::between;

struct TourCase {
  PathGeometry geometry;
  std::vector<Target> targets;
};

TourCase random_case(std::uint64_t seed, int most_layers, int most_points) {
  core::KeyedNoise random(seed, {1});
  FeaturePlan feature;
  const double from = between(random, -50.0, 20.0);
  const double to = from + between(random, 30.0, 120.0);
  feature.nominal = {between(random, 24.0, 120.0), from, to};
  feature.sampling.layers = 1 + static_cast<int>(between(random, 0.0, most_layers));
  feature.sampling.points_per_layer = 3 + static_cast<int>(between(random, 0.0, most_points - 2.0));
  feature.sampling.stagger = random.uniform();
  TourCase out;
  out.geometry = {0.5 * feature.nominal.diameter_mm, from, to, seed % 3 == 0, 2.0, 3.0, 5.0, 0.0};
  out.targets = *sampling_targets(feature);
  return out;
}

std::vector<std::size_t> own_order(std::size_t n) {
  std::vector<std::size_t> out(n);
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

TEST(ShortTour, VisitsEveryTargetOnceAndIsNeverLongerThanTheirOwnOrder) {
  int shorter = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const TourCase c = random_case(seed, 7, 14);
    const TourCost cost = bare_cost(c.targets, c.geometry);
    const auto tour = short_tour(c.targets, cost);
    const auto own = own_order(c.targets.size());
    auto sorted = tour;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted, own);
    const double own_mm = tour_length_mm(own, cost);
    EXPECT_LE(tour_length_mm(tour, cost), own_mm + 1e-9);
    if (tour_length_mm(tour, cost) < 0.98 * own_mm) ++shorter;
  }
  EXPECT_GT(shorter, 20) << "of 60";
}

TEST(ShortTour, IsTheBestOfAllOrdersOfSixTargetsAndNearlySoOfEight) {
  int best_found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    TourCase c = random_case(seed, 4, 6);
    c.targets.resize(std::min<std::size_t>(c.targets.size(), seed % 2 == 0 ? 6 : 8));
    const TourCost cost = bare_cost(c.targets, c.geometry);
    auto order = own_order(c.targets.size());
    double best_mm = std::numeric_limits<double>::infinity();
    do {
      best_mm = std::min(best_mm, tour_length_mm(order, cost));
    } while (std::next_permutation(order.begin(), order.end()));
    const double found_mm = tour_length_mm(short_tour(c.targets, cost), cost);
    EXPECT_GE(found_mm, best_mm - 1e-9);
    EXPECT_LE(found_mm, (c.targets.size() <= 7 ? 1.0 + 1e-12 : 1.1) * best_mm);
    if (found_mm < best_mm + 1e-6) ++best_found;
  }
  EXPECT_GE(best_found, 15) << "of 20";
}

TEST(ShortTour, IsTheSameForTheSameTargets) {
  const TourCase c = random_case(4, 6, 12);
  const TourCost cost = bare_cost(c.targets, c.geometry);
  EXPECT_EQ(short_tour(c.targets, cost), short_tour(c.targets, cost));
}

TEST(ShortTour, OrdersThousandsOfTargetsWithoutImprovingThem) {
  FeaturePlan feature;
  feature.nominal = {60.0, 0.0, 100.0};
  feature.sampling.layers = 40;
  feature.sampling.points_per_layer = 100;
  const PathGeometry geometry = {30.0, 0.0, 100.0, false, 2.0, 3.0, 5.0, 0.0};
  const auto targets = *sampling_targets(feature);
  const TourCost cost = bare_cost(targets, geometry);
  const auto tour = short_tour(targets, cost);
  EXPECT_LE(tour_length_mm(tour, cost), tour_length_mm(own_order(targets.size()), cost));
}

}  // namespace
}  // namespace rondure::plans
