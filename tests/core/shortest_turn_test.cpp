#include "core/shortest_turn.h"

#include <gtest/gtest.h>

namespace rondure::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(ShortestTurn, HasTheBitsOfEigen) {
  std::srand(1);
  for (int k = 0; k < 20000; ++k) {
    const Vector3d from = k % 3 == 0 ? Vector3d(Vector3d::UnitZ()) : Vector3d(Vector3d::Random());
    Vector3d to = Vector3d::Random();
    if (k % 4 == 1) to = from + 1e-6 * Vector3d::Random();
    if (k % 4 == 2) to = -from + 1e-4 * Vector3d::Random();
    EXPECT_EQ(shortest_turn(from, to),
              Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix());
  }
}

TEST(ShortestTurn, TurnsHalfRoundBetweenOppositeDirections) {
  EXPECT_EQ(shortest_turn(Vector3d::UnitZ(), -Vector3d::UnitZ()),
            Matrix3d(Vector3d(1, -1, -1).asDiagonal()));
  std::srand(2);
  for (int k = 0; k < 300; ++k) {
    const Vector3d from =
        k == 0 ? Vector3d(Vector3d::UnitY()) : Vector3d(Vector3d::Random().normalized());
    // Opposite, or beside it by less than a urad.
    const Vector3d to = (-from + (k % 3) * 3e-7 * Vector3d::Random()).normalized();
    const Matrix3d turn = shortest_turn(from, 3.0 * to);
    EXPECT_LT((turn * from - to).norm(), 1e-15);
    EXPECT_LT((turn * turn.transpose() - Matrix3d::Identity()).norm(), 4e-15);
    EXPECT_NEAR(turn.determinant(), 1.0, 4e-15);
  }
}

}  // namespace
}  // namespace rondure::core
