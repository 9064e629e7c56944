#pragma once

#include <string_view>

#include "evaluation/results/evaluation.h"
#include "reports/drawings/internal/svg.h"

namespace rondure::reports {

/// A tick below the frame of a drawing with its label; `bottom` is the lower edge of the frame.
void tick_below(Svg& svg, double x, double bottom, std::string_view label);
/// A tick on the left of a frame with its label; `left` is the edge of the frame, and the label
/// ends `gap` before it.
void tick_beside(Svg& svg, double left, double y, std::string_view label, double gap = 8.0);
/// The label alone, for a grid line.
void label_beside(Svg& svg, double left, double y, std::string_view label, double gap = 8.0);

/// A scale bar at the left below a drawing: `length` px represent `length_um`.
/// @param top  Upper end of its strokes.
void scale_bar(Svg& svg, int top, double length, double length_um);

/// Ticks every 30 deg round a polar drawing, with lines and labels every 90 deg.
struct PolarAxes {
  double centre = 0.0;         ///< Centre, x and y.
  double edge = 0.0;           ///< Radius at which the ticks begin.
  double tick = 0.0;           ///< Length of a tick.
  double labelled_tick = 0.0;  ///< Length of a tick every 90 deg.
  double beside = 0.0;         ///< Distance of the labels of 0 and 180 deg from the centre.
  double above = 0.0;          ///< Distance of the label of 90 deg from the centre.
};
void draw_polar_axes(Svg& svg, const PolarAxes& axes);

/// A point of a section: a triangle or a square at a contact with the zone, otherwise a disc of
/// that radius; 0: none.
void draw_section_point(Svg& svg, double x, double y, const evaluation::CloudPoint& point,
                        double radius);

/// Colour scale of deviations beside a drawing, from minus to plus half the zone, with values in
/// um; 60 px wide.
void deviation_scale(Svg& svg, double x, double top, double bottom, double half_zone_mm);

}  // namespace rondure::reports
