#include "plans/checks/internal/bodies.h"
#include "plans/checks/internal/plan_checks.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "plans/analyses/features.h"
#include "plans/analyses/internal/series_file.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/solid_mesh.h"
#include "plans/schema/json_text.h"
#include "record/points/triangles.h"
#include "record/sha256.h"

namespace rondure::plans {
namespace {

using core::Code;
using Keys = std::vector<std::string_view>;

constexpr std::uintmax_t kMostMeshBytes = std::uintmax_t{512} << 20;

/// The keys that a body of a shape must give.
Keys needed_by(BodyPlan::Shape shape) {
  switch (shape) {
    case BodyPlan::Shape::kCylinder:
      return {"diameter_mm", "from_mm", "to_mm"};
    case BodyPlan::Shape::kRing:
      return {"diameter_mm", "bore_diameter_mm", "from_mm", "to_mm"};
    case BodyPlan::Shape::kBox:
      return {"size_mm"};
    case BodyPlan::Shape::kMesh:
      return {"file", "unit"};
  }
  return {};
}

/// Reports keys of its shape that are missing, and keys of other shapes. Returns whether none is.
bool check_keys(const BodyPlan& body, const std::string& where, Findings& findings) {
  const Keys needed = needed_by(body.shape);
  bool all = true;
  for (const std::string_view key : needed) {
    const std::string pointer = member_pointer(where, std::string(key));
    if (findings.is_given(pointer)) continue;
    all = false;
    findings.meaning(Code::kMissingKey, pointer,
                     fmt::format("this key is missing: a body of shape {} needs {}",
                                 name_of(body.shape), fmt::join(needed, ", ")));
  }
  for (const std::string_view key : {"diameter_mm", "bore_diameter_mm", "from_mm", "to_mm",
                                     "size_mm", "file", "unit", "facets"}) {
    const std::string pointer = member_pointer(where, std::string(key));
    const bool own = std::find(needed.begin(), needed.end(), key) != needed.end() ||
                     (key == "facets" && body.shape == BodyPlan::Shape::kMesh);
    if (own || !findings.is_given(pointer)) continue;
    findings.meaning(Code::kMeaning, pointer,
                     fmt::format("has no effect: the shape is {}; remove it", name_of(body.shape)));
  }
  return all;
}

void check_revolved(const BodyPlan& body, const std::string& where, Findings& findings) {
  if (body.shape != BodyPlan::Shape::kCylinder && body.shape != BodyPlan::Shape::kRing) return;
  if (body.from_mm >= body.to_mm) {
    findings.meaning(Code::kMeaning, where + "/to_mm",
                     fmt::format("the upper end, {:g} mm, is not above the lower one, {:g} mm",
                                 body.to_mm, body.from_mm));
  }
  if (body.bore_diameter_mm >= body.diameter_mm) {
    findings.meaning(Code::kMeaning, where + "/bore_diameter_mm",
                     fmt::format("the hole, {:g} mm, is not smaller than the ring, {:g} mm",
                                 body.bore_diameter_mm, body.diameter_mm));
  }
}

core::Result<void> read_mesh(const Plan& plan, BodyPlan& body) {
  TRY(const std::string bytes, read_data_file(plan.folder / body.file, body.file, kMostMeshBytes));
  TRY(const auto read, record::read_triangles(bytes, body.file, *body.unit));
  TRY(body.mesh, SolidMesh::build(read.points_mm, read.corners));
  body.sha256 = record::sha256_hex(bytes);
  return {};
}

std::string line_of(const BodyPlan& body) { return body.sha256 + "  " + body.file + "\n"; }

}  // namespace

void read_bodies(Plan& plan, Findings& findings) {
  if (!plan.fixture) return;
  std::vector<BodyPlan>& bodies = plan.fixture->bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    BodyPlan& body = bodies[i];
    const std::string where = item_pointer("/fixture/bodies", i);
    if (!findings.sound(where)) continue;
    if (const auto k = earlier_with_same_id(bodies, i)) {
      findings.meaning(Code::kMeaning, where + "/id",
                       fmt::format("{} has the id {} too; give each its own",
                                   item_pointer("/fixture/bodies", *k), in_quotes(body.id)));
    }
    const bool turns = body.frame == BodyPlan::Frame::kHoop || body.frame == BodyPlan::Frame::kRing;
    if (turns && is_fixed(plan)) {
      findings.meaning(Code::kMeaning, where + "/frame",
                       fmt::format("the fixture is \"fixed\" and has no {}; give \"base\" or "
                                   "\"part\"",
                                   name_of(body.frame)));
    }
    if (!check_keys(body, where, findings)) continue;
    check_revolved(body, where, findings);
    if (body.shape == BodyPlan::Shape::kBox) {
      if (auto box = SolidMesh::box(vector3(body.size_mm))) {
        body.mesh = *std::move(box);
      } else {
        findings.meaning(box.error().code, where + "/size_mm", box.error().what);
      }
    }
    if (body.shape != BodyPlan::Shape::kMesh) continue;
    if (const auto read = read_mesh(plan, body); !read) {
      const core::Error& error = read.error();
      findings.meaning(error.code, where + "/file",
                       error.where.empty() ? error.what : error.where + ": " + error.what);
    }
  }
}

std::string body_files(const Plan& plan) {
  std::string out;
  if (!plan.fixture) return out;
  for (const BodyPlan& body : plan.fixture->bodies) {
    if (body.shape == BodyPlan::Shape::kMesh) out += line_of(body);
  }
  return out;
}

std::vector<core::Error> bodies_changed(const Plan& plan, std::string_view on_record) {
  std::vector<core::Error> out;
  if (!plan.fixture) return out;
  for (std::size_t i = 0; i < plan.fixture->bodies.size(); ++i) {
    const BodyPlan& body = plan.fixture->bodies[i];
    if (body.shape != BodyPlan::Shape::kMesh) continue;
    if (on_record.find(line_of(body)) != std::string_view::npos) continue;
    out.push_back({Code::kMeaning,
                   fmt::format("{} is not the file that the run began with; put that back, or "
                               "start a new run",
                               body.file),
                   item_pointer("/fixture/bodies", i) + "/file"});
  }
  return out;
}

}  // namespace rondure::plans
