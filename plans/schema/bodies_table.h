#pragma once

#include "plans/bodies_plan.h"
#include "plans/schema/key_spec.h"

// The part of plan_table.h for the bodies that the path planner avoids.

namespace rondure::plans {

template <class Visitor>
void describe(Visitor& v, BodyPlan& p) {
  constexpr double kFar_mm = 10'000.0;
  v.text("id", p.id,
         {.required = true, .empty_allowed = false, .meaning = "Its name, for messages."});
  v.text("shape", p.shape,
         {.required = true,
          .meaning = "cylinder, ring: about its z. box: about its origin. mesh: an STL file."});
  v.text("frame", p.frame,
         {.meaning = "What it is fixed to. hoop: turns with alpha about axis_point_mm. ring: turns "
                     "with both axes. part: a mesh there is the part itself."});
  v.numbers("position_mm", p.position_mm, within(kFar_mm, "Its origin in that frame."));
  v.numbers("rotation_deg", p.rotation_deg,
            within(360.0, "Its rotation there, about x, then y, then z."));
  v.number("clearance_mm", p.clearance_mm,
           range(0.0, 500.0, "Kept from it beside machine.clearance_mm."));
  v.number("diameter_mm", p.diameter_mm, above(0.0, 5000.0, "Of a cylinder or ring, outside."));
  v.number("bore_diameter_mm", p.bore_diameter_mm, above(0.0, 5000.0, "Of a ring: its hole."));
  v.number("from_mm", p.from_mm, within(kFar_mm, "Of a cylinder or ring: lower end, its z."));
  v.number("to_mm", p.to_mm, within(kFar_mm, "Upper end."));
  v.numbers("size_mm", p.size_mm, above(0.0, 5000.0, "Of a box: its lengths along x, y and z."));
  v.text("file", p.file,
         {.empty_allowed = false,
          .meaning = "Of a mesh: an STL file, text or binary, relative to the plan."});
  v.text("unit", p.unit, {.meaning = "Of a mesh: that of its file. Needed."});
  v.text("facets", p.facets,
         {.meaning = "Of a mesh. round: its facets stand for round walls, which are kept clear."});
}

}  // namespace rondure::plans
