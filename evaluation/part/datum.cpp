#include "evaluation/part/internal/families.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/part/internal/asked_sections.h"
#include "evaluation/part/part_state.h"
#include "fit/datums/datum_axis.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/plane.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using Association = record::Indication::Association;
using record::Shape;

/// Play from which on a datum is said to rock [mm].
constexpr double kRocks = 1e-3;

/// A text of the key "datum" with the features that it names.
struct NamedDatum {
  std::string name;
  std::vector<std::size_t> features;
  bool plane = false;
};

/// Letters of the features on the drawing; empty for a feature without one.
using Letters = std::vector<std::string>;

core::Result<Letters> letters_of(std::span<const MeasuredSurface> part) {
  Letters out;
  for (const MeasuredSurface& surface : part) {
    out.emplace_back();
    if (record::is_analysis(surface.of->feature.shape)) continue;
    TRY(const auto settings,
        record::task_of<record::SurfaceSettings>(surface.of->feature.settings));
    out.back() = settings.letter;
  }
  return out;
}

std::optional<std::size_t> feature_named(std::span<const MeasuredSurface> part,
                                         const Letters& letters, const std::string& name) {
  const auto letter = std::ranges::find(letters, name);
  if (letter != letters.end() && !name.empty()) {
    return static_cast<std::size_t>(letter - letters.begin());
  }
  const auto id = std::ranges::find(part, name, [](const auto& s) { return s.of->feature.id; });
  if (id == part.end()) return std::nullopt;
  return static_cast<std::size_t>(id - part.begin());
}

/// "A, C": the names of all features.
std::string plan_names(std::span<const MeasuredSurface> part, const Letters& letters) {
  std::string out;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!out.empty()) out += ", ";
    out += letters[i].empty() ? part[i].of->feature.id : letters[i];
  }
  return out;
}

/// The features of a text: of the whole text, as an id may hold a hyphen, else of its pieces.
core::Result<std::vector<std::size_t>> features_of(std::span<const MeasuredSurface> part,
                                                   const Letters& letters,
                                                   const std::string& text) {
  if (const auto whole = feature_named(part, letters, text)) return std::vector{*whole};
  std::vector<std::size_t> out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('-', begin), text.size());
    const std::string piece = text.substr(begin, end - begin);
    const auto found = feature_named(part, letters, piece);
    if (!found) {
      return core::fail(
          core::Code::kMeaning,
          core::phrase("datum \"{}\": no feature has the letter or id \"{}\"; the plan has {}",
                       text, piece, plan_names(part, letters)));
    }
    if (std::ranges::find(out, *found) != out.end()) {
      return core::fail(core::Code::kMeaning,
                        core::phrase("datum \"{}\" names \"{}\" twice", text, piece));
    }
    out.push_back(*found);
    begin = end + 1;
  }
  return out;
}

/// Whether two features have the same points, under two names.
bool same_points(const MeasuredSurface& a, const MeasuredSurface& b) {
  return !a.of->cloud.empty() &&
         std::ranges::equal(a.of->cloud, b.of->cloud, {}, &CloudPoint::tip_mm, &CloudPoint::tip_mm);
}

core::Result<NamedDatum> named_datum(std::span<const MeasuredSurface> part, const Letters& letters,
                                     std::size_t toleranced, const std::string& text) {
  TRY(auto features, features_of(part, letters, text));
  NamedDatum out{text, std::move(features)};
  for (const std::size_t i : out.features) {
    const record::Feature& feature = part[i].of->feature;
    const bool itself = i == toleranced;
    if (itself && out.features.size() == 1) {
      return core::fail(core::Code::kMeaning,
                        core::phrase("datum \"{}\": a feature is no datum of itself", text));
    }
    if (!itself && same_points(part[i], part[toleranced])) {
      return core::fail(
          core::Code::kMeaning,
          core::phrase("datum \"{}\": {} and {} have the same points, and a feature is no datum of "
                       "itself; name another, or give each its own points",
                       text, feature.id, part[toleranced].of->feature.id));
    }
    out.plane = feature.shape == Shape::kPlane;
    if (out.plane && out.features.size() > 1) {
      return core::fail(
          core::Code::kMeaning,
          core::phrase("datum \"{}\": a common datum is of cylinders; name one plane", text));
    }
    if (!out.plane && feature.shape != Shape::kCylinder && feature.shape != Shape::kCircle) {
      return core::fail(core::Code::kMeaning,
                        core::phrase("datum \"{}\": a {} gives no datum here; name a cylinder or a "
                                     "plane",
                                     text, record::name_of(feature.shape)));
    }
  }
  return out;
}

