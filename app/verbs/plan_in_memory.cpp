#include "app/verbs/plan_in_memory.h"

#include <system_error>

#include <fmt/format.h>

#include "app/run/ending.h"
#include "app/run/kept_trials.h"
#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "plans/schema/json_text.h"
#include "record/files.h"
#include "reports/terminal/summary.h"
#include "reports/words/language.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

RunArguments arguments_of(const PlanInMemory& plan) {
  RunArguments out;
  out.plan = plan.save_plan;
  if (plan.save_plan.empty()) {
    out.plan = plan.name;
    out.plan_text = plan.text({});
    out.place_name = plan.place_name;
  }
  out.out = plan.out;
  out.serial = plan.serial;
  out.operator_name = plan.operator_name;
  return out;
}

int say_summary(const std::string& directory) {
  const auto record = read_sound_record(directory);
  if (!record) return kRunFailed;
  const auto evaluation = KeptTrials(directory).evaluate(*record);
  if (!evaluation) return refuse(evaluation.error());
  say(reports::write_summary(*record, *evaluation, reports::Language::kEnglish));
  return kAllWell;
}

}  // namespace

std::string file_from(const std::string& file, const fs::path& folder) {
  if (folder.empty() || fs::path(file).is_absolute()) return file;
  std::error_code unknown;
  const fs::path relative = fs::relative(file, folder, unknown);
  return relative.empty() ? fs::absolute(file).string() : relative.string();
}

core::Result<void> check_spelling(const PlanInMemory& plan) {
  for (const auto& [place, word] : plan.words) {
    const std::size_t at = plans::first_not_utf8(word);
    if (at == word.size()) continue;
    return core::fail(
        core::Code::kBadOption,
        fmt::format("{} contains {}, which is not UTF-8, so that no plan can name it; rename it",
                    plans::in_quotes(word), plans::unshowable_in_words(word, at)),
        place);
  }
  return {};
}

int save_or_run(const PlanInMemory& plan) {
  if (!plan.save_plan.empty()) {
    std::error_code unknown;
    if (fs::exists(plan.save_plan, unknown)) {
      return refuse(
          {core::Code::kFile, "the file exists; name another one, or remove it", plan.save_plan});
    }
    const std::string text = plan.text(fs::absolute(plan.save_plan).parent_path());
    if (auto saved = record::write_file(plan.save_plan, text); !saved) return refuse(saved.error());
    say_line(plan.save_plan);
    if (plan.out.empty()) return kAllWell;
  }
  return run(arguments_of(plan));
}

int run_in_passing(const PlanInMemory& plan, bool json) {
  const record::PrivateFolder folder("rondure-fit");
  if (folder.path().empty()) {
    return refuse({core::Code::kFile,
                   "no folder can be made for the run; set TMPDIR to one that can be written",
                   {}});
  }
  RunArguments arguments = arguments_of(plan);
  arguments.out = (folder / "in-passing").string();
  arguments.archive = "none";
  arguments.formats = {"json"};
  arguments.quiet = true;
  const int status = run(arguments);
  if (status > kNotConforming) return status;
  if (!json) {
    const int said = say_summary(arguments.out);
    return said == kAllWell ? status : said;
  }
  const auto report = record::read_file(fs::path(arguments.out) / "report.json");
  if (!report) return refuse(report.error());
  say(*report);
  return status;
}

}  // namespace rondure::app
