#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "plans/key_spec.h"
#include "record/points/points.h"
#include "record/words.h"

namespace rondure::plans {

class SolidMesh;  // plans/path/solid_mesh.h

/// A solid of fixture, table or part, which the path planner avoids.
struct BodyPlan {
  enum class Frame { kBase, kHoop, kRing, kPart };
  enum class Shape { kCylinder, kRing, kBox, kMesh };
  enum class Facets { kFlat, kRound };

  std::string id;
  Frame frame = Frame::kBase;
  Shape shape = Shape::kCylinder;
  std::array<double, 3> position_mm = {0.0, 0.0, 0.0};
  std::array<double, 3> rotation_deg = {0.0, 0.0, 0.0};  ///< About x, then y, then z.
  double clearance_mm = 0.0;                             ///< Beside that of the machine.
  // Of a cylinder and a ring.
  double diameter_mm = 0.0;
  double bore_diameter_mm = 0.0;
  double from_mm = 0.0;
  double to_mm = 0.0;
  std::array<double, 3> size_mm = {0.0, 0.0, 0.0};  ///< Of a box.
  // Of a mesh.
  std::string file;
  std::optional<record::LengthUnit> unit;
  Facets facets = Facets::kFlat;

  // Not keys: read_bodies() fills them.
  std::shared_ptr<const SolidMesh> mesh;  ///< Of a mesh and a box.
  std::string sha256;                     ///< Of the file.
};

RONDURE_WORDS(BodyPlan::Frame, {kBase, "base"}, {kHoop, "hoop"}, {kRing, "ring"}, {kPart, "part"});
RONDURE_WORDS(BodyPlan::Shape, {kCylinder, "cylinder"}, {kRing, "ring"}, {kBox, "box"},
              {kMesh, "mesh"});
RONDURE_WORDS(BodyPlan::Facets, {kFlat, "flat"}, {kRound, "round"});

// Keys and meanings of the bodies that the path planner avoids.

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
