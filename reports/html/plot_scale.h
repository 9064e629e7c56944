#pragma once

#include "reports/html/svg.h"

namespace rondure::reports {

/// The colours of deviations beside a drawing, from minus to plus half the zone, with their values
/// in um; 60 px wide.
void deviation_scale(Svg& svg, double x, double top, double bottom, double half_zone_mm);

}  // namespace rondure::reports
