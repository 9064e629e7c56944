#include "app/resumption.h"

#include <system_error>

#include <fmt/format.h>

#include "record/journal.h"
#include "record/unborn_run.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

/// Whether a run directory stands where a plan is expected.
bool names_directory(const RunArguments& arguments) {
  std::error_code ignored;
  return fs::is_directory(arguments.plan, ignored);
}

/// A word as a shell reads it.
std::string quoted(const std::string& word) {
  if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                             "/._-+,:@%=") == std::string::npos) {
    return word;
  }
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

core::Result<Resumption> find_resumption(const RunArguments& arguments) {
  Resumption out;
  const bool by_directory = names_directory(arguments);
  out.directory = by_directory ? arguments.plan : arguments.out;
  if (out.directory.empty()) {
    return core::fail(core::Code::kBadOption,
                      "--resume does not say which run goes on; name its directory: --out DIR, or "
                      "rondure run RUN_DIR --resume");
  }
  if (by_directory && !arguments.out.empty() &&
      fs::absolute(arguments.out) != fs::absolute(arguments.plan)) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("two run directories are named, {} and {}; name one",
                                  arguments.plan, arguments.out));
  }
  if (!by_directory) {
    const auto unborn = record::clear_unborn_run(out.directory);
    if (!unborn) return core::fail(unborn.error());
    if (*unborn) return out;
  }
  const auto read = record::read_journal(out.directory);
  if (!read) return core::fail(read.error());
  out.state = read->record.sealed ? Resumption::State::kFinished : Resumption::State::kGoesOn;
  out.plan_text = read->record.header.plan_text;
  out.plan_file = read->record.header.plan_file;
  return out;
}

plans::PlanOrProblems plan_of(const RunArguments& arguments, const Resumption& run) {
  if (!arguments.resume || !names_directory(arguments)) return plans::read_plan(arguments.plan);
  auto plan = plans::parse_plan(run.plan_text, {}, run.plan_file);
  if (plan) return plan;
  // A plan that was good: what is missing are its points files, which stand beside it.
  auto problems = plan.error();
  problems.push_back(
      {core::Code::kFile,
       fmt::format("name the plan, so that its files are found: rondure run {} --out "
                   "{} --resume",
                   run.plan_file, quoted(run.directory.string())),
       {}});
  return tl::unexpected(std::move(problems));
}

std::string resume_command(const fs::path& directory) {
  return fmt::format("rondure run {} --resume", quoted(directory.string()));
}

}  // namespace rondure::app
