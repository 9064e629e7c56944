#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string_view>

#include "record/run_record.h"

// Private to the room: what no journal of Rondure contains.

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

}  // namespace rondure::record
