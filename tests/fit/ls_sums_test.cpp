#include "fit/least_squares/internal/sums.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;
using Flat = std::vector<Eigen::Vector2d>;

const Axis kAxis{{0.1, -0.2, 3.0}, Eigen::Vector3d(0.2, -0.3, 1.0).normalized()};
const Eigen::Vector3d kOrigin(400.0, -300.0, 50.0);

/// Points about kAxis, radius 25, half length 35.
Points3 cylinder_points(std::size_t n, double form_mm, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {3});
  const auto frame = across(kAxis.direction);
  Points3 out;
  for (std::size_t i = 0; i < n; ++i) {
    const double theta = core::kTwoPi * noise.uniform();
    const double r = 25.0 + form_mm * noise.normal();
    out.push_back(kOrigin + kAxis.point_mm +
                  frame * Eigen::Vector2d(r * std::cos(theta), r * std::sin(theta)) +
                  kAxis.direction * 35.0 * (2.0 * noise.uniform() - 1.0));
  }
  return out;
}

Flat flattened(const Points3& points) {
  const auto frame = across(kAxis.direction);
  Flat out;
  for (const auto& p : points) out.emplace_back(frame.transpose() * (p - kOrigin));
  return out;
}

std::vector<Simd> simds() {
  std::vector<Simd> out = {Simd::kPortable};
  if (best_simd() != Simd::kPortable) out.push_back(Simd::kAvx2);
  if (best_simd() == Simd::kAvx512) out.push_back(Simd::kAvx512);
  return out;
}

template <int N>
std::vector<std::uint64_t> bits(const PassSums<N>& sums) {
  std::vector<std::uint64_t> out;
  const auto add = [&](double v) { out.push_back(std::bit_cast<std::uint64_t>(v)); };
  for (Eigen::Index i = 0; i < N; ++i) add(sums.right(i));
  for (Eigen::Index i = 0; i < N * N; ++i) add(sums.matrix(i));
  add(sums.squares);
  add(sums.along_mm);
  return out;
}

TEST(LsSums, AllInstructionSetsGiveTheSameBits) {
  const CylinderFrame frame(kAxis, 35.0);
  for (const std::size_t n : {1U, 5U, 7U, 8U, 9U, 24U, 31U, 1023U, 1024U, 1025U, 5000U}) {
    for (const double form_mm : {1e-3, 3.0}) {  // by the series, and by the square root
      SCOPED_TRACE(testing::Message() << n << " points, form " << form_mm);
      const Points3 points = cylinder_points(n, form_mm, n);
      const Flat flat = flattened(points);
      for (const bool matrix : {true, false}) {
        const auto solid = bits(cylinder_sums(points, kOrigin, frame, 25.0, {matrix, nullptr}));
        const auto plane = bits(circle_sums(flat, {0.1, 0.2}, {0.3, 0.1}, 25.0, {matrix, nullptr}));
        for (const Simd simd : simds()) {
          EXPECT_EQ(solid,
                    bits(cylinder_sums(points, kOrigin, frame, 25.0, {matrix, nullptr, simd})));
          EXPECT_EQ(plane,
                    bits(circle_sums(flat, {0.1, 0.2}, {0.3, 0.1}, 25.0, {matrix, nullptr, simd})));
        }
      }
    }
  }
}

/// The same sums from the frame's own rows, in 80-bit numbers.
struct Plain {
  Eigen::Matrix<long double, 5, 5> matrix = Eigen::Matrix<long double, 5, 5>::Zero();
  Eigen::Matrix<long double, 5, 1> right = Eigen::Matrix<long double, 5, 1>::Zero();
  long double squares = 0.0L;
};

Plain plain_sums(const Points3& points, const CylinderFrame& frame, double radius) {
  Plain out;
  for (const auto& p : points) {
    const ContactRow<4> row = frame.contact_row(p - kOrigin, 0);
    Eigen::Matrix<double, 5, 1> g;
    g << row.gradient, -1.0;
    const auto wide = g.cast<long double>();
    const long double residual = row.distance - radius;
    out.matrix += wide * wide.transpose();
    out.right -= wide * residual;
    out.squares += residual * residual;
  }
  return out;
}

