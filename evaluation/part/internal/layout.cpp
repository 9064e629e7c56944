#include "evaluation/part/internal/layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "core/phrase.h"
#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/part/internal/sections.h"
#include "evaluation/part/internal/windows.h"
#include "evaluation/part/outliers.h"
#include "evaluation/part/place.h"
#include "evaluation/results/measured_cloud.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/cone.h"
#include "fit/least_squares/sections.h"
#include "fit/least_squares/sphere.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

using record::Shape;
using record::SurfaceSettings;
using record::WindowTask;
using SurfacePoints = std::vector<Eigen::Vector3d>;

constexpr double kThickestMm = 0.5;
constexpr double kGuardMm = 0.5;
/// An axis that leans more (60 deg) has no angle about part z.
constexpr double kLeastUpright = 0.5;
/// The windows move the axis, and the axis the angles; two or three rounds settle.
constexpr int kMostRounds = 8;

core::Error said(core::Code code, core::Phrase what) { return error_of(code, std::move(what)); }

bool is_touched(const record::Feature& feature) {
  return feature.strategy != record::Strategy::kPointsFile;
}

/// Whether the sections of a shape are square to its axis.
bool is_turned(Shape shape) {
  return shape == Shape::kCylinder || shape == Shape::kCircle || shape == Shape::kCone;
}

SurfacePoints chosen_points(const SurfacePoints& tips, const std::vector<bool>& chosen) {
  SurfacePoints out;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    if (chosen[i]) out.push_back(tips[i]);
  }
  return out;
}

/// Builds the layout of one surface, step by step.
class LayoutBuilder {
 public:
  LayoutBuilder(const FeatureResult& feature, SurfaceSettings settings)
      : feature_(feature),
        settings_(std::move(settings)),
        tips_(tips_of(feature.cloud)),
        to_part_(feature.part_turn.transpose()),
        guard_mm_(kGuardMm + feature.tip_radius_mm.value_or(0.0)) {
    out_.kept.assign(tips_.size(), true);
  }

  core::Result<SurfaceLayout> build() {
    for (const WindowTask& window : settings_.exclude) {
      TRY_DO(check_window(window));
    }
    TRY_DO(find_axis());
    find_sections();
    TRY_DO(leave_out_found());
    for (std::size_t row = 0; row < tips_.size(); ++row) {
      if (!out_.kept[row]) out_.windows.push_back({row, window_of_[row]});
    }
    TRY_DO(take_windows_from_sections());
    TRY_DO(check_thickness());
    TRY_DO(find_outliers());
    return std::move(out_);
  }

  /// The places about the axis of the points that take part.
  std::vector<PlaceOnPart> places() {
    std::vector<PlaceOnPart> out;
    if (tips_.empty()) return out;
    for (std::size_t row = 0; row < tips_.size(); ++row)
      out_.kept[row] = !feature_.cloud[row].left_out;
    find_heights();
    const auto axis = axis_of_kept();
    if (!axis) return out;
    place(*axis);
    if (leans_) return out;
    for (const PartPlace& at : places_) {
      out.push_back({at.angle_rad < 0.0 ? at.angle_rad + core::kTwoPi : at.angle_rad,
                     out_.no_heights ? std::nullopt : std::optional(at.z_mm)});
    }
    return out;
  }

 private:
  [[nodiscard]] Shape shape() const { return feature_.feature.shape; }

  /// Start direction of the fit; of a plane the side to which it faces.
  [[nodiscard]] std::optional<Eigen::Vector3d> near() const {
    if (feature_.ls_cylinder) return feature_.ls_cylinder->axis.direction;
    if (shape() != Shape::kPlane || !settings_.faces) return std::nullopt;
    const double up = *settings_.faces == record::Faces::kUp ? 1.0 : -1.0;
    return to_part_.transpose() * Eigen::Vector3d(0.0, 0.0, up);
  }

  core::Result<fit::Axis> axis_of_kept() const {
    const bool all = std::find(out_.kept.begin(), out_.kept.end(), false) == out_.kept.end();
    if (all && feature_.ls_cylinder) return feature_.ls_cylinder->axis;
    TRY(const auto fit,
        fitted(feature_, chosen_points(tips_, out_.kept), near(), Deviations::kSkip));
    return fit.axis;
  }

