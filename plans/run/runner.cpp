#include "plans/run/runner.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/cell/internal/open_cell.h"
#include "plans/checks/internal/bodies.h"
#include "plans/checks/internal/calibration_use.h"
#include "plans/checks/internal/plan_reach.h"
#include "plans/checks/laboratory.h"
#include "plans/checks/points_file.h"
#include "plans/resume/internal/recorded_run.h"
#include "plans/run/internal/fixture_base.h"
#include "plans/run/internal/fixture_calibration.h"
#include "plans/run/internal/inspection.h"
#include "plans/run/internal/part_place.h"
#include "plans/run/internal/qualification.h"
#include "plans/run/internal/run_head.h"
#include "plans/schema/json_text.h"
#include "record/sha256.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::plans {
namespace {

/// Usual number of touches of a strategy, for the time left.
std::size_t expected_touches(const FeaturePlan& feature, std::size_t targets) {
  if (!is_touched(feature)) return 0;
  const auto repeats = static_cast<std::size_t>(feature.pose_search.repeats);
  switch (strategy_of(feature)) {
    case record::Strategy::kGuided:
      return targets * (feature.type == record::Shape::kCylinder ? 2 + repeats : repeats);
    case record::Strategy::kMerged:
      return targets * repeats * feature.pose_search.poses.size();
    case record::Strategy::kVirtual:
    case record::Strategy::kStartPose:
      return targets * repeats;
    case record::Strategy::kAsPublished:
      return targets * (25 + repeats);
    default:
      return targets * (80 + repeats);
  }
}

/// Targets of every feature, checked in its start pose before anything moves.
core::Result<std::vector<std::vector<Target>>> plan_targets(const Plan& plan) {
  std::vector<std::vector<Target>> out(plan.features.size());
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (!is_touched(plan.features[i])) continue;
    TRY(out[i], reachable_targets(plan, i));
  }
  return out;
}

/// Data of a feature that need no machine, read once: the hashed data are the evaluated data.
struct FeatureData {
  std::string sha256;
  record::PointTable points;  ///< For a points file.
  AnalysisData series;        ///< For an analysis.
};

core::Result<FeatureData> read_points_file(const Plan& plan, std::size_t index) {
  const std::string& name = plan.features[index].source->file;
  TRY(const auto bytes, record::read_file(plan.folder / name, record::kMostPointsBytes));
  TRY(auto table, points_of(plan, index, bytes));
  return FeatureData{record::sha256_hex(bytes), std::move(table), {}};
}

core::Result<std::vector<FeatureData>> read_data(const Plan& plan, std::uint64_t seed) {
  std::vector<FeatureData> out(plan.features.size());
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (needs_machine(plan.features[i]) || follows_loading(plan.features[i])) continue;
    if (analysis_kind(plan.features[i].type) != nullptr) {
      TRY(auto data, analysis_data(plan, i, seed));
      out[i].sha256 = data.sha256;
      out[i].series = std::move(data);
    } else {
      TRY(out[i], read_points_file(plan, i));
    }
  }
  return out;
}

/// Writes the rows of a points file into the journal, as one cloud without a pose search.
core::Result<void> take_points(RunContext& context, int index, const record::PointTable& table) {
  const int pose = context.next_pose++;
  if (context.recorded.pose(pose) == nullptr) {
    if (auto kept = context.journal.add(record::PoseVisit{pose, index, {}, {}, true, 0.0}); !kept)
      return kept;
  }
  const bool known = context.recorded.touch(context.next_touch) != nullptr;
  std::vector<record::Touch> rows;
  rows.reserve(table.points_mm.size());
  std::vector<int> taken(static_cast<std::size_t>(std::max(table.layer_count(), 1)), 0);
  for (std::size_t i = 0; i < table.points_mm.size(); ++i) {
    record::Touch row;
    row.id = context.next_touch++;
    row.pose = pose;
    row.layer = table.layers.empty() ? 0 : table.layers[i];
    row.point = taken[static_cast<std::size_t>(row.layer)]++;
    row.tip_mm = table.points_mm[i];
    rows.push_back(row);
  }
  if (known) return {};  // one transaction: all are there or none
  return context.journal.add(rows);
}