/// A datum with the points of its features, as they enter it: unfiltered, without their windows.
struct DatumPoints {
  NamedDatum named;
  Association association = Association::kOneSided;
  std::vector<PreparedSurface> surfaces;

  [[nodiscard]] bool one_sided() const {
    return association == Association::kOneSided || association == Association::kEqualised;
  }
  [[nodiscard]] tl::unexpected<core::Error> fails(const core::Error& why) const {
    return core::fail(why.code, core::phrase("datum {}: {}", named.name, why.said()));
  }
  [[nodiscard]] std::vector<fit::DatumCylinder> cylinders() const {
    std::vector<fit::DatumCylinder> out;
    for (const PreparedSurface& s : surfaces) out.push_back({s.points_mm, s.material.inside});
    return out;
  }
  /// Extent of all points along a direction [mm].
  [[nodiscard]] double extent_mm(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d& from = surfaces.front().points_mm.front();
    fit::Extremes out;
    for (const PreparedSurface& s : surfaces) {
      for (const auto& p : s.points_mm) out.take((p - from).dot(direction));
    }
    return out.width();
  }
  [[nodiscard]] DatumResult result(const fit::Axis& place, std::vector<double> radii) const {
    DatumResult out;
    out.name = named.name;
    out.association = association;
    out.plane = named.plane;
    out.place = place;
    out.radii_mm = std::move(radii);
    out.features = named.features;
    return out;
  }
};

core::Result<DatumPoints> datum_points(const PartState& state, NamedDatum named,
                                       Association association, const FeatureResult& toleranced) {
  const std::span<const MeasuredSurface> part = state.surfaces();
  DatumPoints out{std::move(named), association, {}};
  for (const std::size_t i : out.named.features) {
    if (part[i].of->failure) return out.fails(*part[i].of->failure);
    const auto factor = related(*part[i].of, toleranced);
    if (!factor) return out.fails(factor.error());
    auto surface = state.prepared(i, record::Indication{});
    if (!surface) return out.fails(surface.error());
    if (surface->no_sections) return out.fails(*surface->no_sections);
    for (Eigen::Vector3d& p : surface->points_mm) p *= *factor;
    out.surfaces.push_back(*std::move(surface));
  }
  return out;
}

/// Direction of the longest feature that has one; a single section has none.
std::optional<Eigen::Vector3d> start_direction(const DatumPoints& datum) {
  std::optional<Eigen::Vector3d> out;
  double longest = 0.0;
  for (const PreparedSurface& s : datum.surfaces) {
    if (s.of->feature.shape != Shape::kCylinder) continue;
    const double length = fit::extremes_of(s.points_mm, [&](const auto& p) {
                            return p.dot(s.axis.direction);
                          }).width();
    if (length <= longest) continue;
    longest = length;
    out = s.axis.direction;
  }
  return out;
}

fit::DatumAssociation to_fit(Association association) {
  switch (association) {
    case Association::kEqualised:
      return fit::DatumAssociation::kEqualised;
    case Association::kLs:
      return fit::DatumAssociation::kLeastSquares;
    case Association::kZone:
      return fit::DatumAssociation::kZone;
    case Association::kOneSided:
      break;
  }
  return fit::DatumAssociation::kOneSided;
}

