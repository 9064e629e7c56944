#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plans/key_spec.h"
#include "plans/schema/findings.h"
#include "plans/schema/json_text.h"
#include "record/tasks/analysis_influences.h"

namespace rondure::plans {

/// Visitor of plan_table.h that fills a struct from a JSON object. A missing or wrong value leaves
/// its default; every problem goes to the findings. Call finish() after describe().
class TableReader {
 public:
  /// All three arguments must outlive the reader.
  TableReader(const JsonValue& object, std::string pointer, Findings& findings)
      : object_(object), pointer_(std::move(pointer)), findings_(findings) {}

  void text(std::string_view key, std::string& value, const TextSpec& spec);
  void text(std::string_view key, std::optional<std::string>& value, const TextSpec& spec);
  template <record::Worded Enum>
  void text(std::string_view key, Enum& value, const TextSpec& spec) {
    std::optional<Enum> given;
    text(key, given, spec);
    if (given) value = *given;
  }
  template <record::Worded Enum>
  void text(std::string_view key, std::optional<Enum>& value, const TextSpec& spec) {
    std::optional<std::string> given;
    text(key, given, spec_of_words<Enum>(spec));
    if (given) value = record::value_named<Enum>(*given);
  }
  void texts(std::string_view key, std::vector<std::string>& values, const TextSpec& spec);
  void number(std::string_view key, double& value, const NumberSpec& spec);
  void number(std::string_view key, std::optional<double>& value, const NumberSpec& spec);
  void numbers(std::string_view key, std::array<double, 3>& values, const NumberSpec& spec);
  void numbers(std::string_view key, std::vector<double>& values, const NumberSpec& spec);
  void whole(std::string_view key, int& value, const NumberSpec& spec);
  void whole(std::string_view key, std::uint64_t& value, const NumberSpec& spec);
  /// Accepts a number, the standard uncertainty, or an object with the distribution.
  void influence(std::string_view key, record::Influence& value, const NumberSpec& spec);
  /// Accepts a text and ignores it.
  void passed_over(std::string_view key, std::string_view meaning);

  template <class T>
  void object(std::string_view key, T& value, const GroupSpec& spec) {
    if (const JsonValue* json = object_at(key, spec)) read(*json, pointer_to(key), value);
  }

  template <class T>
  void object(std::string_view key, std::optional<T>& value, const GroupSpec& spec) {
    if (const JsonValue* json = object_at(key, spec)) read(*json, pointer_to(key), value.emplace());
  }

  template <class T>
  void list(std::string_view key, std::vector<T>& values, const GroupSpec& spec) {
    const JsonValue* json = list_at(key, spec);
    if (json == nullptr) return;
    for (std::size_t i = 0; i < json->items.size(); ++i) {
      T& value = values.emplace_back();
      const std::string pointer = item_pointer(pointer_to(key), i);
      if (expect_object(json->items[i], pointer)) read(json->items[i], pointer, value);
    }
  }

  /// Reports the keys of the object that are not in the table, and repeated ones.
  void finish();

 private:
  template <class T, class... Spec>
  void read(const JsonValue& json, const std::string& pointer, T& value, const Spec&... spec) {
    TableReader reader(json, pointer, findings_);
    describe(reader, value, spec...);
    reader.finish();
  }

  [[nodiscard]] std::string pointer_to(std::string_view key) const {
    return member_pointer(pointer_, key);
  }
  const JsonValue* value_at(std::string_view key, bool required, std::string_view meaning);
  const JsonValue* object_at(std::string_view key, const GroupSpec& spec);
  const JsonValue* list_at(std::string_view key, const GroupSpec& spec);
  const JsonValue* array_at(std::string_view key, const NumberSpec& spec);
  bool expect_object(const JsonValue& json, const std::string& pointer);
  bool read_text(const JsonValue& json, const std::string& pointer, const TextSpec& spec,
                 std::string& value);
  bool read_number(const JsonValue& json, const std::string& pointer, std::string_view key,
                   const NumberSpec& spec, double& value);
  bool read_whole(std::string_view key, const NumberSpec& spec, double& value);
  void report_unknown(const JsonMember& member);
  void problem(const JsonValue& json, core::Code code, std::string where, std::string what);

  const JsonValue& object_;
  std::string pointer_;
  Findings& findings_;
  std::vector<std::string_view> keys_;
};

}  // namespace rondure::plans
