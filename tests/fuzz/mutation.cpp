#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::fuzz {
namespace {

/// Numbers that stand at the edges of what is read.
constexpr std::array<const char*, 20> kEdges = {
    "0",    "-0",    "1",      "-1",     "1e9",        "-1e9",      "999999999.999",
    "1e-9", "1e-15", "1e-300", "5e-324", "2147483648", "360",       "-360",
    "180",  "90",    "1e6",    "1e-6",   "0.1",        "123456.789"};

using Fields = std::vector<std::string>;

struct TextTable {
  Fields header;
  std::vector<Fields> rows;
};

Fields fields_of(const std::string& line) {
  Fields out;
  std::istringstream fields(line);
  for (std::string field; std::getline(fields, field, ',');) out.push_back(field);
  if (!line.empty() && line.back() == ',') out.emplace_back();
  return out;
}

TextTable table_of(const std::string& text) {
  TextTable out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    if (out.header.empty()) {
      out.header = fields_of(line);
    } else {
      out.rows.push_back(fields_of(line));
    }
  }
  return out;
}

std::string line_of(const Fields& fields) {
  std::string out;
  for (const std::string& field : fields) out += (out.empty() ? "" : ",") + field;
  return out + "\n";
}

/// One change of a table after the other.
class TableChange {
 public:
  TableChange(TextTable table, std::mt19937& random) : t_(std::move(table)), random_(random) {}

  void change() {
    if (t_.rows.empty()) return;
    const std::size_t row = below(t_.rows.size());
    const std::size_t column = below(t_.header.size());
    switch (below(17)) {
      case 0:
        t_.rows.resize(1 + below(t_.rows.size()));
        break;
      case 1:
        for (std::size_t left = 1 + below(8); left > 0 && t_.rows.size() > 1; --left) {
          t_.rows.erase(t_.rows.begin() + static_cast<std::ptrdiff_t>(below(t_.rows.size())));
        }
        break;
      case 2:
        t_.rows.insert(t_.rows.begin() + static_cast<std::ptrdiff_t>(row), 1 + below(20),
                       Fields(t_.rows[row]));
        break;
      case 3:
      case 4:
        set(row, column, edge());
        break;
      case 5: {
        const std::string value = below(2) == 0 ? edge() : field(row, column);
        for (std::size_t i = 0; i < t_.rows.size(); ++i) set(i, column, value);
        break;
      }
      case 6:
        each(column, scale(), 0.0);
        break;
      case 7:
        each(column, 1.0, scale() * (below(2) == 0 ? 1.0 : -1.0));
        break;
      case 8: {
        const std::size_t from = below(t_.header.size());
        for (std::size_t i = 0; i < t_.rows.size(); ++i) set(i, column, field(i, from));
        break;
      }
      case 9:
        std::shuffle(t_.rows.begin(), t_.rows.end(), random_);
        break;
      case 10:
        std::reverse(t_.rows.begin(), t_.rows.end());
        break;
      case 11:
        std::swap(t_.header[column], t_.header[below(t_.header.size())]);
        break;
      case 12:
      case 13:
        tremble(column, 1);
        break;
      case 14:
      case 15:
        tremble(column, 10);
        break;
      default:
        for (std::size_t i = 0; i < t_.rows.size(); ++i)
          set(i, column, field(below(i + 1), column));
        break;
    }
  }

  [[nodiscard]] std::string text() const {
    std::string out = line_of(t_.header);
    for (const Fields& row : t_.rows) out += line_of(row);
    return out;
  }

 private:
  std::size_t below(std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>(random_()) % limit;
  }
  std::string edge() { return kEdges[below(kEdges.size())]; }
  double scale() {
    constexpr std::array<double, 10> kScales = {1e-12, 1e-9, 1e-6, 1e-3, 0.0,
                                                -1.0,  1e3,  1e6,  1e9,  0.5};
    return kScales[below(kScales.size())];
  }
  [[nodiscard]] std::string field(std::size_t row, std::size_t column) const {
    return column < t_.rows[row].size() ? t_.rows[row][column] : std::string();
  }
  void set(std::size_t row, std::size_t column, const std::string& value) {
    if (column < t_.rows[row].size()) t_.rows[row][column] = value;
  }
  void each(std::size_t column, double factor, double shift) {
    for (std::size_t i = 0; i < t_.rows.size(); ++i) {
      const auto number = core::parse_number(field(i, column));
      if (number) set(i, column, fmt::format("{:.12g}", *number * factor + shift));
    }
  }

  /// Moves one row in `every` by a little or by much.
  void tremble(std::size_t column, std::size_t every) {
    const double size = std::pow(10.0, -static_cast<double>(below(10)));
    for (std::size_t i = 0; i < t_.rows.size(); ++i) {
      const auto number = core::parse_number(field(i, column));
      if (!number || below(every) != 0) continue;
      const double part = 2.0 * static_cast<double>(below(1'000'001)) / 1e6 - 1.0;
      set(i, column, fmt::format("{:.12g}", *number + part * (std::abs(*number) * size + 1e-6)));
    }
  }

  TextTable t_;
  std::mt19937& random_;
};

}  // namespace

std::string Mutation::input(unsigned seed) const {
  std::mt19937 random(seed);
  const auto below = [&random](std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>(random()) % limit;
  };
  const auto pick = [&below](const std::vector<std::string>& from) -> const std::string& {
    return from[below(from.size())];
  };
  std::string text = pick(corpus_);
  for (std::size_t left = 1 + below(6); left > 0; --left) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(below(12), text.size() - at);
    switch (random() % 7) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random() % 256);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.insert(at, pick(words_));
        break;
      case 4:
        text.replace(at, length, pick(words_));
        break;
      case 5: {
        const std::string& other = pick(corpus_);
        text.insert(at, other.substr(below(other.size()), below(80)));
        break;
      }
      default:
        text.insert(at, 1 + below(40), static_cast<char>(32 + random() % 95));
        break;
    }
  }
  return text;
}

std::string TableMutation::input(unsigned seed) const {
  std::mt19937 random(seed);
  const std::string& text = tables_[random() % tables_.size()];
  TableChange table(table_of(text), random);
  for (std::size_t left = 1 + random() % 3; left > 0; --left) table.change();
  // The first line tells what kind of table it is.
  return (text.starts_with("#") ? text.substr(0, text.find('\n') + 1) : std::string()) +
         table.text();
}

}  // namespace rondure::fuzz