  /// Places of all points about an axis.
  void place(const fit::Axis& axis) {
    fit::Axis in_part{to_part_ * axis.point_mm, to_part_ * axis.direction};
    if (!is_turned(shape())) in_part.direction = Eigen::Vector3d::UnitZ();
    if (shape() == Shape::kPlane) in_part.point_mm = to_part_ * fit::mean_point(tips_);
    const Eigen::Vector3d& w = in_part.direction;
    if (std::abs(w.z()) < kLeastUpright) {
      leans_ = said(core::Code::kMeaning,
                    core::phrase("the axis leans {:.1f} deg from part z, about which windows and "
                                 "portions are stated; turn the data so that the axis is near z",
                                 std::acos(std::abs(w.z())) / core::kDegree));
      out_.no_heights = leans_;
    }
    places_.clear();
    for (const Eigen::Vector3d& tip : tips_) {
      const Eigen::Vector3d q = to_part_ * tip;
      const double up = leans_ ? 0.0 : (q.z() - in_part.point_mm.z()) / w.z();
      const Eigen::Vector3d v = q - in_part.point_mm - up * w;
      const double radius =
          is_turned(shape()) ? fit::distance_mm(in_part, q) : std::hypot(v.x(), v.y());
      places_.push_back({std::atan2(v.y(), v.x()),
                         shape() == Shape::kPlane ? radius : q.z() + first_layer_mm_, radius});
    }
  }

  /// Shift from machine z to part z, by the nominal height of the lowest layer.
  void find_heights() {
    if (!is_touched(feature_.feature) || shape() == Shape::kPlane) return;
    if (!settings_.first_layer_mm) {
      out_.no_heights =
          said(core::Code::kMeaning,
               core::phrase("the nominal height of the lowest layer is not recorded, so that "
                            "windows and portions along part z have no place"));
      return;
    }
    int lowest = feature_.cloud.front().layer;
    for (const CloudPoint& point : feature_.cloud) lowest = std::min(lowest, point.layer);
    std::vector<double> heights;
    for (const CloudPoint& point : feature_.cloud) {
      if (point.layer == lowest) heights.push_back((to_part_ * point.tip_mm).z());
    }
    first_layer_mm_ = *settings_.first_layer_mm - core::mean(heights);
  }

  [[nodiscard]] bool is_inside(const WindowTask& window, std::size_t row) const {
    return is_in(window, places_[row], guard_mm_);
  }

  /// The axis of the points outside the windows, and the places about it.
  core::Result<void> find_axis() {
    find_heights();
    for (int round = 0; round < kMostRounds; ++round) {
      TRY(const auto axis, axis_of_kept());
      out_.axis = axis;
      place(axis);
      std::vector<bool> kept(tips_.size(), true);
      window_of_.assign(tips_.size(), {});
      for (const WindowTask& window : settings_.exclude) {
        if (leans_) return core::fail(*leans_);
        if (out_.no_heights && (window.from_mm || window.to_mm)) {
          return core::fail(*out_.no_heights);
        }
        if (window.found_beyond_um) continue;
        for (std::size_t row = 0; row < tips_.size(); ++row) {
          if (!kept[row] || !is_inside(window, row)) continue;
          kept[row] = false;
          window_of_[row] = window.name;
        }
      }
      if (kept == out_.kept) break;
      out_.kept = std::move(kept);
      if (auto left = check_layers_left(); !left) return left;
    }
    return {};
  }

  /// An axis needs two layers.
  core::Result<void> check_layers_left() {
    if (shape() != Shape::kCylinder || !has_layers(feature_)) return {};
    std::map<int, bool> layers;
    for (std::size_t row = 0; row < tips_.size(); ++row) {
      bool& any = layers[feature_.cloud[row].layer];
      any = any || out_.kept[row];
    }
    const auto left =
        std::count_if(layers.begin(), layers.end(), [](const auto& layer) { return layer.second; });
    if (left >= 2) return {};
    if (settings_.exclude.empty()) {
      return core::fail(said(core::Code::kRank,
                             core::phrase("all points lie in one layer, and an axis needs 2: "
                                          "measure more layers, or make the feature a circle")));
    }
    return core::fail(said(core::Code::kRank,
                           core::phrase("the windows leave {} of {} layers; 2 are needed: make "
                                        "them smaller, or plan more layers",
                                        left, layers.size())));
  }

