#pragma once

#include <filesystem>
#include <string>

namespace rondure::wire {

/// Who has a device file open, e.g. "minicom (process 4711)"; several with commas. "" when nobody
/// is found: programs of other users cannot be seen.
[[nodiscard]] std::string device_holders(const std::filesystem::path& device);

}  // namespace rondure::wire
