#pragma once

#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <soci/soci.h>

#include "record/run_record.h"

// Private to the room: values as a journal stores them, and errors for contents that no journal of
// Rondure has.

namespace rondure::record {

/// The file is readable but holds a value or table that no journal of Rondure contains.
struct Contradiction : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The database itself is damaged.
struct Damage : Contradiction {
  using Contradiction::Contradiction;
};

/// Throws Contradiction unless a stored number is core::is_measurable().
void require_number(std::string_view column, double value);
void require_numbers(std::string_view column, std::initializer_list<double> values);
void require_touch(const Touch& touch);

/// Reads the word of a column; throws Contradiction when its enum has no such word.
template <Worded Enum>
Enum named(std::string_view column, const std::string& text) {
  if (const auto value = value_named<Enum>(text)) return *value;
  throw Contradiction(fmt::format("{} holds the unknown word \"{}\"", column, text.substr(0, 40)));
}

/// The feature whose index is in a row of `table`; throws Contradiction when there is none.
[[nodiscard]] Feature& feature_at(RunRecord& record, int feature, std::string_view table);

/// A number bound with its indicator; null when it was not measured.
struct Measured {
  double value = 0.0;
  soci::indicator given = soci::i_null;

  /// @throws  std::runtime_error for NaN, which SQLite would store as null.
  void take(const std::optional<double>& number, const std::string& name);
  [[nodiscard]] std::optional<double> get() const;
};

}  // namespace rondure::record
