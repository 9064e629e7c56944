#include "plans/resume/internal/plan_changes.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "core/version.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

constexpr std::size_t kShownDigits = 12;  ///< Of a digest.

/// A value as shown in one line.
std::string shown(const JsonValue& value) {
  switch (value.kind) {
    case JsonValue::Kind::kNull:
      return "null";
    case JsonValue::Kind::kBoolean:
      return value.boolean ? "true" : "false";
    case JsonValue::Kind::kNumber:
      return plain(value.number);
    case JsonValue::Kind::kText:
      return in_quotes(value.text);
    case JsonValue::Kind::kArray:
      return fmt::format("an array of {}", value.items.size());
    case JsonValue::Kind::kObject:
      return fmt::format("an object of {} keys", value.members.size());
  }
  return {};
}

class Comparison {
 public:
  void compare(const JsonValue& before, const JsonValue& now, const std::string& pointer) {
    if (before.kind != now.kind) return tell(pointer, shown(before), shown(now));
    switch (before.kind) {
      case JsonValue::Kind::kObject:
        return compare_members(before, now, pointer);
      case JsonValue::Kind::kArray:
        return compare_items(before, now, pointer);
      default:
        if (before.number != now.number || before.text != now.text ||
            before.boolean != now.boolean) {
          tell(pointer, shown(before), shown(now));
        }
    }
  }

  [[nodiscard]] std::vector<core::Error> take() { return std::move(changes_); }

 private:
  void compare_members(const JsonValue& before, const JsonValue& now, const std::string& pointer) {
    for (const JsonMember& member : before.members) {
      const std::string where = member_pointer(pointer, member.key);
      const JsonValue* other = now.find(member.key);
      if (other != nullptr) {
        compare(member.value, *other, where);
      } else {
        tell(where, shown(member.value), "absent");
      }
    }
    for (const JsonMember& member : now.members) {
      if (before.find(member.key) != nullptr) continue;
      tell(member_pointer(pointer, member.key), "absent", shown(member.value));
    }
  }

  void compare_items(const JsonValue& before, const JsonValue& now, const std::string& pointer) {
    const std::size_t shared = std::min(before.items.size(), now.items.size());
    for (std::size_t i = 0; i < std::max(before.items.size(), now.items.size()); ++i) {
      const std::string where = item_pointer(pointer, i);
      if (i < shared) {
        compare(before.items[i], now.items[i], where);
      } else if (i < before.items.size()) {
        tell(where, shown(before.items[i]), "absent");
      } else {
        tell(where, "absent", shown(now.items[i]));
      }
    }
  }

  void tell(const std::string& pointer, const std::string& before, const std::string& now) {
    changes_.push_back({core::Code::kMeaning,
                        fmt::format("the run began with {}, the plan now says {}", before, now),
                        pointer});
  }

  std::vector<core::Error> changes_;
};

}  // namespace

std::vector<core::Error> plan_changes(std::string_view old_text, std::string_view new_text) {
  if (old_text == new_text) return {};
  const auto before = parse_json(old_text, "the plan in the journal");
  const auto now = parse_json(new_text, "the plan");
  if (!before) return {before.error()};
  if (!now) return {now.error()};
  Comparison comparison;
  comparison.compare(*before, *now, "");
  return comparison.take();
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
  if (!options.serial.empty()) differs("serial number", header.serial, options.serial);
  if (!options.operator_name.empty()) {
    differs("operator", header.operator_name, options.operator_name);
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
