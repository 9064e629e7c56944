#pragma once

#include <vector>

#include "plans/plan.h"
#include "record/tasks/settings.h"

namespace rondure::plans {

/// The settings of one section of a feature, such as &FeaturePlan::spindle; the defaults if the
/// section is missing.
template <auto section>
[[nodiscard]] std::vector<record::Setting> settings_of_section(const FeaturePlan& feature) {
  auto given = feature.*section;
  return record::settings_of_task(given ? *given : given.emplace());
}

}  // namespace rondure::plans
