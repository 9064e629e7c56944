#pragma once

#include "record/words.h"

namespace rondure::record {

/// A setting that is on or off.
enum class Switch { kOff, kOn };

RONDURE_WORDS(Switch, {kOff, "off"}, {kOn, "on"});

}  // namespace rondure::record
