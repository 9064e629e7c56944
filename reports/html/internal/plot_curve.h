#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "record/run_record.h"

namespace rondure::reports {

/// One line of a drawing of an analysis. `css_class` is one of html/style.h: "profile" (black),
/// "zone-outer" (orange), "zone-inner" (blue), "guide" (dotted), "mean" (dashed).
struct Curve {
  std::string name;
  std::string css_class = "profile";
  std::vector<double> x;  ///< Polar: angles [rad]; otherwise in the unit of the axis.
  std::vector<double> y;  ///< Polar: deviations [um]; otherwise in the unit of the axis.
  /// For a chart: half width of a band about y; one per point, or empty.
  std::vector<double> band = {};
  bool marks_only = false;  ///< For a chart: points without a line.
};

/// A polar plot of closed curves about a mean circle, all at one magnification, with a scale bar
/// and the names of the lines. More than 1440 points are thinned to the extremes of equal pieces.
/// @param closed  The last point joins the first; false for successive revolutions.
[[nodiscard]] std::string polar_chart(std::string_view title, const std::vector<Curve>& curves,
                                      bool closed = true);

/// An ordinary chart of lines.
/// @param y_reach  The y axis goes at least so far up and down: of charts that are compared.
[[nodiscard]] std::string line_chart(std::string_view title, std::string_view x_title,
                                     std::string_view y_title, const std::vector<Curve>& curves,
                                     double y_reach = 0.0);

/// Bars over whole numbers, with limits drawn as steps where there are any.
struct Bar {
  int order = 0;
  double value = 0.0;
  bool hollow = false;  ///< Not recovered: there is no value.
};
struct BarLimit {
  int first = 0;
  int last = 0;
  double value = 0.0;
};
/// The limits in the masks of characteristics [um].
[[nodiscard]] std::vector<BarLimit> limits_of(const std::vector<record::Characteristic>& asked);
[[nodiscard]] std::string bar_chart(std::string_view title, std::string_view x_title,
                                    std::string_view y_title, const std::vector<Bar>& bars,
                                    const std::vector<BarLimit>& limits = {});

/// A bar between two values at a place.
struct Span {
  double x = 0.0;
  double low = 0.0;
  double high = 0.0;
  bool worst = false;   ///< Drawn with a mark above it.
  bool absent = false;  ///< There is no value: a cross.
};
/// Bars over places along an axis, with limits over the whole width.
[[nodiscard]] std::string span_chart(std::string_view title, std::string_view x_title,
                                     std::string_view y_title, const std::vector<Span>& spans,
                                     const std::vector<double>& limits);

}  // namespace rondure::reports
