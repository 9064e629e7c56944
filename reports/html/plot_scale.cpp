#include "reports/html/plot_scale.h"

#include "core/numbers.h"

namespace rondure::reports {

using core::signed_um;

void deviation_scale(Svg& svg, double x, double top, double bottom, double half_zone_mm) {
  constexpr int kSteps = 41;
  constexpr double kBar = 14.0;
  const double from = top + 18.0;
  const double height = (bottom - from) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double ratio = 1.0 - 2.0 * i / (kSteps - 1.0);
    svg.rect(x, from + i * height, kBar, height + 0.4, "swatch", diverging_colour(ratio));
  }
  svg.rect(x, from, kBar, kSteps * height, "frame");
  svg.text(x, top + 6.0, "start", "title", "µm");
  const Scale y{-half_zone_mm, half_zone_mm, from + kSteps * height, from};
  for (const int part : {-2, -1, 0, 1, 2}) {
    const double value = 0.5 * part * half_zone_mm;
    const double shift = part == 2 ? 7.0 : part == -2 ? 1.0 : 4.0;
    svg.line(x + kBar, y.at(value), x + kBar + 4.0, y.at(value), "tick");
    svg.text(x + kBar + 7.0, y.at(value) + shift, "start", "label",
             part == 0 ? "0" : signed_um(value));
  }
}

}  // namespace rondure::reports
