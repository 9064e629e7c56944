#include "plans/schema/internal/key_list.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "plans/key_spec.h"
#include "plans/plan.h"
#include "plans/schema/internal/plan_table.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

struct Page {
  std::string_view path;
  std::string_view file;
};

// The page of an object and of all that it holds, unless a longer path says otherwise.
constexpr std::array kPages = {
    Page{"", "plan.md"},
    Page{"features[].characteristics[]", "drawing.md"},
    Page{"features[].contour", "contour.md"},
    Page{"features[].five_axis", "five-axis-head.md"},
    Page{"features[].rotary_axes", "fixture-calibration.md"},
    Page{"features[].spindle", "spindle.md"},
    Page{"features[].wheel", "wheel.md"},
    Page{"fixture", "fixtures.md"},
    Page{"fixture.calibration", "fixture-calibration.md"},
    Page{"fixture.reached_pose", "fixture-by-hand.md"},
    Page{"fixture.thorlabs", "fixture-thorlabs.md"},
    Page{"simulation", "simulation.md"},
    Page{"simulation.contour", "contour.md"},
    Page{"simulation.five_axis", "five-axis-head.md"},
    Page{"simulation.spindle", "spindle.md"},
    Page{"simulation.wheel", "wheel.md"},
};

std::string page_of(std::string_view path) {
  Page best = kPages.front();
  for (const Page& page : kPages) {
    if (path.starts_with(page.path) && page.path.size() >= best.path.size()) best = page;
  }
  return std::string(best.file);
}

// Of the heading "### `path`", as GitHub makes it.
std::string anchor_of(std::string_view path) {
  std::string out;
  for (const char c : path.empty() ? std::string_view("the-plan") : path) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-') out += c;
  }
  return out;
}

std::string range_text(std::string_view key, const NumberSpec& spec) {
  const std::string_view unit = unit_of(key);
  const std::string limits = !spec.above && spec.at_most > 0.0 && spec.at_least == -spec.at_most
                                 ? fmt::format("±{}", plain(spec.at_most))
                                 : fmt::format("{}{}..{}", spec.above ? ">" : "",
                                               plain(spec.at_least), plain(spec.at_most));
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

// "0, 0, 500"; one number where all are alike.
template <class Numbers>
std::string joined(const Numbers& values) {
  const bool alike = std::all_of(values.begin(), values.end(),
                                 [&](double value) { return value == values.front(); });
  if (alike) return values.empty() ? "" : plain(values.front());
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : ", ") + plain(value);
  return out;
}

// Keys with one value and one meaning share a row.
struct Row {
  std::string keys;
  std::string value;
  std::string meaning;
  std::string inner = {};  // what follows the path of the table in that of the object in it

  bool operator==(const Row&) const = default;
};

struct Table {
  std::string path;
  std::vector<Row> rows;
};

// Visitor of plan_table.h that collects one table per object, the outer object first.
class KeyList {
 public:
  KeyList(std::string path, std::vector<Table>& tables)
      : path_(std::move(path)), at_(tables.size()), tables_(tables) {
    tables_.push_back({path_, {}});
  }

  void text(std::string_view key, const std::string& value, const TextSpec& spec) {
    row(key, spellings(spec), value.empty() ? "" : fmt::format("`{}`", value), spec);
  }
  void text(std::string_view key, const std::optional<std::string>&, const TextSpec& spec) {
    row(key, spellings(spec), "", spec);
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
    row(key, "array of " + spellings(spec), code_list(values), spec);
  }
  void number(std::string_view key, double value, const NumberSpec& spec) {
    row(key, range_text(key, spec), value >= spec.at_least ? plain(value) : "", spec);
  }
  void number(std::string_view key, const std::optional<double>&, const NumberSpec& spec) {
    row(key, range_text(key, spec), "", spec);
  }
  void numbers(std::string_view key, const std::array<double, 3>& values, const NumberSpec& spec) {
    row(key, "3 numbers, " + range_text(key, spec), joined(values), spec);
  }
  void numbers(std::string_view key, const std::vector<double>& values, const NumberSpec& spec) {
    row(key, "numbers, " + range_text(key, spec), joined(values), spec);
  }
  template <class Whole>
  void whole(std::string_view key, Whole value, const NumberSpec& spec) {
    row(key, fmt::format("whole, {:.0f}..{:.0f}", spec.at_least, spec.at_most),
        fmt::format("{}", value), spec);
  }
  void passed_over(std::string_view key, std::string_view meaning) {
    row(key, "text", "", TextSpec{.meaning = meaning});
  }
  void influence(std::string_view key, const record::Influence&, const NumberSpec& spec) {
    row(key, range_text(key, spec), "", spec);
  }

