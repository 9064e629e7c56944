#include "app/run/resumption.h"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/text/answer.h"
#include "plans/analyses/analysis.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

/// Whether a run directory is named in place of a plan.
bool names_directory(const RunArguments& arguments) {
  std::error_code ignored;
  return fs::is_directory(arguments.plan, ignored);
}

/// Whether the archive of a plan is a file that is found from the plan's folder.
bool archives_beside(const plans::Plan& plan) {
  if (plan.reports.archive.empty()) return false;
  const auto place = record::parse_archive_place(plan.reports.archive);
  return place && place->kind == record::ArchivePlace::Kind::kFile &&
         fs::path(place->address).is_relative();
}

/// Whether a plan can be resumed only from its folder, which holds its files.
bool needs_folder(const plans::Plan& plan, const RunArguments& arguments) {
  if (!arguments.plan_text.empty()) return false;  // its folder is the current one
  if (arguments.archive.empty() && archives_beside(plan)) return true;
  const auto of_file = [](const plans::BodyPlan& body) { return !body.file.empty(); };
  if (plan.fixture && std::ranges::any_of(plan.fixture->bodies, of_file)) return true;
  return std::any_of(plan.features.begin(), plan.features.end(), [](const auto& feature) {
    return feature.source || plans::has_files(feature);
  });
}

}  // namespace

core::Result<Resumption> find_resumption(const RunArguments& arguments) {
  Resumption out;
  const bool by_directory = names_directory(arguments);
  out.directory = by_directory ? arguments.plan : arguments.out;
  if (out.directory.empty()) {
    return core::fail_with(core::Code::kBadOption,
                           "--resume does not say which run goes on, {} is not a directory; name "
                           "the run: rondure run RUN_DIR --resume, or --out DIR beside the plan",
                           arguments.plan);
  }
  if (by_directory && !arguments.out.empty() &&
      fs::absolute(arguments.out) != fs::absolute(arguments.plan)) {
    return core::fail_with(core::Code::kBadOption,
                           "two run directories are named, {} and {}; name one", arguments.plan,
                           arguments.out);
  }
  if (!by_directory) {
    TRY(const auto unstarted, record::clear_unstarted_run(out.directory));
    if (unstarted) return out;
  }
  TRY(auto held, record::hold_journal(out.directory));
  out.held.emplace(std::move(held));
  return out;
}

plans::PlanOrProblems plan_of(const RunArguments& arguments, const Resumption& run) {
  if (!arguments.plan_text.empty()) {
    return plans::parse_plan(arguments.plan_text, {}, arguments.plan);
  }
  if (!arguments.resume || !names_directory(arguments)) return plans::read_plan(arguments.plan);
  const record::Header& header = run.held->read.record.header;
  auto plan = plans::parse_plan(header.plan_text, {}, header.plan_file);
  std::vector<core::Error> problems;
  if (!plan) {  // it was valid once: its points files, which are beside the plan, are missing
    problems = plan.error();
  } else if (arguments.archive.empty() && archives_beside(*plan)) {
    problems.push_back({core::Code::kFile,
                        fmt::format("the archive {} stands beside the plan, which is not named; "
                                    "name it with --archive, or",
                                    plan->reports.archive),
                        "/reports/archive"});
  } else {
    return plan;
  }
  problems.push_back(
      {core::Code::kFile,
       fmt::format("name the plan, so that its files are found: rondure run {} --out "
                   "{} --resume",
                   quoted(header.plan_file), quoted(run.directory.string())),
       {}});
  return tl::unexpected(std::move(problems));
}

std::string resume_command(const RunToFinish& run) {
  const RunArguments& arguments = run.arguments;
  const std::string directory = quoted(run.directory.string());
  std::string out = "rondure run ";
  if (needs_folder(run.plan, arguments) && !names_directory(arguments)) {
    out += fmt::format("{} --out {}", quoted(arguments.plan), directory);
  } else {
    out += directory;
  }
  out += " --resume";
  for (std::size_t i = 0; i < arguments.formats.size(); ++i) {
    out += (i == 0 ? " --format " : ",") + arguments.formats[i];
  }
  if (arguments.language != "en") out += " --lang " + arguments.language;
  if (arguments.detail) out += " --detail";
  if (arguments.paper) out += fmt::format(" --paper {}", name_of(*arguments.paper));
  if (!arguments.archive.empty()) out += " --archive " + quoted(run.archive.shown);
  return out;
}

}  // namespace rondure::app
