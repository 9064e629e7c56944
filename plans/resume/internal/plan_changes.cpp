#include "plans/resume/internal/plan_changes.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include <fmt/format.h>

#include "core/version.h"
#include "plans/schema/json_text.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::plans {
namespace {

constexpr std::size_t kShownDigits = 12;  ///< Digits of a digest.

/// A value in one line.
/// @param value  Null: absent.
std::string shown(const JsonValue* value) {
  if (value == nullptr) return "absent";
  switch (value->kind) {
    case JsonValue::Kind::kNull:
      return "null";
    case JsonValue::Kind::kBoolean:
      return value->boolean ? "true" : "false";
    case JsonValue::Kind::kNumber:
      return plain(value->number);
    case JsonValue::Kind::kText:
      return in_quotes(value->text);
    case JsonValue::Kind::kArray:
      return fmt::format("an array of {}", value->items.size());
    case JsonValue::Kind::kObject:
      return fmt::format("an object of {} keys", value->members.size());
  }
  return {};
}

const JsonValue* item_of(const JsonValue& array, std::size_t i) {
  return i < array.items.size() ? &array.items[i] : nullptr;
}

/// Adds the differences between two values, of which one may be absent.
void add_differences(const JsonValue* before, const JsonValue* now, const std::string& pointer,
                     std::vector<core::Error>& out) {
  const bool same = before != nullptr && now != nullptr && before->kind == now->kind &&
                    before->number == now->number && before->text == now->text &&
                    before->boolean == now->boolean;
  if (!same) {
    out.push_back(
        {core::Code::kMeaning,
         fmt::format("the run began with {}, the plan now says {}", shown(before), shown(now)),
         pointer});
    return;
  }
  for (const JsonMember& member : before->members) {
    add_differences(&member.value, now->find(member.key), member_pointer(pointer, member.key), out);
  }
  for (const JsonMember& member : now->members) {
    if (before->find(member.key) != nullptr) continue;
    add_differences(nullptr, &member.value, member_pointer(pointer, member.key), out);
  }
  for (std::size_t i = 0; i < std::max(before->items.size(), now->items.size()); ++i) {
    add_differences(item_of(*before, i), item_of(*now, i), item_pointer(pointer, i), out);
  }
}

}  // namespace

std::vector<core::Error> plan_changes(std::string_view old_text, std::string_view new_text) {
  if (old_text == new_text) return {};
  const auto before = parse_json(old_text, "the plan in the journal");
  const auto now = parse_json(new_text, "the plan");
  if (!before) return {before.error()};
  if (!now) return {now.error()};
  std::vector<core::Error> out;
  add_differences(&*before, &*now, "", out);
  return out;
}

std::vector<core::Error> changes_since(const record::RunRecord& run, const Plan& plan,
                                       const RunOptions& options) {
  const record::Header& header = run.header;
  auto out = plan_changes(header.plan_text, plan.text);
  const auto differs = [&](std::string_view what, const std::string& before,
                           const std::string& now) {
    if (before == now) return;
    out.push_back({core::Code::kMeaning,
                   fmt::format("the run began with the {} {}, now it would be {}", what,
                               in_quotes(before), in_quotes(now)),
                   {}});
  };
  differs("program version", header.version, std::string(core::kVersion));
  if (header.simulated) {
    differs("seed", std::to_string(header.seed),
            std::to_string(options.seed.value_or(header.seed)));
  }
  const auto people =
      record::task_of<record::HeadSettings>(run.settings, "head/").value_or(record::HeadSettings());
  for (const auto& [what, before, given] :
       {std::tuple("serial number", header.serial, &options.serial),
        std::tuple("operator", header.operator_name, &options.operator_name),
        std::tuple("order", people.order.value_or(""), &options.order),
        std::tuple("customer", people.customer.value_or(""), &options.customer)}) {
    if (!given->empty()) differs(what, before, *given);
  }
  return out;
}

core::Error points_changed(std::size_t feature_index, const record::Feature& feature,
                           const std::string& sha256) {
  return {core::Code::kMeaning,
          fmt::format("the points of {} changed since the run began: SHA-256 {}..., now {}...",
                      feature.points_file, feature.points_sha256.substr(0, kShownDigits),
                      sha256.substr(0, kShownDigits)),
          item_pointer("/features", feature_index) +
              (feature.shape == record::Shape::kContour ? "/contour/parts" : "/source/file")};
}

}  // namespace rondure::plans
