#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/pose.h"
#include "core/result.h"
#include "record/run_record.h"

namespace rondure::plans {

/// What an interrupted run left in its journal. The resumed run goes through the same steps as the
/// first time and asks here before each of them: what is known is taken, not done again. A run that
/// begins has an empty past.
///
/// A step that is not the recorded one ends the run (kJournal): then this program, on this
/// processor, does not follow the way of the one that measured, and its touches would not fit.
class RecordedRun {
 public:
  RecordedRun() = default;
  explicit RecordedRun(record::RunRecord run);

  /// Whether the machine has still to stand while the program goes through known touches.
  /// @param next_touch  Number of the touch that comes next.
  [[nodiscard]] bool replaying(std::int64_t next_touch) const;
  /// The recorded touch of that number, or nullptr.
  [[nodiscard]] const record::Touch* touch(std::int64_t id) const;
  /// The recorded pose of that number, or nullptr.
  [[nodiscard]] const record::PoseVisit* pose(int id) const;
  /// The decision that comes next, or nullptr. Decisions about the whole run are passed over:
  /// those are of earlier interruptions.
  [[nodiscard]] const record::Decision* next_decision();
  /// Hidden truths of a feature in the journal: one for each of its final clouds.
  [[nodiscard]] std::ptrdiff_t truths_of(int feature) const;
  /// Whether the part was located again behind that many touches.
  [[nodiscard]] bool relocated_behind(std::int64_t touches) const;
  /// Whether a feature went on behind the present step without a touch: it decided or turned.
  [[nodiscard]] bool goes_on_untouched(int next_pose) const;
  /// Whether a decision about the whole run is in the journal.
  [[nodiscard]] bool has_decision(const std::string& text) const;
  /// Whether the series of a feature are in the journal: all of them, or none is.
  [[nodiscard]] bool knows_series(int feature) const;
  /// The number of the next check: -1, -2, ...
  [[nodiscard]] std::int64_t next_check() const;

 private:
  record::RunRecord run_;
  std::int64_t machine_touches_end_ = 0;  ///< Behind the last touch that the machine made.
  std::size_t next_decision_ = 0;
};

/// The decision that a part is located again, without the reason.
[[nodiscard]] std::string relocation_text(std::int64_t touches);

/// Whether two touches are the same step: number, purpose, place, direction within 1e-9.
[[nodiscard]] core::Result<void> check_same_step(const record::Touch& known,
                                                 const record::Touch& planned);
/// The same for poses as commanded, within 1e-9 rad.
[[nodiscard]] core::Result<void> check_same_step(const record::PoseVisit& known, int feature,
                                                 const core::Pose& commanded);
[[nodiscard]] core::Result<void> check_same_step(const record::Decision& known,
                                                 const record::Decision& planned);

}  // namespace rondure::plans
