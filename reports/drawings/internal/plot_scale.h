#pragma once

#include <string_view>

#include "evaluation/results/evaluation.h"
#include "reports/drawings/internal/svg.h"

namespace rondure::reports {

/// A tick below the frame of a drawing, whose lower edge is `bottom`, with its label.
void tick_below(Svg& svg, double x, double bottom, std::string_view label);
/// A tick on the left of a frame, whose edge is `left`; the label ends `gap` before it.
void tick_beside(Svg& svg, double left, double y, std::string_view label, double gap = 8.0);
/// The label alone, for a line of a grid.
void label_beside(Svg& svg, double left, double y, std::string_view label, double gap = 8.0);

/// A bar at the left below a drawing, `length` px long, which stands for `length_um`.
/// @param top  Upper end of its strokes.
void scale_bar(Svg& svg, int top, double length, double length_um);

/// Ticks every 30 deg round a polar drawing, with lines and labels every 90 deg.
struct PolarAxes {
  double centre = 0.0;         ///< x and y.
  double edge = 0.0;           ///< Radius at which ticks begin.
  double tick = 0.0;           ///< Length.
  double labelled_tick = 0.0;  ///< Length of those every 90 deg.
  double beside = 0.0;         ///< Labels of 0 and 180 deg, from the centre.
  double above = 0.0;          ///< Label of 90 deg.
};
void draw_polar_axes(Svg& svg, const PolarAxes& axes);

/// A point of a section: a triangle or a square where it touches the zone, else a disc of that
/// radius; 0: none.
void draw_section_point(Svg& svg, double x, double y, const evaluation::CloudPoint& point,
                        double radius);

/// The colours of deviations beside a drawing, from minus to plus half the zone, with their values
/// in um; 60 px wide.
void deviation_scale(Svg& svg, double x, double top, double bottom, double half_zone_mm);

}  // namespace rondure::reports
