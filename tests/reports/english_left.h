#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports::testing {

/// The first piece of a page that is English and does not say so: a text, or a label of a drawing
/// or a cell, with a word of three small letters or more. Not looked at: what stands within
/// lang="en", codes and digests (classes "code" and "mono"), the style. Taken away first: `names`,
/// the texts of the user.
/// @return  Empty when there is none.
[[nodiscard]] std::string english_left(std::string_view page, std::vector<std::string> names);

}  // namespace rondure::reports::testing
