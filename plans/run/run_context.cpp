#include "plans/run/internal/inspection.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/run/internal/reached_pose.h"

namespace rondure::plans {
namespace {

/// Number of touches that are repeated before an interrupted run is resumed, if the cloud has so
/// many: one touch shows a shift along its own direction only.
constexpr std::size_t kChecks = 3;

constexpr double kStill_mm = 1e-6;  // a shorter move is not made

/// Checks that a replayed pose of the journal has the same reading as before: part and targets
/// follow the recorded reading.
core::Result<void> check_reading(const record::PoseVisit& known, const core::Pose& reads,
                                 double resolution_rad) {
  constexpr double kRoundOff_rad = 1e-9;
  const double apart_rad = std::max(std::abs(reads.alpha_rad - known.reached.alpha_rad),
                                    std::abs(reads.beta_rad - known.reached.beta_rad));
  if (apart_rad <= resolution_rad + kRoundOff_rad) return {};
  const auto degrees = [](const core::Pose& pose) {
    return fmt::format("({:.7g}, {:.7g}) deg", pose.alpha_rad / core::kDegree,
                       pose.beta_rad / core::kDegree);
  };
  return core::fail(
      core::Code::kMachine,
      fmt::format("in pose {} the fixture reads {}, before the interruption it read {}: {:.3g} deg "
                  "apart, its resolution allows {:g} deg (resolution_deg); it has lost its "
                  "position, see to its homing, couplings and load, then resume",
                  known.id, degrees(reads), degrees(known.reached), apart_rad / core::kDegree,
                  resolution_rad / core::kDegree),
      "/fixture/resolution_deg");
}

}  // namespace

void take_reading(const cmm::TouchReading& reading, record::Touch& row) {
  row.tip_mm = reading.tip_W_mm;
  row.temperature_degC = reading.temperature_degC;
  row.scale_temperature_degC = reading.scale_temperature_degC;
  row.time_s = reading.time_s;
}

cmm::TouchReading reading_of(const record::Touch& row) {
  return {row.tip_mm, row.temperature_degC, row.time_s, 0.0, row.scale_temperature_degC};
}

core::Result<void> RunContext::check_stop() const {
  if (replaying()) {
    return core::fail_with(core::Code::kJournal,
                           "the journal has no touch {}, after which the clamping was changed",
                           next_touch);
  }
  if (!options.stop_requested || !options.stop_requested()) return {};
  return core::fail_with(core::Code::kStopped,
                         "stopped by the operator after {} touches; all of them are kept",
                         next_touch);
}

void RunContext::show() const {
  if (options.progress && !replaying()) options.progress(progress);
}

core::Result<record::Touch> RunContext::touch(TouchStep step) {
  step.command.id = next_touch;
  step.row.id = next_touch;
  step.row.approach = step.command.direction_W;
  if (const record::Touch* known = recorded.touch(next_touch))
    return replay(std::move(step), *known);
  TRY_DO(check_stop());
  const NextMove next = {NextMove::Kind::kTouch, doing + ": touch", cell->machine().position_W_mm(),
                         step.command.expected_tip_W_mm};
  TRY_DO(ask(next));
  TRY(const auto reading, cell->machine().touch(step.command));
  record::Touch row = step.row;
  take_reading(reading, row);
  TRY_DO(journal.add(row));
  note_truth({&row, 1});
  ++next_touch;
  progress.touches = static_cast<std::size_t>(next_touch);
  progress.time_s = row.time_s;
  show();
  return row;
}

void RunContext::note_truth(std::span<const record::Touch> rows) {
  const std::vector<Eigen::Vector3d> tips = cell->true_tips_W_mm();
  if (tips.size() != rows.size()) return;
  Eigen::Isometry3d X_WW = Eigen::Isometry3d::Identity();
  // Of balls the errors of the fixture are what is measured.
  const bool carried =
      rows.front().pose >= 0 &&
      !measures_by_touch(plan.features[static_cast<std::size_t>(last_visit.feature)]);
  if (const auto X_WB = cell->true_body_to_machine(); X_WB && carried) {
    fixture::Kinematics nominal = cell->kinematics();
    nominal.alpha_motion = nominal.beta_motion = nullptr;
    X_WW = fixture::body_to_machine(nominal, last_visit.reached) * X_WB->inverse();
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d tip = X_WW * tips[i];
    true_tips.insert(true_tips.end(), {static_cast<double>(rows[i].id), tip.x(), tip.y(), tip.z()});
  }
}

core::Result<void> RunContext::keep_truth(int feature) {
  record::Series out{feature,
                     record::kTrueTips,
                     record::Series::Role::kTruth,
                     {{"touch", ""}, {"x_mm", "mm"}, {"y_mm", "mm"}, {"z_mm", "mm"}},
                     std::move(true_tips)};
  true_tips.clear();
  if (out.values.empty() || recorded.knows_truth(feature)) return {};
  return journal.add({&out, 1}, {});
}

core::Result<record::Touch> RunContext::replay(TouchStep step, const record::Touch& known) {
  TRY_DO(check_same_step(known, step.row));
  TRY_DO(cell->replay_touch(step.command, reading_of(known)));
  note_truth({&known, 1});
  ++next_touch;
  step.row = known;
  TRY_DO(keep_replayed(std::move(step)));
  return known;
}

core::Result<void> RunContext::keep_replayed(TouchStep step) {
  progress.touches = static_cast<std::size_t>(next_touch);
  if (last_steps.size() == kChecks) last_steps.erase(last_steps.begin());
  last_steps.push_back(std::move(step));
  if (recorded.relocated_after(next_touch)) {
    if (!replaying()) {
      TRY_DO(cell->home_again());
    }
    relocation_due = true;
    return core::fail(core::Code::kLocation, "the part was located again");
  }
  return replaying() ? core::Result<void>{} : come_back();
}

core::Result<void> RunContext::replay_state(const TouchStep& step) {
  if (step.scan) return cell->replay_scan(*step.scan, step.scan_end);
  return cell->replay_touch(step.command, reading_of(step.row));
}

core::Result<void> RunContext::come_back() {
  if (auto go = ask_for_homing(); !go) return go;
  lost_place = true;
  doing = "repeating the last touches";
  TRY(const auto reads, cell->home_again());
  // The repeated touches themselves check a pose that was measured.
  const bool has_encoders = !plan.fixture->reached_pose;
  if (const record::PoseVisit* known = recorded.pose(last_steps.back().row.pose);
      known != nullptr && has_encoders) {
    if (auto same = check_reading(*known, reads, resolution_rad()); !same) return same;
  }
  double largest_mm = 0.0;
  for (std::size_t i = 0; i < last_steps.size(); ++i) {
    const TouchStep& step = last_steps[i];
    if (auto moved = follow(i == 0 ? step.entry_W : step.way_W); !moved) return moved;
    if (auto moved = follow(step.aside_W); !moved) return moved;
    const Polyline back(step.aside_W.rbegin(), step.aside_W.rend());
    const auto difference_mm = repeat_touch(step, recorded.next_check() - static_cast<int>(i));
    if (!difference_mm) {
      if (difference_mm.error().code != core::Code::kCollision) {
        (void)follow(back);
        (void)follow({step.entry_W.rbegin(), step.entry_W.rend()});
      }
      return part_has_moved(difference_mm.error());
    }
    if (auto moved = follow(back); !moved) return moved;
    largest_mm = std::max(largest_mm, *difference_mm);
  }
  if (auto on = replay_state(last_steps.back()); !on) return on;
  return note_return(last_steps.size(), largest_mm);
}

core::Result<void> RunContext::come_back_to_change(double time_s) {
  if (auto go = ask_for_homing(); !go) return go;
  lost_place = true;
  TRY_DO(cell->home_again());
  cell->replay_stand(vector3(plan.machine->park_mm), time_s);
  return note_return(0, 0.0);
}

core::Result<void> RunContext::note_return(std::size_t repeated, double largest_mm) {
  const core::Message resumed = {
      core::MessageCode::kRunResumed,
      {options.started_utc, static_cast<double>(next_touch), static_cast<double>(repeated),
       largest_mm / core::kMicrometre, plan.machine->resume_limit_um}};
  lost_place = false;
  return journal.add(record::Decision{-1, cell->machine().time_s(), resumed});
}

tl::unexpected<core::Error> RunContext::part_has_moved(const core::Error& error) {
  const bool on_part = last_steps.back().row.pose >= 0;
  const bool moved = error.code == core::Code::kLocation || error.code == core::Code::kNoTouch;
  if (!options.relocate || !on_part || !moved) return core::fail(error);
  if (plan.part.location_uncertainty_mm <= 0.0) {
    return core::fail(error.code, error.what +
                                      "; it cannot be located again, the plan states no "
                                      "location_uncertainty_mm");
  }
  const record::PoseVisit* visit = recorded.pose(last_steps.back().row.pose);
  if (visit != nullptr &&
      measures_by_touch(plan.features[static_cast<std::size_t>(visit->feature)])) {
    return core::fail(error.code, error.what + "; balls cannot be located again");
  }
  if (recorded.goes_on_untouched(next_pose)) {
    return core::fail(error.code, error.what +
                                      "; it cannot be located again, since the run stood between "
                                      "two clouds");
  }
  const record::Decision decision{
      -1,
      cell->machine().time_s(),
      {core::MessageCode::kPartLocatedAgain, {static_cast<double>(next_touch), error.what}}};
  TRY_DO(journal.add(decision));
  relocation_due = true;
  lost_place = false;
  return core::fail(error);
}

core::Result<double> RunContext::repeat_touch(const TouchStep& step, std::int64_t check_id) {
  cmm::TouchCommand command = step.command;
  command.id = check_id;
  const auto reading = cell->machine().touch(command);
  const std::string moved =
      "; part or machine has moved while the run was interrupted, start a new run, or locate the "
      "part again (run --resume --relocate)";
  if (!reading) {
    const bool nothing = reading.error().code == core::Code::kNoTouch;
    return core::fail_with(reading.error().code, "touch {} could not be repeated: {}{}",
                           step.row.id, reading.error().what, nothing ? moved : std::string());
  }
  record::Touch check = step.row;
  check.id = check_id;
  check.purpose = record::Touch::Purpose::kCheck;
  take_reading(*reading, check);
  TRY_DO(journal.add(check));
  const double difference_mm = (check.tip_mm - step.row.tip_mm).norm();
  if (difference_mm <= plan.machine->resume_limit_um * core::kMicrometre) return difference_mm;
  return core::fail(
      core::Code::kLocation,
      fmt::format("touch {} was repeated and differs by {:.3f} um, the plan allows {:g} um "
                  "(resume_limit_um){}",
                  step.row.id, difference_mm / core::kMicrometre, plan.machine->resume_limit_um,
                  moved),
      "/machine/resume_limit_um");
}

double RunContext::resolution_rad() const { return cell->fixture().limits().resolution_rad; }

core::Result<void> RunContext::ask(const NextMove& move) {
  if (!options.before_move || retreating) return {};
  auto go = options.before_move(move);
  if (!go) retreating = true;
  return go;
}

core::Result<void> RunContext::ask_for_homing() {
  return ask(
      {NextMove::Kind::kHome, "home machine and fixture: up, then to the park position", {}, {}});
}

core::Result<void> RunContext::follow(const Polyline& path_W) {
  if (replaying()) return {};
  cmm::Machine& machine = cell->machine();
  Polyline passed = {machine.position_W_mm()};
  for (const Eigen::Vector3d& corner : path_W) {
    const NextMove next = {NextMove::Kind::kMove, doing + ": move", passed.back(), corner};
    const bool moves = (corner - passed.back()).norm() > kStill_mm;
    if (auto go = moves ? ask(next) : core::Result<void>{}; !go) {
      for (auto back = passed.rbegin() + 1; back != passed.rend(); ++back) {
        if (auto moved = machine.move_to(*back); !moved) return moved;
      }
      return go;
    }
    if (auto moved = machine.move_to(corner); !moved) return moved;
    passed.push_back(corner);
  }
  return {};
}

core::Result<void> RunContext::rise() {
  if (replaying()) return {};
  Eigen::Vector3d up = cell->machine().position_W_mm();
  up.z() = std::max(up.z(), plan.machine->park_mm[2]);
  return follow({up});
}

core::Result<record::PoseVisit> RunContext::turn(int feature, const core::Pose& commanded) {
  if (!replaying() && !is_fixed(plan)) {
    const std::string what = "turn the fixture to " + in_degrees(commanded);
    TRY_DO(ask({NextMove::Kind::kTurn, what, {}, {}}));
  }
  const auto steps =  // planned before a person turns the fixture
      reached_pose_steps(plan, cell->kinematics(), feature, commanded);
  if (!steps) return core::fail(steps.error());
  auto reached = replaying() ? cell->replay_turn(commanded) : cell->turn_to(commanded);
  if (reached && !steps->empty()) reached = measure_reached_pose(*this, *steps, commanded);
  if (!reached) return core::fail(reached.error());
  if (const record::PoseVisit* known = recorded.pose(next_pose)) {
    TRY_DO(check_same_step(*known, feature, commanded));
    if (!replaying() && steps->empty()) {
      TRY_DO(check_reading(*known, *reached, resolution_rad()));
    }
    ++next_pose;
    return last_visit = *known;
  }
  TRY_DO(check_station_reached(plan, static_cast<std::size_t>(feature), commanded, *reached,
                               resolution_rad()));
  const record::PoseVisit next{next_pose, feature, commanded,
                               *reached,  false,   cell->machine().time_s()};
  TRY_DO(journal.add(next));
  ++next_pose;
  return last_visit = next;
}

core::Result<void> RunContext::change_clamping(int feature, const std::string& clamped,
                                               const std::string& what) {
  doing = "to the park position, before the clamping is changed";
  TRY_DO(rise());
  TRY_DO(follow({vector3(plan.machine->park_mm)}));
  const bool by_hand = plan.fixture->reached_pose.has_value();
  if (!by_hand && replaying()) {
    TRY_DO(cell->replay_turn({}));
  } else if (!by_hand) {
    TRY_DO(ask({NextMove::Kind::kTurn, "turn the fixture to " + in_degrees({}), {}, {}}));
    TRY_DO(cell->turn_to({}));
  }
  record::Decision changed{
      feature,
      cell->machine().time_s(),
      {core::MessageCode::kClampingChanged, {static_cast<double>(next_touch), clamped, ""}}};
  if (const record::Decision* known = recorded.next_decision()) {
    TRY_DO(check_same_step(*known, changed));
    return replaying() ? core::Result<void>{} : come_back_to_change(known->time_s);
  }
  if (!cell->is_simulated()) {
    if (!options.ask_a_person) {
      return core::fail_with(core::Code::kStopped, "stopped, there is nobody to ask: {}", what);
    }
    TRY(changed.message.arguments.back(), options.ask_a_person(what));
  }
  return journal.add(changed);
}

core::Result<void> RunContext::note(int feature, const core::Message& message) {
  const record::Decision decision{feature, cell->machine().time_s(), message};
  if (const record::Decision* known = recorded.next_decision()) {
    return check_same_step(*known, decision);
  }
  return journal.add(decision);
}

}  // namespace rondure::plans
