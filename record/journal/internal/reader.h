#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string_view>

#include <soci/soci.h>

#include "record/journal/journal.h"

// Private to the room: reads the rows of a journal as records.

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

/// Throws Contradiction unless the file holds exactly the tables of that version (docs/journal.md),
/// word for word: no index, view, trigger or other table.
void require_schema(soci::session& sql, std::int64_t version);

/// Reads and checks every table of an open journal. Throws soci::soci_error, Contradiction, Damage.
[[nodiscard]] ReadJournal read_tables(soci::session& sql);

}  // namespace rondure::record
