#include <cmath>
#include <cstdio>
#include <vector>

#include <core/version.h>
#include <fit/references/min_zone.h>

int main() {
  // Two points 1 um outside a circle and two inside it that alternate: the zone is 2 um wide, about
  // the centre.
  const std::vector<Eigen::Vector2d> points_mm = {
      {10.001, 0}, {0, 9.999}, {-10.001, 0}, {0, -9.999}};
  const auto zone = rondure::fit::min_zone_circle(points_mm);
  if (!zone) {
    std::printf("no zone: %s\n", zone.error().what.c_str());
    return 1;
  }
  std::printf("rondure %s: zone %.9f mm\n", std::string(rondure::core::kVersion).c_str(),
              zone->width_mm());
  return std::abs(zone->width_mm() - 0.002) < 1e-12 ? 0 : 1;
}
