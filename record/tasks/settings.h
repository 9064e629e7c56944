#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"
#include "record/key_spec.h"
#include "record/run_record.h"
#include "record/tasks/analysis_influences.h"

// Conversion of a task to the settings of a journal and back. The function describe(visitor, task)
// of each task lists its keys once; settings_of_task() and task_of() visit them.

namespace rondure::record {

/// Visitor that converts a task into settings, so that the run can be evaluated without its plan.
/// Every key is written, even with its default; a key without value and default is absent. Keys of
/// nested objects include their path ("mask/from").
class SettingList {
 public:
  explicit SettingList(std::string path = {}) : path_(std::move(path)) {}

  void text(std::string_view key, const std::string& value, const TextSpec&) { word(key, value); }
  void text(std::string_view key, const std::optional<std::string>& value, const TextSpec&) {
    if (value) word(key, *value);
  }
  template <Worded Enum>
  void text(std::string_view key, Enum value, const TextSpec&) {
    word(key, std::string(name_of(value)));
  }
  template <Worded Enum>
  void text(std::string_view key, const std::optional<Enum>& value, const TextSpec&) {
    if (value) word(key, std::string(name_of(*value)));
  }
  void texts(std::string_view key, const std::vector<std::string>& values, const TextSpec&) {
    for (const std::string& value : values) word(key, value);
  }
  void number(std::string_view key, double value, const NumberSpec&) { add(key, value); }
  void number(std::string_view key, const std::optional<double>& value, const NumberSpec&) {
    if (value) add(key, *value);
  }
  void numbers(std::string_view key, const std::array<double, 3>& values, const NumberSpec&) {
    for (const double value : values) add(key, value);
  }
  void numbers(std::string_view key, const std::vector<double>& values, const NumberSpec&) {
    for (const double value : values) add(key, value);
  }
  template <class Whole>
  void whole(std::string_view key, Whole value, const NumberSpec&) {
    add(key, static_cast<double>(value));
  }
  void passed_over(std::string_view, std::string_view) {}
  void influence(std::string_view key, Influence& value, const NumberSpec& spec) {
    if (value) inner(key, *value, spec);
  }
  template <class T>
  void object(std::string_view key, T& value, const GroupSpec&) {
    inner(key, value);
  }
  template <class T>
  void object(std::string_view key, std::optional<T>& value, const GroupSpec&) {
    if (value) inner(key, *value);
  }
  template <class T>
  void list(std::string_view key, std::vector<T>& values, const GroupSpec&) {
    for (T& value : values) inner(key, value);
  }

  [[nodiscard]] std::vector<Setting> take() { return std::move(settings_); }

 private:
  void add(std::string_view key, double value) {
    settings_.push_back({path_ + std::string(key), value, {}});
  }
  void word(std::string_view key, const std::string& value) {
    settings_.push_back({path_ + std::string(key), std::nullopt, value});
  }
  template <class T, class... Spec>
  void inner(std::string_view key, T& value, const Spec&... spec) {
    SettingList list(path_ + std::string(key) + "/");
    describe(list, value, spec...);
    for (Setting& setting : list.settings_) settings_.push_back(std::move(setting));
  }

  std::string path_;
  std::vector<Setting> settings_;
};

/// Visitor that fills a task from settings, the reverse of SettingList. A key that is missing from
/// the settings, as it may be in a run of another version, keeps the default of the task; an object
/// exists when one of its keys does. A new item of a list begins where its first key occurs again,
/// so that key must be a single value that SettingList always writes.
class SettingReader {
 public:
  /// @param settings  Not copied; must outlive the reader.
  explicit SettingReader(std::span<const Setting> settings, std::string path = {})
      : settings_(settings), path_(std::move(path)) {}

