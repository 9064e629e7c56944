#include "core/shortest_turn.h"

#include <gtest/gtest.h>

namespace rondure::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(ShortestTurn, IsTheFormulaOfRodrigues) {
  std::srand(1);
  for (int k = 0; k < 20000; ++k) {
    const Vector3d from = k % 3 == 0 ? Vector3d(Vector3d::UnitZ()) : Vector3d(Vector3d::Random());
    Vector3d to = Vector3d::Random();
    if (k % 4 == 1) to = from + 1e-6 * Vector3d::Random();
    if (k % 4 == 2) to = -from + 1e-4 * Vector3d::Random();
    // I + [v] + [v]^2 / (1 + cos), v = a x b: the last term is v v^T (1 - cos) / sin^2 too.
    const Vector3d a = from.normalized();
    const Vector3d b = to.normalized();
    const Vector3d v = a.cross(b);
    const double far = 1.0 + a.dot(b);  // from opposite directions
    Matrix3d turn = Matrix3d::Identity() * a.dot(b) + v * v.transpose() / far;
    for (int i = 0; i < 3; ++i) turn.col(i) += v.cross(Vector3d(Vector3d::Unit(i)));
    EXPECT_LT((shortest_turn(from, to) - turn).norm(), 2e-15 / far) << k;
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