/// The sentence that has a correction loaded before feature `index` is measured.
std::string loading_in_words(const Plan& plan, std::size_t index) {
  const FeaturePlan& feature = plan.features[index];
  std::string files;
  for (const SeriesFile& file : analysis_kind(feature.type)->files(feature)) {
    files += (files.empty() ? "" : ", ") + file.file;
  }
  return fmt::format(
      "load the correction that feature {} gave into the control, measure feature {} and save {} "
      "beside the plan; a run that is stopped here writes the correction, and --resume asks again",
      in_quotes(feature.five_axis ? feature.five_axis->repeat->with.feature
                                  : feature.contour->repeat->with.feature),
      in_quotes(feature.id), files);
}

/// Asks for the correction to be loaded, reads the files that were measured with it, and journals
/// the answer with their digest.
core::Result<AnalysisData> data_after_loading(RunContext& context, std::size_t index) {
  const FeaturePlan& feature = context.plan.features[index];
  record::Decision answer{
      static_cast<int>(index), 0.0, {core::MessageCode::kCorrectionLoaded, {"", ""}}};
  const record::Decision* known = context.recorded.next_decision();
  if (known != nullptr) {
    TRY_DO(check_same_step(*known, answer));
  } else {
    const std::string what = loading_in_words(context.plan, index);
    if (!context.options.ask_a_person) {
      return core::fail_with(core::Code::kStopped, "stopped, there is nobody to ask: {}", what);
    }
    TRY(answer.message.arguments.front(), context.options.ask_a_person(what));
  }
  auto data = analysis_data(context.plan, index, 0);
  if (!data || data->series.empty()) {
    // Whoever measured it can save the file anew, and the run goes on.
    return core::fail(
        core::Code::kFile,
        fmt::format("feature {}: {}; put its files right and resume the run", in_quotes(feature.id),
                    data ? "a file is missing" : data.error().what),
        data ? feature_pointer(index) : data.error().where);
  }
  answer.message.arguments.back() = data->sha256;
  if (known == nullptr) {
    TRY_DO(context.journal.add(answer));
  }
  return data;
}

/// Writes the series of an analysis into the journal: all of them or none.
core::Result<void> take_series(RunContext& context, int index, const AnalysisData& data) {
  if (context.recorded.knows_series(index)) return {};
  return context.journal.add(data.series, data.truths);
}

/// Evaluates the balls and journals what the features after them take: the calibration itself, or
/// why they will be void. They are measured in the nominal fixture where there is none.
core::Result<void> take_calibration(RunContext& context, int index) {
  if (!context.options.calibrate) {
    return core::fail(core::Code::kInternal, "nobody evaluates the calibration of the fixture");
  }
  record::RunRecord so_far;
  context.options.followed_by->catch_up(so_far);
  FoundCalibration found = context.options.calibrate(so_far, index);
  const auto usable = usable_calibration(context.plan, found.text, so_far.header.started_utc);
  if (found.void_because.empty() && !usable) found.void_because = usable.error().what;
  TRY_DO(context.note(index,
                      {core::MessageCode::kCalibrationTaken, {found.text, found.void_because}}));
  if (usable) context.cell->use(*usable);
  return {};
}

/// Has balls or part clamped where the feature before this one was measured on the other.
core::Result<void> have_clamped(RunContext& context, std::size_t index) {
  const Plan& plan = context.plan;
  const auto end = plan.features.rend();
  const auto before = std::find_if(end - static_cast<std::ptrdiff_t>(index), end, needs_machine);
  const FeaturePlan& feature = plan.features[index];
  if (before == end || clamped_alike(*before, feature)) return {};
  const std::string balls =
      "the balls of " + in_quotes(feature.rotary_axes ? feature.id : before->id);
  const std::string part = "the part " + in_quotes(plan.part.id);
  const std::string& out = feature.rotary_axes ? part : balls;
  const std::string& in = feature.rotary_axes ? balls : part;
  return context.change_clamping(
      static_cast<int>(index), feature.rotary_axes ? feature.id : plan.part.id,
      fmt::format("take {} out of the fixture, clamp {} as the plan says, and step back", out, in));
}