  /// By layer and pass, or by gaps between heights.
  void find_sections() {
    std::vector<SectionRows>& sections = out_.sections;
    const auto& cloud = feature_.cloud;
    if (has_layers(feature_)) {
      std::map<std::pair<int, std::optional<int>>, std::size_t> known;
      for (std::size_t row = 0; row < cloud.size(); ++row)
        known[{cloud[row].layer, cloud[row].pass}];
      for (auto& [place, index] : known) {
        index = sections.size();
        sections.push_back({place.first, place.second, 0.0, {}, false});
      }
      for (std::size_t row = 0; row < cloud.size(); ++row) {
        sections[known.at({cloud[row].layer, cloud[row].pass})].rows.push_back(row);
      }
    } else if (is_turned(shape())) {
      for (auto& rows : fit::rows_by_height(tips_, out_.axis)) {
        sections.push_back({.layer = static_cast<int>(sections.size()), .rows = std::move(rows)});
      }
    }
    for (const PartPlace& place : places_) out_.part_z_mm.push_back(place.z_mm);
    for (SectionRows& section : sections) {
      std::sort(section.rows.begin(), section.rows.end());
      double sum = 0.0;
      for (const std::size_t row : section.rows) sum += places_[row].z_mm;
      section.part_z_mm = sum / static_cast<double>(section.rows.size());
      // A touched layer stands at its planned height, whatever each touch says.
      for (const std::size_t row : section.rows) out_.part_z_mm[row] = section.part_z_mm;
    }
  }

  /// The windows in which only points off the profile are left out.
  core::Result<void> leave_out_found() {
    std::vector<bool> kept = out_.kept;
    for (const WindowTask& window : settings_.exclude) {
      if (!window.found_beyond_um) continue;
      if (out_.sections.empty() || !is_turned(shape())) {
        return core::fail(
            said(core::Code::kMeaning,
                 core::phrase("window {}: found_beyond_um needs sections of a cylinder, a circle "
                              "or a cone; state the window itself",
                              window.name)));
      }
      for (const SectionRows& section : out_.sections) {
        if (auto done = leave_out_found(window, section, kept); !done) return done;
      }
    }
    out_.kept = std::move(kept);
    TRY(out_.axis, axis_of_kept());
    return {};
  }

