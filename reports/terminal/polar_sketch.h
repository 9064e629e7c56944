#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/evaluation.h"

namespace rondure::reports {

/// Capabilities of a terminal for drawings.
enum class SketchStyle {
  kNone,     ///< No drawing: the text goes into a file or a pipe.
  kAscii,    ///< Letters only.
  kBraille,  ///< Unicode braille patterns, 2 x 4 dots per character.
};

/// A small drawing of a section for the terminal: the circles of the zone, the profile between
/// them, and the contacts with all sections.
struct PolarSketch {
  std::vector<std::string> rows;  ///< kSketchRows lines of kSketchColumns columns.
  std::string title;              ///< Name of the section.
  std::size_t section = 0;        ///< Its number, from 1.
  std::size_t sections = 0;       ///< Number of sections.
};

inline constexpr int kSketchRows = 11;
inline constexpr int kSketchColumns = 22;

/// Draws the section with the largest deviation. The zone always has the same width in the drawing.
/// None for kNone, for analyses, without a zone and for a zone of no width. Same evaluation, same
/// text; O(points).
[[nodiscard]] std::optional<PolarSketch> polar_sketch(const evaluation::FeatureResult& feature,
                                                      SketchStyle style);

}  // namespace rondure::reports
