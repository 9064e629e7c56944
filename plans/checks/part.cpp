#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

using Names = std::initializer_list<std::string_view>;

/// Reports the members of a section that have no effect: those named, or all others.
void refuse(const std::string& section, bool named, Names names, std::string_view why,
            Findings& findings) {
  for (const std::string& key : findings.given_in(section)) {
    const std::string name = key.substr(section.size() + 1);
    if ((std::find(names.begin(), names.end(), name) != names.end()) != named) continue;
    findings.meaning(Code::kMeaning, key, fmt::format("has no effect: {}; remove it", why));
  }
}

/// Checks that the features of part.alignment are touched, a cylinder and a plane with a side.
void check_alignment(const Plan& plan, Findings& findings) {
  if (!plan.part.alignment) return;
  const auto check = [&](std::string_view key, const std::string& id, record::Shape shape) {
    const std::size_t index = feature_index(plan, id);
    const bool plane = shape == record::Shape::kPlane;
    if (index < plan.features.size()) {
      const FeaturePlan& found = plan.features[index];
      const bool sided = !plane || found.nominal.faces;
      if (is_touched(found) && found.type == shape && sided) return;
    }
    findings.meaning(Code::kMeaning, fmt::format("/part/alignment/{}", key),
                     fmt::format("{} is no touched {} of this plan{}; name one", in_quotes(id),
                                 name_of(shape), plane ? " that says \"faces\"" : ""));
  };
  check("axis", plan.part.alignment->axis, record::Shape::kCylinder);
  check("face", plan.part.alignment->face, record::Shape::kPlane);
}

/// Checks what holds against the part where it holds it: the circle contains both.
void check_held(const Plan& plan, Findings& findings) {
  const auto& held = plan.part.held;
  if (!held || !findings.sound("/part/held")) return;
  // Of the pieces in the band the thickest; where none is known there, the thinnest of the part.
  double thickest_mm = 0.0;
  double thinnest_mm = std::numeric_limits<double>::infinity();
  const auto add = [&](double from_mm, double to_mm, double diameter_mm) {
    thinnest_mm = std::min(thinnest_mm, diameter_mm);
    const bool within = from_mm < held->to_mm && to_mm > held->from_mm;
    if (within) thickest_mm = std::max(thickest_mm, diameter_mm);
  };
  for (const SectionPlan& s : plan.part.sections) add(s.from_mm, s.to_mm, s.diameter_mm);
  for (const FeaturePlan& feature : plan.features) {
    if (!is_touched(feature) || feature.side == record::Side::kInside) continue;
    const PartPiece piece = piece_of(feature);
    add(piece.from_mm(), piece.to_mm(), 2.0 * piece.radius_mm());
  }
  const double least_mm = thickest_mm > 0.0 ? thickest_mm : thinnest_mm;
  if (!(held->diameter_mm < least_mm) || std::isinf(least_mm)) return;
  findings.meaning(
      Code::kMeaning, "/part/held/diameter_mm",
      fmt::format("{:g} mm is less than the part, {:g} mm, which the holder contains; give the "
                  "circle about the part axis that contains all of the holder",
                  held->diameter_mm, least_mm));
}

/// Checks that a part whose height no touch shows cannot be met or missed by moves that believe it.
void check_height(const Plan& plan, Findings& findings) {
  if (plan.part.system == PartPlan::System::kControl || plan.part.alignment) return;
  constexpr std::string_view kWhere = "/part/location_uncertainty_mm";
  constexpr std::string_view kRemedy =
      "lower it, or give part.alignment, whose face shows the height";
  const double off_mm = plan.part.location_uncertainty_mm;
  const double kept_mm = std::min(plan.machine->approach_mm, plan.machine->clearance_mm);
  const std::string why = fmt::format(
      "no touch shows the height of the part, which may be {:g} mm off along its axis", off_mm);
  if (off_mm > kept_mm) {
    findings.meaning(Code::kUnreachable, std::string(kWhere),
                     fmt::format("{}, and the tip keeps {:g} mm from it (the lesser of "
                                 "machine.approach_mm and clearance_mm); {}",
                                 why, kept_mm, kRemedy));
    return;
  }
  for (const FeaturePlan& feature : plan.features) {
    const bool round =
        feature.type == record::Shape::kCylinder || feature.type == record::Shape::kCircle;
    if (!round || !is_touched(feature)) continue;
    const auto targets = locating_targets(feature, off_mm);
    if (!targets || targets->empty()) continue;
    const double inside_mm = targets->front().z_mm - feature.nominal.from_mm;
    if (off_mm <= inside_mm) continue;
    findings.meaning(Code::kUnreachable, std::string(kWhere),
                     fmt::format("{}, and the touches that locate {} lie {:g} mm from its ends; {}",
                                 why, in_quotes(feature.id), inside_mm, kRemedy));
    return;
  }
}

