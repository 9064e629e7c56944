#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plans/plan.h"
#include "plans/schema/key_spec.h"
#include "record/run_record.h"

namespace rondure::plans {

/// Visitor of plan_table.h that converts the section of an analysis into settings of the journal,
/// so that it can be evaluated without its plan. Every key is written, also with its default; a key
/// without value and default is absent. Keys of nested objects carry their path ("mask/from").
class SettingList {
 public:
  explicit SettingList(std::string path = {}) : path_(std::move(path)) {}

  void text(std::string_view key, const std::string& value, const TextSpec&) { word(key, value); }
  void text(std::string_view key, const std::optional<std::string>& value, const TextSpec&) {
    if (value) word(key, *value);
  }
  template <record::Worded Enum>
  void text(std::string_view key, Enum value, const TextSpec&) {
    word(key, std::string(name_of(value)));
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

  [[nodiscard]] std::vector<record::Setting> take() { return std::move(settings_); }

 private:
  void add(std::string_view key, double value) {
    settings_.push_back({path_ + std::string(key), value, {}});
  }
  void word(std::string_view key, const std::string& value) {
    settings_.push_back({path_ + std::string(key), std::nullopt, value});
  }
  template <class T>
  void inner(std::string_view key, T& value) {
    SettingList list(path_ + std::string(key) + "/");
    describe(list, value);
    for (record::Setting& setting : list.settings_) settings_.push_back(std::move(setting));
  }

  std::string path_;
  std::vector<record::Setting> settings_;
};

/// The settings of one section of a feature, such as &FeaturePlan::spindle; the defaults if the
/// section is missing.
template <auto section>
[[nodiscard]] std::vector<record::Setting> settings_of_section(const FeaturePlan& feature) {
  SettingList list;
  auto given = feature.*section;
  describe(list, given ? *given : given.emplace());
  return list.take();
}

}  // namespace rondure::plans
