#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/pose.h"
#include "core/result.h"
#include "record/growing_record.h"

namespace rondure::plans {

/// State of a run, for display.
struct Progress {
  std::string feature;
  int pose_number = 0;               ///< Number within the feature, from 1.
  std::optional<core::Pose> pose;    ///< As the fixture reads it; none: there is no fixture.
  std::size_t touches = 0;           ///< Touches made so far in the whole run.
  std::size_t touches_expected = 0;  ///< Estimate for the whole run.
  double time_s = 0.0;               ///< Machine clock at the last touch.
  std::optional<double> f_mm;        ///< Least zone of the last complete cloud in its pose.
};

/// The next motion of a run in single steps.
struct NextMove {
  enum class Kind { kHome, kMove, kTouch, kTurn };
  Kind kind = Kind::kMove;
  std::string what;  ///< Description, e.g. "layer 1, point 2: move".
  /// Tip centre before and after, machine frame; for a touch, the expected contact. Only for kMove
  /// and kTouch.
  Eigen::Vector3d from_W_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_W_mm = Eigen::Vector3d::Zero();
};

/// What the feature that calibrates the fixture gives those after it.
struct FoundCalibration {
  std::string text;          ///< As fixture-calibration.json would hold it.
  std::string void_because;  ///< Why no feature may use it; empty: it holds.
};

/// Settings of a run that are not part of its plan.
struct RunOptions {
  std::filesystem::path directory;  ///< Absent or empty; to resume a run, its directory.
  std::string run_id;
  std::string plan_file;  ///< Name for the record.
  std::string serial;
  std::string operator_name;
  std::string order;        ///< Order that the run belongs to.
  std::string customer;     ///< For whom the part is inspected.
  std::string started_utc;  ///< Time of this start, also for a resumed run. For the record only.
  std::string processor;
  std::optional<std::uint64_t> seed;     ///< Replaces the seed of the plan.
  std::filesystem::path wire_log;        ///< Log of all lines from and to a machine; "": none.
  std::function<bool()> stop_requested;  ///< Polled before every touch and during motions.
  std::function<void(const Progress&)> progress;
  std::shared_ptr<record::GrowingRecord>
      followed_by;  ///< Receives the rows of the journal; may be null.
  /// Called before each motion; an error (kStopped) ends the run: the tip returns along its path
  /// and rises, without further calls. Not called for motions that a fault makes necessary.
  std::function<core::Result<void>(const NextMove&)> before_move;
  /// Asks a person to set a pose of a fixture "manual" in front of a real machine.
  std::function<core::Result<void>(const core::Pose&)> set_by_hand;
  /// Evaluates a feature that calibrates the fixture, from what the run has recorded so far. Needed
  /// by a plan with `fixture.calibration.feature`.
  std::function<FoundCalibration(const record::RunRecord&, int feature)> calibrate;
  /// Asks a person for a step between two features, to clamp something else in a real cell or to
  /// load a correction into a control, and returns the time of the answer (UTC). An error
  /// (kStopped) ends the run, which can be resumed there.
  std::function<core::Result<std::string>(const std::string& what)> ask_a_person;
  bool relocate = false;     ///< When resuming: a part that has moved is located again.
  bool single_step = false;  ///< Limits travel to the plan's step_speed_mm_s.
};

}  // namespace rondure::plans
