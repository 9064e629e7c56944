#include "reports/sentence_format.h"

#include <algorithm>

namespace rondure::reports {
namespace {

bool is_small(char c) { return c >= 'a' && c <= 'z'; }

/// Characters of a number as fmt writes it, also "inf" and an en dash.
bool is_number(std::string_view text) {
  return text == "inf" || text == "nan" || text == "\u2013" ||
         text.find_first_not_of("+-0123456789.e") == std::string_view::npos;
}

/// One place of a format: "{}", "{1}", "{:.3f}", "{0:g}".
struct Place {
  std::size_t index = 0;
  bool number = false;
};

/// Calls `text` with each piece of fixed text and `place` with each place, in order.
template <class OnText, class OnPlace>
void walk(std::string_view format, const OnText& text, const OnPlace& place) {
  std::size_t next = 0;
  for (;;) {
    const std::size_t open = format.find('{');
    text(format.substr(0, open));
    if (open == std::string_view::npos) return;
    const std::size_t close = format.find('}', open);
    std::string_view inside = format.substr(open + 1, close - open - 1);
    Place found;
    const bool numbered = !inside.empty() && inside.front() != ':';
    found.index = numbered ? static_cast<std::size_t>(inside.front() - '0') : next++;
    found.number =
        inside.find('f') != std::string_view::npos || inside.find('g') != std::string_view::npos;
    place(found);
    format.remove_prefix(close + 1);
  }
}

}  // namespace

bool has_no_words(std::string_view text) {
  int run = 0;
  for (const char c : text) {
    run = is_small(c) ? run + 1 : 0;
    if (run == 3) return false;
  }
  return true;
}

SentenceFormat::SentenceFormat(std::string_view format) {
  walk(
      format,
      [&](std::string_view text) {
        pieces_.emplace_back(text);
        letters_ += text.size();
      },
      [&](const Place& place) {
        indices_.push_back(place.index);
        if (place.index >= numbers_only_.size()) numbers_only_.resize(place.index + 1);
        if (place.number) numbers_only_[place.index] = true;
      });
}

bool SentenceFormat::match(std::string_view rest, std::size_t place,
                           std::vector<std::string>& found) const {
  if (place == indices_.size()) return rest.empty();
  const std::string& next = pieces_[place + 1];
  const bool last = place + 1 == indices_.size();
  std::string& argument = found[indices_[place]];
  const std::string before = argument;
  for (std::size_t at = 1; at <= rest.size(); ++at) {
    at = last ? rest.size() - std::min(next.size(), rest.size() - 1) : rest.find(next, at);
    if (at == std::string_view::npos) break;
    const std::string_view candidate = rest.substr(0, at);
    const bool fits = rest.substr(at, next.size()) == next &&
                      (before.empty() || before == candidate) &&
                      (!numbers_only_[indices_[place]] || is_number(candidate));
    if (fits) {
      argument = candidate;
      if (match(rest.substr(at + next.size()), place + 1, found)) return true;
      argument = before;
    }
    if (last) break;
  }
  return false;
}

std::optional<std::vector<std::string>> SentenceFormat::arguments_of(
    std::string_view sentence) const {
  if (indices_.empty() || sentence.substr(0, pieces_.front().size()) != pieces_.front()) {
    return std::nullopt;
  }
  std::vector<std::string> found(numbers_only_.size());
  if (!match(sentence.substr(pieces_.front().size()), 0, found)) return std::nullopt;
  return found;
}

std::string with_arguments(std::string_view format, const std::vector<std::string>& arguments) {
  std::string out;
  walk(
      format, [&](std::string_view text) { out += text; },
      [&](const Place& place) {
        if (place.index < arguments.size()) out += arguments[place.index];
      });
  return out;
}

}  // namespace rondure::reports
