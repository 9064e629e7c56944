#pragma once

#include <array>

#include "record/words.h"

namespace rondure::record {

/// A setting that is on or off.
enum class Switch { kOff, kOn };

constexpr auto words_of(Switch) {
  return std::to_array<Word<Switch>>({{Switch::kOff, "off"}, {Switch::kOn, "on"}});
}

}  // namespace rondure::record
