#pragma once

#include <string>
#include <string_view>

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

}  // namespace rondure::reports
