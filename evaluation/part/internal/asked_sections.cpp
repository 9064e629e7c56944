#include "evaluation/part/internal/asked_sections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "evaluation/results/internal/deviation.h"

namespace rondure::evaluation {
namespace {

using Indication = record::Indication;

/// Points of one section differ by at most this along the axis (drawing, 1).
constexpr double kThickness = 0.5;

double height_along_mm(const PreparedSurface& surface, const Eigen::Vector3d& place_mm) {
  return (place_mm - surface.axis.point_mm).dot(surface.axis.direction);
}

double within_one_turn(double angle_rad) {
  const double angle = std::fmod(angle_rad, core::kTwoPi);
  return angle < 0.0 ? angle + core::kTwoPi : angle;
}

/// Whether sorted angles are those of equal steps. The circle of a lobed section lies beside the
/// centre of its scan by the square of the lobes over the radius, which turns equal steps by much
/// less than this; circumference, area and two-point sizes change by the square of that.
bool is_uniform(std::span<const double> theta_rad) {
  const double step = core::kTwoPi / static_cast<double>(theta_rad.size());
  constexpr double kOfAStep = 1e-3;
  for (std::size_t i = 0; i < theta_rad.size(); ++i) {
    const double even = theta_rad.front() + static_cast<double>(i) * step;
    if (std::abs(theta_rad[i] - even) > kOfAStep * step) return false;
  }
  return true;
}

double unseen_of(const PreparedSurface& surface, std::span<const std::size_t> points,
                 std::span<const std::size_t> windows, std::size_t a_turn) {
  std::vector<double> angles_rad;
  for (const std::size_t i : points) {
    angles_rad.push_back(within_one_turn(angle_rad(surface, surface.points_mm[i])));
  }
  for (const std::size_t row : windows) {
    angles_rad.push_back(within_one_turn(angle_rad(surface, surface.of->cloud[row].tip_mm)));
  }
  return unseen_rad(std::move(angles_rad), a_turn);
}

/// section_layers counts from the lowest layer; a file may number its layers as it likes.
core::Result<void> check_ascending(const PreparedSurface& surface, const Sections& sections) {
  double up = 1.0;  // of a plane heights are radii
  if (surface.of->feature.shape != record::Shape::kPlane) {
    Eigen::Index largest = 0;
    surface.axis.direction.cwiseAbs().maxCoeff(&largest);
    up = surface.axis.direction[largest] < 0.0 ? -1.0 : 1.0;
  }
  for (std::size_t i = 1; i < sections.size(); ++i) {
    const SurfaceSection& below = sections[i - 1];
    const SurfaceSection& above = sections[i];
    if (below.layer == above.layer || up * above.height_mm > up * below.height_mm) continue;
    return core::fail(
        core::Code::kMeaning,
        core::phrase("section_layers counts from the lowest layer, but layer {} lies below layer "
                     "{}: number the layers of the file upwards",
                     above.layer + 1, below.layer + 1));
  }
  return {};
}

}  // namespace

core::Result<Sections> asked_sections(const PreparedSurface& surface,
                                      const Indication& indication) {
  Sections all = surface.sections;
  std::erase_if(all, [](const SurfaceSection& section) { return section.points.empty(); });
  if (all.empty() && surface.of->feature.shape == record::Shape::kCircle) {
    SurfaceSection section;
    section.points.resize(surface.points_mm.size());
    std::iota(section.points.begin(), section.points.end(), std::size_t{0});
    all.push_back(std::move(section));
  }
  if (all.empty()) {
    return core::fail(core::Code::kSampling,
                      core::phrase("the points form no sections; give the file a column layer"));
  }
  if (indication.section != Indication::Section::kSCS) return all;
  if (auto ascend = check_ascending(surface, all); !ascend) return core::fail(ascend.error());
  Sections out;
  for (const double number : indication.section_layers) {
    const auto found = std::ranges::find_if(
        all, [&](const SurfaceSection& section) { return section.layer + 1 == number; });
    if (found == all.end()) {
      return core::fail(core::Code::kRank,
                        core::phrase("section_layers names layer {:g}, of which no points are "
                                     "left; name one of the layers {} to {}",
                                     number, all.front().layer + 1, all.back().layer + 1));
    }
    out.push_back(*found);
  }
  if (!out.empty()) return out;
  return core::fail(core::Code::kMeaning,
                    core::phrase("section SCS needs section_layers, the layers that it is of"));
}

Sections by_pass(const PreparedSurface& surface, const SurfaceSection& section) {
  std::map<std::optional<int>, SurfaceSection> passes;
  for (const std::size_t i : section.points) {
    const std::size_t row = surface.rows[i];
    const auto pass =
        row < surface.of->cloud.size() ? surface.of->cloud[row].pass : std::optional<int>();
    const auto [one, is_new] = passes.try_emplace(pass, section);
    if (is_new) one->second.points.clear();
    one->second.points.push_back(i);
  }
  Sections out;
  for (auto& [pass, one] : passes) out.push_back(std::move(one));
  return out;
}

core::Result<std::vector<fit::Section>> projected(const PreparedSurface& surface,
                                                  std::span<const SurfaceSection> of) {
  std::vector<fit::Section> out;
  for (const SurfaceSection& section : of) {
    std::vector<Eigen::Vector3d> points;
    for (const std::size_t i : section.points) points.push_back(surface.points_mm[i]);
    if (points.size() < 3) {
      return core::fail(core::Code::kTooFewPoints,
                        core::phrase("layer {} has {} points, and a circle needs at least 3: touch "
                                     "more",
                                     section.layer + 1, points.size()));
    }
    auto one = fit::sections_across(std::span(&points, 1), surface.axis);
    if (!one) return core::fail(in_layer(section, one.error()));
    out.push_back(std::move(one->front()));
  }
  return out;
}

core::Result<fit::ResampledProfile> section_profile(const fit::Section& section) {
  std::vector<double> theta_rad;
  std::vector<double> r_mm;
  for (const Eigen::Vector2d& p : section.points_mm) {
    const Eigen::Vector2d v = p - section.circle.center_mm;
    theta_rad.push_back(std::atan2(v.y(), v.x()));
    r_mm.push_back(v.norm());
  }
  const auto profile = fit::ordered_profile(theta_rad, r_mm);
  if (!profile) return core::fail(profile.error());
  if (!is_uniform(profile->theta_rad)) return fit::resampled(*profile);
  return fit::ResampledProfile{.profile = {profile->theta_rad.front(), profile->r_mm}};
}

void add_rows(const PreparedSurface& surface, std::span<const std::size_t> points, Finding& out) {
  for (const std::size_t i : points) out.rows.push_back(surface.rows[i]);
}

std::vector<std::size_t> window_rows(const PreparedSurface& surface,
                                     const SurfaceSection& section) {
  double middle_mm = 0.0;
  for (const std::size_t i : section.points) {
    middle_mm +=
        height_along_mm(surface, surface.points_mm[i]) / static_cast<double>(section.points.size());
  }
  std::vector<std::size_t> out;
  for (const LeftOut& left : surface.left_out) {
    if (left.window.empty() || left.row >= surface.of->cloud.size()) continue;
    const double height = height_along_mm(surface, surface.of->cloud[left.row].tip_mm);
    if (std::abs(height - middle_mm) <= kThickness) out.push_back(left.row);
  }
  return out;
}

double angle_rad(const PreparedSurface& surface, const Eigen::Vector3d& place_mm) {
  const Eigen::Vector2d q =
      fit::across(surface.axis.direction).transpose() * (place_mm - surface.axis.point_mm);
  return std::atan2(q.y(), q.x());
}

double unseen_in(const PreparedSurface& surface, const SurfaceSection& section) {
  const auto windows = window_rows(surface, section);
  return unseen_of(surface, section.points, windows, section.points.size() + windows.size());
}

double unseen_in(const PreparedSurface& surface) {
  std::vector<std::size_t> points(surface.points_mm.size());
  std::iota(points.begin(), points.end(), std::size_t{0});
  std::vector<std::size_t> windows;
  for (const LeftOut& left : surface.left_out) {
    if (!left.window.empty() && left.row < surface.of->cloud.size()) windows.push_back(left.row);
  }
  std::size_t a_turn = surface.sections.empty() ? points.size() : 1;
  for (const SurfaceSection& section : surface.sections) {
    a_turn = std::max(a_turn, section.points.size());
  }
  return unseen_of(surface, points, windows, a_turn);
}

core::Phrase of_sections(const core::Phrase& what, const Indication& indication) {
  if (indication.section == Indication::Section::kAll) return what;
  if (indication.section == Indication::Section::kACS) {
    return core::phrase("{} of any section", what);
  }
  std::string layers;
  for (const double layer : indication.section_layers) {
    layers += fmt::format("{}{:g}", layers.empty() ? "" : ", ", layer);
  }
  return core::phrase("{} of section {}", what, layers);
}

core::Error in_layer(const SurfaceSection& section, const core::Error& error) {
  return core::error_of(error.code, core::phrase("layer {}: {}", section.layer + 1, error.said()));
}

}  // namespace rondure::evaluation
