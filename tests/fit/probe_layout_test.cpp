// Layouts of three probes against the tables of methods, roundness A.5.
#include "fit/spindle/probe_layout.h"

#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::kDegree;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Order, then |G| and g of layouts A, B and R*.
struct PrintedOrder {
  int k;
  double ga, na, gb, nb, gr, nr;
};
constexpr std::array<PrintedOrder, 51> kTable = {{
    {0, 107.6467, 0.71, 0.9962, 1.74, 0.7649, 2.09},
    {1, 0.0000, kNone, 0.0000, kNone, 0.0000, kNone},
    {2, 109.6281, 0.70, 1.9942, 0.87, 1.6298, 0.98},
    {3, 3.9993, 19.21, 2.9955, 0.58, 2.7076, 0.59},
    {4, 107.5738, 0.71, 2.0048, 0.86, 2.2986, 0.70},
    {5, 3.9993, 19.21, 0.0923, 18.73, 0.8000, 2.00},
    {6, 109.4796, 0.70, 1.0046, 1.72, 0.7241, 2.21},
    {7, 7.9932, 9.61, 0.0933, 18.54, 0.7094, 2.26},
    {8, 107.3551, 0.72, 1.9793, 0.87, 0.8153, 1.96},
    {9, 7.9932, 9.61, 2.9898, 0.58, 2.2713, 0.70},
    {10, 109.1827, 0.70, 2.0110, 0.86, 2.6094, 0.61},
    {11, 11.9763, 6.42, 0.1835, 9.43, 1.5326, 1.04},
    {12, 106.9909, 0.72, 1.0294, 1.68, 0.7188, 2.23},
    {13, 11.9763, 6.42, 0.1874, 9.23, 1.2044, 1.33},
    {14, 108.7378, 0.71, 1.9603, 0.88, 0.6813, 2.35},
    {15, 15.9431, 4.82, 2.9784, 0.58, 1.5287, 1.05},
    {16, 106.4817, 0.72, 2.0129, 0.86, 2.4845, 0.64},
    {17, 15.9431, 4.82, 0.2733, 6.33, 2.0410, 0.78},
    {18, 108.1456, 0.71, 1.0692, 1.62, 0.9364, 1.71},
    {19, 19.8884, 3.86, 0.2820, 6.14, 1.4230, 1.12},
    {20, 105.8282, 0.73, 1.9372, 0.89, 1.3675, 1.17},
    {21, 19.8884, 3.86, 2.9613, 0.58, 0.8984, 1.78},
    {22, 107.4068, 0.72, 2.0104, 0.86, 1.9570, 0.82},
    {23, 23.8066, 3.23, 0.3616, 4.78, 2.2060, 0.73},
    {24, 105.0314, 0.73, 1.1221, 1.54, 1.2806, 1.25},
    {25, 23.8066, 3.23, 0.3769, 4.59, 1.3801, 1.16},
    {26, 106.5225, 0.72, 1.9100, 0.91, 1.9012, 0.84},
    {27, 27.6927, 2.77, 2.9385, 0.59, 1.2394, 1.29},
    {28, 104.0922, 0.74, 2.0034, 0.86, 1.2203, 1.31},
    {29, 27.6927, 2.77, 0.4481, 3.86, 1.9769, 0.81},
    {30, 105.4938, 0.73, 1.1859, 1.46, 1.5399, 1.04},
    {31, 31.5411, 2.44, 0.4719, 3.67, 1.1706, 1.37},
    {32, 103.0119, 0.75, 1.8790, 0.92, 2.0847, 0.77},
    {33, 31.5411, 2.44, 2.9103, 0.59, 1.9636, 0.81},
    {34, 104.3222, 0.74, 1.9919, 0.87, 0.9513, 1.68},
    {35, 35.3469, 2.17, 0.5326, 3.25, 1.4004, 1.14},
    {36, 101.7920, 0.75, 1.2584, 1.37, 1.5673, 1.02},
    {37, 35.3469, 2.17, 0.5668, 3.05, 0.9552, 1.67},
    {38, 103.0092, 0.75, 1.8443, 0.94, 1.8921, 0.85},
    {39, 39.1047, 1.96, 2.8765, 0.60, 2.4487, 0.65},
    {40, 100.4343, 0.76, 1.9759, 0.88, 1.6100, 0.99},
    {41, 39.1047, 1.96, 0.6150, 2.81, 0.7306, 2.19},
    {42, 101.5566, 0.76, 1.3377, 1.29, 1.2931, 1.24},
    {43, 42.8096, 1.79, 0.6614, 2.62, 0.8691, 1.84},
    {44, 98.9404, 0.78, 1.8059, 0.96, 1.3865, 1.15},
    {45, 42.8096, 1.79, 2.8374, 0.61, 2.5272, 0.63},
    {46, 99.9664, 0.77, 1.9555, 0.88, 2.3280, 0.69},
    {47, 46.4564, 1.65, 0.6952, 2.49, 0.9478, 1.69},
    {48, 97.3124, 0.79, 1.4219, 1.22, 0.7290, 2.19},
    {49, 46.4564, 1.65, 0.7554, 2.29, 0.8577, 1.87},
    {50, 98.2407, 0.78, 1.7640, 0.98, 0.6958, 2.30},
}};

