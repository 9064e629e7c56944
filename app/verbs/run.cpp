#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/run/archive_step.h"
#include "app/run/ending.h"
#include "app/run/kept_trials.h"
#include "app/run/resumption.h"
#include "app/run/step_prompt.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/numbers.h"
#include "core/result.h"
#include "evaluation/evaluate.h"
#include "evaluation/handed_calibration.h"
#include "plans/analyses/features.h"
#include "plans/checks/doubts.h"
#include "plans/forecast/forecast.h"
#include "plans/plan.h"
#include "plans/run/runner.h"
#include "plans/schema/json_text.h"
#include "record/journal/journal.h"
#include "reports/html/pdf.h"
#include "reports/words/language.h"
#include "web/view.h"

namespace rondure::app {
namespace {

/// The predicted times of a plan, stage by stage.
std::vector<web::PredictedStage> predicted_stages(const plans::Forecast& forecast) {
  std::vector<web::PredictedStage> out;
  for (const plans::ForecastStage& stage : forecast.stages) {
    out.push_back({stage.touches * stage.times, stage.time_s});
  }
  return out;
}

/// Opens the live page of a run (--watch), prints its address, and connects it to the run through
/// `options`. The stop button acts as Ctrl-C.
/// @return  Null when no page is requested; kFile when its port is not available.
core::Result<std::unique_ptr<web::LiveView>> open_live(const RunArguments& arguments,
                                                       const plans::Forecast& forecast,
                                                       plans::RunOptions& options) {
  if (arguments.watch.empty()) return std::unique_ptr<web::LiveView>();
  web::LiveOptions live;
  if (arguments.watch != "auto")
    live.port = static_cast<std::uint16_t>(core::parse_number(arguments.watch).value_or(0.0));
  live.control = arguments.control;
  live.stages = predicted_stages(forecast);
  live.stop = request_stop;
  live.language = reports::language_named(arguments.language).value_or(reports::Language::kEnglish);
  auto record = std::make_shared<record::GrowingRecord>();
  TRY(auto view, web::LiveView::start(std::move(live), record));
  options.followed_by = std::move(record);
  tell(fmt::format("rondure: live page at {} ({})\n", view->url(),
                   arguments.control ? "with a stop button; keep the address to yourself"
                                     : "read-only; --control adds a stop button"));
  return view;
}

/// kBadOption for --speed with a machine that is not simulated here, because it has its own speed.
core::Result<void> check_machine_speed(const RunArguments& arguments, const plans::Plan& plan) {
  if (!arguments.speed || !plan.machine ||
      plan.machine->driver == plans::MachinePlan::Driver::kSimulated)
    return {};
  return core::fail(core::Code::kBadOption,
                    fmt::format("--speed is for a machine that is simulated here, this one is "
                                "\"{}\" and has its own",
                                name_of(plan.machine->driver)),
                    "/machine/driver");
}

/// Slows a simulated run down for observers. The record is not affected.
class Pace {
 public:
  /// @param speed  Simulated seconds per second of real time; > 0.
  explicit Pace(double speed) : speed_(speed) {}