core::Result<void> inspect(RunContext& context, const std::vector<std::vector<Target>>& targets,
                           const std::vector<FeatureData>& data) {
  for (std::size_t i = 0; i < context.plan.features.size(); ++i) {
    const FeaturePlan& feature = context.plan.features[i];
    const auto index = static_cast<int>(i);
    if (follows_loading(feature)) {
      TRY(const auto read, data_after_loading(context, i));
      TRY_DO(take_series(context, index, read));
      continue;
    }
    if (!needs_machine(feature)) {
      auto taken = analysis_kind(feature.type) != nullptr
                       ? take_series(context, index, data[i].series)
                       : take_points(context, index, data[i].points);
      if (!taken) return taken;
      continue;
    }
    TRY_DO(have_clamped(context, i));
    context.cell->mount(feature);
    if (measures_by_touch(feature)) {
      TRY_DO(calibrate_fixture(context, index));
      TRY_DO(context.keep_truth(index));
      if (i == calibrating_feature(context.plan)) {
        TRY_DO(take_calibration(context, index));
      }
      continue;
    }
    FeatureSession session(context, index, targets[i]);
    if (auto searched = search_pose(session, feature); !searched) {
      return core::fail(searched.error().at(fmt::format("/features/{}", i)));
    }
    TRY_DO(context.keep_truth(index));
  }
  return {};
}

/// References machine and fixture and qualifies the probe.
core::Result<void> prepare(RunContext& context) {
  // The part is in the ring from the start: every motion must keep clear of it.
  const auto first =
      std::find_if(context.plan.features.begin(), context.plan.features.end(), needs_machine);
  context.cell->mount(*first);
  if (context.replaying()) {
    TRY_DO(context.cell->replay_home());
  } else {
    if (auto go = context.ask_for_homing(); !go) return go;
    if (auto homed = context.cell->machine().home(); !homed) return homed;
    TRY_DO(context.cell->home_fixture());
  }
  const auto tip = qualify_probe(context);
  if (!tip) return core::fail(tip.error().at("/probe/qualification"));
  TRY_DO(find_fixture_base(context, tip->radius_mm));
  return find_part_place(context);
}

/// The plan with the speeds of this run: slower while each move is confirmed.
Plan driven(const Plan& plan, const RunOptions& options) {
  Plan out = plan;
  if (options.single_step && out.machine) {
    double& speed = out.machine->travel_speed_mm_s;
    speed = std::min(speed, out.machine->step_speed_mm_s);
  }
  return out;
}

/// Records that a run was made in single steps.
core::Result<void> note_single_steps(RunContext& context) {
  if (!context.options.single_step || context.recorded.touch(0) != nullptr) return {};
  return context.journal.add(record::Decision{
      -1, 0.0, {core::MessageCode::kSingleSteps, {context.plan.machine->step_speed_mm_s}}});
}

/// The options of a run that reads its own rows where a feature takes what an earlier one found.
RunOptions following(const Plan& plan, RunOptions options) {
  const bool joined = calibrating_feature(plan) < plan.features.size();
  if (joined && !options.followed_by) {
    options.followed_by = std::make_shared<record::GrowingRecord>();
  }
  return options;
}

/// Gives observers the rows on record, and from then on each new row.
void follow(const RunOptions& options, record::RunRecord on_record, record::Journal& journal) {
  if (!options.followed_by) return;
  options.followed_by->begin(std::move(on_record));
  journal.follow(options.followed_by);
}

/// Data known before the first touch.
struct Preparation {
  std::vector<std::vector<Target>> targets;
  std::vector<FeatureData> data;
  std::uint64_t seed = 0;
  std::optional<UsedCalibration> calibration;
};

