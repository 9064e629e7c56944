#include "plans/schema/internal/table_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/encodings.h"
#include "plans/key_spec.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;
using Kind = JsonValue::Kind;

// "in mm" for a key with a unit, otherwise empty.
std::string in_unit(std::string_view key) {
  const std::string_view unit = unit_of(key);
  return unit.empty() ? std::string() : fmt::format(" in {}", unit);
}

std::string with_unit(double value, std::string_view key) {
  const std::string_view unit = unit_of(key);
  return unit.empty() ? plain(value) : fmt::format("{} {}", plain(value), unit);
}

bool allowed(double value, const NumberSpec& spec) {
  const bool high_enough = spec.above ? value > spec.at_least : value >= spec.at_least;
  return high_enough && value <= spec.at_most;
}

std::string range_message(double value, std::string_view key, const NumberSpec& spec) {
  std::string message =
      spec.above
          ? fmt::format("{} is outside the limits: above {}, at most {}", with_unit(value, key),
                        plain(spec.at_least), with_unit(spec.at_most, key))
          : fmt::format("{} is outside {}..{}", with_unit(value, key), plain(spec.at_least),
                        with_unit(spec.at_most, key));
  if (!spec.hint.empty()) message += fmt::format("; {}", spec.hint);
  return message;
}

std::string spelled(const std::vector<std::string_view>& words) {
  std::string out;
  for (const std::string_view word : words) {
    out += fmt::format("{}\"{}\"", out.empty() ? "" : ", ", word);
  }
  return words.size() == 1 ? out : "one of " + out;
}

std::string spelling_message(const std::string& value, const TextSpec& spec) {
  constexpr std::size_t kMostListed = 12;  // more hide the one that is meant
  const std::string_view near = nearest_word(value, spec.one_of);
  if (!near.empty() && spec.one_of.size() > kMostListed) {
    return fmt::format(
        "{} is not known; did you mean \"{}\"? plans/schema/plan.schema.json lists all {} words",
        in_quotes(value), near, spec.one_of.size());
  }
  const std::string hint = near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near);
  return fmt::format("{} is not known; give {}{}", in_quotes(value), spelled(spec.one_of), hint);
}

// The first sentence of a meaning, which is enough for a message. "e.g. x" does not end a sentence.
std::string_view first_sentence(std::string_view text) {
  for (std::size_t at = text.find(". "); at != std::string_view::npos;
       at = text.find(". ", at + 1)) {
    const bool begins = at + 2 < text.size() && text[at + 2] >= 'A' && text[at + 2] <= 'Z';
    if (begins) return text.substr(0, at + 1);
  }
  return text;
}

// A sentence of the table as a clause: without full stop, with a small initial letter unless it is
// an abbreviation.
std::string as_clause(std::string_view sentence) {
  std::string clause(sentence);
  if (clause.ends_with('.')) clause.pop_back();
  const bool word = clause.size() > 1 && std::islower(static_cast<unsigned char>(clause[1])) != 0;
  if (word) clause[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(clause[0])));
  return clause;
}

}  // namespace

void TableReader::problem(const JsonValue& json, Code code, std::string where, std::string what) {
  findings_.structure(json.order, {code, std::move(what), std::move(where)});
}

const JsonValue* TableReader::value_at(std::string_view key, bool required,
                                       std::string_view meaning) {
  keys_.push_back(key);
  const JsonValue* json = object_.find(key);
  if (json != nullptr) {
    findings_.note_given(pointer_to(key));
  } else if (required) {
    problem(object_, Code::kMissingKey, pointer_to(key),
            fmt::format("this key is missing: {}", as_clause(first_sentence(meaning))));
  }
  return json;
}

bool TableReader::expect_object(const JsonValue& json, const std::string& pointer) {
  if (json.kind == Kind::kObject) return true;
  problem(json, Code::kWrongType, pointer,
          fmt::format("is {}; an object {{ ... }} is needed", found(json)));
  return false;
}

const JsonValue* TableReader::object_at(std::string_view key, const GroupSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr || !expect_object(*json, pointer_to(key))) return nullptr;
  return json;
}

