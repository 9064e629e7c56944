#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/encodings.h"
#include "plans/key_spec.h"

namespace rondure::app {
namespace {

/// A line for each code of errors, warnings and decisions, and for the influences: "name: text", or
/// "name name: text".
constexpr std::string_view kCodes =
#include "app/text/codes.inc"
    ;

/// The lines as name and text.
std::vector<std::pair<std::string_view, std::string_view>> entries() {
  std::vector<std::pair<std::string_view, std::string_view>> out;
  for (std::string_view rest = kCodes; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(line.size() + 1);
    const std::size_t colon = line.find(": ");
    for (std::string_view names = line.substr(0, colon); !names.empty();) {
      const std::string_view name = names.substr(0, names.find(' '));
      out.emplace_back(name, line.substr(colon + 2));
      names.remove_prefix(std::min(name.size() + 1, names.size()));
    }
  }
  return out;
}

}  // namespace

int explain(const ExplainArguments& arguments) {
  std::string code = arguments.code;
  std::erase_if(code, [](char c) { return c == '[' || c == ']'; });  // as messages have it
  std::vector<std::string_view> names;
  for (const auto& [name, text] : entries()) {
    names.push_back(name);
    if (name == code) {
      say(wrapped(text, fmt::format("{}: ", name), "  "));
      return kAllWell;
    }
  }
  if (code.empty()) {
    say(wrapped(fmt::format("{}", fmt::join(names, " ")), "", ""));
    return kAllWell;
  }
  const std::string_view near = plans::nearest_word(code, names);
  return refuse(core::Error{
      core::Code::kBadOption,
      near.empty()
          ? fmt::format("there is no code {}; all: rondure explain", core::printable(code))
          : fmt::format("there is no code {}; did you mean {}?", core::printable(code), near)});
}

}  // namespace rondure::app