  /// Waits until the wall clock has reached the machine's clock, or a stop is requested. The first
  /// call is the start of both.
  void keep(double machine_time_s) {
    constexpr auto kLook = std::chrono::milliseconds(20);  // time after which a stop is noticed
    if (!first_s_) {
      first_s_ = machine_time_s;
      start_ = Clock::now();
    }
    const std::chrono::duration<double> due((machine_time_s - *first_s_) / speed_);
    while (!stop_requested()) {
      const std::chrono::duration<double> left = due - (Clock::now() - start_);
      if (left.count() <= 0.0) return;
      std::this_thread::sleep_for(std::min<std::chrono::duration<double>>(left, kLook));
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  double speed_;
  std::optional<double> first_s_;
  Clock::time_point start_;
};

namespace fs = std::filesystem;

/// "01_spool_simulated-20261121T023302Z"; a number follows while such a directory exists.
std::string run_name(const fs::path& plan, const std::string& utc, const fs::path& parent) {
  std::string compact;
  for (const char c : utc) {
    if (c != '-' && c != ':') compact += c;
  }
  const std::string name = plan.stem().string() + "-" + compact;
  std::string unique = name;
  // a directory that cannot be examined cannot be created either; that is reported
  std::error_code unknown;
  for (int i = 2; fs::exists(parent / unique, unknown); ++i) unique = fmt::format("{}-{}", name, i);
  return unique;
}

/// The name of a run: the folder itself, also for "runs/7/" and ".".
std::string last_folder(const fs::path& directory) {
  const fs::path whole = fs::absolute(directory).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

/// The place of the run on disk, and the options that the record needs.
plans::RunOptions options_of(const RunArguments& arguments) {
  plans::RunOptions options;
  options.started_utc = utc_now();
  const fs::path parent = "runs";
  options.directory = arguments.out.empty()
                          ? parent / run_name(arguments.plan, options.started_utc, parent)
                          : fs::path(arguments.out);
  options.run_id = last_folder(options.directory);
  options.plan_file = fs::path(arguments.plan).filename().string();
  options.serial = arguments.serial;
  options.operator_name = arguments.operator_name;
  options.order = arguments.order;
  options.customer = arguments.customer;
  options.processor = processor();
  options.seed = arguments.seed;
  options.wire_log = arguments.wire_log;
  options.stop_requested = stop_requested;
  options.relocate = arguments.relocate;
  options.set_by_hand = ask_to_set;
  options.calibrate = [](const record::RunRecord& so_far, int feature) {
    const auto found =
        evaluation::handed_calibration(evaluation::evaluate_calibration(so_far, feature));
    return plans::FoundCalibration{found.text,
                                   found.void_because ? found.void_because->english() : ""};
  };
  options.ask_a_person = ask_a_person;
  return options;
}

/// Measures, from the beginning or from the last touch.
/// @param held  The journal of the run to resume; none: a new run.
plans::RunOrRefusals measure(const plans::Plan& plan, plans::RunOptions options,
                             std::optional<record::HeldJournal> held,
                             const RunArguments& arguments) {
  ProgressLine line(arguments.quiet || arguments.step);
  StepPrompt prompt;
  if (arguments.step) {
    options.single_step = true;
    options.before_move = [&prompt](const plans::NextMove& move) { return prompt.ask(move); };
  }
  std::optional<Pace> pace;
  if (arguments.speed) pace.emplace(*arguments.speed);
  options.progress = [&line, &pace](const plans::Progress& progress) {
    line.show(progress);
    if (pace) pace->keep(progress.time_s);
  };
  if (held) return plans::resume_plan(plan, options, *std::move(held));
  auto run = plans::run_plan(plan, options);
  if (!run) return tl::unexpected(std::vector<core::Error>{run.error()});
  return std::move(*run);
}

void tell_how_to_go_on(const plans::Run& run, const RunToFinish& ending) {
  if (!run.failure || !plans::is_resumable(*run.failure)) return;
  if (run.failure->code == core::Code::kCollision && plans::is_fixed(ending.plan)) {
    return tell(
        "rondure: a resumed run would take the same path: correct the place of the part in the\n"
        "plan, or place the part anew, and start a new run\n");
  }
  tell(fmt::format("rondure: to resume it after its last touch: {}\n", resume_command(ending)));
}

/// Points out that a non-empty run directory may hold a run to resume; a finished one is none.
void tell_about_resume(const RunToFinish& ending) {
  std::error_code ignored;
  if (!fs::exists(ending.directory / record::kJournalName, ignored)) return;
  if (const auto there = record::read_journal(ending.directory); there && there->record.sealed)
    return tell("rondure: the run that lies there is finished; name another directory by --out\n");
  tell(fmt::format("rondure: to go on with the run that lies there: {}\n", resume_command(ending)));
}

/// Prints why nothing is measured: a fault, or all changes since the run began.
void tell_reasons(const std::vector<core::Error>& reasons, bool resume, const fs::path& directory) {
  if (!resume || reasons.front().code != core::Code::kMeaning) return print_error(reasons.front());
  tell(
      fmt::format("rondure: the run in {} cannot go on, it began with something else; undo this, "
                  "or start a new run:\n",
                  directory.string()));
  print_error(reasons);
}

/// A machine that does not answer or has a fault is not a mistake in the input.
int status_of(const std::vector<core::Error>& reasons) {
  return reasons.front().code == core::Code::kMachine ? kRunFailed : kBadInput;
}

/// Checks that there is a terminal to ask for a fixture set by hand with a real machine.
core::Result<void> check_hand(const plans::Plan& plan) {
  const bool by_hand =
      plan.fixture && plan.fixture->driver == plans::FixturePlan::Driver::kManual && plan.machine &&
      plan.machine->driver != plans::MachinePlan::Driver::kSimulated;
  if (!by_hand) return {};
  auto terminal = StepPrompt::check_terminal(
      "the fixture \"manual\" is set by a person, who is asked for each pose");
  if (!terminal) return core::fail(terminal.error().at("/fixture/driver"));
  return {};
}

/// Checks the printer first, so that an hour's measurement does not end without its report.
core::Result<void> check_printing(const RunArguments& arguments, const plans::Plan& plan) {
  const auto& formats = formats_of(arguments, plan);
  if (std::find(formats.begin(), formats.end(), "pdf") == formats.end()) return {};
  const auto browser = reports::find_browser();
  return browser ? core::Result<void>() : core::fail(browser.error());
}

/// Checks names of the command line as those of the plan, because every report contains them.
core::Result<void> check_names(const RunArguments& arguments) {
  const auto refuse_name = [](const char* option, const std::string& name, std::string_view fault) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("{} {} {}", option, plans::in_quotes(name), fault), option);
  };
  for (const auto& [option, name] : {std::pair("--serial", &arguments.serial),
                                     std::pair("--operator", &arguments.operator_name)}) {
    const std::size_t at = plans::first_unshowable(*name);
    if (at == name->size()) continue;
    return refuse_name(option, *name,
                       fmt::format("contains {}, which no report can show; remove it",
                                   plans::unshowable_in_words(*name, at)));
  }
  for (const auto& [option, name] :
       {std::pair("--order", &arguments.order), std::pair("--customer", &arguments.customer)}) {
    if (const auto fault = plans::fault_of_name(*name)) return refuse_name(option, *name, *fault);
  }
  return {};
}

std::vector<core::Error> named_places(const RunArguments& arguments,
                                      std::vector<core::Error> errors) {
  if (!arguments.place_name) return errors;
  for (core::Error& error : errors) error.where = arguments.place_name(error.where);
  return errors;
}

/// Measures, evaluates and writes the reports.
int measure_and_conclude(const RunToFinish& ending, const plans::RunOptions& options,
                         std::optional<record::HeldJournal> held) {
  const bool resume = held.has_value();
  auto run = measure(ending.plan, options, std::move(held), ending.arguments);
  if (!run) {
    if (ending.live != nullptr) ending.live->show_failure(core::to_line(run.error().front()));
    tell_reasons(run.error(), resume, options.directory);
    if (!ending.arguments.resume) tell_about_resume(ending);
    return status_of(run.error());
  }
  if (run->failure) print_error(*run->failure);
  const int status = conclude(ending, *run);
  tell_how_to_go_on(*run, ending);
  return status;
}

/// A finished run ends with its verdict only when it is the requested run: for another part or plan
/// its verdict says nothing.
int conclude_finished(const RunToFinish& ending, const plans::RunOptions& options,
                      record::HeldJournal held) {
  const auto differences = plans::differences_from_run(held.read.record, ending.plan, options);
  if (differences.empty()) return finish_sealed(ending, std::move(held));
  if (differences.front().code == core::Code::kMeaning) {
    tell(
        fmt::format("rondure: the run in {} is finished, and began with something else; undo this, "
                    "or name a new directory for another run:\n",
                    options.directory.string()));
  }
  return refuse(differences);
}

}  // namespace

int run(const RunArguments& arguments) {
  if (arguments.step) {
    if (auto terminal = StepPrompt::check_terminal("--step asks before each move"); !terminal)
      return refuse(terminal.error());
  }
  if (auto sound = check_names(arguments); !sound) return refuse(sound.error());
  auto resumption = arguments.resume ? find_resumption(arguments) : Resumption{};
  if (!resumption) return refuse(resumption.error());
  const auto plan = plan_of(arguments, *resumption);
  if (!plan) return refuse(named_places(arguments, plan.error()));
  for (const auto& allowed : {check_hand(*plan), check_machine_speed(arguments, *plan)}) {
    if (!allowed) return refuse(allowed.error());
  }
  plans::RunOptions options = options_of(arguments);
  if (!resumption->directory.empty()) {
    options.directory = resumption->directory;
    options.run_id = last_folder(options.directory);
  }
  const auto archive = archive_of(arguments.archive, *plan, options.directory);
  if (!archive) return refuse(archive.error());
  RunToFinish ending{arguments, *plan, *archive, options.directory};
  listen_for_stop();
  std::optional<record::HeldJournal>& held = resumption->held;
  if (held && held->read.record.sealed) {
    return conclude_finished(ending, options, *std::move(held));
  }
  if (auto printing = check_printing(arguments, *plan); !printing) return refuse(printing.error());
  if (arguments.resume && !held && !arguments.quiet) {
    tell(fmt::format("rondure: {} holds no run yet; it begins\n", options.directory.string()));
  }
  // As `plan` checks it: all poses, their spheres among them, before anything moves.
  const auto forecast = plans::forecast(*plan);
  if (!forecast) return refuse(forecast.error());
  tell_doubts(named_places(arguments, plans::doubts_of(*plan)));
  const auto live = open_live(arguments, *forecast, options);
  if (!live) return refuse(live.error());
  ending.live = live->get();
  return measure_and_conclude(ending, options, std::move(held));
}

}  // namespace rondure::app
