#include "plans/resume/internal/recorded_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/version.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/schema/json_text.h"
#include "record/journal/message_text.h"
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

namespace {

constexpr double kSame = 1e-9;  ///< rad, or of a unit vector: above rounding, below any step.

tl::unexpected<core::Error> other_way(const std::string& what) {
  return core::fail_with(core::Code::kJournal,
                         "the run cannot go on: {}; this program or this computer does not repeat "
                         "the run that was interrupted, start a new one",
                         what);
}

/// A message as code, for an error text: levelling-step {"alpha_deg":1.41,...}.
std::string as_code(const core::Message& message) {
  return fmt::format("{} {}", core::message_name(message.code), record::arguments_json(message));
}

}  // namespace

RecordedRun::RecordedRun(record::RunRecord run) : run_(std::move(run)) {
  for (const record::Touch& touch : run_.touches) {
    const record::PoseVisit* visit = touch.pose < 0 ? nullptr : pose(touch.pose);
    const bool from_file =
        visit != nullptr && run_.features[static_cast<std::size_t>(visit->feature)].strategy ==
                                record::Strategy::kPointsFile;
    if (!from_file) machine_touches_end_ = touch.id + 1;
  }
}

bool RecordedRun::replaying(std::int64_t next_touch) const {
  if (run_.ending == "finished" || next_touch < machine_touches_end_) return true;
  // What was touched last has been taken out since: nothing may move toward it.
  return std::any_of(
      run_.decisions.begin() + static_cast<std::ptrdiff_t>(next_decision_), run_.decisions.end(),
      [](const auto& d) { return d.message.code == core::MessageCode::kClampingChanged; });
}

const record::Touch* RecordedRun::touch(std::int64_t id) const {
  const auto index = static_cast<std::size_t>(id);
  return index < run_.touches.size() ? &run_.touches[index] : nullptr;
}

const record::PoseVisit* RecordedRun::pose(int id) const {
  const auto index = static_cast<std::size_t>(id);
  return index < run_.poses.size() ? &run_.poses[index] : nullptr;
}

const record::Decision* RecordedRun::next_decision() {
  while (next_decision_ < run_.decisions.size()) {
    const record::Decision& decision = run_.decisions[next_decision_++];
    if (decision.feature >= 0) return &decision;
  }
  return nullptr;
}

bool RecordedRun::knows_truth(int feature) const {
  return run_.truth_series_of(feature, record::kTrueTips) != nullptr;
}

bool RecordedRun::relocated_after(std::int64_t touches) const {
  return has_decision(
      {core::MessageCode::kPartLocatedAgain, {static_cast<double>(touches), std::string()}});
}

bool RecordedRun::goes_on_untouched(int next_pose) const {
  const auto ahead = run_.decisions.begin() + static_cast<std::ptrdiff_t>(next_decision_);
  return pose(next_pose) != nullptr ||
         std::any_of(ahead, run_.decisions.end(), [](const auto& d) { return d.feature >= 0; });
}

bool RecordedRun::has_decision(const core::Message& message) const {
  return std::any_of(run_.decisions.begin(), run_.decisions.end(), [&](const auto& d) {
    return d.feature < 0 && core::say_the_same(d.message, message);
  });
}

const core::Message* RecordedRun::decided(core::MessageCode code) const {
  const auto found = std::find_if(
      run_.decisions.begin(), run_.decisions.end(),
      [&](const record::Decision& d) { return d.feature < 0 && d.message.code == code; });
  return found == run_.decisions.end() ? nullptr : &found->message;
}

bool RecordedRun::knows_series(int feature) const {
  return std::any_of(run_.series.begin(), run_.series.end(),
                     [&](const auto& series) { return series.feature == feature; });
}

std::int64_t RecordedRun::next_check() const {
  return run_.checks.empty() ? -1 : run_.checks.back().id - 1;
}

core::Result<void> check_same_step(const record::Touch& known, const record::Touch& planned) {
  const bool same = known.id == planned.id && known.purpose == planned.purpose &&
                    known.pose == planned.pose && known.layer == planned.layer &&
                    known.point == planned.point && known.repeat == planned.repeat &&
                    (known.approach - planned.approach).norm() <= kSame;
  if (same) return {};
  return other_way(fmt::format(
      "touch {} of its journal is a {} touch of pose {}, layer {}, point {}; now it would be a {} "
      "touch of pose {}, layer {}, point {}, {:.3g} rad off",
      known.id, record::name_of(known.purpose), known.pose, known.layer + 1, known.point + 1,
      record::name_of(planned.purpose), planned.pose, planned.layer + 1, planned.point + 1,
      (known.approach - planned.approach).norm()));
}

core::Result<void> check_same_step(const record::PoseVisit& known, int feature,
                                   const core::Pose& commanded) {
  const bool same = known.feature == feature &&
                    std::abs(known.commanded.alpha_rad - commanded.alpha_rad) <= kSame &&
                    std::abs(known.commanded.beta_rad - commanded.beta_rad) <= kSame;
  if (same) return {};
  return other_way(fmt::format("pose {} of its journal is {}; now it would be {}", known.id,
                               in_degrees(known.commanded, 6), in_degrees(commanded, 6)));
}

core::Result<void> check_same_step(const record::Decision& known, const record::Decision& planned) {
  if (known.feature == planned.feature && core::say_the_same(known.message, planned.message))
    return {};
  return other_way(fmt::format("it decided {}; now it would be {}", as_code(known.message),
                               as_code(planned.message)));
}

}  // namespace rondure::plans