/// @param run_utc  Start of the run.
core::Result<Preparation> prepare_plan(const Plan& plan, const RunOptions& options,
                                       std::string_view run_utc) {
  TRY(auto targets, plan_targets(plan));
  const std::uint64_t seed = options.seed.value_or(plan.simulation ? plan.simulation->seed : 0);
  TRY(auto data, read_data(plan, seed));
  TRY(auto calibration, used_calibration(plan, run_utc));
  return Preparation{std::move(targets), std::move(data), seed, std::move(calibration)};
}

/// The cell of a plan; null when every feature comes from a file.
core::Result<std::unique_ptr<Cell>> cell_of(const Plan& plan, const RunOptions& options,
                                            std::uint64_t seed, bool resumed) {
  if (!touches_anything(plan)) return nullptr;
  auto cell = open_cell(driven(plan, options), {seed, resumed, options.wire_log,
                                                options.stop_requested, options.set_by_hand});
  if (!cell) return cell;
  // The driver may be coarser than the plan states.
  const double resolution_rad = (*cell)->fixture().limits().resolution_rad;
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    TRY_DO(check_zero_is_held(plan, i, resolution_rad));
  }
  return cell;
}

/// Executes the plan and writes how the run ended.
void execute(const Plan& plan, const RunOptions& options, const Preparation& known, Cell* cell,
             record::RunRecord recorded, Run& run) {
  RunContext context{plan, options, cell, run.journal};
  context.recorded = RecordedRun(std::move(recorded));
  if (cell != nullptr && known.calibration) cell->use(known.calibration->calibration);
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    context.progress.touches_expected +=
        measures_by_touch(plan.features[i])
            ? calibration_touches(plan, i)
            : expected_touches(plan.features[i], known.targets[i].size());
  }
  const bool touching = cell != nullptr;
  if (touching)
    context.progress.touches_expected +=
        static_cast<std::size_t>(plan.probe->qualification.touches());
  if (touching && plan.fixture->datum)
    context.progress.touches_expected += plan.fixture->datum->touches();
  auto done = touching ? note_single_steps(context) : core::Result<void>{};
  if (done && touching) done = prepare(context);
  if (done) done = inspect(context, known.targets, known.data);
  if (!done) run.failure = done.error();
  const std::string ending = done                                        ? "finished"
                             : run.failure->code == core::Code::kStopped ? "stopped"
                                                                         : "failed";
  if (auto ended = run.journal.end(ending, run.failure ? &*run.failure : nullptr);
      !ended && !run.failure) {
    run.failure = ended.error();
  }
}

/// All differences from the run on record: plan, options, and the files of the plan.
std::vector<core::Error> all_changes(const record::RunRecord& run, const Plan& plan,
                                     const RunOptions& options, const Preparation& known) {
  auto changes = changes_since(run, plan, options);
  // A damaged journal may hold fewer features than its plan; its later readers report that.
  for (std::size_t i = 0; i < std::min(plan.features.size(), run.features.size()); ++i) {
    if (const auto same = check_same_poses(plan.features[i], run.features[i].settings); !same) {
      changes.push_back(core::Error(same.error()).at(feature_pointer(i) + "/five_axis/poses"));
    }
    std::string now = known.data[i].sha256;
    if (follows_loading(plan.features[i])) {
      if (run.features[i].points_sha256.empty()) continue;  // they may still be measured
      const auto read = analysis_data(plan, i, 0);
      if (read) now = read->sha256;
    }
    if (changes.empty() && now != run.features[i].points_sha256) {
      changes.push_back(points_changed(i, run.features[i], now));
    }
  }
  const auto fixture = record::task_of<record::FixtureSettings>(run.settings, "fixture/");
  if (changes.empty() && known.calibration &&
      (!fixture || fixture->calibration != known.calibration->text)) {
    changes.push_back({core::Code::kMeaning,
                       "the calibration of the fixture is not the one the run began with; put its "
                       "file back, or start a new run",
                       "/fixture/calibration/file"});
  }
  if (changes.empty()) {
    changes = bodies_changed(plan, fixture ? fixture->bodies.value_or("") : std::string());
  }
  return changes;
}

}  // namespace

