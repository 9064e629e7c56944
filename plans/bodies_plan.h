#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "record/points/points.h"
#include "record/words.h"

namespace rondure::plans {

class SolidMesh;  // plans/path/solid_mesh.h

/// A solid of fixture, table or part, which the path planner avoids. Keys and meanings:
/// bodies_table.h.
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

}  // namespace rondure::plans
