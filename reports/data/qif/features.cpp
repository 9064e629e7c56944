#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/measured_cloud.h"
#include "evaluation/results/section.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"
#include "reports/data/qif/internal/parts.h"

namespace rondure::reports {
namespace {

using core::decimal;

using record::Reference;

/// A cylinder, circle or plane fitted to the points by one reference; radii of the surface where
/// the tip is known.
struct Associated {
  Reference reference = Reference::kLeastSquares;
  fit::Axis axis;          ///< For a circle or plane: a point of it and its normal.
  double radius_mm = 0.0;  ///< Of a plane none.
  double deviation_mm = 0.0;
};

std::vector<Associated> cylinders_of(const evaluation::FeatureResult& feature) {
  std::vector<Associated> out;
  const double offset_mm = surface_offset_mm(feature);
  if (const auto& ls = feature.ls_cylinder) {
    out.push_back(
        {Reference::kLeastSquares, ls->axis, ls->radius_mm + offset_mm, ls->deviation_mm});
  }
  if (const auto zone = zone_of(feature); zone && feature.mz_cylinder) {
    out.push_back({Reference::kMinimumZone, feature.mz_cylinder->axis, zone->mean_radius_mm,
                   zone->deviation_mm});
  }
  const auto add_one = [&](Reference reference, const core::Result<fit::OneSidedCylinder>& one) {
    if (!one) return;
    out.push_back({reference, one->axis, one->radius_mm + offset_mm, one->deviation_mm});
  };
  add_one(Reference::kMinimumCircumscribed, feature.mc_cylinder);
  add_one(Reference::kMaximumInscribed, feature.mi_cylinder);
  return out;
}

std::vector<Associated> planes_of(const evaluation::FeatureResult& feature) {
  std::vector<Associated> out;
  if (const auto& ls = feature.ls_plane) {
    out.push_back(
        {Reference::kLeastSquares, {ls->plane.point_mm, ls->plane.normal}, 0.0, ls->deviation_mm});
  }
  if (const auto& mz = feature.mz_plane) {
    out.push_back(
        {Reference::kMinimumZone, {mz->outer.point_mm, mz->outer.normal}, 0.0, mz->width_mm});
  }
  return out;
}

std::vector<Associated> circles_of(const evaluation::FeatureResult& feature,
                                   const evaluation::LayerResult& layer) {
  std::vector<Associated> out;
  const double offset_mm = surface_offset_mm(feature);
  const auto add_circle = [&](Reference reference, const Eigen::Vector2d& center_mm,
                              double radius_mm, double deviation_mm) {
    out.push_back(
        {reference, section_axis(feature, layer, center_mm), radius_mm + offset_mm, deviation_mm});
  };
  if (const auto& ls = layer.ls) {
    add_circle(Reference::kLeastSquares, ls->center_mm, ls->radius_mm, ls->deviation_mm);
  }
  if (const auto& mz = layer.mz) {
    add_circle(Reference::kMinimumZone, mz->center_mm,
               0.5 * (mz->inner_radius_mm + mz->outer_radius_mm), mz->width_mm());
  }
  const auto add_one = [&](Reference reference, const core::Result<fit::OneSidedCircle>& one) {
    if (one) add_circle(reference, one->center_mm, one->radius_mm, one->deviation_mm);
  };
  add_one(Reference::kMinimumCircumscribed, layer.mc);
  add_one(Reference::kMaximumInscribed, layer.mi);
  return out;
}

/// "CircleFeatureItem", ...
std::string feature_element(record::Shape shape, std::string_view kind) {
  const char* name = shape == record::Shape::kCircle   ? "Circle"
                     : shape == record::Shape::kPlane  ? "Plane"
                     : shape == record::Shape::kCone   ? "Cone"
                     : shape == record::Shape::kSphere ? "Sphere"
                                                       : "Cylinder";
  return fmt::format("{}Feature{}", name, kind);
}

/// Location and normal of a circle or plane, centre of a sphere, or the axis of a cylinder or cone.
void add_place(pugi::xml_node node, record::Shape shape, const std::string& point,
               const std::string& direction) {
  const bool axis = shape == record::Shape::kCylinder || shape == record::Shape::kCone;
  const pugi::xml_node place = axis ? add(node, "Axis") : node;
  add(place, axis ? "AxisPoint" : "Location", point);
  if (shape == record::Shape::kSphere) return;
  add(place, axis ? "Direction" : "Normal", direction);
}

/// Definition, nominal and item of a surface, or of a circle, at a height above the origin.
QifShape add_shape(QifDraft& draft, const record::Feature& asked, record::Shape kind,
                   double height_mm, const std::string& name) {
  QifShape shape;
  shape.shape = kind;
  const auto surface = record::task_of<record::SurfaceSettings>(asked.settings);
  const auto add_node = [&](pugi::xml_node list, std::string_view part) {
    return add_numbered(draft, list, feature_element(kind, part));
  };
  pugi::xml_node node = add_node(draft.lists.feature_definitions, "Definition");
  const int definition = id_of(node);
  if (kind != record::Shape::kPlane) {
    add(node, "InternalExternal", asked.side == record::Side::kOutside ? "EXTERNAL" : "INTERNAL");
    add(node, "Diameter", decimal(asked.nominal_diameter_mm));
  }
  if (kind == record::Shape::kCone) {
    const std::optional<double> half = surface ? surface->half_angle_deg : std::nullopt;
    add(node, "HalfAngle", decimal(std::abs(half.value_or(0.0))));
  }

  node = add_node(draft.lists.feature_nominals, "Nominal");
  shape.nominal = id_of(node);
  add_attributes(node, {{"frame", "part: axis along z"}});
  add(node, "FeatureDefinitionId", definition);
  const bool down = surface && surface->faces == record::Faces::kDown;
  add_place(node, kind, text_of({0.0, 0.0, height_mm}), down ? "0 0 -1" : "0 0 1");

  node = add_node(draft.lists.feature_items, "Item");
  shape.item = id_of(node);
  add(node, "FeatureNominalId", shape.nominal);
  add(node, "FeatureName", name);
  add(add(node, "DeterminationMode"), "Checked");
  return shape;
}

/// The points of a set that belong to a shape; rows count from 0, none means all.
struct PointRange {
  std::optional<int> set = {};
  std::optional<std::pair<std::size_t, std::size_t>> rows = {};
};

void add_point_list(pugi::xml_node parent, const PointRange& points) {
  if (!points.set) return;
  pugi::xml_node list = add_list(parent, "PointList");
  if (!points.rows) {
    add(list, "WholePointSetId", *points.set);
    return;
  }
  pugi::xml_node range = add(list, "RangePointSetId", *points.set);
  set(range, "range", fmt::format("{} {}", points.rows->first + 1, points.rows->second + 1));
}

void add_measurement(QifDraft& draft, QifShape& shape, const Associated& found,
                     const PointRange& points) {
  const pugi::xml_node node = add_numbered(draft, draft.lists.measured_features,
                                           feature_element(shape.shape, "Measurement"));
  shape.measured[static_cast<std::size_t>(found.reference)] = id_of(node);
  add_attributes(node,
                 {{"frame", draft.frame},
                  {"reference", shape.shape == record::Shape::kPlane
                                    ? std::string(record::name_of(found.reference))
                                    : evaluation::reference_of(found.reference, shape.shape)}});
  add(node, "FeatureItemId", shape.item);
  if (draft.device) add_references(node, "MeasurementDeviceIds", {*draft.device});
  add_point_list(node, points);
  add_algorithm(node, found.reference);
  add_place(node, shape.shape, text_of(found.axis.point_mm), text_of(found.axis.direction));
  if (shape.shape != record::Shape::kPlane) add(node, "Diameter", decimal(2.0 * found.radius_mm));
  add(node, "Form", decimal(found.deviation_mm));
}

/// The rows of a layer as a range; empty where they are not consecutive.
PointRange point_range(std::optional<int> set, const std::vector<std::size_t>& rows) {
  if (rows.empty() || rows.back() - rows.front() + 1 != rows.size()) return {};
  if (!std::is_sorted(rows.begin(), rows.end())) return {};
  return {set, std::pair{rows.front(), rows.back()}};
}

/// The axis for angles and deviations of the cloud, where there is a zone.
std::optional<fit::Axis> zone_axis(const evaluation::FeatureResult& feature) {
  if (feature.mz_cylinder) return feature.mz_cylinder->axis;
  if (feature.feature.shape != record::Shape::kCircle || feature.layers.empty()) return {};
  const evaluation::LayerResult& section = feature.layers.front();
  if (!section.mz) return {};
  return section_axis(feature, section, section.mz->center_mm);
}

void append(std::string& list, const std::string& item) {
  if (!list.empty()) list += ' ';
  list += item;
}

/// Unit vectors out of the material, one for each point.
std::string normals_of(const evaluation::FeatureResult& feature, const fit::Axis& axis) {
  const double sign = feature.feature.side == record::Side::kOutside ? 1.0 : -1.0;
  const Eigen::Vector3d unit = axis.direction.normalized();
  std::string text;
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const Eigen::Vector3d arm = point.tip_mm - axis.point_mm;
    Eigen::Vector3d radial = arm - arm.dot(unit) * unit;
    const double length_mm = radial.norm();
    radial = length_mm > 0.0 ? Eigen::Vector3d(radial / length_mm)
                             : Eigen::Vector3d(fit::across(unit).col(0));
    append(text, text_of(sign * radial));
  }
  return text;
}

/// Writes the evaluated points: means of repeated touches, as tip centres where the tip is known,
/// with normals out of the material, and with deviations where there is a zone.
/// @return The id of the set; none without points.
std::optional<int> add_points(QifDraft& draft, const evaluation::FeatureResult& feature) {
  if (feature.cloud.empty()) return {};
  const auto axis = zone_axis(feature);
  pugi::xml_node node = add(draft.lists.point_sets, "MeasuredPointSet");
  const int id = draft.ids.next();
  node.append_attribute("count").set_value(static_cast<unsigned long long>(feature.cloud.size()));
  node.append_attribute("id").set_value(id);
  add_attributes(node,
                 {{"frame", draft.frame},
                  {"points", !feature.tip_radius_mm         ? "as given; the tip is not known"
                             : passes_of(feature.cloud) > 1 ? "tip centres; all passes"
                                                            : "tip centres; means of repeated "
                                                              "touches"},
                  {"temperature", feature.thermal ? "brought to 20 degC" : "as measured"}});
  std::string points;
  std::string deviations;
  for (const evaluation::CloudPoint& point : feature.cloud) {
    append(points, text_of(point.tip_mm));
    append(deviations, core::shortest(point.deviation_mm));
  }
  add(node, "Points", points);
  if (axis) add(node, "Normals", normals_of(feature, *axis));
  add(node, "Compensated", feature.tip_radius_mm ? "false" : "true");
  if (feature.tip_radius_mm) add(node, "ProbeRadius", decimal(*feature.tip_radius_mm));
  if (draft.device) add(node, "MeasurementDeviceId", *draft.device);
  if (axis) add(node, "Deviations", deviations);
  return id;
}

}  // namespace