bool is_resumable(const core::Error& failure) {
  switch (failure.code) {
    case core::Code::kStopped:
    case core::Code::kMachine:
    case core::Code::kNoTouch:
    case core::Code::kCollision:
    case core::Code::kJournal:
    case core::Code::kFile:
      return true;
    default:
      return false;
  }
}

core::Result<Run> run_plan(const Plan& plan, const RunOptions& given) {
  const RunOptions options = following(plan, given);
  TRY(const auto known, prepare_plan(plan, options, options.started_utc));
  TRY(auto cell, cell_of(plan, options, known.seed, false));
  record::RunRecord head = run_head(plan, options, known.seed);
  if (cell) {
    head.header.simulated = cell->is_simulated() || simulates_analysis(plan);
    if (!head.header.simulated) head.header.seed = 0;
    head.header.machine = cell->machine().description();
    head.header.fixture = cell->fixture().description();
  }
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    head.features[i].points_sha256 = known.data[i].sha256;
    const record::PointTable& points = known.data[i].points;
    if (!points.read.empty()) {
      const record::SourceSettings how{{}, {}, {}, points.read, points.repeated};
      for (auto& setting : record::settings_of_task(how, "source/")) {
        head.features[i].settings.push_back(std::move(setting));
      }
    }
    if (!points.layers.empty()) {
      head.features[i].layers = points.layer_count();
      head.features[i].points_per_layer = points.least_points_per_layer();
    }
  }
  const auto resolution_rad =
      cell ? std::optional(cell->fixture().limits().resolution_rad) : std::nullopt;
  for (record::Setting& setting : fixture_settings(plan, known.calibration, resolution_rad)) {
    head.settings.push_back(std::move(setting));
  }
  TRY(record::HeadSettings people, laboratory_of(plan));
  if (!options.order.empty()) people.order = options.order;
  if (!options.customer.empty()) people.customer = options.customer;
  for (record::Setting& setting : record::settings_of_task(std::move(people), "head/")) {
    head.settings.push_back(std::move(setting));
  }
  TRY(auto journal, record::Journal::create(options.directory, head.header, head.artefact,
                                            head.features, head.settings));
  Run run{std::move(journal), std::nullopt};
  follow(options, std::move(head), run.journal);
  execute(plan, options, known, cell.get(), {}, run);
  return run;
}

std::vector<core::Error> differences_from_run(const record::RunRecord& run, const Plan& plan,
                                              const RunOptions& options) {
  RunOptions same = options;
  if (!same.seed) same.seed = run.header.seed;
  const auto known = prepare_plan(plan, same, run.header.started_utc);
  if (!known) return {known.error()};
  return all_changes(run, plan, same, *known);
}

RunOrRefusals resume_plan(const Plan& plan, const RunOptions& given, record::HeldJournal held) {
  const RunOptions options = following(plan, given);
  const auto refuse = [](const core::Error& error) {
    return tl::unexpected(std::vector<core::Error>{error});
  };
  record::RunRecord recorded = held.read.record;  // the rest of `held` moves into the journal
  RunOptions same = options;
  if (!same.seed) same.seed = recorded.header.seed;
  const auto known = prepare_plan(plan, same, recorded.header.started_utc);
  if (!known) return refuse(known.error());
  auto changes = all_changes(recorded, plan, same, *known);
  if (!changes.empty()) return tl::unexpected(std::move(changes));
  const auto cell = cell_of(plan, options, known->seed, true);
  if (!cell) return refuse(cell.error());
  auto journal = record::Journal::reopen(options.directory, std::move(held));
  if (!journal) return refuse(journal.error());
  Run run{std::move(*journal), std::nullopt};
  record::RunRecord open = recorded;  // reopening removed its ending
  open.ending.clear();
  open.failure.reset();
  follow(options, std::move(open), run.journal);
  execute(plan, options, *known, cell->get(), std::move(recorded), run);
  return run;
}

}  // namespace rondure::plans
