#pragma once

#include <string_view>
#include <vector>

namespace rondure::plans {

/// The word that was probably meant: the nearest by edit distance (a swap of neighbours counts one)
/// when it is near enough to be a slip, else "".
[[nodiscard]] std::string_view nearest_word(std::string_view word,
                                            const std::vector<std::string_view>& known);

}  // namespace rondure::plans
