#include <algorithm>
#include <cmath>
#include <utility>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/part/internal/datum.h"
#include "evaluation/part/internal/families.h"
#include "fit/datums/datum.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/sections.h"
#include "record/tasks/form_facts.h"

namespace rondure::evaluation {
namespace {

using record::Form;
using record::Shape;

/// The extracted median line: centres of sections square to the axis of the feature itself.
struct MedianLine {
  std::vector<SurfaceSection> sections;
  std::vector<Eigen::Vector3d> centers_mm;
};

tl::unexpected<core::Error> of_feature(const PreparedSurface& surface, const core::Error& why) {
  return core::fail(why.code, core::phrase("{}: {}", surface.of->feature.id, why.said()));
}

core::Result<MedianLine> median_line_of(const PreparedSurface& surface,
                                        const record::Indication& asked) {
  const bool fixed = asked.section == record::Indication::Section::kSCS;
  MedianLine out;
  std::vector<std::vector<Eigen::Vector3d>> layers;
  const auto all = layers_of(surface);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double layer = surface.sections[i].layer + 1.0;
    const bool named = std::ranges::find(asked.section_layers, layer) != asked.section_layers.end();
    if (fixed && !named) continue;
    out.sections.push_back(surface.sections[i]);
    layers.push_back(all[i]);
  }
  for (const double layer : asked.section_layers) {
    const auto is_it = [&](const SurfaceSection& section) { return section.layer + 1.0 == layer; };
    if (!fixed || std::ranges::any_of(out.sections, is_it)) continue;
    return core::fail(core::Code::kSampling,
                      core::phrase("layer {:g} of section_layers has no points; {} has {} layers",
                                   layer, surface.of->feature.id, layers_in(surface.sections)));
  }
  if (layers.empty()) {
    return core::fail(core::Code::kSampling,
                      core::phrase("the points of {} fall into no sections: give the file a column "
                                   "\"layer\"",
                                   surface.of->feature.id));
  }
  const auto sections = fit::sections_across(layers, surface.axis);
  if (!sections) return of_feature(surface, sections.error());
  out.centers_mm = fit::median_line(*sections);
  return out;
}

core::Result<void> check_direction(const PreparedSurface& surface, const MedianLine& line) {
  const std::size_t count = layers_in(line.sections);
  if (count > 1) return {};
  return core::fail(core::Code::kRank,
                    core::phrase("{} section of {} gives no direction; plan at least 2 layers, or "
                                 "ask for concentricity",
                                 count, surface.of->feature.id));
}

bool has_axis(const PreparedSurface& surface) {
  const Shape shape = surface.of->feature.shape;
  return shape == Shape::kCylinder || shape == Shape::kCircle;
}

tl::unexpected<core::Error> not_of_shape(const PreparedSurface& surface,
                                         const record::Characteristic& asked) {
  return core::fail(
      core::Code::kMeaning,
      core::phrase("{} is not that of a {}: ask it of a cylinder or of a plane",
                   record::name_of(asked.form), record::name_of(surface.of->feature.shape)));
}

void add_value(const record::Characteristic& asked, double value_mm, bool diameter,
               Finding& finding) {
  std::string symbol(record::facts_of(asked.form).symbol);
  if (diameter) symbol += " \u00d8";
  finding.judged.push_back({std::move(symbol), value_mm, limits_of(asked)});
}

/// Coaxiality, concentricity: the section centre that lies farthest from the datum axis.
core::Result<Finding> find_place(const PreparedSurface& surface,
                                 const record::Characteristic& asked,
                                 std::span<const DatumResult> datums) {
  if (!has_axis(surface)) {
    return core::fail(
        core::Code::kMeaning,
        core::phrase("{} is that of an axis, a {} has none: ask for run-out or "
                     "perpendicularity",
                     record::name_of(asked.form), record::name_of(surface.of->feature.shape)));
  }
  const auto datum = datum_axis_of(datums, asked);
  if (!datum) return core::fail(datum.error());
  auto line = median_line_of(surface, asked.indication);
  if (!line) return core::fail(line.error());
  if (asked.form == Form::kCoaxiality) {
    if (auto enough = check_direction(surface, *line); !enough) return core::fail(enough.error());
  }
  const auto value = fit::coaxiality_mm(line->centers_mm, datum->place);
  if (!value) return of_feature(surface, value.error());
  Finding out = found_about(surface, datums, *datum);
  add_value(asked, *value, true, out);
  for (std::size_t i = 0; i < line->sections.size(); ++i) {
    const SurfaceSection& section = line->sections[i];
    out.local.push_back({LocalValue::Place::kLayer, section.layer, section.height_mm,
                         2.0 * fit::distance_mm(datum->place, line->centers_mm[i])});
    if (out.local.back().value_mm > out.local[out.worst].value_mm) out.worst = i;
  }
  out.centers_mm = std::move(line->centers_mm);
  return out;
}

/// A direction at an angle to another, turned about it by an azimuth.
struct Leaning {
  Eigen::Vector3d along;
  Eigen::Matrix<double, 3, 2> across;
  double cosine = 1.0;
  double sine = 0.0;