  void text(std::string_view key, std::string& value, const TextSpec& spec) {
    const Setting* const setting = text_at(key, spec.required);
    if (setting == nullptr) return;
    if (!allows(spec, setting->text)) return refuse_word(*setting);
    value = setting->text;
  }
  void text(std::string_view key, std::optional<std::string>& value, const TextSpec& spec) {
    if (text_at(key, spec.required) != nullptr) text(key, value.emplace(), spec);
  }
  template <Worded Enum>
  void text(std::string_view key, Enum& value, const TextSpec& spec) {
    const Setting* const setting = text_at(key, spec.required);
    if (setting == nullptr) return;
    const auto named = value_named<Enum>(setting->text);
    if (!named) return refuse_word(*setting);
    value = *named;
  }
  template <Worded Enum>
  void text(std::string_view key, std::optional<Enum>& value, const TextSpec& spec) {
    if (text_at(key, spec.required) != nullptr) text(key, value.emplace(), spec);
  }
  void texts(std::string_view key, std::vector<std::string>& values, const TextSpec& spec) {
    const std::string name = path_ + std::string(key);
    std::vector<std::string> given;
    for (const Setting& setting : settings_) {  // no item may be passed over
      if (setting.name != name) continue;
      if (setting.number) return refuse(name, kNeedsText);
      if (!allows(spec, setting.text)) return refuse_word(setting);
      given.push_back(setting.text);
    }
    if (!given.empty()) values = std::move(given);
  }
  void number(std::string_view key, double& value, const NumberSpec& spec) {
    if (const Setting* const setting = number_at(key, spec.required)) value = *setting->number;
  }
  void number(std::string_view key, std::optional<double>& value, const NumberSpec& spec) {
    if (const Setting* const setting = number_at(key, spec.required)) value = setting->number;
  }
  void numbers(std::string_view key, std::array<double, 3>& values, const NumberSpec& spec) {
    std::vector<double> given;
    numbers(key, given, spec);
    if (given.size() == values.size()) {
      std::copy(given.begin(), given.end(), values.begin());
    } else if (!given.empty()) {
      refuse(path_ + std::string(key),
             "has " + std::to_string(given.size()) + " numbers, 3 are needed");
    }
  }
  void numbers(std::string_view key, std::vector<double>& values, const NumberSpec& spec) {
    const std::string name = path_ + std::string(key);
    if (at(key, spec.required) == nullptr) return;
    std::vector<double> given;
    for (const Setting& setting : settings_) {  // no item may be passed over
      if (setting.name != name) continue;
      if (!setting.number) return refuse(name, kNeedsNumber);
      given.push_back(*setting.number);
    }
    values = std::move(given);
  }
  template <class Whole>
  void whole(std::string_view key, Whole& value, const NumberSpec& spec) {
    const Setting* const setting = number_at(key, spec.required);
    if (setting == nullptr) return;
    const double given = *setting->number;
    // Also prevents conversion of a number that does not fit into the type.
    const bool fits = given == std::floor(given) && given >= spec.at_least && given <= spec.at_most;
    if (!fits && given != static_cast<double>(value)) {
      return refuse(setting->name, "is no whole number within its limits");
    }
    if (fits) value = static_cast<Whole>(given);
  }
  template <class T>
  void object(std::string_view key, T& value, const GroupSpec&) {
    inner(settings_, path_ + std::string(key) + "/", value);
  }
  template <class T>
  void object(std::string_view key, std::optional<T>& value, const GroupSpec&) {
    const std::string path = path_ + std::string(key) + "/";
    if (any_below(path)) inner(settings_, path, value.emplace());
  }
  void influence(std::string_view key, Influence& value, const NumberSpec& spec) {
    const std::string path = path_ + std::string(key) + "/";
    if (any_below(path)) inner(settings_, path, value.emplace(), spec);
  }
  template <class T>
  void list(std::string_view key, std::vector<T>& values, const GroupSpec&) {
    const std::string path = path_ + std::string(key) + "/";
    std::vector<Setting> item;
    const auto take_item = [&] {
      if (!item.empty()) inner(item, path, values.emplace_back());
      item.clear();
    };
    for (const Setting& setting : settings_) {
      if (!setting.name.starts_with(path)) continue;
      if (!item.empty() && setting.name == item.front().name) take_item();
      item.push_back(setting);
    }
    take_item();
  }

  /// The first setting that does not meet the specification of its task; none when all do.
  [[nodiscard]] const std::optional<std::string>& fault() const { return fault_; }

 private:
  static constexpr const char* kNeedsNumber = "is a text, a number is needed";
  static constexpr const char* kNeedsText = "is a number, a text is needed";

  static bool allows(const TextSpec& spec, const std::string& word) {
    return spec.one_of.empty() ||
           std::find(spec.one_of.begin(), spec.one_of.end(), word) != spec.one_of.end();
  }
  const Setting* at(std::string_view key, bool required) {
    const std::string name = path_ + std::string(key);
    const auto found = std::find_if(settings_.begin(), settings_.end(),
                                    [&](const Setting& setting) { return setting.name == name; });
    if (found != settings_.end()) return &*found;
    if (nested_ && required) refuse(name, "is missing");
    return nullptr;
  }
  const Setting* text_at(std::string_view key, bool required) {
    const Setting* const setting = at(key, required);
    if (setting == nullptr || !setting->number) return setting;
    refuse(setting->name, kNeedsText);
    return nullptr;
  }
  const Setting* number_at(std::string_view key, bool required) {
    const Setting* const setting = at(key, required);
    if (setting == nullptr || setting->number) return setting;
    refuse(setting->name, kNeedsNumber);
    return nullptr;
  }
  /// Whether the settings hold an object: one of its keys.
  [[nodiscard]] bool any_below(const std::string& path) const {
    return std::any_of(settings_.begin(), settings_.end(),
                       [&](const Setting& setting) { return setting.name.starts_with(path); });
  }
  template <class T, class... Spec>
  void inner(std::span<const Setting> settings, const std::string& path, T& value,
             const Spec&... spec) {
    SettingReader reader(settings, path);
    reader.nested_ = true;
    describe(reader, value, spec...);
    if (!fault_) fault_ = reader.fault_;
  }
  void refuse(const std::string& name, const std::string& why) {
    if (!fault_) fault_ = "setting \"" + name + "\" " + why;
  }
  void refuse_word(const Setting& setting) {
    constexpr std::size_t kShown = 40;
    refuse(setting.name, "says \"" + setting.text.substr(0, kShown) + "\", which is not known");
  }

  std::span<const Setting> settings_;
  std::string path_;
  bool nested_ = false;  ///< Reads an object or an item of a list, which a plan gives whole.
  std::optional<std::string> fault_;
};

/// The settings of a task, each key after `path`.
template <class Task>
[[nodiscard]] std::vector<Setting> settings_of_task(Task task, const std::string& path = {}) {
  SettingList list(path);
  describe(list, task);
  return list.take();
}

/// The task from which settings_of_task() wrote these settings, with the same bits; other settings
/// are ignored. kMeaning names a setting with an unknown word, or a text in place of a number.
template <class Task>
[[nodiscard]] core::Result<Task> task_of(std::span<const Setting> settings,
                                         const std::string& path = {}) {
  Task task;
  SettingReader reader(settings, path);
  describe(reader, task);
  if (reader.fault()) return core::fail(core::Code::kMeaning, *reader.fault());
  return task;
}

}  // namespace rondure::record
