#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace rondure::plans {

// The specification of a key in plan_table.h, besides its name, its place and its default. Plain
// data: the same specification reads a value, writes its schema and describes it in docs/plan.md.

/// A number, or each number of an array. The lower limit itself is allowed unless `above` is set.
struct NumberSpec {
  double at_least = 0.0;
  double at_most = 0.0;
  bool above = false;  ///< The value must be greater than `at_least`, not equal to it.
  bool required = false;
  core::Code code = core::Code::kOutOfRange;  ///< For a value beyond the limits.
  std::string_view hint = {};  ///< Added to the message of a value beyond the limits.
  std::string_view meaning;
};

/// A number in -limit..limit.
[[nodiscard]] inline NumberSpec within(double limit, std::string_view meaning) {
  return {.at_least = -limit, .at_most = limit, .meaning = meaning};
}

/// A number in least..most.
[[nodiscard]] inline NumberSpec range(double least, double most, std::string_view meaning) {
  return {.at_least = least, .at_most = most, .meaning = meaning};
}

/// A number above `least`, at most `most`.
[[nodiscard]] inline NumberSpec above(double least, double most, std::string_view meaning) {
  return {.at_least = least, .at_most = most, .above = true, .meaning = meaning};
}

/// The same key, which a plan must give.
[[nodiscard]] inline NumberSpec required(NumberSpec spec) {
  spec.required = true;
  return spec;
}

/// A text, or each text of an array. With `one_of`, only these; otherwise at most kMaxTextBytes.
struct TextSpec {
  std::vector<std::string_view> one_of = {};
  std::string_view former = {};   ///< One that an earlier version still took,
  std::string_view instead = {};  ///< and what to do in its place.
  bool required = false;
  bool empty_allowed = true;
  std::string_view meaning;
};

/// An object, or an array of objects.
struct GroupSpec {
  bool required = false;
  bool empty_allowed = true;  ///< For an array.
  std::string_view meaning;
};

inline constexpr std::size_t kMaxTextBytes = 10'000;
inline constexpr std::size_t kMaxListItems = 1000;

/// The unit in the suffix of a key, as messages print it: "diameter_mm" gives "mm",
/// "touch_speed_mm_s" gives "mm/s", "layers" gives "".
[[nodiscard]] std::string_view unit_of(std::string_view key);

/// The key without its unit suffix, also for a unit that no plan uses ("diameter_inch").
[[nodiscard]] std::string_view stem_of(std::string_view key);

}  // namespace rondure::plans