  core::Result<void> leave_out_found(const WindowTask& window, const SectionRows& section,
                                     std::vector<bool>& kept) {
    std::vector<std::size_t> rows;
    std::vector<bool> inside;
    std::vector<double> angle;
    std::vector<double> r;
    for (const std::size_t row : section.rows) {
      if (!out_.kept[row]) continue;
      rows.push_back(row);
      inside.push_back(is_inside(window, row));
      angle.push_back(places_[row].angle_rad);
      r.push_back(places_[row].radius_mm);
    }
    if (std::find(inside.begin(), inside.end(), true) == inside.end()) return {};
    TRY(const auto off, off_profile(angle, r, inside, *window.found_beyond_um * core::kMicrometre));
    const auto found = std::count(off.begin(), off.end(), true);
    constexpr long kMostShare = 5;  // one in five
    if (kMostShare * found > static_cast<long>(rows.size())) {
      return core::fail(said(
          core::Code::kOutliers,
          core::phrase("window {}: {} of {} points of layer {} lie beyond {:g} um, more than 20 "
                       "%: that is form; state the window itself, without found_beyond_um",
                       window.name, found, rows.size(), section.layer + 1,
                       *window.found_beyond_um)));
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!off[i]) continue;
      kept[rows[i]] = false;
      window_of_[rows[i]] = window.name;
    }
    return {};
  }

  core::Result<void> take_windows_from_sections() {
    for (SectionRows& section : out_.sections) {
      std::vector<std::size_t> rows;
      std::vector<std::size_t> left_out;
      for (const std::size_t row : section.rows) (out_.kept[row] ? rows : left_out).push_back(row);
      section.gap = !rows.empty() && rows.size() < section.rows.size();
      if (rows.empty()) {
        out_.warnings.push_back(
            said(core::Code::kSparse,
                 core::phrase("the windows take all points of layer {}: there is one section less",
                              section.layer + 1)));
      }
      section.rows = std::move(rows);
      section.dense = is_turned(shape()) && carries_lowest_cutoff(points_of(section.rows),
                                                                  out_.axis, points_of(left_out));
    }
    return check_layers_left();
  }

  [[nodiscard]] SurfacePoints points_of(const std::vector<std::size_t>& rows) const {
    SurfacePoints out;
    for (const std::size_t row : rows) out.push_back(tips_[row]);
    return out;
  }

  /// Points of a file without layers that lie at one height nowhere (a helix, a scanner) are a
  /// surface all the same, without sections.
  core::Result<void> check_thickness() {
    if (!is_turned(shape())) return {};
    const bool may_lack = !has_layers(feature_) &&
                          std::ranges::none_of(settings_.exclude, [](const WindowTask& window) {
                            return window.found_beyond_um.has_value();
                          });
    for (const SectionRows& section : out_.sections) {
      if (section.rows.empty()) continue;
      std::vector<double> heights;
      for (const std::size_t row : section.rows) {
        heights.push_back((tips_[row] - out_.axis.point_mm).dot(out_.axis.direction));
      }
      auto done = evaluation::check_thickness(feature_, section.layer, heights);
      if (!done && !may_lack) return done;
      if (!done && !out_.no_sections) out_.no_sections = done.error();
    }
    if (!out_.no_sections) return {};
    out_.sections.clear();
    for (std::size_t row = 0; row < tips_.size(); ++row) out_.part_z_mm[row] = places_[row].z_mm;
    return {};
  }

  core::Result<void> find_outliers() {
    TRY(const auto fit,
        fitted(feature_, chosen_points(tips_, out_.kept), near(), Deviations::kCompute));
    const std::vector<bool> beyond = beyond_five_scales(fit.off_mm);
    if (const auto count = count_of_outliers(beyond); !count) {
      out_.too_many = count.error();
      return {};
    }
    const double middle = core::median(fit.off_mm);
    std::vector<std::pair<double, std::size_t>> far;
    std::size_t i = 0;
    for (std::size_t row = 0; row < tips_.size(); ++row) {
      if (!out_.kept[row]) continue;
      if (beyond[i]) far.emplace_back(fit.off_mm[i] - middle, row);
      ++i;
    }
    std::stable_sort(far.begin(), far.end(), [](const auto& a, const auto& b) {
      return std::abs(a.first) > std::abs(b.first);
    });
    for (const auto& [off, row] : far) {
      out_.outlying.push_back(row);
      out_.off_mm.push_back(off);
    }
    if (out_.no_sections) {
      find_form_of_scatter();
    } else {
      find_form();
    }
    return {};
  }

  /// Where there are no sections, outlying points are neighbours that lie no farther apart than one
  /// and a half times the nearest point, or three of them at one angle.
  void find_form_of_scatter() {
    std::vector<bool> off(tips_.size(), false);
    for (const std::size_t row : out_.outlying) off[row] = true;
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < tips_.size(); ++row) {
      if (out_.kept[row]) rows.push_back(row);
    }
    std::ranges::stable_sort(rows, {}, [&](std::size_t row) { return places_[row].z_mm; });
    /// Visits the points whose height differs by less than `reach`, which a visit may shorten.
    const auto each_near = [&](std::size_t k, const double& reach, const auto& visit) {
      const PartPlace& at = places_[rows[k]];
      const auto look = [&](std::size_t i) {
        const PartPlace& p = places_[rows[i]];
        const double up_mm = p.z_mm - at.z_mm;
        if (std::abs(up_mm) > reach) return false;
        const double turn_rad = std::remainder(p.angle_rad - at.angle_rad, core::kTwoPi);
        visit(rows[i], std::hypot(up_mm, turn_rad * at.radius_mm));
        return true;
      };
      for (std::size_t i = k + 1; i < rows.size() && look(i); ++i) {
      }
      for (std::size_t i = k; i > 0 && look(i - 1); --i) {
      }
    };
    constexpr double kBeside = 1.5;
    std::vector<std::pair<double, double>> angles;  // with how far one angle reaches
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (!off[rows[k]]) continue;
      double nearest_mm = HUGE_VAL;
      each_near(k, nearest_mm,
                [&](std::size_t, double apart_mm) { nearest_mm = std::min(nearest_mm, apart_mm); });
      const double reach_mm = kBeside * nearest_mm;
      bool beside = false;
      each_near(k, reach_mm, [&](std::size_t row, double apart_mm) {
        beside = beside || (off[row] && apart_mm <= reach_mm);
      });
      const PartPlace& at = places_[rows[k]];
      for (const double turn : {0.0, core::kTwoPi})
        angles.emplace_back(at.angle_rad + turn, reach_mm / at.radius_mm);
      if (beside) return say_form_of_scatter(at);
    }
    std::ranges::sort(angles);
    for (std::size_t i = 0; i + 2 < angles.size(); ++i) {
      if (angles[i + 2].first - angles[i].first <= angles[i].second)
        return say_form_of_scatter({angles[i].first, 0.0, 0.0});
    }
  }

  void say_form_of_scatter(const PartPlace& at) {
    out_.form = said(
        core::Code::kOutliers,
        core::phrase("points next to each other, or one above the other, at {:.1f} deg lie more "
                     "than five robust scales off: neighbours are form, and the outlier rule takes "
                     "out single points only; leave outliers out, or state a window",
                     core::degrees(std::remainder(at.angle_rad, core::kTwoPi))));
  }

  /// Outlying points that are neighbours round a section or one above the other are form: a dent, a
  /// burr, a raised spot, a step, a groove. Points that missed the surface stand alone.
  void find_form() {
    std::vector<bool> off(tips_.size(), false);
    for (const std::size_t row : out_.outlying) off[row] = true;
    std::vector<OutlyingPoint> far;
    for (const SectionRows& section : out_.sections) {
      std::vector<std::size_t> rows = section.rows;
      std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
        return places_[a].angle_rad < places_[b].angle_rad;
      });
      std::vector<bool> by_angle;
      for (const std::size_t row : rows) {
        by_angle.push_back(off[row]);
        const double spacing_rad = core::kTwoPi / static_cast<double>(rows.size());
        if (off[row]) far.push_back({places_[row].angle_rad, spacing_rad, &section});
      }
      const std::size_t run = longest_run(by_angle);
      if (run <= 1 && (run == 0 || run < rows.size())) continue;
      out_.form = said(
          core::Code::kOutliers,
          core::phrase("{} of {} points of layer {}, next to each other, lie more than five robust "
                       "scales off: neighbours are form, and the outlier rule takes out single "
                       "points only; leave outliers out, or state a window",
                       run, rows.size(), section.layer + 1));
      return;
    }
    find_groove(std::move(far));
  }

  struct OutlyingPoint {
    double angle_rad = 0.0;
    double spacing_rad = 0.0;  ///< Between the points of its section.
    const SectionRows* section = nullptr;
  };

  void find_groove(std::vector<OutlyingPoint> far) {
    std::sort(far.begin(), far.end(), [](const OutlyingPoint& a, const OutlyingPoint& b) {
      return a.angle_rad < b.angle_rad;
    });
    const std::size_t count = far.size();
    for (std::size_t i = 0; i < count; ++i) {  // once more round: a groove may lie at the seam
      far.push_back(far[i]);
      far.back().angle_rad += core::kTwoPi;
    }
    for (std::size_t i = 0; i < count; ++i) {
      // Of layers that are not aligned the nearest point is up to half a step away.
      const double end_rad = far[i].angle_rad + 0.75 * far[i].spacing_rad;
      std::set<int> layers;
      for (std::size_t k = i; k < i + count && far[k].angle_rad <= end_rad; ++k) {
        if (far[k].section->pass == far[i].section->pass) layers.insert(far[k].section->layer);
      }
      const auto apart = [](int a, int b) { return b - a == 1; };
      if (std::adjacent_find(layers.begin(), layers.end(), apart) == layers.end()) continue;
      out_.form = said(
          core::Code::kOutliers,
          core::phrase("points of {} layers, one above the other at {:.1f} deg, lie more than five "
                       "robust scales off: neighbours are form, and the outlier rule takes out "
                       "single points only; leave outliers out, or state a window",
                       layers.size(), core::degrees(far[i].angle_rad)));
      return;
    }
  }

  const FeatureResult& feature_;
  SurfaceSettings settings_;
  SurfacePoints tips_;
  Eigen::Matrix3d to_part_;
  double guard_mm_;
  double first_layer_mm_ = 0.0;  ///< Added to machine z.
  std::vector<PartPlace> places_;
  std::optional<core::Error> leans_;
  std::vector<std::string> window_of_;  ///< By row; empty outside.
  SurfaceLayout out_;
};

}  // namespace

