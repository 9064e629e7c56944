#pragma once

#include <string>
#include <string_view>

namespace rondure::fuzz {

// Runs verbs that read a file, in this process; each returns "" or a description of the fault. The
// first byte selects options; the others are the file.

[[nodiscard]] std::string try_fit(std::string_view bytes);
[[nodiscard]] std::string try_rotary_axes(std::string_view bytes);
[[nodiscard]] std::string try_roundness(std::string_view bytes);

}  // namespace rondure::fuzz
