#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/checks/internal/bodies.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/checks/internal/plan_reach.h"
#include "plans/path/internal/rotary_poses.h"
#include "plans/plan.h"
#include "plans/schema/findings.h"
#include "plans/schema/internal/plan_table.h"
#include "plans/schema/internal/table_reader.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

tl::unexpected<std::vector<core::Error>> refuse(core::Error problem) {
  return tl::unexpected(std::vector<core::Error>{std::move(problem)});
}

// Sets the single layer of a circle, which a plan may omit.
void complete_circles(Plan& plan, const Findings& findings) {
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    FeaturePlan& feature = plan.features[i];
    if (feature.type != record::Shape::kCircle) continue;
    const std::string where = feature_pointer(i);
    if (!findings.is_given(where + "/sampling/layers")) feature.sampling.layers = 1;
  }
}

/// Fills an empty simulation with a typical part, ground and clamped by hand, on a typical machine,
/// so that a plan can be tried before anything of either is known.
void complete_simulation(Plan& plan, const JsonValue& json) {
  const JsonValue* const given = json.find("simulation");
  if (given == nullptr || !plan.simulation || !given->members.empty()) return;
  SimulatedPartPlan& part = plan.simulation->part;
  part.offset_x_mm = 0.05 * plan.part.location_uncertainty_mm;
  part.offset_y_mm = -0.03 * plan.part.location_uncertainty_mm;
  part.tilt_deg = 0.01;
  part.tilt_toward_deg = 40.0;
  part.diameter_error_um = -2.0;
  part.taper_um = 0.5;
  part.lobes = {{2, 0.4, 20.0}, {3, 0.5, 75.0}, {5, 0.15}};
  plan.simulation->probe.repeatability_um = 0.2;
  plan.simulation->machine.errors = SimulatedMachinePlan::Errors::kTypical;
}

/// Reads the keys of a plan and what follows of them alone.
Plan read_keys(const JsonValue& json, std::string_view text, Findings& findings) {
  Plan plan;
  plan.text = text;
  TableReader reader(json, "", findings);
  describe(reader, plan);
  reader.finish();
  complete_circles(plan, findings);
  complete_simulation(plan, json);
  measure_datums_in_one_pose(plan, findings);
  stand_without_fixture(plan, findings);
  return plan;
}

}  // namespace

PlanOrProblems parse_plan(std::string_view text, const std::filesystem::path& folder,
                          std::string_view name) {
  const auto json = parse_json(text, name);
  if (!json) return refuse(json.error());
  Findings findings;
  Plan plan = read_keys(*json, text, findings);
  plan.folder = folder;
  read_bodies(plan, findings);
  read_head_poses(plan, findings);
  check_plan(plan, findings);
  std::vector<core::Error> problems = findings.take();
  // Reach can be judged only when every number is valid.
  if (problems.empty()) {
    if (touches_anything(plan)) {
      if (auto free = check_room(plan); !free) problems.push_back(free.error());
    }
    // An obstacle of the whole part would be reported again for every feature.
    const bool room = problems.empty();
    for (std::size_t i = 0; room && i < plan.features.size(); ++i) {
      if (measures_by_touch(plan.features[i])) {
        if (auto visits = rotary_visits(plan, i); !visits) problems.push_back(visits.error());
      }
      if (!is_touched(plan, i, findings)) continue;
      if (auto targets = reachable_targets(plan, i); !targets) problems.push_back(targets.error());
    }
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return plan;
}

core::Result<Plan> recorded_plan(std::string_view text) {
  constexpr std::string_view kName = "the plan in the journal";
  const auto fault = [&](const core::Error& e) {
    return core::fail_with(Code::kJournal, "{}: {}: {}", kName, e.where, e.what);
  };
  const auto json = parse_json(text, kName);
  if (!json) return fault(json.error());
  Findings findings;
  Plan plan = read_keys(*json, text, findings);
  if (const auto problems = findings.take(); !problems.empty()) return fault(problems.front());
  return plan;
}

record::Paper recorded_paper(std::string_view text) {
  const auto json = parse_json(text, "the plan in the journal");
  const JsonValue* reports = json ? json->find("reports") : nullptr;
  const JsonValue* paper = reports != nullptr ? reports->find("paper") : nullptr;
  const auto named =
      paper != nullptr ? record::value_named<record::Paper>(paper->text) : std::nullopt;
  return named.value_or(ReportsPlan{}.paper);
}

PlanOrProblems read_plan(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  std::error_code reason;
  const std::filesystem::file_status status = std::filesystem::status(path, reason);
  if (status.type() == std::filesystem::file_type::not_found) {
    return refuse(
        {Code::kFile, "the plan does not exist; check the name and the folder", path.string()});
  }
  if (!std::filesystem::is_regular_file(status)) {
    return refuse({Code::kFile, "this is not a file that can be read; give a plan, name.json",
                   path.string()});
  }
  const std::uintmax_t bytes = std::filesystem::file_size(path, reason);
  if (!reason && bytes > kMaxPlanBytes) {  // checked before reading it into memory
    return refuse({Code::kSyntax,
                   fmt::format("the file has {} bytes, the limit is {}; this is not a plan", bytes,
                               kMaxPlanBytes),
                   name});
  }
  const auto text = record::read_file(path);
  if (!text) return refuse(text.error().at(path.string()));
  return parse_plan(*text, path.parent_path(), name);
}

}  // namespace rondure::plans
