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

/// Where a run stands, for whoever watches.
struct Progress {
  std::string feature;
  int pose_number = 0;               ///< From 1, within the feature.
  core::Pose pose;                   ///< As the fixture reads it.
  std::size_t touches = 0;           ///< Done, in the whole run.
  std::size_t touches_expected = 0;  ///< Estimate for the whole run.
  double time_s = 0.0;               ///< Machine clock at the last touch.
  std::optional<double> f_mm;        ///< Least zone of the last complete cloud in its pose.
};

/// A motion that comes next, for whoever follows a run step by step.
struct NextMove {
  enum class Kind { kHome, kMove, kTouch, kTurn };
  Kind kind = Kind::kMove;
  std::string what;  ///< In words, e.g. "layer 1, point 2: move".
  /// Tip centre before and after, machine frame; the expected contact of a touch. Only of kMove and
  /// kTouch.
  Eigen::Vector3d from_W_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_W_mm = Eigen::Vector3d::Zero();
};

/// Everything about a run that does not stand in the plan.
struct RunOptions {
  std::filesystem::path directory;  ///< Is made; must be absent or empty. Of a run to resume: its.
  std::string run_id;
  std::string plan_file;  ///< Name for the record.
  std::string serial;
  std::string operator_name;
  std::string started_utc;  ///< Of this start, also of a resumed run. For the record only.
  std::string processor;
  std::optional<std::uint64_t> seed;     ///< Takes the place of the plan's.
  std::filesystem::path wire_log;        ///< Of what goes to a machine and comes; "": none.
  std::function<bool()> stop_requested;  ///< Asked before every touch, and while a machine moves.
  std::function<void(const Progress&)> progress;
  std::shared_ptr<record::GrowingRecord> followed_by;  ///< Gets what the journal holds; or none.
  /// Asked before each motion; an error (kStopped) ends the run: the tip goes back on the way it
  /// came, without asking, and up. Not asked for motions that a fault makes necessary.
  std::function<core::Result<void>(const NextMove&)> before_move;
  /// Asks a person to set a pose of a fixture "manual" in front of a real machine.
  std::function<core::Result<void>(const core::Pose&)> set_by_hand;
  bool relocate = false;     ///< Of a run to resume: a part that has moved is located again.
  bool single_step = false;  ///< A first run: travels at the plan's step_speed_mm_s at most.
};

}  // namespace rondure::plans
