#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "plans/json_text.h"
#include "plans/plan_checks.h"
#include "record/points_csv.h"

namespace rondure::plans {
namespace {

using core::Code;

constexpr std::uintmax_t kMaxPointsFileBytes = 1'000'000'000;

// The bytes of a points file; the error names the file as the plan does.
core::Result<std::string> read_points_file(const std::filesystem::path& path,
                                           const std::string& file) {
  std::error_code reason;
  const std::filesystem::file_status status = std::filesystem::status(path, reason);
  if (status.type() == std::filesystem::file_type::not_found) {
    return core::fail(Code::kFile,
                      fmt::format("the file {} does not exist; the name is relative to "
                                  "the folder of the plan",
                                  in_quotes(file)));
  }
  if (!std::filesystem::is_regular_file(status)) {
    return core::fail(Code::kFile,
                      fmt::format("{} is not a file that can be read", in_quotes(file)));
  }
  const std::uintmax_t bytes = std::filesystem::file_size(path, reason);
  if (!reason && bytes > kMaxPointsFileBytes) {
    return core::fail(Code::kFile, fmt::format("the file {} has {} bytes, the limit is {}",
                                               in_quotes(file), bytes, kMaxPointsFileBytes));
  }
  return record::read_file(path);
}

}  // namespace

void check_points_file(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index) + "/source/file";
  if (!feature.source || !findings.sound(feature_pointer(index) + "/source")) return;
  const std::string& file = feature.source->file;
  const auto bytes = read_points_file(plan.folder / file, file);
  if (!bytes) return findings.meaning(bytes.error().code, where, bytes.error().what);
  const auto table = record::parse_points_csv(*bytes, file);
  if (!table) {
    const core::Error& error = table.error();
    return findings.meaning(error.code, error.where.empty() ? where : error.where, error.what);
  }
  const bool cylinder = feature.type == "cylinder";
  if (cylinder && table->dimensions != 3) {
    return findings.meaning(
        Code::kMeaning, where,
        fmt::format("the file {} has the columns x,y; a cylinder needs x,y,z", in_quotes(file)));
  }
  const std::size_t needed = cylinder ? 6 : 4;
  if (table->points_mm.size() < needed) {
    findings.meaning(Code::kTooFewPoints, where,
                     fmt::format("the file {} has {} points; a {} needs at least {}",
                                 in_quotes(file), table->points_mm.size(), feature.type, needed));
  }
}

}  // namespace rondure::plans
