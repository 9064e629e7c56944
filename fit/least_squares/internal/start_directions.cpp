#include "fit/least_squares/internal/start_directions.h"

#include <algorithm>
#include <cmath>

#include "core/decompositions.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kLookedAt = 200;  // points of the sample
constexpr int kDirections = 240;        // on the half sphere, some 9 deg apart
constexpr std::size_t kKept = 8;
const double kApart = std::cos(12.0 * core::kDegree);

struct Scored {
  Eigen::Vector3d direction;
  double rms = 0.0;
};

/// Evenly spread directions of the half sphere (Fibonacci spiral) and the three principal axes.
std::vector<Eigen::Vector3d> spread(SpacePoints sample) {
  std::vector<Eigen::Vector3d> out;
  const double golden = core::kTwoPi * (2.0 - (1.0 + std::sqrt(5.0)) / 2.0);
  for (int i = 0; i < kDirections; ++i) {
    const double z = (i + 0.5) / kDirections;
    const double across = std::sqrt(1.0 - z * z);
    out.emplace_back(across * std::cos(golden * i), across * std::sin(golden * i), z);
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : sample) scatter += p * p.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(scatter);
  for (int k = 0; k < 3; ++k) out.emplace_back(principal.eigenvectors().col(k));
  return out;
}

}  // namespace

std::vector<Eigen::Vector3d> start_directions(
    SpacePoints points,
    const std::function<std::optional<double>(SpacePoints, const Eigen::Vector3d&)>& rms) {
  std::vector<Eigen::Vector3d> sample;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kLookedAt);
  for (std::size_t i = 0; i < points.size(); i += stride) sample.push_back(points[i]);

  std::vector<Scored> scored;
  for (const Eigen::Vector3d& direction : spread(sample)) {
    if (const auto residual = rms(sample, direction)) scored.push_back({direction, *residual});
  }
  std::ranges::stable_sort(scored, {}, &Scored::rms);
  std::vector<Eigen::Vector3d> out;
  for (const Scored& candidate : scored) {
    const bool near = std::ranges::any_of(out, [&](const Eigen::Vector3d& d) {
      return std::abs(d.dot(candidate.direction)) > kApart;
    });
    if (!near) out.push_back(candidate.direction);
    if (out.size() == kKept) break;
  }
  return out;
}

}  // namespace rondure::fit
