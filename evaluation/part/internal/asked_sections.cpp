#include "evaluation/part/internal/asked_sections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "evaluation/part/internal/associated.h"
#include "evaluation/part/internal/layout.h"
#include "evaluation/results/internal/deviation.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/sphere.h"

namespace rondure::evaluation {
namespace {

using Indication = record::Indication;

/// Points of one section differ by at most this along the axis (drawing, 1).
constexpr double kThickness = 0.5;
/// Fewest points that show a turn.
constexpr std::size_t kFewestOfATurn = 3;
/// Whatever windows name: nothing rests on points that leave half a turn open (roundness, B.4).
constexpr double kMostOpen = 0.5 * core::kTwoPi - 1e-6;
/// Greatest distance of a point of a face from the circle of its layer [mm].
constexpr double kOffCircle = 0.1;

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

double unseen_of(const PreparedSurface& surface, const fit::Axis& about,
                 std::span<const std::size_t> points, std::span<const std::size_t> windows,
                 std::size_t a_turn) {
  const auto frame = fit::across(about.direction);
  std::vector<Eigen::Vector2d> places;
  for (const std::size_t i : points) {
    places.emplace_back(frame.transpose() * (surface.points_mm[i] - about.point_mm));
  }
  const double open = fit::largest_gap_rad(places, Eigen::Vector2d::Zero());
  if (open >= kMostOpen) return open;
  for (const std::size_t row : windows) {
    places.emplace_back(frame.transpose() * (surface.of->cloud[row].tip_mm - about.point_mm));
  }
  std::vector<double> angles_rad;
  for (const Eigen::Vector2d& q : places) {
    angles_rad.push_back(within_one_turn(std::atan2(q.y(), q.x())));
  }
  return unseen_rad(std::move(angles_rad), a_turn);
}

std::vector<std::size_t> all_points_of(const PreparedSurface& surface) {
  std::vector<std::size_t> out(surface.points_mm.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

std::vector<std::size_t> all_window_rows(const PreparedSurface& surface) {
  std::vector<std::size_t> out;
  for (const LeftOut& left : surface.left_out) {
    if (!left.window.empty() && left.row < surface.of->cloud.size()) out.push_back(left.row);
  }
  return out;
}

double unseen_in_section(const PreparedSurface& surface, const SurfaceSection& section,
                         const fit::Axis& about) {
  if (!surface.as_measured) return 0.0;
  const auto windows = window_rows(surface, section);
  return unseen_of(surface, about, section.points, windows, section.points.size() + windows.size());
}

/// The axis of the circle of a layer of a face. Points along a row, or spread, are on none.
std::optional<fit::Axis> circle_axis(const PreparedSurface& surface,
                                     const SurfaceSection& section) {
  const auto frame = fit::across(surface.axis.direction);
  std::vector<Eigen::Vector2d> places;
  double chord_mm = 0.0;
  for (const std::size_t i : section.points) {
    places.emplace_back(frame.transpose() * (surface.points_mm[i] - surface.axis.point_mm));
    chord_mm = std::max(chord_mm, (places.back() - places.front()).norm());
  }
  if (places.size() < kFewestOfATurn) return std::nullopt;
  const auto circle = fit::ls_circle(places);
  if (!circle || circle->deviation_mm > 2.0 * kOffCircle) return std::nullopt;
  // The circle of a row is so large that no point stands off its chord.
  if (chord_mm * chord_mm < 8.0 * circle->radius_mm * kOffCircle) return std::nullopt;
  return fit::Axis{surface.axis.point_mm + frame * circle->center_mm, surface.axis.direction};
}

/// section_layers counts from the lowest layer; a file may number its layers as it likes.
core::Result<void> check_ascending(const PreparedSurface& surface, const Sections& sections) {
  double up = 1.0;  // of a plane heights are radii
  if (surface.of->feature.shape != record::Shape::kPlane) {
    Eigen::Index largest = 0;
    surface.axis.direction.cwiseAbs().maxCoeff(&largest);
    up = surface.axis.direction[largest] < 0.0 ? -1.0 : 1.0;
    const bool touched = surface.of->feature.strategy != record::Strategy::kPointsFile;
    if (touched && surface.axis.direction.dot(surface.of->part_turn.col(2)) < 0.0) up = -1.0;
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
  TRY_DO(check_ascending(surface, all));
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
  TRY(const auto profile, fit::ordered_profile(theta_rad, r_mm));
  if (!is_uniform(profile.theta_rad)) return fit::resampled(profile);
  return fit::ResampledProfile{.profile = {profile.theta_rad.front(), profile.r_mm}};
}

void add_rows(const PreparedSurface& surface, std::span<const std::size_t> points, Finding& out) {
  for (const std::size_t i : points) out.rows.push_back(surface.rows[i]);
}

std::vector<std::size_t> window_rows(const PreparedSurface& surface,
                                     const SurfaceSection& section) {
  const bool layers = has_layers(*surface.of);
  double middle_mm = 0.0;
  for (const std::size_t i : section.points) {
    middle_mm +=
        height_along_mm(surface, surface.points_mm[i]) / static_cast<double>(section.points.size());
  }
  std::vector<std::size_t> out;
  for (const LeftOut& left : surface.left_out) {
    if (left.window.empty() || left.row >= surface.of->cloud.size()) continue;
    const CloudPoint& point = surface.of->cloud[left.row];
    const bool here =
        layers ? point.layer == section.layer
               : std::abs(height_along_mm(surface, point.tip_mm) - middle_mm) <= kThickness;
    if (here) out.push_back(left.row);
  }
  return out;
}

double angle_rad(const PreparedSurface& surface, const Eigen::Vector3d& place_mm) {
  const Eigen::Vector2d q =
      fit::across(surface.axis.direction).transpose() * (place_mm - surface.axis.point_mm);
  return std::atan2(q.y(), q.x());
}

double unseen_in(const PreparedSurface& surface, const SurfaceSection& section) {
  return unseen_in_section(surface, section, surface.axis);
}

std::optional<core::Phrase> unseen_part(const PreparedSurface& surface,
                                        std::span<const SurfaceSection> sections,
                                        const fit::Axis& about) {
  for (const SurfaceSection& section : sections) {
    if (section.points.size() < kFewestOfATurn) {
      return core::phrase(
          "layer {} has {} points, a turn needs at least {}: touch more there, or leave the layer "
          "out",
          section.layer + 1, section.points.size(), kFewestOfATurn);
    }
    const double unseen = unseen_in_section(surface, section, about);
    if (unseen <= 0.0) continue;
    return core::phrase(
        "layer {}: the points leave {:.0f} deg of the turn unseen; measure the whole turn, and "
        "keep what windows and gaps leave open below 180 deg",
        section.layer + 1, core::degrees(unseen));
  }
  return std::nullopt;
}

std::optional<core::Phrase> unseen_turn(const PreparedSurface& surface, const fit::Axis& about) {
  if (!surface.as_measured) return std::nullopt;
  std::size_t a_turn = surface.sections.empty() ? surface.points_mm.size() : 1;
  for (const SurfaceSection& section : surface.sections) {
    a_turn = std::max(a_turn, section.points.size());
  }
  const double unseen =
      unseen_of(surface, about, all_points_of(surface), all_window_rows(surface), a_turn);
  if (unseen <= 0.0) return std::nullopt;
  return unseen_words(unseen);
}

/// A ball is seen where its points reach round it as far as a pole and its equator do, less what
/// each point stands for: one of n on half a ball for 2 pi / n. From a smaller cap lobes turn into
/// size, as they do on an arc.
std::optional<core::Phrase> unseen_of_ball(const PreparedSurface& surface) {
  const auto ball = fit::ls_sphere(surface.points_mm);
  if (!surface.as_measured || !ball) return std::nullopt;
  std::vector<Eigen::Vector3d> directions;
  for (const Eigen::Vector3d& p : surface.points_mm) {
    directions.push_back((p - ball->center_mm).normalized());
  }
  // The least ball round directions of less than a half has the radius of their cap's rim.
  const auto rim = associated_sphere(directions, record::Reference::kMinimumCircumscribed);
  const double reach =
      rim && rim->radius_mm < 1.0 ? std::asin(rim->radius_mm) : 0.25 * core::kTwoPi;
  const double needed =
      0.25 * core::kTwoPi - std::acos(1.0 - 1.0 / static_cast<double>(directions.size()));
  if (reach >= needed) return std::nullopt;
  return core::phrase(
      "the points reach {:.0f} deg round one side of the ball, {} points must reach {:.0f} deg: "
      "touch it from its pole to its equator",
      core::degrees(reach), directions.size(), core::degrees(needed));
}

std::optional<core::Phrase> unseen_part(const PreparedSurface& surface) {
  if (surface.of->feature.shape == record::Shape::kSphere) return unseen_of_ball(surface);
  const bool layers = has_layers(*surface.of) && !surface.sections.empty();
  return layers ? unseen_part(surface, surface.sections, surface.axis)
                : unseen_turn(surface, surface.axis);
}

std::optional<core::Phrase> unseen_of_face(const PreparedSurface& surface) {
  if (!surface.as_measured) return std::nullopt;
  for (const SurfaceSection& section : surface.sections) {
    const auto about = circle_axis(surface, section);
    if (!about) continue;
    if (auto why = unseen_part(surface, std::span(&section, 1), *about)) return why;
  }
  // Windows over one side of the face: seen from the middle of what there was to measure.
  const auto windows = all_window_rows(surface);
  if (windows.empty()) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : surface.points_mm) sum += p;
  for (const std::size_t row : windows) sum += surface.of->cloud[row].tip_mm;
  const auto count = static_cast<double>(surface.points_mm.size() + windows.size());
  const auto frame = fit::across(surface.axis.direction);
  std::vector<Eigen::Vector2d> places;
  for (const Eigen::Vector3d& p : surface.points_mm) {
    places.emplace_back(frame.transpose() * (p - sum / count));
  }
  const double open = fit::largest_gap_rad(places, Eigen::Vector2d::Zero());
  if (open < kMostOpen) return std::nullopt;
  return unseen_words(open);
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
