#pragma once

#include <string>
#include <string_view>

#include "evaluation/results/evaluation.h"

namespace rondure::reports {

/// One inline drawing. Lengths are in its own units (CSS px at its natural width); classes are
/// those of html/style.h; the functions escape their texts.
class Svg {
 public:
  Svg(double width, double height, std::string_view css_class, std::string_view label);

  void line(double x1, double y1, double x2, double y2, std::string_view css_class);
  void circle(double x, double y, double r, std::string_view css_class, std::string_view fill = {});
  void rect(double x, double y, double w, double h, std::string_view css_class,
            std::string_view fill = {});
  void path(std::string_view d, std::string_view css_class);
  /// anchor: "start", "middle", "end".
  void text(double x, double y, std::string_view anchor, std::string_view css_class,
            std::string_view text);
  /// Text that reads upwards, centred at (x, y), for titles of vertical axes.
  void upward_text(double x, double y, std::string_view css_class, std::string_view text);
  /// Marks of contact points and poses, centred at (x, y), with r from the centre to the border.
  void triangle(double x, double y, double r, std::string_view css_class);
  void square(double x, double y, double r, std::string_view css_class);
  void diamond(double x, double y, double r, std::string_view css_class);
  void cross(double x, double y, double r, std::string_view css_class);

  /// Description that a screen reader gives after the label.
  void describe(std::string_view text);
  /// Adds markup from elsewhere unchanged.
  void add(std::string_view markup) { body_ += markup; }

  [[nodiscard]] std::string str() const { return body_ + "</svg>"; }
  /// The drawing as a complete file, with its style.
  [[nodiscard]] std::string document(std::string_view style) const;

 private:
  std::string body_;
};

/// Maps values onto a drawing, linearly or by decades.
struct Scale {
  double low = 0.0;
  double high = 1.0;
  double from = 0.0;  ///< Place of `low` in the drawing.
  double to = 1.0;    ///< Place of `high` in the drawing.
  bool decades = false;

  [[nodiscard]] double at(double value) const;
};

/// A tick's label: at most six significant digits, no trailing zeros.
[[nodiscard]] std::string tick_label(double value);

/// Colour of a deviation: blue below zero, white at zero, orange above; lightness is a monotone
/// function of the size. `ratio` in [-1, 1].
[[nodiscard]] std::string diverging_colour(double ratio);
/// Colour of a size: dark for 0, light for 1.
[[nodiscard]] std::string sequential_colour(double ratio);

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
