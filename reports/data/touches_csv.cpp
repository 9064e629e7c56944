#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/utf8.h"
#include "reports/data/csv_field.h"
#include "reports/data/csv_files.h"

namespace rondure::reports {
namespace {

using core::printable;

std::string number(double value) { return std::isfinite(value) ? core::shortest(value) : ""; }

std::string measured(const std::optional<double>& value) { return value ? number(*value) : ""; }

}  // namespace

std::string write_touches_csv(const record::RunRecord& record) {
  std::map<int, std::string> feature_of_pose;
  for (const record::PoseVisit& pose : record.poses) {
    const auto index = static_cast<std::size_t>(pose.feature);
    if (pose.feature >= 0 && index < record.features.size()) {
      feature_of_pose[pose.id] = csv_field(record.features[index].id);
    }
  }
  std::string text = fmt::format("# rondure touches, run {}\n", printable(record.header.run_id));
  text +=
      "id,purpose,feature,pose,layer,point,repeat,x_mm,y_mm,z_mm,dir_x,dir_y,dir_z,"
      "temperature_degC,time_s,scale_temperature_degC\n";
  for (const record::Touch& touch : record.touches) {
    const auto feature = feature_of_pose.find(touch.pose);
    text += fmt::format("{},{},{},{},{},{},{}", touch.id, record::name_of(touch.purpose),
                        feature == feature_of_pose.end() ? "" : feature->second, touch.pose,
                        touch.layer, touch.point, touch.repeat);
    for (const double value : {touch.tip_mm.x(), touch.tip_mm.y(), touch.tip_mm.z(),
                               touch.approach.x(), touch.approach.y(), touch.approach.z()}) {
      text += ',';
      text += number(value);
    }
    text += fmt::format(",{},{},{}\n", measured(touch.temperature_degC), number(touch.time_s),
                        measured(touch.scale_temperature_degC));
  }
  return text;
}

}  // namespace rondure::reports