  [[nodiscard]] Eigen::Vector3d at(double azimuth_rad) const {
    return cosine * along + sine * outward(azimuth_rad);
  }
  /// Square to at(), in one plane with it and `along`.
  [[nodiscard]] Eigen::Vector3d square_to(double azimuth_rad) const {
    return cosine * outward(azimuth_rad) - sine * along;
  }
  [[nodiscard]] Eigen::Vector3d outward(double azimuth_rad) const {
    return across * Eigen::Vector2d(std::cos(azimuth_rad), std::sin(azimuth_rad));
  }
  [[nodiscard]] double azimuth_of(const Eigen::Vector3d& direction) const {
    const Eigen::Vector2d part = across.transpose() * direction;
    return std::atan2(part.y(), part.x());
  }
};

Leaning leaning(const Eigen::Vector3d& along, double angle_rad) {
  return {along, fit::across(along), std::cos(angle_rad), std::sin(angle_rad)};
}

/// The normal at an angle to the datum direction between whose planes the points have the least
/// distance: the turn about the datum is free.
/// @param near  Normal of the points.
Eigen::Vector3d tightest_normal(fit::SpacePoints points, const Leaning& zone,
                                const Eigen::Vector3d& near) {
  const double start = zone.azimuth_of(near);
  const auto range = [&](const Eigen::Vector3d& n) {
    return fit::extremes_of(points, [&](const auto& p) { return (p - points.front()).dot(n); })
        .width();
  };
  // A turn moves the points apart by their extent along the turn, so that the least range lies
  // where that does not exceed the range at the start.
  const double growth = zone.sine * range(zone.outward(start + 0.25 * core::kTwoPi));
  if (!(growth > 0.0)) return zone.at(start);
  const double reach = std::min(2.0 * range(zone.at(start)) / growth, 0.125 * core::kTwoPi);
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  constexpr int kSteps = 80;  // the bracket shrinks to 2e-17 of its width
  double low = start - reach;
  double high = start + reach;
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double at_a = range(zone.at(a));
  double at_b = range(zone.at(b));
  for (int i = 0; i < kSteps; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = range(zone.at(a));
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = range(zone.at(b));
    }
  }
  return zone.at(0.5 * (low + high));
}

/// The zone of parallel planes with a normal, or the round one along it.
core::Result<Finding> find_zone(const PreparedSurface& surface, const record::Characteristic& asked,
                                std::span<const DatumResult> datums, fit::SpacePoints points,
                                const Eigen::Vector3d& normal, bool round) {
  const auto value = round ? fit::orientation_of_axis_mm(points, normal)
                           : fit::orientation_of_plane_mm(points, normal);
  if (!value) return of_feature(surface, value.error());
  Finding out = found_about(surface, datums, datums.front());
  add_value(asked, *value, round, out);
  if (has_axis(surface)) {
    out.centers_mm.assign(points.begin(), points.end());
    return out;
  }
  std::vector<double> heights;
  for (const auto& p : points) heights.push_back((p - points.front()).dot(normal));
  add_extreme_rows(surface, heights, out);
  return out;
}

/// Nominal angle between the direction of the feature, an axis or a normal, and that of the datum.
core::Result<double> nominal_angle_rad(const record::Characteristic& asked, bool same_kind) {
  const double square = 0.25 * core::kTwoPi;
  double between = 0.0;
  if (asked.form == Form::kPerpendicularity) {
    between = square;
  } else if (asked.form == Form::kAngularity) {
    if (!asked.indication.angle_deg) {
      return core::fail(core::Code::kMissingKey,
                        core::phrase("angularity has no nominal angle; give angle_deg"));
    }
    between = *asked.indication.angle_deg * core::kDegree;
  }
  return same_kind ? between : square - between;
}

/// Parallelism, perpendicularity, angularity of an axis or of a plane to either.
core::Result<Finding> find_orientation(const PreparedSurface& surface,
                                       const record::Characteristic& asked,
                                       std::span<const DatumResult> datums) {
  const bool plane = surface.of->feature.shape == Shape::kPlane;
  if (!plane && !has_axis(surface)) return not_of_shape(surface, asked);
  const Eigen::Vector3d& to = datums.front().place.direction;
  const auto angle = nominal_angle_rad(asked, plane == datums.front().plane);
  if (!angle) return core::fail(angle.error());
  const bool along = std::abs(*angle) < core::kSameAngle;
  const Leaning zone = leaning(surface.axis.direction.dot(to) < 0.0 ? -to : to, *angle);
  if (plane) {
    const Eigen::Vector3d normal =
        along ? to : tightest_normal(surface.points_mm, zone, surface.axis.direction);
    return find_zone(surface, asked, datums, surface.points_mm, normal, false);
  }
  const auto line = median_line_of(surface, record::Indication{});
  if (!line) return core::fail(line.error());
  if (auto enough = check_direction(surface, *line); !enough) return core::fail(enough.error());
  if (asked.form != Form::kAngularity) {
    return find_zone(surface, asked, datums, line->centers_mm, to, along);
  }
  // Two planes, square to the plane in which the axis leans from the datum (ISO 1101).
  const Eigen::Vector3d normal = zone.square_to(zone.azimuth_of(surface.axis.direction));
  return find_zone(surface, asked, datums, line->centers_mm, normal, false);
}

}  // namespace

core::Result<Finding> find_location(const PreparedSurface& surface,
                                    const record::Characteristic& asked,
                                    std::span<const DatumResult> datums) {
  if (datums.empty()) {
    return core::fail(core::Code::kMissingKey, core::phrase("{} needs a datum, e.g. [\"A-B\"]",
                                                            record::name_of(asked.form)));
  }
  const bool place = asked.form == Form::kCoaxiality || asked.form == Form::kConcentricity;
  return place ? find_place(surface, asked, datums) : find_orientation(surface, asked, datums);
}

}  // namespace rondure::evaluation