/// No axis rests on an arc, whatever the association: an axis needs the turn of every section.
core::Result<void> check_surrounded(const DatumPoints& datum) {
  for (const PreparedSurface& surface : datum.surfaces) {
    const auto why = unseen_part(surface);
    if (!why) continue;
    return core::fail(core::Code::kReferenceAbsent,
                      core::phrase("datum {}: no axis rests on {}: {}", datum.named.name,
                                   surface.of->feature.id, *why));
  }
  return {};
}

/// The axis of one or several cylinders, by any association.
class AxisAssociation {
 public:
  explicit AxisAssociation(const DatumPoints& datum)
      : datum_(datum), cylinders_(datum.cylinders()), near_(start_direction(datum)) {}

  [[nodiscard]] core::Result<fit::DatumAxis> find(Association association) const {
    // One feature has the minimum zone that the report states of it.
    const bool own_zone = association == Association::kZone && cylinders_.size() == 1;
    auto found =
        own_zone ? zone_cylinder() : fit::datum_axis(cylinders_, to_fit(association), near_);
    if (!found) return datum_.fails(found.error());
    if (found->ending == fit::ZoneEnding::kConverged) return found;
    if (association == Association::kOneSided) {
      if (auto reference = reference_cylinder()) return *std::move(reference);
      if (is_first_order_optimum(*found)) return found;
    }
    return core::fail(core::Code::kNotConverged,
                      core::phrase("datum {}: the search for its axis did not come to rest; plan "
                                   "association \"equalised\" or \"ls\"",
                                   datum_.named.name));
  }
  [[nodiscard]] core::Result<fit::DatumRock> rock() const {
    const auto out = fit::datum_rock(cylinders_, near_);
    if (!out) return datum_.fails(out.error());
    return out;
  }

 private:
  [[nodiscard]] core::Result<fit::DatumAxis> zone_cylinder() const {
    TRY(const auto zone, fit::min_zone_cylinder(cylinders_.front().points_mm, near_));
    fit::DatumAxis out;
    out.axis = zone.axis;
    out.ending = zone.ending;
    out.radii_mm = {0.5 * (zone.inner_radius_mm + zone.outer_radius_mm)};
    return out;
  }
  /// The envelope cylinder of a single feature, by the search that passes over places from which
  /// the radius falls to second order only.
  [[nodiscard]] std::optional<fit::DatumAxis> reference_cylinder() const {
    if (cylinders_.size() > 1) return std::nullopt;
    const auto search =
        cylinders_.front().inside ? fit::max_inscribed_cylinder : fit::min_circumscribed_cylinder;
    const auto found = search(cylinders_.front().points_mm, near_, {});
    if (!found || found->certificate.kind == fit::Certificate::Kind::kNone) return std::nullopt;
    fit::DatumAxis out;
    out.axis = found->axis;
    out.radii_mm = {found->radius_mm};
    out.contacts = found->contacts;
    return out;
  }
  /// The search does not settle on five contacts where all points of a perfect form are as near.
  /// Its radii then sum to the first-order optimum, and the axis has no room to rock.
  [[nodiscard]] bool is_first_order_optimum(const fit::DatumAxis& found) const {
    constexpr double kSameSum = 1e-9;
    const auto known = rock();
    double sum = 0.0;
    for (std::size_t i = 0; i < cylinders_.size(); ++i) {
      sum += (cylinders_[i].inside ? -1.0 : 1.0) * found.radii_mm[i];
    }
    return known && std::abs(sum - known->sum_mm) <= kSameSum && known->play_mm < kRocks;
  }

  const DatumPoints& datum_;
  std::vector<fit::DatumCylinder> cylinders_;
  std::optional<Eigen::Vector3d> near_;
};

