#include "core/noise.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace rondure::core {
namespace {

TEST(Splitmix64, GivesThePublishedFirstOutputForSeedOne) {
  std::uint64_t state = 1;
  EXPECT_EQ(splitmix64(state), 0x910a2dec89025cc1ULL);
}

TEST(KeyedNoise, DependsOnItsKeyAloneAndOnTheOrderOfItsParts) {
  KeyedNoise first(7, {1, 2});
  KeyedNoise other(7, {5});
  (void)other.normal();  // what else is drawn does not matter
  KeyedNoise again(7, {1, 2});
  EXPECT_EQ(first.normal(), again.normal());
  std::set<double> draws;
  for (std::uint64_t a = 0; a < 20; ++a) {
    for (std::uint64_t b = 0; b < 20; ++b) draws.insert(KeyedNoise(7, {a, b}).uniform());
  }
  EXPECT_EQ(draws.size(), 400U);
}

TEST(KeyedNoise, IsNormalOverNeighbouringKeys) {
  const int n = 200000;
  double sum = 0.0;
  double squares = 0.0;
  double fourth = 0.0;
  double lag = 0.0;
  double last = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = KeyedNoise(3, {static_cast<std::uint64_t>(i)}).normal();
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
    lag += x * last;
    last = x;
  }
  // Five standard deviations of each estimate.
  EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / n, 3.0, 5.0 * std::sqrt(96.0 / n));
  EXPECT_NEAR(lag / n, 0.0, 5.0 / std::sqrt(n));
}

}  // namespace
}  // namespace rondure::core
