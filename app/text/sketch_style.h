#pragma once

#include "reports/terminal/polar_sketch.h"

namespace rondure::app {

/// The style of drawings on standard output: braille on a terminal whose locale is UTF-8 (the first
/// of LC_ALL, LC_CTYPE, LANG that is set), letters on another terminal, none in a file or a pipe.
[[nodiscard]] reports::SketchStyle sketch_style();

}  // namespace rondure::app
