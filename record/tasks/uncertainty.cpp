#include "record/tasks/uncertainty.h"

#include <algorithm>
#include <utility>

#include "record/tasks/settings.h"

namespace rondure::record {
namespace {

constexpr const char* kUncertaintyPath = "uncertainty/";

/// Visitor of describe_groups(): a group is there when it is declared, also without keys.
struct DeclaredOnly {
  const std::vector<std::string>& declared;

  template <class T>
  void object(std::string_view key, std::optional<T>& group, const GroupSpec&) {
    if (std::find(declared.begin(), declared.end(), key) == declared.end()) return group.reset();
    if (!group) group.emplace();
  }
};

}  // namespace

std::vector<Setting> settings_of_uncertainty(const UncertaintyTask& task,
                                             const std::optional<double>& expansion_per_K) {
  UncertaintyTask copy = task;
  GroupNames groups;
  describe_groups(groups, copy);
  DeclaredUncertainty declared;
  if (task.thermal) declared.expansion_per_K = expansion_per_K;
  declared.groups.assign(groups.names.begin(), groups.names.end());
  std::vector<Setting> out = settings_of_task(std::move(copy), kUncertaintyPath);
  for (Setting& setting : settings_of_task(std::move(declared), kUncertaintyPath)) {
    out.push_back(std::move(setting));
  }
  return out;
}

core::Result<std::optional<RecordedUncertainty>> recorded_uncertainty(
    std::span<const Setting> settings) {
  const bool there = std::any_of(settings.begin(), settings.end(), [](const Setting& setting) {
    return setting.name.starts_with(kUncertaintyPath);
  });
  if (!there) return std::optional<RecordedUncertainty>();
  TRY(auto task, task_of<UncertaintyTask>(settings, kUncertaintyPath));
  TRY(const auto declared, task_of<DeclaredUncertainty>(settings, kUncertaintyPath));
  DeclaredOnly only{declared.groups};
  describe_groups(only, task);
  return RecordedUncertainty{std::move(task), declared.expansion_per_K};
}

}  // namespace rondure::record
