#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/part/internal/asked_sections.h"
#include "evaluation/part/internal/families.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/points.h"
#include "record/tasks/form_facts.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using Direction = record::Indication::Direction;
using record::Form;
using record::Shape;

/// Fewest points whose run-out means anything.
constexpr std::size_t kFewestOnTurn = 3;
/// Greatest distance of a point from the circle on a face to which it is said to belong [mm].
constexpr double kOnCircle = 0.1;

/// Run-out of a surface about an axis: what is measured of a point, and in which circles.
struct Turned {
  const PreparedSurface& surface;
  fit::Axis axis;  ///< Out of the face, for an axial one.
  bool axial = false;
  double share = 1.0;           ///< Of the change of the distance, normal to the surface.
  std::vector<double> measure;  ///< Distance or height; of a touched cone at one height [mm].
  std::vector<double> radius;   ///< Distance of each point [mm].
};

struct Circle {
  int layer = 0;
  double position_mm = 0.0;  ///< Height, or radius on a face.
  std::vector<std::size_t> points;
};

core::Result<void> check_turned(const PreparedSurface& surface,
                                const record::Characteristic& asked) {
  const Shape shape = surface.of->feature.shape;
  const Direction direction = asked.indication.direction;
  const bool total = asked.form == Form::kTotalRunOut;
  const auto refuse = [](core::Phrase said) { return core::fail(core::Code::kMeaning, said); };
  if (direction == Direction::kConical && total) {
    return refuse(core::phrase("total run-out is radial or axial; of a cone ask for run-out"));
  }
  if (direction == Direction::kConical && shape != Shape::kCone) {
    return refuse(core::phrase("conical run-out is that of a cone; of a {} ask for \"{}\"",
                               record::name_of(shape),
                               shape == Shape::kPlane ? "axial" : "radial"));
  }
  if (direction == Direction::kAxial && shape != Shape::kPlane) {
    return refuse(core::phrase("axial run-out is that of a face; of a {} ask for \"{}\"",
                               record::name_of(shape),
                               shape == Shape::kCone ? "conical" : "radial"));
  }
  const bool round =
      shape == Shape::kCylinder || shape == Shape::kCircle || (shape == Shape::kCone && !total);
  if (direction == Direction::kRadial && !round) {
    return refuse(core::phrase("radial run-out is that of a cylinder; of a {} ask for \"{}\"",
                               record::name_of(shape),
                               shape == Shape::kPlane ? "axial" : "conical"));
  }
  return {};
}

/// Whether the points were touched along the planned normals: then those of one layer of a part
/// that sits askew are at different heights, of a cone on circles of different sizes.
bool is_touched(const PreparedSurface& surface) {
  return surface.of->clamping && !surface.of->clamping->file;
}

/// The nominal half angle of a cone, which a conical run-out cannot do without.
core::Result<std::optional<double>> half_angle_deg(const PreparedSurface& surface,
                                                   const record::Indication& asked) {
  if (surface.of->feature.shape != Shape::kCone ||
      (asked.direction != Direction::kConical && !is_touched(surface))) {
    return std::nullopt;
  }
  TRY(const auto settings, record::task_of<record::SurfaceSettings>(surface.of->feature.settings));
  if (!settings.half_angle_deg && asked.direction == Direction::kConical) {
    return core::fail(core::Code::kMissingKey,
                      core::phrase("conical run-out needs the nominal half angle of {}: give "
                                   "nominal.half_angle_deg",
                                   surface.of->feature.id));
  }
  return settings.half_angle_deg;
}

/// Heights of the points along the axis, upwards, from their mean, and the slope of the radius over
/// them.
struct ConeSlope {
  std::vector<double> height_mm;
  double widens = 0.0;
};

ConeSlope slope_of(const Turned& turned) {
  const auto count = static_cast<double>(turned.radius.size());
  const Eigen::Vector3d mean = fit::mean_point(turned.surface.points_mm);
  const double mean_radius =
      std::accumulate(turned.radius.begin(), turned.radius.end(), 0.0) / count;
  // The lowest layer is the first, whichever way the axis points.
  const Sections& sections = turned.surface.sections;
  const bool down = !sections.empty() && sections.back().height_mm < sections.front().height_mm;
  const Eigen::Vector3d up = down ? -turned.axis.direction : turned.axis.direction;
  ConeSlope out;
  double square = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i < turned.radius.size(); ++i) {
    const double height = (turned.surface.points_mm[i] - mean).dot(up);
    out.height_mm.push_back(height);
    square += height * height;
    product += height * (turned.radius[i] - mean_radius);
  }
  out.widens = product / square;
  return out;
}

/// The measure of a cone as if all its points lay at one height, along the cone that they show.
std::vector<double> at_one_height(const Turned& turned) {
  const ConeSlope slope = slope_of(turned);
  std::vector<double> out = turned.measure;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] -= turned.share * slope.widens * slope.height_mm[i];
  }
  return out;
}