bool has_layers(const FeatureResult& feature) {
  const auto& cloud = feature.cloud;
  return feature.feature.layers > 0 || feature.feature.shape == Shape::kCircle ||
         std::any_of(cloud.begin(), cloud.end(),
                     [&](const CloudPoint& point) { return point.layer != cloud.front().layer; });
}

core::Result<FittedSurface> fitted(const FeatureResult& feature,
                                   std::span<const Eigen::Vector3d> points_mm,
                                   const std::optional<Eigen::Vector3d>& near,
                                   Deviations deviations) {
  FittedSurface out;
  const auto fill = [&](const auto& off) {
    if (deviations == Deviations::kSkip) return;
    out.off_mm.reserve(points_mm.size());
    for (const Eigen::Vector3d& p : points_mm) out.off_mm.push_back(off(p));
  };
  const auto from_axis = [&](const Eigen::Vector3d& p) { return fit::distance_mm(out.axis, p); };
  switch (feature.feature.shape) {
    case Shape::kCylinder: {
      TRY(const auto cylinder, fit::ls_cylinder(points_mm, near));
      out.axis = cylinder.axis;
      fill(from_axis);
      return out;
    }
    case Shape::kCircle: {
      const fit::Axis& up = feature.section_axis;
      const auto frame = fit::across(up.direction);
      std::vector<Eigen::Vector2d> plane;
      for (const Eigen::Vector3d& p : points_mm) {
        plane.emplace_back(frame.transpose() * (p - up.point_mm));
      }
      TRY(const auto circle, fit::ls_circle(plane));
      out.axis = {up.point_mm + frame * circle.center_mm, up.direction};
      fill(from_axis);
      return out;
    }
    case Shape::kPlane: {
      TRY(const auto plane, fit::ls_plane(points_mm, near));
      out.axis = {plane.plane.point_mm, plane.plane.normal};
      fill([&](const Eigen::Vector3d& p) { return fit::height_mm(plane.plane, p); });
      return out;
    }
    case Shape::kSphere: {
      TRY(const auto sphere, fit::ls_sphere(points_mm));
      out.axis = {sphere.center_mm, feature.part_turn.col(2)};
      fill([&](const Eigen::Vector3d& p) { return (p - sphere.center_mm).norm(); });
      return out;
    }
    case Shape::kCone: {
      TRY(const auto cone, fit::ls_cone(points_mm, near));
      out.axis = cone.cone.axis;
      fill([&](const Eigen::Vector3d& p) { return cone.cone.deviation_mm(p); });
      return out;
    }
    case Shape::kSpindle:
    case Shape::kWheel:
    case Shape::kContour:
    case Shape::kRotaryAxes:
    case Shape::kFiveAxis:
      break;
  }
  return core::fail(
      said(core::Code::kMeaning, core::phrase("characteristics of a {} are not computed; make the "
                                              "feature a cylinder, a circle, a plane or a sphere",
                                              std::string(name_of(feature.feature.shape)))));
}

