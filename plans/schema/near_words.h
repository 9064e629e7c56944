#pragma once

#include <string_view>
#include <vector>

namespace rondure::plans {

/// The known word that is meant: the one that drawings or other programs call so ("circularity" for
/// "roundness"), else the most similar by edit distance (swapped neighbours count as one edit), if
/// it is close enough to be a typing error, else "".
[[nodiscard]] std::string_view nearest_word(std::string_view word,
                                            const std::vector<std::string_view>& known);

}  // namespace rondure::plans
