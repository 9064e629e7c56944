#include "reports/words/internal/sentence_format.h"

#include <algorithm>

namespace rondure::reports {
namespace {

bool is_small(char c) { return c >= 'a' && c <= 'z'; }

bool is_unit(std::string_view word) { return word == "deg" || word == "urad"; }

/// Characters of a number as fmt writes it, also "inf" and an en dash.
bool is_number(std::string_view text) {
  return text == "inf" || text == "nan" || text == "\u2013" ||
         text.find_first_not_of("+-0123456789.e") == std::string_view::npos;
}

}  // namespace

bool has_no_words(std::string_view text) {
  while (!text.empty()) {
    const auto first = std::find_if(text.begin(), text.end(), is_small);
    const auto last = std::find_if_not(first, text.end(), is_small);
    const std::string_view word(first, last);
    if (word.size() >= 3 && !is_unit(word)) return false;
    text = std::string_view(last, text.end());
  }
  return true;
}

SentenceFormat::SentenceFormat(std::string_view format) {
  for (std::size_t next = 0;; ++next) {
    const std::size_t open = format.find('{');
    pieces_.emplace_back(format.substr(0, open));
    letters_ += pieces_.back().size();
    if (open == std::string_view::npos) return;
    const std::size_t close = std::min(format.find('}', open), format.size() - 1);
    const std::string_view inside = format.substr(open + 1, close - open - 1);
    const bool numbered = !inside.empty() && inside.front() != ':';
    const std::size_t index =
        numbered ? static_cast<std::size_t>(inside.front() - '0') % 10 : std::min(next, 9UL);
    indices_.push_back(index);
    if (index >= kinds_.size()) kinds_.resize(index + 1, Kind::kText);
    if (inside.ends_with('f') || inside.ends_with('g')) kinds_[index] = Kind::kNumber;
    if (inside.ends_with('s')) kinds_[index] = Kind::kName;
    format.remove_prefix(close + 1);
  }
}

bool SentenceFormat::stays(std::size_t argument) const {
  return argument < kinds_.size() && kinds_[argument] == Kind::kName;
}

bool SentenceFormat::match(std::string_view rest, std::size_t place,
                           std::vector<std::string>& found) const {
  if (place == indices_.size()) return rest.empty();
  const std::size_t index = indices_[place];
  const std::string& next = pieces_[place + 1];
  const bool last = place + 1 == indices_.size();
  const std::string before = found[index];
  for (std::size_t at = 1; at <= rest.size(); ++at) {
    // After the last place, the rest of the format must end the sentence.
    if (last) at = std::max(at, rest.size() - std::min(rest.size(), next.size()));
    at = rest.find(next, at);
    if (at == std::string_view::npos) break;
    const std::string_view candidate = rest.substr(0, at);
    if (!before.empty() && before != candidate) continue;
    if (kinds_[index] == Kind::kNumber && !is_number(candidate)) continue;
    found[index] = candidate;
    if (match(rest.substr(at + next.size()), place + 1, found)) return true;
    found[index] = before;
  }
  return false;
}

std::optional<std::vector<std::string>> SentenceFormat::arguments_of(
    std::string_view sentence) const {
  if (indices_.empty() || !sentence.starts_with(pieces_.front())) return std::nullopt;
  std::vector<std::string> found(kinds_.size());
  if (!match(sentence.substr(pieces_.front().size()), 0, found)) return std::nullopt;
  return found;
}

std::string SentenceFormat::with(const std::vector<std::string>& arguments) const {
  std::string out = pieces_.front();
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    if (indices_[i] < arguments.size()) out += arguments[indices_[i]];
    out += pieces_[i + 1];
  }
  return out;
}

}  // namespace rondure::reports
