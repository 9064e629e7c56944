#include "cmm/simulated/part_surface.h"

#include "cmm/simulated/internal/surface_shape.h"

namespace rondure::cmm {

double PartSurface::radius_at(double theta_rad, double z_mm) const {
  return radius_derivatives(*this, theta_rad, z_mm).r_mm;
}

PartSurface PartSurface::scaled(double factor) const {
  PartSurface out = *this;
  for (double* length : {&out.radius_mm, &out.half_length_mm, &out.form.taper_mm,
                         &out.form.barrel_mm, &out.form.bend_mm}) {
    *length *= factor;
  }
  for (Lobe& lobe : out.form.lobes) lobe.amplitude_mm *= factor;
  for (SurfaceMark& mark : out.marks) {
    for (double* length :
         {&mark.z_mm, &mark.width_mm, &mark.length_mm, &mark.height_mm, &mark.flank_mm}) {
      *length *= factor;
    }
  }
  return out;
}

}  // namespace rondure::cmm
