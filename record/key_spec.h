#pragma once

#include <string_view>
#include <vector>

#include "core/error.h"
#include "record/words.h"

namespace rondure::record {

// The specification of a key of a task or a plan, besides its name, its place and its default. It
// is plain data: the same specification reads a value from a plan, writes its schema, describes it
// in docs/ and checks it in a journal.

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

/// The same specification for a key that a plan must have.
[[nodiscard]] inline NumberSpec required(NumberSpec spec) {
  spec.required = true;
  return spec;
}

/// A text, or each text of an array. With `one_of`, only these; otherwise any of limited length.
struct TextSpec {
  std::vector<std::string_view> one_of = {};
  bool required = false;
  bool empty_allowed = true;
  std::string_view meaning;
};

/// The specification of a text that is an enum: all its words, unless `spec` allows only some.
template <Worded Enum>
[[nodiscard]] TextSpec spec_of_words(TextSpec spec) {
  if (!spec.one_of.empty()) return spec;
  for (const auto& word : words_of(Enum{})) spec.one_of.push_back(word.text);
  return spec;
}

/// An object, or an array of objects.
struct GroupSpec {
  bool required = false;
  bool empty_allowed = true;  ///< Whether an array may be empty.
  std::string_view meaning;
};

}  // namespace rondure::record