core::Result<DatumResult> axis_datum(const DatumPoints& datum, Proof proof) {
  if (datum.surfaces.size() == 1 && (datum.surfaces[0].of->feature.shape == Shape::kCircle ||
                                     layers_in(datum.surfaces[0].sections) == 1)) {
    return core::fail(core::Code::kRank,
                      core::phrase("datum {} has 1 section, an axis needs 2; name a common datum, "
                                   "e.g. \"A-B\"",
                                   datum.named.name));
  }
  TRY_DO(check_surrounded(datum));
  const AxisAssociation associated(datum);
  TRY(const auto found, associated.find(datum.association));
  DatumResult out = datum.result(found.axis, found.radii_mm);
  out.length_mm = datum.extent_mm(out.place.direction);
  if (datum.association != Association::kOneSided || proof == Proof::kNone) return out;
  TRY(const auto equalised, associated.find(Association::kEqualised));
  TRY(const auto rock, associated.rock());
  out.equalised = equalised.axis;
  out.play_mm = rock.play_mm;
  return out;
}

/// The one-sided plane is the outer one of the minimum zone; it does not rock, so that it is the
/// equalised one, too.
core::Result<DatumResult> plane_datum(const DatumPoints& datum) {
  const PreparedSurface& surface = datum.surfaces.front();
  fit::Plane plane;
  if (datum.association == Association::kLs) {
    const auto ls = fit::ls_plane(surface.points_mm, surface.axis.direction);
    if (!ls) return datum.fails(ls.error());
    plane = ls->plane;
  } else {
    const auto zone = fit::min_zone_plane(surface.points_mm, surface.axis.direction);
    if (!zone) return datum.fails(zone.error());
    if (zone->certificate.kind != fit::Certificate::Kind::kGlobal) {
      return core::fail(core::Code::kNotConverged,
                        core::phrase("datum {}: it is not proven that its plane is the outermost; "
                                     "plan association \"ls\", or touch a wider face",
                                     datum.named.name));
    }
    plane = zone->outer;
  }
  DatumResult out = datum.result({plane.point_mm, plane.normal}, {});
  // The middle of the points, from which the distance of a toleranced feature counts.
  const Eigen::Vector3d mean = fit::mean_point(surface.points_mm);
  out.place.point_mm = mean - fit::height_mm(plane, mean) * plane.normal;
  const auto frame = fit::across(plane.normal);
  out.length_mm = 2.0 * fit::extremes_of(surface.points_mm, [&](const auto& p) {
                          return (frame.transpose() * (p - mean)).norm();
                        }).high;
  return out;
}

/// The secondary datum after a primary plane: the axis along its normal, of the circle of the
/// projected points.
core::Result<DatumResult> axis_square_to(const DatumResult& primary, const DatumPoints& datum) {
  if (datum.surfaces.size() > 1) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("datum {}: after a plane one cylinder gives the axis; name one",
                                   datum.named.name));
  }
  TRY_DO(check_surrounded(datum));
  const PreparedSurface& surface = datum.surfaces.front();
  const fit::Plane plane{primary.place.point_mm, primary.place.direction};
  const auto frame = fit::across(plane.normal);
  const Eigen::Vector3d mean = fit::mean_point(surface.points_mm);
  std::vector<Eigen::Vector2d> flat;
  for (const auto& p : surface.points_mm) flat.emplace_back(frame.transpose() * (p - mean));
  const auto ls = fit::ls_circle(flat);
  if (!ls) return datum.fails(ls.error());
  const auto along_normal = [&](const Eigen::Vector2d& center) {
    return fit::conventional({mean + frame * center, plane.normal}, mean);
  };
  DatumResult out = datum.result(along_normal(ls->center_mm), {ls->radius_mm});
  if (datum.one_sided()) {
    const auto found =
        fit::datum_axis_square_to(plane, {surface.points_mm, surface.material.inside});
    if (!found) return datum.fails(found.error());
    out.place = found->axis;
    out.radii_mm = found->radii_mm;
  } else if (datum.association == Association::kZone) {
    const auto zone = fit::min_zone_circle(flat);
    if (!zone) return datum.fails(zone.error());
    out.place = along_normal(zone->center_mm);
    out.radii_mm = {0.5 * (zone->inner_radius_mm + zone->outer_radius_mm)};
  }
  out.length_mm = datum.extent_mm(plane.normal);
  return out;
}

}  // namespace