void check_place(const Plan& plan, Findings& findings) {
  if (!findings.sound("/part")) return;
  const bool control = plan.part.system == PartPlan::System::kControl;
  if (!control && !findings.is_given("/part/position_mm")) {
    findings.meaning(Code::kMissingKey, "/part/position_mm",
                     "this key is missing: without a fixture the plan says where the part stands; "
                     "give its origin, x, y, z in the machine frame, or \"system\": "
                     "\"control\"");
  }
  if (control && plan.part.alignment) {
    findings.meaning(Code::kMeaning, "/part/alignment",
                     "has no effect: the part system of the control says where the part stands; "
                     "remove it, or take \"system\": \"plan\"");
  }
  check_alignment(plan, findings);
  check_held(plan, findings);
  if (plan.machine && findings.sound("/machine") && findings.sound("/features")) {
    check_height(plan, findings);
  }
  const auto& axis = plan.part.axis;
  if (std::hypot(axis[0], axis[1], axis[2]) < 1e-3) {
    findings.meaning(Code::kMeaning, "/part/axis",
                     "three zeros are no direction; give that of part z, e.g. [0, 0, 1]");
  }
}

/// Checks that no feature needs another pose than that in which the part stands.
void check_poses(const Plan& plan, Findings& findings) {
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const FeaturePlan& feature = plan.features[i];
    const std::string where = feature_pointer(i) + "/pose_search";
    if (!is_touched(plan, i, findings) || !findings.sound(where)) continue;
    const bool cylinder = feature.type == record::Shape::kCylinder;
    if (cylinder && feature.pose_search.strategy != record::Strategy::kStartPose) {
      findings.meaning(Code::kMeaning, where + "/strategy",
                       fmt::format("\"{}\" turns the part, and without a fixture it stands still; "
                                   "give \"start-pose\", or leave the key out",
                                   name_of(feature.pose_search.strategy)));
    }
    constexpr std::string_view kStill = "without a fixture the part stands still";
    if (cylinder) {
      refuse(where, false, {"strategy", "repeats"}, kStill, findings);
    } else {  // check_feature() refuses the others
      refuse(where, true, {"start_alpha_deg", "start_beta_deg", "poses", "merge"}, kStill,
             findings);
    }
  }
}

}  // namespace

void stand_without_fixture(Plan& plan, const Findings& findings) {
  if (!findings.is_given("/fixture")) {
    const auto& features = plan.features;
    bool touched = false;
    for (std::size_t i = 0; i < features.size(); ++i)
      touched = touched || is_touched(plan, i, findings);
    // Balls need a fixture, which check_equipment() then misses.
    touched = touched && std::none_of(features.begin(), features.end(), measures_by_touch);
    if (touched) plan.fixture.emplace().driver = FixturePlan::Driver::kFixed;
  }
  if (!is_fixed(plan)) return;
  FixturePlan& fixture = *plan.fixture;
  fixture.axis_point_mm = plan.part.position_mm;
  fixture.part_axis = plan.part.axis;
  fixture.min_alpha_deg = fixture.max_alpha_deg = 0.0;
  fixture.min_beta_deg = fixture.max_beta_deg = 0.0;
  fixture.resolution_deg = 0.0;
  if (plan.uncertainty) plan.uncertainty->fixture.emplace();  // axes that are not there add nothing
  if (const auto& held = plan.part.held) {
    fixture.clamp_from_mm = held->from_mm;
    fixture.clamp_to_mm = held->to_mm;
    fixture.ring_diameter_mm = held->diameter_mm;
  }
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (findings.is_given(feature_pointer(i) + "/pose_search/strategy")) continue;
    plan.features[i].pose_search.strategy = record::Strategy::kStartPose;
  }
}