/// Refuses a planned half angle that is not that of the points: the value would be of another cone.
core::Result<void> check_half_angle(const Turned& turned, double planned_deg) {
  constexpr double kFarthest_deg = 1.0;
  const std::string& id = turned.surface.of->feature.id;
  if (turned.surface.sections.size() == 1) {
    return core::fail(core::Code::kSampling,
                      core::phrase("one layer tells nothing of the half angle of {}, which its "
                                   "run-out needs: plan at least 2 layers",
                                   id));
  }
  const double found_deg = std::atan(slope_of(turned).widens) / core::kDegree;
  if (std::abs(found_deg - planned_deg) <= kFarthest_deg) return {};  // written to refuse no number
  return core::fail(
      core::Code::kMeaning,
      core::phrase("the points of {} show a half angle of {:.2f} deg, "
                   "nominal.half_angle_deg is {:g}: more than {:g} deg apart; correct "
                   "the plan, > 0 opens upwards",
                   id, found_deg, planned_deg, kFarthest_deg));
}

core::Result<Turned> turned_about(const PreparedSurface& surface, const record::Indication& asked,
                                  const fit::Axis& datum) {
  TRY_DO(fit::check_points(surface.points_mm));
  TRY(const auto half_deg, half_angle_deg(surface, asked));
  const bool normal = asked.direction == Direction::kConical;
  const double share = normal ? std::cos(*half_deg * core::kDegree) : 1.0;
  Turned out{surface, datum, asked.direction == Direction::kAxial, share, {}, {}};
  if (out.axis.direction.dot(surface.axis.direction) < 0.0) {
    out.axis.direction = -out.axis.direction;
  }
  for (const Eigen::Vector3d& p : surface.points_mm) {
    out.radius.push_back(fit::distance_mm(out.axis, p));
    const double height = (p - surface.points_mm.front()).dot(out.axis.direction);
    out.measure.push_back(out.axial ? height : out.share * out.radius.back());
  }
  if (half_deg) {
    TRY_DO(check_half_angle(out, *half_deg));
    if (is_touched(surface)) out.measure = at_one_height(out);
  }
  return out;
}

fit::Extremes measured_range(const Turned& turned, const std::vector<std::size_t>& points) {
  return fit::extremes_of(points, [&](std::size_t i) { return turned.measure[i]; });
}

tl::unexpected<core::Error> no_circle(double radius_mm) {
  return core::fail(core::Code::kSampling,
                    core::phrase("a face needs circles about the datum axis: layers are circles "
                                 "of the plane; no turn of points within {:g} mm of radius {:.3f} "
                                 "mm",
                                 kOnCircle, radius_mm));
}

/// Whether points lie all round the axis: a few on one side show nothing of a turn.
bool surround(const Turned& turned, const std::vector<std::size_t>& points) {
  const auto frame = fit::across(turned.axis.direction);
  std::vector<Eigen::Vector2d> flat;
  for (const std::size_t i : points) {
    flat.emplace_back(frame.transpose() * (turned.surface.points_mm[i] - turned.axis.point_mm));
  }
  return flat.size() >= kFewestOnTurn &&
         fit::largest_gap_rad(flat, Eigen::Vector2d::Zero()) < 0.5 * core::kTwoPi;
}

/// The one circle of a stated radius.
core::Result<std::vector<Circle>> stated_circle(const Turned& turned, double radius_mm) {
  Circle out{0, radius_mm, {}};
  for (std::size_t i = 0; i < turned.radius.size(); ++i) {
    if (std::abs(turned.radius[i] - radius_mm) <= kOnCircle) out.points.push_back(i);
  }
  if (!surround(turned, out.points)) return no_circle(radius_mm);
  return std::vector{std::move(out)};
}

/// The planned circles of a face; each must be one about the datum axis.
core::Result<std::vector<Circle>> circles_of(const Turned& turned, const Sections& sections) {
  std::vector<Circle> out;
  for (const SurfaceSection& section : sections) {
    Circle circle{section.layer, 0.0, section.points};
    double mean = 0.0;
    for (const std::size_t i : circle.points) {
      mean += turned.radius[i] / static_cast<double>(circle.points.size());
    }
    circle.position_mm = mean;
    const auto off = [&](std::size_t i) { return std::abs(turned.radius[i] - mean) > kOnCircle; };
    if (std::ranges::any_of(circle.points, off) || !surround(turned, circle.points)) {
      return no_circle(mean);
    }
    out.push_back(std::move(circle));
  }
  return out;
}

