#include "cmm/ipp/internal/reader.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "cmm/ipp/numbers.h"

namespace rondure::cmm::ipp {
namespace {

constexpr std::array kErrors = {
    ErrorEntry{0, 0, "Buffer full"},
    ErrorEntry{1, 2, "Illegal tag"},
    ErrorEntry{2, 2, "No space at pos. 6"},
    ErrorEntry{6, 2, "Transaction aborted (Use ClearAllErrors To Continue)"},
    ErrorEntry{7, 3, "Illegal character"},
    ErrorEntry{8, 3, "Protocol error"},
    ErrorEntry{500, 3, "Emergency stop"},
    ErrorEntry{501, 3, "Unsupported command"},
    ErrorEntry{502, 3, "Incorrect arguments"},
    ErrorEntry{503, 9, "Controller communications failure"},
    ErrorEntry{504, 1, "Argument out of range"},
    ErrorEntry{505, 3, "Argument not recognized"},
    ErrorEntry{506, 3, "Argument not supported"},
    ErrorEntry{507, 3, "Illegal command"},
    ErrorEntry{508, 3, "Bad context"},
    ErrorEntry{509, 3, "Bad argument"},
    ErrorEntry{510, 3, "Bad property"},
    ErrorEntry{511, 3, "Error processing method"},
    ErrorEntry{512, 1, "No daemons are active"},
    ErrorEntry{513, 2, "Daemon does not exist"},
    ErrorEntry{514, 2, "Use ClearAllErrors to continue"},
    ErrorEntry{515, 2, "Daemon already exists"},
    ErrorEntry{1000, 3, "Machine in error state"},
    ErrorEntry{1001, 2, "Illegal touch"},
    ErrorEntry{1002, 9, "Axis does not exist"},
    ErrorEntry{1003, 2, "No touch"},
    ErrorEntry{1004, 9, "Number of angles not supported on current device"},
    ErrorEntry{1005, 3, "Error during home"},
    ErrorEntry{1006, 2, "Surface not found"},
    ErrorEntry{1007, 3, "Theta out of range"},
    ErrorEntry{1008, 3, "Target position out of machine volume"},
    ErrorEntry{1009, 3, "Air pressure out of range"},
    ErrorEntry{1010, 2, "Vector has no norm"},
    ErrorEntry{1011, 2, "Unable to move"},
    ErrorEntry{1012, 2, "Bad lock combinations"},
    ErrorEntry{1013, 3, "Coordinate system not found"},
    ErrorEntry{1014, 2, "Failed to set value due to active internal correction"},
    ErrorEntry{1500, 3, "Failed to re-seat head"},
    ErrorEntry{1501, 3, "Probe not armed"},
    ErrorEntry{1502, 3, "Tool not found"},
    ErrorEntry{1503, 3, "Tool not defined"},
    ErrorEntry{1504, 3, "Collection not found"},
    ErrorEntry{1505, 2, "Tool not alignable"},
    ErrorEntry{1506, 1, "Tool property not applicable"},
    ErrorEntry{1507, 3, "Tool not alignable to given orientation"},
    ErrorEntry{2000, 3, "Tool not calibrated"},
    ErrorEntry{2001, 2, "Head error excessive force"},
    ErrorEntry{2002, 3, "Type of probe does not allow this operation"},
    ErrorEntry{2500, 3, "Machine limit encountered [Move Out Of Limits]"},
    ErrorEntry{2501, 3, "Axis not active"},
    ErrorEntry{2502, 3, "Axis position error"},
    ErrorEntry{2503, 9, "Scale read head failure"},
    ErrorEntry{2504, 3, "Collision"},
    ErrorEntry{2505, 2, "Specified angle out of range"},
    ErrorEntry{2506, 2, "Part not aligned"},
};

}  // namespace

const ErrorEntry* find_error(int number) {
  const auto found =
      std::lower_bound(kErrors.begin(), kErrors.end(), number,
                       [](const ErrorEntry& entry, int wanted) { return entry.number < wanted; });
  return found != kErrors.end() && found->number == number ? &*found : nullptr;
}

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