const JsonValue* TableReader::list_at(std::string_view key, const GroupSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr) return nullptr;
  if (json->kind != Kind::kArray) {
    problem(*json, Code::kWrongType, pointer_to(key),
            fmt::format("is {}; an array of objects [ {{ ... }} ] is needed", found(*json)));
    return nullptr;
  }
  if (json->items.empty() && !spec.empty_allowed) {
    problem(*json, Code::kOutOfRange, pointer_to(key),
            "is an empty array; at least 1 entry is needed");
  }
  if (json->items.size() > kMaxListItems) {
    problem(*json, Code::kOutOfRange, pointer_to(key),
            fmt::format("has {} entries, the limit is {}", json->items.size(), kMaxListItems));
    return nullptr;
  }
  return json;
}

bool TableReader::read_text(const JsonValue& json, const std::string& pointer, const TextSpec& spec,
                            std::string& value) {
  const auto refuse = [&](Code code, std::string what) {
    problem(json, code, pointer, std::move(what));
    return false;
  };
  if (json.kind != Kind::kText) {
    return refuse(Code::kWrongType,
                  fmt::format("is {}; a text in double quotes is needed", found(json)));
  }
  if (!spec.one_of.empty() &&
      std::find(spec.one_of.begin(), spec.one_of.end(), json.text) == spec.one_of.end()) {
    return refuse(Code::kBadOption, spelling_message(json.text, spec));
  }
  if (json.text.empty() && !spec.empty_allowed) {
    return refuse(Code::kOutOfRange, "is an empty text; at least 1 character is needed");
  }
  if (json.text.size() > kMaxTextBytes) {
    return refuse(Code::kOutOfRange,
                  fmt::format("has {} bytes, the limit is {}", json.text.size(), kMaxTextBytes));
  }
  if (const std::size_t at = first_unshowable(json.text); at < json.text.size()) {
    return refuse(Code::kOutOfRange,
                  fmt::format("{} contains {}, which no report can show; remove it",
                              in_quotes(json.text), unshowable_in_words(json.text, at)));
  }
  value = json.text;
  return true;
}

void TableReader::text(std::string_view key, std::string& value, const TextSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr || !read_text(*json, pointer_to(key), spec, value) || key != "id") return;
  // Reports, datums and options name things by their ids: two must not look alike.
  if (const auto fault = fault_of_name(value)) {
    problem(*json, Code::kMeaning, pointer_to(key),
            fmt::format("{} {}", in_quotes(core::printable(value)), *fault));
  }
}

void TableReader::text(std::string_view key, std::optional<std::string>& value,
                       const TextSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr) return;
  std::string given;
  if (read_text(*json, pointer_to(key), spec, given)) value = std::move(given);
}

void TableReader::texts(std::string_view key, std::vector<std::string>& values,
                        const TextSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr) return;
  if (json->kind != Kind::kArray) {
    return problem(*json, Code::kWrongType, pointer_to(key),
                   fmt::format("is {}; an array of texts [ \"...\" ] is needed", found(*json)));
  }
  if (json->items.empty() && !spec.empty_allowed) {
    return problem(*json, Code::kOutOfRange, pointer_to(key),
                   "is an empty array; at least 1 entry is needed");
  }
  values.clear();
  for (std::size_t i = 0; i < json->items.size(); ++i) {
    const std::string pointer = item_pointer(pointer_to(key), i);
    std::string given;
    if (!read_text(json->items[i], pointer, spec, given)) continue;
    if (std::find(values.begin(), values.end(), given) != values.end()) {
      problem(json->items[i], Code::kOutOfRange, pointer,
              fmt::format("{} stands here twice; remove one", in_quotes(given)));
    }
    values.push_back(std::move(given));
  }
}

bool TableReader::read_number(const JsonValue& json, const std::string& pointer,
                              std::string_view key, const NumberSpec& spec, double& value) {
  if (json.kind != Kind::kNumber) {
    problem(json, Code::kWrongType, pointer,
            fmt::format("is {}; a number{} is needed", found(json), in_unit(key)));
    return false;
  }
  if (!allowed(json.number, spec)) {
    problem(json, spec.code, pointer, range_message(json.number, key, spec));
    return false;
  }
  value = json.number;
  return true;
}

void TableReader::number(std::string_view key, double& value, const NumberSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json != nullptr) read_number(*json, pointer_to(key), key, spec, value);
}

void TableReader::number(std::string_view key, std::optional<double>& value,
                         const NumberSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr) return;
  double given = 0.0;
  if (read_number(*json, pointer_to(key), key, spec, given)) value = given;
}

