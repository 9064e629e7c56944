#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
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