core::Result<void> check_thickness(const FeatureResult& feature, int layer,
                                   std::span<const double> heights_mm) {
  const auto [low, high] = std::minmax_element(heights_mm.begin(), heights_mm.end());
  if (*high - *low <= kThickestMm || stated_plane(feature.feature) == "nominal") return {};
  const core::Phrase cure =
      feature.feature.shape == Shape::kCircle ? core::phrase("give the points of one section")
      : has_layers(feature) ? core::phrase("give each section its own number in the column layer")
                            : core::phrase("give the file a column layer");
  return core::fail(
      said(core::Code::kSampling,
           core::phrase("section {} is {:.3f} mm thick: points of one section differ by at most "
                        "{:g} mm along the axis; {}",
                        layer + 1, *high - *low, kThickestMm, cure)));
}

std::vector<PlaceOnPart> places_on_part(const FeatureResult& feature) {
  const auto settings = record::task_of<SurfaceSettings>(feature.feature.settings);
  return settings ? LayoutBuilder(feature, *settings).places() : std::vector<PlaceOnPart>();
}

SurfaceLayout layout_of(const FeatureResult& feature) {
  SurfaceLayout out;
  const auto settings = record::task_of<SurfaceSettings>(feature.feature.settings);
  if (feature.failure) {
    out.failure = feature.failure;
  } else if (feature.cloud.empty()) {
    out.failure = said(core::Code::kNoPoints, core::phrase("the feature has no points"));
  } else if (!settings) {
    out.failure = settings.error();
  } else {
    auto built = LayoutBuilder(feature, *settings).build();
    if (built) return *std::move(built);
    out.failure = built.error();
  }
  return out;
}

}  // namespace rondure::evaluation
