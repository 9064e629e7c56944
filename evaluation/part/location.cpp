#include <algorithm>
#include <utility>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/part/internal/asked_sections.h"
#include "evaluation/part/internal/families.h"
#include "fit/datums/datum.h"
#include "fit/least_squares/sections.h"
#include "record/tasks/form_facts.h"

namespace rondure::evaluation {
namespace {

using record::Form;
using record::Shape;

/// The extracted median line: centres of sections square to the axis of the feature itself.
struct MedianLine {
  Sections sections;
  std::vector<Eigen::Vector3d> centers_mm;
};

tl::unexpected<core::Error> of_feature(const PreparedSurface& surface, const core::Error& why) {
  return core::fail(why.code, core::phrase("{}: {}", surface.of->feature.id, why.said()));
}

core::Result<MedianLine> median_line_of(const PreparedSurface& surface,
                                        const record::Indication& asked) {
  auto sections = asked_sections(surface, asked);
  if (!sections) return of_feature(surface, sections.error());
  const auto circles = projected(surface, *sections);
  if (!circles) return of_feature(surface, circles.error());
  return MedianLine{*std::move(sections), fit::median_line(*circles)};
}

/// The centre of a section that is not touched all round is not known well enough for a verdict.
void note_unseen_centers(const PreparedSurface& surface, const MedianLine& line, Finding& out) {
  out.no_verdict = unseen_part(surface, line.sections, surface.axis);
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
  TRY(const auto datum, datum_axis_of(datums, asked));
  TRY(auto line, median_line_of(surface, asked.indication));
  if (asked.form == Form::kCoaxiality) {
    TRY_DO(check_direction(surface, line));
  }
  const auto value = fit::coaxiality_mm(line.centers_mm, datum.place);
  if (!value) return of_feature(surface, value.error());
  Finding out = found_about(surface, datums, datum);
  add_value(asked, *value, true, out);
  for (std::size_t i = 0; i < line.sections.size(); ++i) {
    const SurfaceSection& section = line.sections[i];
    out.local.push_back({LocalValue::Place::kLayer, section.layer, section.height_mm,
                         2.0 * fit::distance_mm(datum.place, line.centers_mm[i])});
    if (out.local.back().value_mm > out.local[out.worst].value_mm) out.worst = i;
  }
  note_unseen_centers(surface, line, out);
  out.centers_mm = std::move(line.centers_mm);
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

/// Orientation of a plane: two planes square to the datum direction, or at an angle to it.
core::Result<Finding> find_plane(const PreparedSurface& surface,
                                 const record::Characteristic& asked,
                                 std::span<const DatumResult> datums, double angle_rad) {
  const auto& points = surface.points_mm;
  Eigen::Vector3d normal = datums.front().place.direction;
  if (angle_rad > core::kSameAngle) {
    const auto zone = fit::inclined_zone(points, normal, angle_rad, surface.axis.direction);
    if (!zone) return of_feature(surface, zone.error());
    normal = zone->outer.normal;
  }
  const auto value = fit::orientation_of_plane_mm(points, normal);
  if (!value) return of_feature(surface, value.error());
  Finding out = found_about(surface, datums, datums.front());
  add_value(asked, *value, false, out);
  std::vector<double> heights;
  for (const auto& p : points) heights.push_back((p - points.front()).dot(normal));
  add_extreme_rows(surface, heights, out);
  // The rest of the face can only add: a plane that fails does so as read.
  if (!asked.tolerance_mm || *value <= *asked.tolerance_mm) {
    out.no_verdict = unseen_of_face(surface);
  }
  return out;
}

/// Orientation of an axis: a round zone along the datum direction or at the angle of an angularity;
/// two planes where the axis is to be square to it.
core::Result<Finding> find_axis(const PreparedSurface& surface, const record::Characteristic& asked,
                                std::span<const DatumResult> datums, double angle_rad) {
  TRY(auto line, median_line_of(surface, record::Indication{}));
  TRY_DO(check_direction(surface, line));
  const Eigen::Vector3d& to = datums.front().place.direction;
  const bool along = angle_rad < core::kSameAngle;
  const bool inclined = asked.form == Form::kAngularity && !along;
  const auto value = along      ? fit::orientation_of_axis_mm(line.centers_mm, to)
                     : inclined ? fit::angularity_of_axis_mm(line.centers_mm, to, angle_rad)
                                : fit::orientation_of_plane_mm(line.centers_mm, to);
  if (!value) return of_feature(surface, value.error());
  Finding out = found_about(surface, datums, datums.front());
  add_value(asked, *value, along || inclined, out);
  note_unseen_centers(surface, line, out);
  out.centers_mm = std::move(line.centers_mm);
  return out;
}

/// Parallelism, perpendicularity, angularity of an axis or of a plane to either.
core::Result<Finding> find_orientation(const PreparedSurface& surface,
                                       const record::Characteristic& asked,
                                       std::span<const DatumResult> datums) {
  const bool plane = surface.of->feature.shape == Shape::kPlane;
  if (!plane && !has_axis(surface)) return not_of_shape(surface, asked);
  TRY(const auto angle, nominal_angle_rad(asked, plane == datums.front().plane));
  return plane ? find_plane(surface, asked, datums, angle)
               : find_axis(surface, asked, datums, angle);
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