TEST(ProbeLayout, HasTheTransferAndGainOfTheTable) {
  const auto expect = [](const ProbeLayout& layout, int k, double transfer, double gain) {
    EXPECT_NEAR(std::abs(layout.transfer(k)), transfer, 5.1e-5) << "harmonic " << k;
    if (gain == kNone) {
      EXPECT_EQ(layout.gain(k), kNone);
    } else {
      EXPECT_NEAR(layout.gain(k), gain, 5.1e-3) << "harmonic " << k;
    }
  };
  for (const PrintedOrder& row : kTable) {
    expect(published_layout_a(), row.k, row.ga, row.na);
    expect(published_layout_b(), row.k, row.gb, row.nb);
    expect(reference_layout(), row.k, row.gr, row.nr);
  }
}

TEST(ProbeLayout, HasTheWeightsOfTheTable) {
  struct Case {
    ProbeLayout layout;
    double phi2_deg, phi3_deg, k2, k3, norm, worst;
    int worst_order;
    double u;
  };
  for (const Case& c : {Case{published_layout_a(), 90, 181.0546875, -54.318751, -54.327955, 76.8313,
                             19.21, 3, 1.51},
                        Case{published_layout_b(), 60.8203125, 240.1171875, -0.989254, -1.006976,
                             1.7299, 18.73, 5, 1.47},
                        Case{reference_layout(), 52.3828125, 248.90625, -0.915932, -0.848995,
                             1.5999, 2.35, 14, 0.43}}) {
    EXPECT_NEAR(c.layout.phi2_rad() / kDegree, c.phi2_deg, 1e-12);
    EXPECT_NEAR(c.layout.phi3_rad() / kDegree, c.phi3_deg, 1e-12);
    EXPECT_NEAR(c.layout.weights()[1], c.k2, 5.1e-7);
    EXPECT_NEAR(c.layout.weights()[2], c.k3, 5.1e-7);
    EXPECT_NEAR(c.layout.weight_norm(), c.norm, 5.1e-5);
    const WorstGain worst = worst_gain(c.layout, 2, 50);
    EXPECT_NEAR(worst.gain, c.worst, 5.1e-3);
    EXPECT_EQ(worst.order, c.worst_order);
    double power = 0.0;
    for (int k = 2; k <= 50; ++k) power += std::pow(c.layout.gain(k), 2);
    EXPECT_NEAR(std::sqrt(2.0 / 1024.0 * power), c.u, 5.1e-3);
  }
  const auto a = ProbeLayout::of(90 * kDegree, 181.05 * kDegree);
  const auto b = ProbeLayout::of(60.82 * kDegree, 240.12 * kDegree);
  EXPECT_NEAR(a->weights()[1], -54.5613, 5.1e-5);
  EXPECT_NEAR(a->weights()[2], -54.5705, 5.1e-5);
  EXPECT_NEAR(b->weights()[1], -0.989200, 5.1e-7);
  EXPECT_NEAR(b->weights()[2], -1.006945, 5.1e-7);
}

