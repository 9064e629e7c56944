#include "reports/verify/internal/derived.h"

#include <fmt/format.h>

#include "core/utf8.h"
#include "evaluation/uncertainty/kept_draws.h"
#include "record/archive/archive.h"
#include "record/files.h"
#include "reports/verify/internal/files.h"

namespace rondure::reports {
namespace {

/// The last line of the head, which names the journal: the lines before it name the program.
std::string_view journal_line(std::string_view head) {
  head.remove_suffix(head.empty() ? 0 : 1);
  return head.substr(head.rfind('\n') + 1);
}

}  // namespace

core::Result<void> compare_trials(const std::filesystem::path& directory, std::string_view head,
                                  std::string_view drawn, std::vector<std::string>& differences,
                                  std::vector<std::string>& notes) {
  constexpr const char* kFile = evaluation::kTrialsFile;
  if (!stands_there(directory / kFile)) {
    if (!drawn.empty()) {
      notes.push_back(
          fmt::format("{} is not there: report and compare compute the intervals again", kFile));
    }
    return {};
  }
  TRY(const auto bytes, record::read_inside(directory, kFile, record::kMostPointsBytes));
  const auto differs = [&](std::string_view why) {
    differences.push_back(fmt::format(
        "{}: {}; remove it: report and compare compute the intervals again", kFile, why));
  };
  if (std::string_view(bytes).ends_with(drawn) && bytes.size() == head.size() + drawn.size() &&
      bytes.starts_with(head)) {
    return {};
  }
  if (bytes.starts_with(head)) {
    differs("its draws are not those that the touches give");
  } else if (bytes.find(journal_line(head)) == std::string::npos) {
    differs("it is not of this journal");
  } else {
    notes.push_back(fmt::format(
        "{}: another build or another kind of processor wrote it, so that it is neither compared "
        "nor taken",
        kFile));
  }
  return {};
}

std::optional<std::string> fault_of_earlier(const EarlierResults& earlier,
                                            const record::RunRecord& record) {
  const auto& own = record.header;
  const auto started_s = record::seconds_of_utc(own.started_utc);
  for (std::size_t i = 0; i < earlier.size(); ++i) {
    const auto& [head, result, time_s, run, number] = earlier[i];
    const auto begun_s = record::seconds_of_utc(head.started_utc);
    std::string why;
    if (head.part_id != own.part_id) {
      why = fmt::format("part {} in place of {}", core::printable(head.part_id),
                        core::printable(own.part_id));
    } else if (head.run_id == own.run_id && head.started_utc == own.started_utc) {
      why = "this run itself";
    } else if ((begun_s && *begun_s != time_s) || (started_s && time_s > *started_s)) {
      why = "no earlier run";
    }
    if (why.empty()) continue;
    return fmt::format("{}: result {} is of {} (run {} of {}); copy the run directory again",
                       kEarlierName, i + 1, why, core::printable(head.run_id),
                       core::printable(head.started_utc));
  }
  return std::nullopt;
}

}  // namespace rondure::reports
