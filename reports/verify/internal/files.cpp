#include "reports/verify/internal/files.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/error.h"
#include "evaluation/uncertainty/kept_draws.h"
#include "record/archive/archive.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/sha256.h"
#include "record/signature.h"

namespace rondure::reports {

namespace fs = std::filesystem;

std::optional<ListedFiles::State> ListedFiles::state_of(const std::string& file) const {
  const auto found = files.find(file);
  return found == files.end() ? std::nullopt : std::optional(found->second);
}

bool stands_there(const fs::path& file) {
  std::error_code problem;
  return fs::symlink_status(file, problem).type() != fs::file_type::not_found;
}

core::Result<ListedFiles> check_listed_files(const fs::path& directory,
                                             std::vector<std::string>& differences) {
  ListedFiles out;
  out.list_found = stands_there(directory / record::kChecksumsName);
  if (!out.list_found) return out;
  const auto list = record::read_checksums(directory);
  if (!list && list.error().code != core::Code::kSyntax) return core::fail(list.error());
  if (!list) {
    differences.push_back(fmt::format("{}: {}", list.error().where, list.error().what));
    return out;
  }
  for (const record::Checksum& line : *list) {
    ListedFiles::State& state = out.files[line.file];
    if (!stands_there(directory / line.file)) {
      state = ListedFiles::State::kAbsent;
      continue;
    }
    TRY(const auto sha256, record::sha256_inside(directory, line.file));
    state = sha256 == line.sha256 ? ListedFiles::State::kAsWritten : ListedFiles::State::kChanged;
  }
  return out;
}

core::Result<void> check_signature(const fs::path& directory, const std::string& public_key_pem,
                                   const ListedFiles& listed, const std::vector<std::string>& files,
                                   std::vector<std::string>& differences) {
  if (!listed.list_found || !stands_there(directory / record::kSignatureName)) {
    differences.push_back(
        fmt::format("the run is not signed: there is no {}; rondure sign signs it",
                    listed.list_found ? record::kSignatureName : record::kChecksumsName));
    return {};
  }
  TRY(const auto sums, record::read_inside(directory, record::kChecksumsName));
  TRY(const auto signature, record::read_inside(directory, record::kSignatureName));
  TRY(const auto holds, record::signature_holds(sums, signature, public_key_pem));
  if (!holds) {
    differences.push_back(
        fmt::format("{}: the signature does not hold: {} or the signature was changed after it was "
                    "signed, or another key signed it",
                    record::kSignatureName, record::kChecksumsName));
  }
  for (const std::string& file : files) {
    const auto state = listed.state_of(file);
    const std::string absent =
        fmt::format("{}: it is not there, and {} names it", file, record::kChecksumsName);
    const bool told =
        std::find(differences.begin(), differences.end(), absent) != differences.end();
    if (state == ListedFiles::State::kAbsent && !told) differences.push_back(absent);
    if (state || !stands_there(directory / file)) continue;
    differences.push_back(
        fmt::format("{}: it is not signed: {} does not name it", file, record::kChecksumsName));
  }
  return {};
}

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
