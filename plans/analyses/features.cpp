#include "plans/analyses/features.h"

#include <algorithm>
#include <array>
#include <optional>

#include "plans/analyses/analysis.h"

namespace rondure::plans {

bool is_touched(const FeaturePlan& feature) {
  return !feature.source && analysis_kind(feature.type) == nullptr;
}

bool needs_machine(const FeaturePlan& feature) {
  return is_touched(feature) || measures_by_touch(feature);
}

bool is_fixed(const Plan& plan) {
  return plan.fixture && plan.fixture->driver == FixturePlan::Driver::kFixed;
}

std::size_t feature_index(const Plan& plan, std::string_view id) {
  const auto same = [&](const FeaturePlan& feature) { return feature.id == id; };
  return static_cast<std::size_t>(std::find_if(plan.features.begin(), plan.features.end(), same) -
                                  plan.features.begin());
}

std::size_t calibrating_feature(const Plan& plan) {
  const bool named = plan.fixture && plan.fixture->calibration;
  if (!named || plan.fixture->calibration->feature.empty()) return plan.features.size();
  return feature_index(plan, plan.fixture->calibration->feature);
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

std::vector<record::Characteristic> characteristics_of(const Plan& plan,
                                                       const FeaturePlan& feature) {
  const std::array<record::CharacteristicLevel, 2> levels = {
      {{feature.defaults, feature.decision_rule}, {plan.defaults, std::nullopt}}};
  std::vector<record::Characteristic> out;
  for (const record::CharacteristicTask& task : feature.characteristics) {
    out.push_back(characteristic_of(task, feature.nominal.diameter_mm, levels));
  }
  return out;
}

std::string clamping_of(const Plan& plan, const FeaturePlan& feature) {
  if (!feature.source || analysis_kind(feature.type) != nullptr) return {};
  if (!feature.source->clamping.empty()) return feature.source->clamping;
  std::size_t sharing = 0;
  std::string named;
  for (const FeaturePlan& other : plan.features) {
    if (!other.source || other.source->file != feature.source->file) continue;
    ++sharing;
    const std::string& own = other.source->clamping;
    // A file of several clampings says of no other row where the part stood.
    if (!named.empty() && !own.empty() && own != named) return feature.source->file;
    if (named.empty()) named = own;
  }
  return named.empty() && sharing > 1 ? feature.source->file : named;
}

}  // namespace rondure::plans