TEST(LsSums, AgreesWithPlainSums) {
  for (const double form_mm : {1e-3, 1.0}) {
    SCOPED_TRACE(form_mm);
    for (const std::size_t n : {9U, 300000U}) {
      SCOPED_TRACE(n);
      const Points3 points = cylinder_points(n, form_mm, 4);
      const CylinderFrame frame(kAxis, 35.0);
      const auto sums = cylinder_sums(points, kOrigin, frame, 25.0);
      const Plain plain = plain_sums(points, frame, 25.0);
      const auto count = static_cast<double>(n);
      EXPECT_LT((sums.right - plain.right.cast<double>()).norm(), 1e-14 * 25.0 * count);
      EXPECT_NEAR(sums.squares, static_cast<double>(plain.squares), 1e-13 * form_mm * 25.0 * count);
      // Within the series the matrix takes q/R for the unit vector.
      const double share = form_mm < 0.01 ? 5.0 * form_mm / 25.0 : 1e-13;
      EXPECT_LT((sums.matrix - plain.matrix.cast<double>()).norm(), share * plain.matrix.norm());
      const auto again = cylinder_sums(points, kOrigin, frame, 25.0, {false});
      EXPECT_EQ(sums.right, again.right);
      EXPECT_TRUE(again.matrix.isZero(0.0));
    }
  }
}

TEST(LsSums, APointOnTheAxisHasADistanceAndNoDirection) {
  Points3 points = cylinder_points(24, 1e-3, 2);
  const CylinderFrame frame({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}, 35.0);
  points[7] = kOrigin + Eigen::Vector3d(0.0, 0.0, 12.0);
  const auto sums = cylinder_sums(points, kOrigin, frame, 25.0);
  const Plain plain = plain_sums(points, frame, 25.0);
  EXPECT_LT((sums.right - plain.right.cast<double>()).norm(), 1e-12);
  EXPECT_NEAR(sums.squares, static_cast<double>(plain.squares), 1e-12 * sums.squares);
  EXPECT_TRUE(sums.matrix.allFinite());
}

TEST(LsSums, ANumberThatIsNotFiniteShowsInTheSquares) {
  const CylinderFrame frame(kAxis, 35.0);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const std::size_t row : {0U, 1024U, 2998U, 2999U}) {
      Points3 points = cylinder_points(3000, 1e-3, 5);
      Flat flat = flattened(points);
      points[row].z() = bad;
      flat[row].x() = bad;
      for (const Simd simd : simds()) {
        EXPECT_FALSE(std::isfinite(
            cylinder_sums(points, kOrigin, frame, 25.0, {false, nullptr, simd}).squares));
        EXPECT_FALSE(
            std::isfinite(circle_sums(flat, {0, 0}, {0, 0}, 25.0, {false, nullptr, simd}).squares));
      }
    }
  }
}

TEST(LsSums, StretchesHoldTheExtremesOfAMovedAxis) {
  for (const std::size_t n : {1500U, 50000U}) {
    const Points3 points = cylinder_points(n, 1e-3, 6);
    const CylinderFrame frame(kAxis, 35.0);
    StretchExtremes extremes(n);
    const auto sums = cylinder_sums(points, kOrigin, frame, 25.0, {true, &extremes});
    const Eigen::Vector4d move(1e-5, -2e-5, 3e-6, 1e-5);
    const CylinderFrame moved = frame.moved(move);
    const double change = 3e-5 + sums.lever * 1.3e-5 + 1e-9;
    const auto distance = [&](std::size_t i) { return moved.distance(points[i] - kOrigin); };
    const auto all = distance_range(n, distance);
    const auto some = distance_range(n, distance, &extremes, change);
    EXPECT_EQ(all.low, some.low);
    EXPECT_EQ(all.high, some.high);
  }
}

}  // namespace
}  // namespace rondure::fit
