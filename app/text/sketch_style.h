#pragma once

#include "reports/terminal/polar_sketch.h"

namespace rondure::app {

/// How standard output can draw: braille on a terminal whose locale is UTF-8 (LC_ALL, LC_CTYPE,
/// LANG, the first that is set), letters on another terminal, not at all in a file or a pipe.
[[nodiscard]] reports::SketchStyle sketch_style();

}  // namespace rondure::app
