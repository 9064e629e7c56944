#include "core/numbers.h"
#include "evaluation/results/measured_cloud.h"
#include "evaluation/results/section.h"
#include "reports/data/qif/internal/parts.h"

namespace rondure::reports {
namespace {

using core::decimal;

/// The axis that angles and deviations of the cloud are about, where there is a zone.
std::optional<fit::Axis> zone_axis(const evaluation::FeatureResult& feature) {
  if (feature.mz_cylinder) return feature.mz_cylinder->axis;
  if (feature.feature.shape != record::Shape::kCircle || feature.layers.empty()) return {};
  const evaluation::LayerResult& section = feature.layers.front();
  if (!section.mz) return {};
  return section_axis(feature, section, section.mz->center_mm);
}

/// One more item of a list of numbers.
void append(std::string& list, const std::string& item) {
  if (!list.empty()) list += ' ';
  list += item;
}

/// Unit vectors out of the material, one a point.
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

}  // namespace

std::optional<int> add_qif_points(QifDraft& draft, const evaluation::FeatureResult& feature) {
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

}  // namespace rondure::reports