bool needs_datum_axis(record::Form form) {
  using record::Form;
  return form == Form::kCoaxiality || form == Form::kConcentricity || form == Form::kRunOut ||
         form == Form::kTotalRunOut;
}

core::Result<std::vector<DatumResult>> datums_of(const PartState& state, std::size_t feature,
                                                 const record::Characteristic& asked, Proof proof) {
  const std::span<const MeasuredSurface> part = state.surfaces();
  TRY(const auto letters, letters_of(part));
  std::vector<NamedDatum> named;
  for (const std::string& text : asked.indication.datum) {
    TRY(auto datum, named_datum(part, letters, feature, text));
    named.push_back(std::move(datum));
  }
  // Whatever follows a primary axis fixes the turn about it, or the place along it: neither counts.
  // After a primary plane a secondary axis gives the place of what needs one.
  if (named.empty()) return std::vector<DatumResult>{};
  const Association association = asked.indication.association.value_or(Association::kOneSided);
  const FeatureResult& toleranced = *part[feature].of;
  TRY(const auto primary, datum_points(state, named.front(), association, toleranced));
  TRY(auto first, primary.named.plane ? plane_datum(primary) : axis_datum(primary, proof));
  std::vector<DatumResult> out = {std::move(first)};
  if (!out.front().plane || !needs_datum_axis(asked.form) || named.size() < 2 || named[1].plane) {
    return out;
  }
  TRY(const auto secondary, datum_points(state, named[1], association, toleranced));
  TRY(auto second, axis_square_to(out.front(), secondary));
  out.push_back(std::move(second));
  return out;
}

Finding found_about(const PreparedSurface& surface, std::span<const DatumResult> datums,
                    const DatumResult& datum) {
  Finding out;
  std::string names;
  for (const DatumResult& one : datums) names += (names.empty() ? "" : ", ") + one.name;
  out.reference =
      core::phrase("about {}, {}", names, core::Phrase(record::name_of(datum.association)));
  const Eigen::Vector3d apart = fit::mean_point(surface.points_mm) - datum.place.point_mm;
  out.numbers.push_back({"datum_length_mm", datum.length_mm, false});
  out.numbers.push_back({"datum_distance_mm", std::abs(apart.dot(datum.place.direction)), false});
  if (datum.association != Association::kOneSided || datum.plane) return out;
  out.numbers.push_back({"datum_play", datum.play_mm});
  if (datum.play_mm > kRocks) {
    out.warnings.push_back(core::error_of(
        core::Code::kSeveralOptima,
        core::phrase("datum {} rocks by {:.1f} um over its length of {:g} mm: its one-sided axis "
                     "is one of several nearly equal ones",
                     datum.name, core::micrometres(datum.play_mm), datum.length_mm)));
  }
  return out;
}

core::Result<DatumResult> datum_axis_of(std::span<const DatumResult> datums,
                                        const record::Characteristic& asked) {
  const auto axis = std::ranges::find(datums, false, &DatumResult::plane);
  if (axis != datums.end()) return *axis;
  return core::fail(core::Code::kMeaning,
                    core::phrase("{} is about an axis: name a cylinder as datum, alone or after "
                                 "the plane",
                                 record::name_of(asked.form)));
}

std::size_t layers_in(std::span<const SurfaceSection> sections) {
  std::set<int> layers;
  for (const SurfaceSection& section : sections) layers.insert(section.layer);
  return layers.size();
}

void add_extreme_rows(const PreparedSurface& surface, const std::vector<double>& measure,
                      Finding& finding) {
  const auto [least, greatest] = std::ranges::minmax_element(measure);
  finding.rows.push_back(surface.rows[static_cast<std::size_t>(greatest - measure.begin())]);
  finding.rows.push_back(surface.rows[static_cast<std::size_t>(least - measure.begin())]);
}

}  // namespace rondure::evaluation