  template <class T>
  void object(std::string_view key, T& value, const GroupSpec& spec) {
    group(key, "object", "", value, spec);
  }
  template <class T>
  void object(std::string_view key, std::optional<T>&, const GroupSpec& spec) {
    T value;
    object(key, value, spec);
  }
  template <class T>
  void list(std::string_view key, std::vector<T>&, const GroupSpec& spec) {
    T value;
    group(key, "objects", "[]", value, spec);
  }

 private:
  template <class Spec>
  void row(std::string_view key, std::string value, const std::string& fallback, const Spec& spec,
           std::string inner = {}) {
    if (spec.required) value += ", **required**";
    if (!spec.required && !fallback.empty()) value += fmt::format(" ({})", fallback);
    Row fresh = {fmt::format("`{}`", key), std::move(value), std::string(spec.meaning),
                 std::move(inner)};
    std::vector<Row>& rows = tables_[at_].rows;
    if (!rows.empty() && fresh.inner.empty() && rows.back().inner.empty() &&
        rows.back().value == fresh.value && rows.back().meaning == fresh.meaning) {
      rows.back().keys += ", " + fresh.keys;
    } else {
      rows.push_back(std::move(fresh));
    }
  }

  template <class T>
  void group(std::string_view key, std::string_view word, std::string_view brackets, T& value,
             const GroupSpec& spec) {
    const std::string inner = fmt::format("{}{}{}", path_.empty() ? "" : ".", key, brackets);
    row(key, std::string(word), "", spec, inner);
    KeyList list(path_ + inner, tables_);
    describe(list, value);
  }

  std::string path_;
  std::size_t at_;
  std::vector<Table>& tables_;
};

}  // namespace

std::map<std::string, std::string> key_list_pages() {
  Plan defaults;
  std::vector<Table> tables;
  KeyList list("", tables);
  describe(list, defaults);

  // Equal objects have one table: the outermost, or the first of them.
  const auto depth = [](const std::string& path) {
    return std::count(path.begin(), path.end(), '.');
  };
  std::map<std::string, std::string> shown_as;
  const std::vector<Row>* shared = nullptr;
  for (const Table& table : tables) {
    std::string best = table.path;
    for (auto other = tables.rbegin(); other != tables.rend(); ++other) {
      if (other->rows == table.rows && depth(other->path) <= depth(best)) best = other->path;
    }
    shown_as[table.path] = best;
    if (table.path == "defaults") shared = &table.rows;
  }
  std::map<std::string, std::string> pages;
  for (const Table& table : tables) {
    if (shown_as.at(table.path) != table.path) continue;
    const std::string page = page_of(table.path);
    const auto link = [&](const std::string& path) {
      const std::string target = page_of(path);
      return fmt::format("{}#{}", target == page ? "" : target, anchor_of(path));
    };
    std::string& text = pages[page];
    const std::string heading = table.path.empty() ? "The plan" : fmt::format("`{}`", table.path);
    text += fmt::format("\n### {}\n\nkey | meaning\n---|---\n", heading);
    bool shares = false;
    for (const Row& row : table.rows) {
      if (&table.rows != shared && std::count(shared->begin(), shared->end(), row) > 0) {
        shares = true;  // a characteristic has the keys of its defaults
        continue;
      }
      std::string value = row.value;  // of an object its word is a link, "[object](#part)"
      if (!row.inner.empty()) {
        value.insert(std::min(value.find(','), value.size()),
                     fmt::format("]({})", link(shown_as.at(table.path + row.inner))));
        value.insert(0, "[");
      }
      text += fmt::format("{} | {}. {}\n", row.keys, value, row.meaning);
    }
    if (shares) text += fmt::format("\nAlso the keys of [`defaults`]({}).\n", link("defaults"));
  }
  return pages;
}

}  // namespace rondure::plans
