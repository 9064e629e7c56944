#include "plans/schema/internal/key_list.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "plans/plan.h"
#include "plans/schema/internal/plan_table.h"
#include "plans/schema/json_text.h"
#include "plans/schema/key_spec.h"

namespace rondure::plans {
namespace {

std::string range_text(std::string_view key, const NumberSpec& spec) {
  const std::string_view unit = unit_of(key);
  const std::string limits =
      spec.above ? fmt::format("> {}, <= {}", plain(spec.at_least), plain(spec.at_most))
                 : fmt::format("{} .. {}", plain(spec.at_least), plain(spec.at_most));
  return unit.empty() ? limits : fmt::format("{} {}", limits, unit);
}

// "`a`, `b`"
template <class Words>
std::string code_list(const Words& words) {
  std::string out;
  for (const auto& word : words) out += fmt::format("{}`{}`", out.empty() ? "" : ", ", word);
  return out;
}

std::string spellings(const TextSpec& spec) {
  return spec.one_of.empty() ? "text" : code_list(spec.one_of);
}

template <class Numbers>
std::string joined(const Numbers& values) {
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : ", ") + plain(value);
  return "[" + out + "]";
}

// Visitor of plan_table.h that writes one table per object, the outer object first.
class KeyList {
 public:
  explicit KeyList(std::string path) : path_(std::move(path)) {}

  void text(std::string_view key, const std::string& value, const TextSpec& spec) {
    row(key, spellings(spec), value.empty() ? "" : fmt::format("`{}`", value), spec.required,
        spec.meaning);
  }
  void text(std::string_view key, const std::optional<std::string>&, const TextSpec& spec) {
    row(key, spellings(spec), "", spec.required, spec.meaning);
  }
  template <record::Worded Enum>
  void text(std::string_view key, Enum value, const TextSpec& spec) {
    text(key, std::string(name_of(value)), spec_of_words<Enum>(spec));
  }
  template <record::Worded Enum>
  void text(std::string_view key, const std::optional<Enum>&, const TextSpec& spec) {
    text(key, std::optional<std::string>(), spec_of_words<Enum>(spec));
  }
  void texts(std::string_view key, const std::vector<std::string>& values, const TextSpec& spec) {
    row(key, "array of " + spellings(spec), code_list(values), spec.required, spec.meaning);
  }
  void number(std::string_view key, double value, const NumberSpec& spec) {
    row(key, range_text(key, spec), value >= spec.at_least ? plain(value) : "", spec.required,
        spec.meaning);
  }
  void number(std::string_view key, const std::optional<double>&, const NumberSpec& spec) {
    row(key, range_text(key, spec), "", spec.required, spec.meaning);
  }
  void numbers(std::string_view key, const std::array<double, 3>& values, const NumberSpec& spec) {
    row(key, "3 numbers, each " + range_text(key, spec), joined(values), spec.required,
        spec.meaning);
  }
  void numbers(std::string_view key, const std::vector<double>& values, const NumberSpec& spec) {
    row(key, "numbers, each " + range_text(key, spec), joined(values), spec.required, spec.meaning);
  }
  template <class Whole>
  void whole(std::string_view key, Whole value, const NumberSpec& spec) {
    row(key, "whole, " + fmt::format("{:.0f} .. {:.0f}", spec.at_least, spec.at_most),
        fmt::format("{}", value), spec.required, spec.meaning);
  }
  void passed_over(std::string_view key, std::string_view meaning) {
    row(key, "text", "", false, meaning);
  }
  void influence(std::string_view key, const record::Influence&, const NumberSpec& spec) {
    row(key, range_text(key, spec) + ", or object", "", spec.required, spec.meaning);
  }

  template <class T>
  void object(std::string_view key, T& value, const GroupSpec& spec) {
    row(key, "object", "", spec.required, spec.meaning);
    inner(fmt::format("{}{}", prefix(), key), value);
  }
  template <class T>
  void object(std::string_view key, std::optional<T>&, const GroupSpec& spec) {
    T value;
    object(key, value, spec);
  }
  template <class T>
  void list(std::string_view key, std::vector<T>&, const GroupSpec& spec) {
    T value;
    row(key, "array of objects", "", spec.required, spec.meaning);
    inner(fmt::format("{}{}[]", prefix(), key), value);
  }

  [[nodiscard]] std::string tables() const {
    return fmt::format("\n### {}\n\n| key | value | default | meaning |\n|---|---|---|---|\n{}{}",
                       path_.empty() ? "The plan" : "`" + path_ + "`", rows_, inner_);
  }

 private:
  [[nodiscard]] std::string prefix() const { return path_.empty() ? "" : path_ + "."; }

  void row(std::string_view key, std::string_view value, std::string_view fallback, bool required,
           std::string_view meaning) {
    rows_ += fmt::format("| `{}` | {} | {} | {} |\n", key, value,
                         required ? "**required**" : fallback, meaning);
  }

  template <class T>
  void inner(std::string path, T& value) {
    KeyList list(std::move(path));
    describe(list, value);
    inner_ += list.tables();
  }

  std::string path_;
  std::string rows_;
  std::string inner_;
};

}  // namespace

std::string key_list_markdown() {
  Plan defaults;
  KeyList list("");
  describe(list, defaults);
  return list.tables();
}

}  // namespace rondure::plans
