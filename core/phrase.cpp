#include "core/phrase.h"

#include <ostream>
#include <utility>

#include <fmt/args.h>
#include <fmt/format.h>

namespace rondure::core {

Phrase::Phrase() = default;

Phrase::Phrase(std::string_view text) : format_(text) {}

Phrase::Phrase(std::string_view format, std::vector<Argument> arguments)
    : format_(format), arguments_(std::move(arguments)) {}

std::string Phrase::english() const {
  std::vector<Argument> shown = arguments_;
  for (Argument& argument : shown) {
    if (const auto* part = std::get_if<Phrase>(&argument.value)) {
      argument = Argument(part->english());
    }
  }
  return filled(format_, shown);
}

std::string filled(std::string_view format, const std::vector<Phrase::Argument>& arguments) {
  if (arguments.empty()) return std::string(format);  // a text, in which a brace is a brace
  fmt::dynamic_format_arg_store<fmt::format_context> store;
  for (const Phrase::Argument& argument : arguments) {
    std::visit(
        [&](const auto& value) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, Phrase>) {
            store.push_back(value);
          }
        },
        argument.value);
  }
  return fmt::vformat(fmt::string_view(format.data(), format.size()), store);
}

bool operator==(const Phrase& a, const Phrase& b) { return a.english() == b.english(); }

bool operator==(const Phrase& a, std::string_view b) { return a.english() == b; }

std::ostream& operator<<(std::ostream& out, const Phrase& phrase) {
  return out << phrase.english();
}

Phrase as_it_is(std::string_view text) { return text.empty() ? Phrase() : phrase("{}", text); }

Phrase joined(const Phrase& first, const Phrase& second) {
  if (first.empty() || second.empty()) return first.empty() ? second : first;
  return phrase("{}; {}", first, second);
}

}  // namespace rondure::core
