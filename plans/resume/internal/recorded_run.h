#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/message.h"
#include "core/pose.h"
#include "core/result.h"
#include "plans/plan.h"
#include "plans/run_options.h"
#include "record/run_record.h"

namespace rondure::plans {

/// The differences between two plans as JSON: one kMeaning per value, `where` its pointer, `what`
/// the old and the new value. Order of keys, spaces and spellings of the same number are ignored.
/// @pre Both texts are valid plans.
[[nodiscard]] std::vector<core::Error> plan_changes(std::string_view old_text,
                                                    std::string_view new_text);

/// All reasons why a run, interrupted or finished, is not a run of this plan and these options:
/// changes of the plan, another version, seed, or name on the command line. Empty if it is one.
[[nodiscard]] std::vector<core::Error> changes_since(const record::RunRecord& run, const Plan& plan,
                                                     const RunOptions& options);

/// The error for a points file of a feature whose digest has changed.
[[nodiscard]] core::Error points_changed(std::size_t feature_index, const record::Feature& feature,
                                         const std::string& sha256);

/// The journal of an interrupted run. The resumed run replays the same steps and consults this
/// object before each of them: a recorded step is taken from the journal and not repeated. For a
/// new run it is empty.
///
/// A step that differs from the recorded one ends the run (kJournal): this program, on this
/// processor, does not repeat the run that was measured, and its touches would not fit.
class RecordedRun {
 public:
  RecordedRun() = default;
  explicit RecordedRun(record::RunRecord run);

  /// Whether the machine stands still because recorded touches, or a change of the clamping after
  /// them, are being replayed.
  /// @param next_touch  Number of the next touch.
  [[nodiscard]] bool replaying(std::int64_t next_touch) const;
  /// The recorded touch of that number, or nullptr.
  [[nodiscard]] const record::Touch* touch(std::int64_t id) const;
  /// The recorded pose of that number, or nullptr.
  [[nodiscard]] const record::PoseVisit* pose(int id) const;
  /// The next decision, or nullptr. Skips decisions about the whole run, which are about earlier
  /// interruptions.
  [[nodiscard]] const record::Decision* next_decision();
  /// Whether the hidden truth of a touched feature is in the journal.
  [[nodiscard]] bool knows_truth(int feature) const;
  /// Whether the part was located again after that many touches.
  [[nodiscard]] bool relocated_after(std::int64_t touches) const;
  /// Whether a feature continued after the current step without a touch, by a decision or a turn.
  [[nodiscard]] bool goes_on_untouched(int next_pose) const;
  /// Whether a decision about the whole run is in the journal.
  [[nodiscard]] bool has_decision(const core::Message& message) const;
  /// The first decision about the whole run with this code, or nullptr.
  [[nodiscard]] const core::Message* decided(core::MessageCode code) const;
  /// Whether the series of a feature are in the journal; either all of them are, or none.
  [[nodiscard]] bool knows_series(int feature) const;
  /// The number of the next check: -1, -2, ...
  [[nodiscard]] std::int64_t next_check() const;

 private:
  record::RunRecord run_;
  std::int64_t machine_touches_end_ = 0;  ///< Id after the last touch that the machine made.
  std::size_t next_decision_ = 0;
};

/// Whether two touches are the same step: number, purpose, place, direction within 1e-9.
[[nodiscard]] core::Result<void> check_same_step(const record::Touch& known,
                                                 const record::Touch& planned);
/// The same for poses as commanded, within 1e-9 rad.
[[nodiscard]] core::Result<void> check_same_step(const record::PoseVisit& known, int feature,
                                                 const core::Pose& commanded);
/// The same for decisions: one feature, messages equal by core::say_the_same(). The wording of a
/// sentence does not matter.
[[nodiscard]] core::Result<void> check_same_step(const record::Decision& known,
                                                 const record::Decision& planned);

}  // namespace rondure::plans
