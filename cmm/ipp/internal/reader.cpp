#include "cmm/ipp/internal/reader.h"

#include <algorithm>

#include <fmt/format.h>

#include "cmm/ipp/internal/errors.h"
#include "cmm/ipp/numbers.h"

namespace rondure::cmm::ipp {
namespace {

constexpr int kLiberalDigits = 400;  // accepts servers that write more digits than allowed

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// Characters that occur in numbers, valid or not.
bool is_number_character(char c) {
  return is_digit(c) || is_letter(c) || c == '+' || c == '-' || c == '.';
}

}  // namespace

bool is_plain(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 32 && c <= 126; });
}

std::string excerpt(std::string_view line, std::size_t shown) {
  std::string out;
  for (const char c : line.substr(0, shown)) out += c >= 32 && c <= 126 ? c : '?';
  return line.size() > shown ? out + "..." : out;
}

void ItemReader::skip_spaces() {
  while (at_ < text_.size() && text_[at_] == ' ') ++at_;
}

bool ItemReader::at_end() {
  skip_spaces();
  return at_ == text_.size();
}

bool ItemReader::take(char c) {
  if (at_ >= text_.size() || text_[at_] != c) return false;
  ++at_;
  return true;
}

tl::unexpected<ItemReader::Fault> ItemReader::fault(int number, std::string_view what) const {
  return tl::unexpected(Fault{number, fmt::format("{} in column {}", what, at_ + 1)});
}

std::string_view ItemReader::read_name(bool dotted) {
  const std::size_t begin = at_;
  std::size_t end = begin;
  while (true) {
    std::size_t part = end;
    if (part >= text_.size() || !is_letter(text_[part])) break;
    while (part < text_.size() && (is_letter(text_[part]) || is_digit(text_[part]) ||
                                   (manner_ == Manner::kLiberal && text_[part] == '_'))) {
      ++part;
    }
    end = part;
    if (!dotted || end >= text_.size() || text_[end] != '.') break;
    ++end;
  }
  if (end > begin && text_[end - 1] == '.') --end;  // a point must be followed by a name
  at_ = end;
  return text_.substr(begin, end - begin);
}

ItemReader::Read<Item> ItemReader::read_string() {
  ++at_;  // the opening quote
  const std::size_t end = text_.find('"', at_);
  if (end == std::string_view::npos) return fault(kIncorrectArguments, "a string without its end");
  if (end == at_ && manner_ == Manner::kStrict) {
    return fault(kIncorrectArguments, "an empty string");
  }
  Item item = string_item(text_.substr(at_, end - at_));
  at_ = end + 1;
  return item;
}

ItemReader::Read<Item> ItemReader::read_number_item() {
  std::size_t end = at_;
  while (end < text_.size() && is_number_character(text_[end])) ++end;
  const auto value =
      read_number(text_.substr(at_, end - at_), manner_ == Manner::kStrict ? 16 : kLiberalDigits);
  if (!value) return fault(kBadArgument, "a number out of form");
  at_ = end;
  return number_item(*value);
}

ItemReader::Read<Item> ItemReader::read_name_or_call(int depth) {
  const std::string_view name = read_name(true);
  if (name.empty()) return fault(kIncorrectArguments, "no argument");
  const std::size_t behind = at_;
  skip_spaces();
  if (at_ >= text_.size() || text_[at_] != '(') {
    at_ = behind;
    return name_item(name);
  }
  TRY(auto arguments, read_arguments(depth + 1));
  return call_item(name, std::move(arguments));
}

ItemReader::Read<Item> ItemReader::read_item(int depth) {
  if (at_ >= text_.size()) return fault(kIncorrectArguments, "the line ends too early");
  const char c = text_[at_];
  if (c == '"') return read_string();
  if (is_digit(c) || c == '+' || c == '-' || c == '.') return read_number_item();
  if (c == '(' && manner_ == Manner::kLiberal) {
    TRY(auto arguments, read_arguments(depth + 1));
    return Item{Item::Kind::kVector, 0.0, {}, std::move(arguments)};
  }
  return read_name_or_call(depth);
}

ItemReader::Read<std::vector<Item>> ItemReader::read_arguments(int depth) {
  if (depth > kMaxDepth) return fault(kProtocolError, "too many parentheses");
  skip_spaces();
  if (!take('(')) return fault(kIncorrectArguments, "no opening parenthesis");
  std::vector<Item> out;
  skip_spaces();
  if (take(')')) return out;
  while (true) {
    TRY(auto item, read_item(depth));
    out.push_back(std::move(item));
    skip_spaces();
    if (take(')')) return out;
    if (!take(',')) return fault(kIncorrectArguments, "neither comma nor closing parenthesis");
    skip_spaces();
  }
}

ItemReader::Read<std::vector<Item>> ItemReader::read_list() {
  std::vector<Item> out;
  while (true) {
    skip_spaces();
    TRY(auto item, read_item(0));
    out.push_back(std::move(item));
    if (at_end()) return out;
    if (!take(',')) return fault(kIncorrectArguments, "no comma between items");
  }
}

}  // namespace rondure::cmm::ipp
