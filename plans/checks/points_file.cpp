#include <string>

#include <fmt/format.h>

#include "plans/analyses/internal/series_file.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/schema/json_text.h"
#include "record/csv/points.h"

namespace rondure::plans {

using core::Code;

void check_points_file(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index) + "/source/file";
  if (!feature.source || !findings.sound(feature_pointer(index) + "/source")) return;
  const std::string& file = feature.source->file;
  const auto bytes = read_data_file(plan.folder / file, file);
  if (!bytes) return findings.meaning(bytes.error().code, where, bytes.error().what);
  const auto table = record::parse_points_csv(*bytes, file);
  if (!table) {
    const core::Error& error = table.error();
    return findings.meaning(error.code, error.where.empty() ? where : error.where, error.what);
  }
  const bool cylinder = feature.type == record::Shape::kCylinder;
  if (cylinder && table->dimensions != 3) {
    return findings.meaning(
        Code::kMeaning, where,
        fmt::format("the file {} has the columns x,y; a cylinder needs x,y,z", in_quotes(file)));
  }
  const std::size_t needed = cylinder ? 6 : 4;
  if (table->points_mm.size() < needed) {
    findings.meaning(
        Code::kTooFewPoints, where,
        fmt::format("the file {} has {} points; a {} needs at least {}", in_quotes(file),
                    table->points_mm.size(), name_of(feature.type), needed));
  }
}

}  // namespace rondure::plans
