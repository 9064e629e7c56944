#include "plans/resume/internal/recorded_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "plans/path/internal/nominal_geometry.h"
#include "record/journal/message_text.h"

namespace rondure::plans {
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