TEST(ProbeLayout, NeverPassesHarmonicOneAndAlwaysItsZeros) {
  for (int seed = 0; seed < 50; ++seed) {
    const double phi2 = (20.0 + 2.9 * seed) * kDegree;
    const double phi3 = (200.0 + 1.7 * seed) * kDegree;
    const auto layout = ProbeLayout::of(phi2, phi3);
    if (!layout) continue;
    EXPECT_NEAR(std::abs(layout->transfer(1)), 0.0, 1e-12 * layout->weight_norm());
    EXPECT_NEAR(std::abs(layout->transfer(-3) - std::conj(layout->transfer(3))), 0.0, 1e-12);
    const double zero = 4.0 * std::sin(phi2 / 2) * std::sin(phi3 / 2) *
                        std::sin((phi2 + phi3) / 2) / std::sin(phi3);
    EXPECT_NEAR(layout->transfer(0).real(), zero, 1e-10 * layout->weight_norm());
  }
}

TEST(LayoutSearch, FindsTheReferenceLayoutAmongWholeSamples) {
  LayoutSearch search;
  search.samples = 1024;
  const auto found = design_layout(search);
  ASSERT_TRUE(found) << found.error().what;
  const ProbeLayout& best = found->front().layout;
  EXPECT_NEAR(found->front().worst.gain, 2.35, 0.005);
  // Its mirror image, P2 and P3 exchanged, is as good.
  const double p3 = std::remainder(best.phi2_rad() + best.phi3_rad(), core::kTwoPi) / kDegree;
  EXPECT_NEAR(
      std::min(std::abs(best.phi2_rad() / kDegree - 52.3828125), std::abs(-p3 - 52.3828125)), 0.0,
      1e-9);
}

TEST(LayoutSearch, IsNoWorseWithAnyAngle) {
  LayoutSearch search;
  search.last = 30;
  search.count = 3;
  const auto free = design_layout(search);
  ASSERT_TRUE(free);
  ASSERT_EQ(free->size(), 3U);
  EXPECT_LE((*free)[0].worst.gain, (*free)[1].worst.gain + 1e-9) << "mirror images are alike";
  search.samples = 256;
  const auto whole = design_layout(search);
  ASSERT_TRUE(whole);
  EXPECT_LE(free->front().worst.gain, whole->front().worst.gain);
  for (const DesignedLayout& d : *free) {
    EXPECT_NEAR(worst_gain(d.layout, 2, 30).gain, d.worst.gain, 1e-9);
    EXPECT_GE(d.worst.gain, d.rms_gain);
  }
}

TEST(LayoutSearch, RefusesBandsAndRangesThatAreNone) {
  const auto code = [](auto change) {
    LayoutSearch search;
    change(search);
    const auto found = design_layout(search);
    return found ? Code::kInternal : found.error().code;
  };
  EXPECT_EQ(code([](LayoutSearch& s) { s.first = 1; }), Code::kBadOption);
  EXPECT_EQ(code([](LayoutSearch& s) { s.last = 1; }), Code::kBadOption);
  EXPECT_EQ(code([](LayoutSearch& s) { s.count = 0; }), Code::kBadOption);
  EXPECT_EQ(code([](LayoutSearch& s) { s.p2_range_deg = {90.0, 40.0}; }), Code::kBadOption);
  EXPECT_EQ(code([](LayoutSearch& s) { s.least_apart_deg = 170.0; }), Code::kBadOption);
}

}  // namespace
}  // namespace rondure::fit
