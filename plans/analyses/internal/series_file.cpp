#include "plans/analyses/internal/series_file.h"

#include <cstdint>
#include <system_error>

#include <fmt/format.h>

#include "plans/schema/json_text.h"
#include "record/files.h"

namespace rondure::plans {

using core::Code;

constexpr std::uintmax_t kMaxDataFileBytes = 1'000'000'000;

core::Result<std::string> read_data_file(const std::filesystem::path& path,
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
  if (!reason && bytes > kMaxDataFileBytes) {
    return core::fail(Code::kFile, fmt::format("the file {} has {} bytes, the limit is {}",
                                               in_quotes(file), bytes, kMaxDataFileBytes));
  }
  return record::read_file(path);
}

}  // namespace rondure::plans
