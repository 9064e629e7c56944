#include "plans/analyses/internal/series_file.h"

#include <system_error>

#include "plans/schema/json_text.h"

namespace rondure::plans {

using core::Code;

core::Result<std::string> read_data_file(const std::filesystem::path& path, const std::string& file,
                                         std::uintmax_t most_bytes) {
  std::error_code reason;
  const std::filesystem::file_status status = std::filesystem::status(path, reason);
  if (status.type() == std::filesystem::file_type::not_found) {
    return core::fail_with(
        Code::kFile, "the file {} does not exist; the name is relative to the folder of the plan",
        in_quotes(file));
  }
  if (!std::filesystem::is_regular_file(status)) {
    return core::fail_with(Code::kFile, "{} is not a file that can be read", in_quotes(file));
  }
  return record::read_file(path, most_bytes);
}

}  // namespace rondure::plans