/// The sections of a cylinder or cone: all of them, never one.
core::Result<std::vector<Circle>> turned_sections(const Turned& turned, const Sections& sections) {
  std::vector<Circle> out;
  for (const SurfaceSection& section : sections) {
    if (section.points.size() < kFewestOnTurn) {
      return core::fail(core::Code::kSampling,
                        core::phrase("layer {} of {} has {} points, run-out needs at least {}: "
                                     "touch more",
                                     section.layer + 1, turned.surface.of->feature.id,
                                     section.points.size(), kFewestOnTurn));
    }
    out.push_back({section.layer, section.height_mm, section.points});
  }
  return out;
}

core::Result<std::vector<Circle>> turned_circles(const Turned& turned,
                                                 const record::Indication& asked) {
  if (turned.axial && asked.radius_mm) return stated_circle(turned, *asked.radius_mm);
  const auto sections = asked_sections(turned.surface, record::Indication{});
  if (!sections) {
    return core::fail(sections.error().code, core::phrase("{}: {}", turned.surface.of->feature.id,
                                                          sections.error().said()));
  }
  return turned.axial ? circles_of(turned, *sections) : turned_sections(turned, *sections);
}

/// What no point and no window names of a turn can only add to the run-out.
void note_unseen_turn(const Turned& turned, const Sections& sections,
                      const record::Characteristic& asked, Finding& out) {
  const auto& limit = asked.tolerance_mm;
  if (limit && out.judged.front().value_mm > *limit) return;
  // The middle of a part of a face lies in that part: the turn is that about the datum.
  const bool face = turned.surface.of->feature.shape == Shape::kPlane;
  const fit::Axis& about = face ? turned.axis : turned.surface.axis;
  out.no_verdict = sections.empty() ? unseen_turn(turned.surface, about)
                                    : unseen_part(turned.surface, sections, about);
}

/// Rows of a file that share a layer should share a height: of a cone, heights that differ count as
/// run-out, or hide it. No verdict where that decides.
void note_heights(Turned turned, const std::vector<Circle>& circles,
                  const record::Characteristic& asked, Finding& out) {
  if (turned.surface.of->feature.shape != Shape::kCone || is_touched(turned.surface)) return;
  if (circles.size() < 2 || !asked.tolerance_mm || out.no_verdict) return;
  turned.measure = at_one_height(turned);
  double value_mm = 0.0;
  for (const Circle& circle : circles) {
    value_mm = std::max(value_mm, measured_range(turned, circle.points).width());
  }
  const double read_mm = out.judged.front().value_mm;
  if ((read_mm <= *asked.tolerance_mm) == (value_mm <= *asked.tolerance_mm)) return;
  out.no_verdict = core::phrase(
      "the rows of a layer lie at different heights: {:.3f} um as read, {:.3f} um brought to one "
      "height along the cone; measure each layer at one height",
      read_mm / core::kMicrometre, value_mm / core::kMicrometre);
}

/// The rows at both ends of the measure among some points, the greatest first.
void add_turned_rows(const Turned& turned, const std::vector<std::size_t>& points,
                     Finding& finding) {
  const auto [least, greatest] =
      std::ranges::minmax_element(points, {}, [&](std::size_t i) { return turned.measure[i]; });
  finding.rows = {turned.surface.rows[*greatest], turned.surface.rows[*least]};
}

}  // namespace

core::Result<Finding> find_run_out(const PreparedSurface& surface,
                                   const record::Characteristic& asked,
                                   std::span<const DatumResult> datums) {
  if (datums.empty()) {
    return core::fail(core::Code::kMissingKey, core::phrase("{} needs a datum, e.g. [\"A-B\"]",
                                                            record::name_of(asked.form)));
  }
  TRY_DO(check_turned(surface, asked));
  TRY(const auto datum, datum_axis_of(datums, asked));
  TRY(const auto about, turned_about(surface, asked.indication, datum.place));
  Finding out = found_about(surface, datums, datum);
  const std::string symbol(record::facts_of(asked.form).symbol);
  if (asked.form == Form::kTotalRunOut) {
    std::vector<std::size_t> all(surface.points_mm.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    add_turned_rows(about, all, out);
    out.judged.push_back({symbol, measured_range(about, all).width(), limits_of(asked)});
    note_unseen_turn(about, surface.sections, asked, out);
    return out;
  }
  TRY(const auto found, turned_circles(about, asked.indication));
  Sections turns;
  for (const Circle& circle : found) {
    turns.push_back(
        {.layer = circle.layer, .height_mm = circle.position_mm, .points = circle.points});
    out.local.push_back({about.axial ? LocalValue::Place::kRadius : LocalValue::Place::kLayer,
                         circle.layer, circle.position_mm,
                         measured_range(about, circle.points).width()});
    if (out.local.back().value_mm > out.local[out.worst].value_mm) out.worst = out.local.size() - 1;
  }
  add_turned_rows(about, found[out.worst].points, out);
  out.judged.push_back({symbol, out.local[out.worst].value_mm, limits_of(asked)});
  note_unseen_turn(about, turns, asked, out);
  note_heights(about, found, asked, out);
  return out;
}

}  // namespace rondure::evaluation
