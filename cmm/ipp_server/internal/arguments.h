#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_server/backend.h"

// Shared by the command handlers of the server.

namespace rondure::cmm::ipp {

using Arguments = std::vector<Item>;

inline constexpr std::size_t kMaxNames = 64;  ///< Per command: the answer must fit into one line.

[[nodiscard]] inline tl::unexpected<Failure> refusal(int number, std::string what) {
  return tl::unexpected(Failure{number, std::move(what)});
}

/// The refusal of arguments that do not match `wanted`: "()", "(number)".
[[nodiscard]] inline tl::unexpected<Failure> wrong_arguments(std::string_view wanted) {
  return refusal(kIncorrectArguments, "the arguments are not " + std::string(wanted));
}

/// An answer of one item.
[[nodiscard]] inline Outcome one_line(Item item) { return Reply{{{std::move(item)}}, 0}; }

/// IsHomed(1): without decimals whatever the form of numbers is.
[[nodiscard]] inline Item flag_item(std::string_view method, bool value) {
  return call_item(method, {name_item(value ? "1" : "0")});
}

[[nodiscard]] inline bool is_one_of(std::string_view name,
                                    std::span<const std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The names of X(), Y(), IJK(); nothing when any argument is not such a call, when there are none,
/// or more than kMaxNames.
[[nodiscard]] inline std::optional<std::vector<std::string>> empty_calls(
    const Arguments& arguments) {
  std::vector<std::string> out;
  for (const Item& item : arguments) {
    if (item.kind != Item::Kind::kCall || !item.arguments.empty()) return std::nullopt;
    out.push_back(item.text);
  }
  if (out.empty() || out.size() > kMaxNames) return std::nullopt;
  return out;
}

}  // namespace rondure::cmm::ipp
