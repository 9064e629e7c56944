#pragma once

#include <filesystem>
#include <string>

namespace rondure::wire {

/// The programs that have a device file open, e.g. "minicom (process 4711)"; several are separated
/// by commas. "" when none is found: programs of other users cannot be seen.
[[nodiscard]] std::string device_holders(const std::filesystem::path& device);

}  // namespace rondure::wire
