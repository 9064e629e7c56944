#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

constexpr const char* kQualification = "/probe/qualification";

std::string pointer_to(std::string_view key) { return fmt::format("{}/{}", kQualification, key); }

/// Reports keys that belong to the other artefact, and keys of a column that are missing.
void check_artefact_keys(const QualificationPlan& q, Findings& findings) {
  for (const std::string_view key :
       {"sphere_diameter_mm", "sphere_center_mm", "points", "stem_diameter_mm",
        "column_diameter_mm", "column_point_mm", "column_from_mm", "column_to_mm", "heights",
        "points_per_height", "column_slope_deg"}) {
    const bool of_both = key == "points" || key.starts_with("sphere") || key.starts_with("stem");
    const bool own = of_both != q.on_column();
    const bool given = findings.is_given(pointer_to(key));
    if (own && !given && key.starts_with("column") && key != "column_slope_deg") {
      findings.meaning(Code::kMissingKey, pointer_to(key),
                       "this key is missing: the probe is qualified on a column, give its "
                       "diameter, a point of its axis and its ends");
    } else if (!own && given) {
      findings.meaning(
          Code::kMeaning, pointer_to(key),
          fmt::format("has no effect: the artefact is a {}; remove it", name_of(q.artefact)));
    }
  }
}

/// Checks that nothing is touched from above, of which a column says nothing.
void check_side_touches(const Plan& plan, Findings& findings) {
  const auto refuse = [&](std::string_view what) {
    findings.meaning(Code::kMeaning, pointer_to("artefact"),
                     fmt::format("{} touched from above, and a column qualifies the tip for "
                                 "touches from the side; qualify it on a sphere",
                                 what));
  };
  if (plan.fixture && (plan.fixture->datum || plan.fixture->reached_pose)) {
    return refuse(plan.fixture->datum && plan.fixture->datum->on_holes()
                      ? "the seat of the fixture is"
                      : "the spheres of the fixture are");
  }
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const FeaturePlan& feature = plan.features[i];
    const bool above = feature.type == record::Shape::kPlane ||
                       feature.type == record::Shape::kSphere || measures_by_touch(feature);
    if (!above || !(is_touched(plan, i, findings) || measures_by_touch(feature))) continue;
    return refuse(fmt::format("feature {} is", in_quotes(feature.id)));
  }
}

}  // namespace

void check_qualification(const Plan& plan, Findings& findings) {
  if (!plan.probe || !findings.sound("/probe")) return;
  const QualificationPlan& q = plan.probe->qualification;
  check_artefact_keys(q, findings);
  if (!q.on_column()) return;
  if (q.column_from_mm >= q.column_to_mm) {
    findings.meaning(Code::kMeaning, pointer_to("column_to_mm"),
                     fmt::format("the upper end, {:g} mm, is not above the lower one, {:g} mm",
                                 q.column_to_mm, q.column_from_mm));
  }
  const double depth_mm = (q.column_to_mm - q.column_from_mm) * (1.0 - 0.5 / q.heights);
  const bool holder = plan.probe->holder_diameter_mm > 0.0 && plan.machine;
  const double reach_mm =
      plan.probe->stylus_length_mm - (holder ? plan.machine->clearance_mm : 0.0);
  if (holder && depth_mm > reach_mm) {
    findings.meaning(Code::kUnreachable, pointer_to("column_from_mm"),
                     fmt::format("the lowest touches lie {:g} mm below the top of the column, the "
                                 "holder of the stylus leaves {:g} mm; touch a shorter piece of it",
                                 depth_mm, reach_mm));
  }
  check_side_touches(plan, findings);
}

}  // namespace rondure::plans
