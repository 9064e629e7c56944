#include "fit/least_squares/sections.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/decompositions.h"
#include "core/statistics.h"
#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

constexpr double kNewSection = 0.5;  // mm between neighbouring heights
constexpr double kThickest = 0.5;    // mm; tilts up to 1 deg of a section of 25 mm stay below

core::Result<Section> section_across(SpacePoints layer_mm, const Axis& axis) {
  Section out;
  const auto frame = across(axis.direction);
  for (const Eigen::Vector3d& p : layer_mm) {
    out.points_mm.emplace_back(frame.transpose() * (p - axis.point_mm));
    out.heights_mm.push_back((p - axis.point_mm).dot(axis.direction));
  }
  TRY(const auto circle, ls_circle(out.points_mm));
  const double thickness = extremes_of(out.heights_mm, [](double h) { return h; }).width();
  if (thickness > kThickest) {
    return core::fail_with(core::Code::kSampling,
                           "its points spread {:.3f} mm along the axis, a section at most {:g} mm: "
                           "measure layers square to the axis",
                           thickness, kThickest);
  }
  out.circle = circle;
  out.center_mm =
      axis.point_mm + frame * circle.center_mm + core::mean(out.heights_mm) * axis.direction;
  return out;
}

}  // namespace

core::Result<std::vector<Section>> sections_across(Layers layers_mm, const Axis& axis) {
  if (layers_mm.empty()) {
    return core::fail(core::Code::kNoPoints, "there is no layer; sections need at least one");
  }
  std::vector<Section> out;
  for (std::size_t i = 0; i < layers_mm.size(); ++i) {
    auto section = section_across(layers_mm[i], axis);
    if (!section) {
      return core::fail_with(section.error().code, "layer {}: {}", i, section.error().what);
    }
    out.push_back(std::move(*section));
  }
  return out;
}

std::vector<std::vector<std::size_t>> rows_by_height(SpacePoints points_mm, const Axis& axis) {
  std::vector<std::size_t> order(points_mm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto height = [&](std::size_t row) {
    return (points_mm[row] - axis.point_mm).dot(axis.direction);
  };
  std::ranges::stable_sort(order, {}, height);
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || height(order[i]) - height(order[i - 1]) > kNewSection) out.emplace_back();
    out.back().push_back(order[i]);
  }
  for (auto& rows : out) std::ranges::sort(rows);
  return out;
}

std::optional<Eigen::Vector3d> layer_normal(SpacePoints points_mm, std::span<const int> layers) {
  // Of a round section the two greater extents are alike, and the least is that of the heights.
  constexpr double kFlat = 0.05;
  std::map<int, std::vector<Eigen::Vector3d>> parted;
  for (std::size_t i = 0; i < points_mm.size(); ++i) parted[layers[i]].push_back(points_mm[i]);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& [layer, points] : parted) {
    const Eigen::Vector3d mean = mean_point(points);
    for (const Eigen::Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(scatter);
  const Eigen::Vector3d& extents = principal.eigenvalues();
  if (!(extents(0) <= kFlat * extents(1) && extents(1) >= kFlat * extents(2))) return std::nullopt;
  return Eigen::Vector3d(principal.eigenvectors().col(0));
}

std::vector<Eigen::Vector3d> median_line(std::span<const Section> sections) {
  std::vector<Eigen::Vector3d> out;
  for (const Section& section : sections) out.push_back(section.center_mm);
  return out;
}

}  // namespace rondure::fit
