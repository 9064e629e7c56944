#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports::testing {

/// Finds the first English text of a page that is not marked as English: a text, or a label of a
/// drawing or a cell, with a word of three small letters or more. The search ignores elements with
/// lang="en", codes and digests (classes "code" and "mono"), and the style. `names`, the texts of
/// the user, are removed first.
/// @return  Empty when there is none.
[[nodiscard]] std::string english_left(std::string_view page, std::vector<std::string> names);

}  // namespace rondure::reports::testing