void TableReader::influence(std::string_view key, record::Influence& value,
                            const NumberSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr) return;
  const std::string pointer = pointer_to(key);
  record::DeclaredInfluence given;
  if (json->kind == Kind::kObject) {
    read(*json, pointer, given, spec);
  } else if (json->kind != Kind::kNumber) {
    return problem(*json, Code::kWrongType, pointer,
                   fmt::format("is {}; a number{} is needed, or an object {{ \"value\": ... }}",
                               found(*json), in_unit(key)));
  } else if (!read_number(*json, pointer, key, spec, given.value)) {
    return;
  }
  value = given;
}

const JsonValue* TableReader::array_at(std::string_view key, const NumberSpec& spec) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr || json->kind == Kind::kArray) return json;
  problem(*json, Code::kWrongType, pointer_to(key),
          fmt::format("is {}; an array of numbers{} is needed", found(*json), in_unit(key)));
  return nullptr;
}

void TableReader::numbers(std::string_view key, std::array<double, 3>& values,
                          const NumberSpec& spec) {
  const JsonValue* json = array_at(key, spec);
  if (json == nullptr) return;
  if (json->items.size() != values.size()) {
    return problem(
        *json, Code::kWrongType, pointer_to(key),
        fmt::format("is {}; exactly 3 numbers x, y, z{} are needed", found(*json), in_unit(key)));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    read_number(json->items[i], item_pointer(pointer_to(key), i), key, spec, values.at(i));
  }
}

void TableReader::numbers(std::string_view key, std::vector<double>& values,
                          const NumberSpec& spec) {
  const JsonValue* json = array_at(key, spec);
  if (json == nullptr) return;
  if (json->items.empty() || json->items.size() > kMaxListItems) {
    return problem(*json, Code::kOutOfRange, pointer_to(key),
                   fmt::format("is {}; 1 to {} numbers{} are needed", found(*json), kMaxListItems,
                               in_unit(key)));
  }
  values.clear();
  for (std::size_t i = 0; i < json->items.size(); ++i) {
    double given = 0.0;
    if (read_number(json->items[i], item_pointer(pointer_to(key), i), key, spec, given))
      values.push_back(given);
  }
}

bool TableReader::read_whole(std::string_view key, const NumberSpec& spec, double& value) {
  const JsonValue* json = value_at(key, spec.required, spec.meaning);
  if (json == nullptr) return false;
  if (json->kind != Kind::kNumber || json->number != std::floor(json->number)) {
    problem(*json, Code::kWrongType, pointer_to(key),
            fmt::format("is {}; a whole number is needed", found(*json)));
    return false;
  }
  return read_number(*json, pointer_to(key), key, spec, value);
}

void TableReader::whole(std::string_view key, int& value, const NumberSpec& spec) {
  double given = 0.0;
  if (read_whole(key, spec, given)) value = static_cast<int>(given);
}

void TableReader::whole(std::string_view key, std::uint64_t& value, const NumberSpec& spec) {
  double given = 0.0;
  if (read_whole(key, spec, given)) value = static_cast<std::uint64_t>(given);
}

void TableReader::passed_over(std::string_view key, std::string_view meaning) {
  std::string ignored;
  text(key, ignored, {.meaning = meaning});
}

void TableReader::report_unknown(const JsonMember& member) {
  const std::string where = pointer_to(member.key);
  for (const std::string_view known : keys_) {
    if (unit_of(known).empty() || stem_of(known) != stem_of(member.key)) continue;
    const std::string_view unit = unit_of(member.key);
    const std::string now = unit.empty() ? "has no unit" : fmt::format("is in {}", unit);
    const std::string_view advice = unit.empty() ? "write" : "convert it and write";
    return problem(member.value, Code::kWrongUnit, where,
                   fmt::format("the key {} {}; this value is given in {}: {} \"{}\"",
                               in_quotes(member.key), now, unit_of(known), advice, known));
  }
  const std::string_view near = nearest_word(member.key, keys_);
  problem(member.value, Code::kUnknownKey, where,
          fmt::format("the key {} is not known here; {}", in_quotes(member.key),
                      near.empty() ? "remove it, or see docs/plan.md for the keys of this object"
                                   : fmt::format("did you mean \"{}\"?", near)));
}

void TableReader::finish() {
  std::set<std::string_view> seen;
  for (const JsonMember& member : object_.members) {
    if (!seen.insert(member.key).second) {
      problem(member.value, Code::kRepeatedKey, pointer_to(member.key),
              fmt::format("the key {} stands more than once in this object; keep one",
                          in_quotes(member.key)));
    } else if (std::find(keys_.begin(), keys_.end(), member.key) == keys_.end()) {
      report_unknown(member);
    }
  }
}

}  // namespace rondure::plans
