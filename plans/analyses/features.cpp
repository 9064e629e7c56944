#include "plans/analyses/features.h"

#include <algorithm>

#include "plans/analyses/analysis.h"

namespace rondure::plans {

bool is_touched(const FeaturePlan& feature) {
  return !feature.source && analysis_kind(feature.type) == nullptr;
}

bool needs_machine(const FeaturePlan& feature) {
  return is_touched(feature) || measures_by_touch(feature);
}

bool touches_anything(const Plan& plan) {
  return std::any_of(plan.features.begin(), plan.features.end(), needs_machine);
}

bool simulates_anything(const Plan& plan) {
  return std::any_of(plan.features.begin(), plan.features.end(), [](const FeaturePlan& feature) {
    return !feature.source && !has_files(feature);
  });
}

bool simulates_analysis(const Plan& plan) {
  return std::any_of(plan.features.begin(), plan.features.end(), [](const FeaturePlan& feature) {
    return analysis_kind(feature.type) != nullptr && !has_files(feature) &&
           !measures_by_touch(feature);
  });
}

}  // namespace rondure::plans
