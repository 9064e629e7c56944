#include "cmm/part_surface.h"

#include "cmm/surface_shape.h"

namespace rondure::cmm {

double PartSurface::radius_at(double theta_rad, double z_mm) const {
  return radius_derivatives(*this, theta_rad, z_mm).r_mm;
}

}  // namespace rondure::cmm