void check_fixed_part(const Plan& plan, Findings& findings) {
  if (!plan.fixture || !findings.sound("/fixture/driver")) return;
  if (!is_fixed(plan)) {
    refuse("/part", true, {"position_mm", "axis", "system", "alignment", "held"},
           "the fixture carries the part, `fixture` says where", findings);
    return;
  }
  check_place(plan, findings);
  constexpr std::string_view kNoAxes = "the fixture is \"fixed\", it has no axes";
  refuse("/fixture", false, {"driver", "id", "table_height_mm", "bodies"}, kNoAxes, findings);
  refuse("/uncertainty/fixture", false, {}, kNoAxes, findings);
  refuse("/simulation/fixture", false, {"base_offset_mm", "base_rotation_deg"}, kNoAxes, findings);
  refuse("/simulation/faults", true, {"fixture_stalls_at_move", "fixture_off_deg"}, kNoAxes,
         findings);
  check_poses(plan, findings);
}

namespace {

using core::Code;
using record::Shape;

/// The keys of an entry that a type of feature does not take.
std::vector<std::string_view> without_effect(Shape type) {
  std::vector<std::string_view> out;
  const auto add = [&](std::initializer_list<std::string_view> keys) {
    out.insert(out.end(), keys);
  };
  if (type != Shape::kPlane) {
    add({"tilt_urad", "tilt_toward_deg", "saucer_um", "wave_um", "wave_order"});
  }
  if (type == Shape::kPlane) {
    add({"offset_x_um", "offset_y_um", "diameter_error_um", "lobes"});
  }
  if (type == Shape::kPlane || type == Shape::kSphere) {
    add({"slope_x_urad", "slope_y_urad", "taper_um", "barrel_um", "bend_um", "bend_phase_deg",
         "keyways", "flats"});
  }
  return out;
}

}  // namespace

void check_overlaps(const Plan& plan, Findings& findings) {
  const auto is_cylinder = [](const FeaturePlan& feature) {
    return is_touched(feature) && feature.type == Shape::kCylinder &&
           feature.nominal.diameter_mm > 0.0;
  };
  for (std::size_t k = 0; k < plan.features.size(); ++k) {
    const FeaturePlan& one = plan.features[k];
    for (std::size_t i = 0; is_cylinder(one) && i < k; ++i) {
      const FeaturePlan& other = plan.features[i];
      const double common_mm = std::min(one.nominal.to_mm, other.nominal.to_mm) -
                               std::max(one.nominal.from_mm, other.nominal.from_mm);
      if (!is_cylinder(other) || one.side != other.side || !(common_mm > 0.0) ||
          one.nominal.diameter_mm == other.nominal.diameter_mm) {
        continue;
      }
      findings.meaning(
          Code::kMeaning, feature_pointer(k) + "/nominal/from_mm",
          fmt::format(
              "{} and {} overlap by {:g} mm along the part, with diameters of {:g} and {:g} mm: "
              "a part has one of them there; correct from_mm, to_mm or diameter_mm",
              in_quotes(one.id), in_quotes(other.id), common_mm, one.nominal.diameter_mm,
              other.nominal.diameter_mm));
      break;
    }
  }
}

void check_simulated_part(const Plan& plan, Findings& findings) {
  if (!plan.simulation || !findings.sound("/simulation/features")) return;
  const auto& entries = plan.simulation->features;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const std::string where = item_pointer("/simulation/features", k);
    const std::string& id = entries[k].id;
    const auto same = [&](const auto& other) { return other.id == id; };
    const auto feature = std::find_if(plan.features.begin(), plan.features.end(), same);
    if (feature == plan.features.end() || !is_touched(*feature)) {
      findings.meaning(
          Code::kMeaning, where + "/id",
          fmt::format("no touched feature has the id {}; write one as in features", in_quotes(id)));
      continue;
    }
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find_if(entries.begin(), end, same) != end) {
      findings.meaning(
          Code::kMeaning, where + "/id",
          fmt::format("the feature {} has an entry already; make one of the two", in_quotes(id)));
    }
    for (const std::string_view key : without_effect(feature->type)) {
      if (!findings.is_given(member_pointer(where, key))) continue;
      findings.meaning(
          Code::kMeaning, member_pointer(where, key),
          fmt::format("has no effect: it is no form of a {}; remove it", name_of(feature->type)));
    }
  }
}

}  // namespace rondure::plans