QifFeature add_qif_feature(QifDraft& draft, const evaluation::FeatureResult& measured) {
  const auto outside = evaluation::outside_windows(measured);
  const evaluation::FeatureResult& feature = outside ? *outside : measured;
  const record::Feature& asked = feature.feature;
  QifFeature out;
  if (record::is_analysis(asked.shape)) return out;
  draft.frame = feature.merged ? "body, of several poses" : "machine, final pose";
  const bool circle = asked.shape == record::Shape::kCircle;
  const std::optional<int> set = add_points(draft, feature);
  out.whole = add_shape(draft, asked, asked.shape, 0.0, asked.id);
  if (circle) {
    if (feature.layers.empty()) return out;
    for (const Associated& found : circles_of(feature, feature.layers.front())) {
      add_measurement(draft, *out.whole, found, {set, {}});
    }
    return out;
  }
  for (const Associated& found : planes_of(feature)) {
    add_measurement(draft, *out.whole, found, {set, {}});
  }
  if (asked.shape != record::Shape::kCylinder) return out;
  for (const Associated& found : cylinders_of(feature)) {
    add_measurement(draft, *out.whole, found, {set, {}});
  }
  for (const evaluation::LayerResult& layer : feature.layers) {
    QifShape section = add_shape(draft, asked, record::Shape::kCircle, layer.height_mm,
                                 fmt::format("{}, section {}", asked.id, layer.layer + 1));
    for (const Associated& found : circles_of(feature, layer)) {
      add_measurement(draft, section, found, point_range(set, layer.rows));
    }
    out.sections.push_back(section);
  }
  return out;
}

}  // namespace rondure::reports
