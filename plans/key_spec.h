#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "record/key_spec.h"

namespace rondure::plans {

using record::above;
using record::GroupSpec;
using record::NumberSpec;
using record::range;
using record::required;
using record::spec_of_words;
using record::TextSpec;
using record::within;

inline constexpr std::size_t kMaxTextBytes = 10'000;
inline constexpr std::size_t kMaxListItems = 1000;

/// The unit in the suffix of a key, as messages print it: "diameter_mm" gives "mm",
/// "touch_speed_mm_s" gives "mm/s", "layers" gives "".
[[nodiscard]] std::string_view unit_of(std::string_view key);

/// The key without its unit suffix, also for a unit that no plan uses ("diameter_inch").
[[nodiscard]] std::string_view stem_of(std::string_view key);

/// The known word that is meant: the one that drawings or other programs call so ("circularity" for
/// "roundness"), else the most similar by edit distance (swapped neighbours count as one edit), if
/// it is close enough to be a typing error, else "".
[[nodiscard]] std::string_view nearest_word(std::string_view word,
                                            const std::vector<std::string_view>& known);

}  // namespace rondure::plans
