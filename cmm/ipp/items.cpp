#include <algorithm>

#include <fmt/format.h>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp/numbers.h"

namespace rondure::cmm::ipp {
namespace {

bool all_digits(std::string_view text) { return std::all_of(text.begin(), text.end(), is_digit); }

int to_int(std::string_view digits) {
  int value = 0;
  for (const char c : digits) value = 10 * value + (c - '0');
  return value;
}

void append(std::string& out, const Item& item, NumberForm form);

void append(std::string& out, std::span<const Item> items, std::string_view between,
            NumberForm form) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) out += between;
    append(out, items[i], form);
  }
}

void append_string(std::string& out, std::string_view contents) {
  out += '"';
  for (const char c : contents) {
    if (c == '"') {
      out += '\'';
    } else {
      out += c >= 32 && c <= 126 ? c : '?';
    }
  }
  if (contents.empty()) out += ' ';
  out += '"';
}

void append(std::string& out, const Item& item, NumberForm form) {
  switch (item.kind) {
    case Item::Kind::kNumber:
      out += wire_number(item.number, form);
      return;
    case Item::Kind::kString:
      append_string(out, item.text);
      return;
    case Item::Kind::kName:
      out += item.text;
      return;
    case Item::Kind::kCall:
    case Item::Kind::kVector:
      out += item.text;
      out += '(';
      append(out, item.arguments, ",", form);
      out += ')';
      return;
  }
}

}  // namespace

std::string to_text(const Tag& tag) {
  return tag.event ? fmt::format("E{:04}", tag.number) : fmt::format("{:05}", tag.number);
}

std::optional<Tag> read_tag(std::string_view text) {
  if (text.size() != kTagLength) return std::nullopt;
  if (text[0] == 'E' && all_digits(text.substr(1))) return Tag{true, to_int(text.substr(1))};
  if (!all_digits(text) || text == "00000") return std::nullopt;
  return Tag{false, to_int(text)};
}

Item number_item(double value) { return {Item::Kind::kNumber, value, {}, {}}; }

Item string_item(std::string_view contents) {
  return {Item::Kind::kString, 0.0, std::string(contents), {}};
}

Item name_item(std::string_view name) { return {Item::Kind::kName, 0.0, std::string(name), {}}; }

Item call_item(std::string_view name, std::vector<Item> arguments) {
  return {Item::Kind::kCall, 0.0, std::string(name), std::move(arguments)};
}

Item call_item(std::string_view name, std::initializer_list<double> values) {
  std::vector<Item> arguments;
  arguments.reserve(values.size());
  for (const double value : values) arguments.push_back(number_item(value));
  return call_item(name, std::move(arguments));
}

Item call_item(std::string_view name, const Eigen::Vector3d& values) {
  return call_item(name, {values.x(), values.y(), values.z()});
}

std::string to_text(const Item& item, NumberForm form) {
  std::string out;
  append(out, item, form);
  return out;
}

std::string to_text(std::span<const Item> items, NumberForm form) {
  const bool bare = std::all_of(items.begin(), items.end(),
                                [](const Item& item) { return item.kind == Item::Kind::kNumber; });
  std::string out;
  append(out, items, bare ? "," : ", ", form);
  return out;
}

const Item* find_call(std::span<const Item> items, std::string_view name) {
  const auto found = std::find_if(items.begin(), items.end(), [name](const Item& item) {
    return item.kind == Item::Kind::kCall && item.text == name;
  });
  return found == items.end() ? nullptr : &*found;
}

std::optional<double> single_number(const Item& call) {
  if (call.arguments.size() != 1 || call.arguments[0].kind != Item::Kind::kNumber) {
    return std::nullopt;
  }
  return call.arguments[0].number;
}

std::optional<std::vector<double>> numbers_of(const Item& call) {
  std::vector<double> out;
  out.reserve(call.arguments.size());
  for (const Item& item : call.arguments) {
    if (item.kind != Item::Kind::kNumber) return std::nullopt;
    out.push_back(item.number);
  }
  return out;
}

std::optional<Eigen::Vector3d> vector_of(const Item& call) {
  const auto numbers = numbers_of(call);
  if (!numbers || numbers->size() != 3) return std::nullopt;
  return Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

std::optional<std::string> string_of(const Item& item) {
  if (item.kind == Item::Kind::kString) return item.text;
  if (item.arguments.size() == 1 && item.arguments[0].kind == Item::Kind::kString) {
    return item.arguments[0].text;
  }
  return std::nullopt;
}

}  // namespace rondure::cmm::ipp
