#pragma once

#include "reports/pdf_text.h"

// Private to the room: inline SVG on paper, through librsvg, which draws it as vectors onto Cairo.

namespace rondure::reports::pdf {

/// CSS px of the page -> pt on paper.
inline constexpr double kPxToPt = 0.75;

/// Natural width of an <svg> [pt].
[[nodiscard]] double drawing_width(const pugi::xml_node& svg);

/// Sets an <svg> of the page at its natural size or, where that is wider than its room or than
/// `widest`, smaller; in the middle of its room where `centred`. What librsvg refuses is noted as a
/// fault and leaves an empty box.
[[nodiscard]] BoxPtr set_drawing(Press& press, const pugi::xml_node& svg, double widest,
                                 bool centred);

}  // namespace rondure::reports::pdf
