#include "reports/verify/verify.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "core/version.h"
#include "evaluation/evaluate.h"
#include "evaluation/uncertainty/kept_draws.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/sha256.h"
#include "record/signature.h"
#include "reports/data/corrections.h"
#include "reports/formats/exports.h"
#include "reports/history/earlier_results.h"
#include "reports/verify/internal/compare_text.h"
#include "reports/verify/internal/files.h"
#include "reports/verify/stored_results.h"

namespace rondure::reports {
namespace {

using core::printable;
using record::Format;

namespace fs = std::filesystem;
using State = ListedFiles::State;

/// How exactly this program can repeat the computation of the program that measured.
struct Exactness {
  bool same_processor = true;
  bool same_version = true;

  /// Tolerance for numbers from another kind of processor or another version: mm, um, deg alike.
  [[nodiscard]] double tolerance() const { return same_processor && same_version ? 0.0 : 1e-9; }
};

Exactness exactness_of(const record::Header& header, const std::string& processor) {
  return {header.processor == processor, header.version == core::kVersion};
}

/// One result by its name: as stored, and as computed from the touches now.
struct Pair {
  std::optional<double> stored;
  std::optional<double> now;
};

/// The difference between both, in one sentence; nothing when they agree.
std::optional<std::string> compare_result(const std::string& name, const Pair& pair,
                                          const Exactness& exactness) {
  if (!pair.stored || !pair.now) {
    if (!exactness.same_version) return std::nullopt;
    return pair.now ? fmt::format("result {} is not stored; the touches give {}", name,
                                  core::shortest(*pair.now))
                    : fmt::format("stored result {} = {} has no counterpart", name,
                                  core::shortest(*pair.stored));
  }
  if (*pair.stored == *pair.now || std::abs(*pair.stored - *pair.now) <= exactness.tolerance()) {
    return std::nullopt;
  }
  return fmt::format("result {} no longer follows: stored {}, the touches give {}", name,
                     core::shortest(*pair.stored), core::shortest(*pair.now));
}

/// Compares the results that a run stored with those computed from its touches now, by name. A
/// result of one side only is a difference unless another version measured: versions may give more
/// or fewer numbers. Adds the first difference, and the number of others.
/// @return How many were compared: stored and computed now.
std::size_t compare_results(const std::vector<record::StoredResult>& stored,
                            const std::vector<record::StoredResult>& now,
                            const Exactness& exactness, Verification& out) {
  std::map<std::string, Pair> pairs;
  // order of the report, so that the first difference is the topmost
  std::vector<std::string> order;
  const auto pair_of = [&](const std::string& name) -> Pair& {
    if (!pairs.contains(name)) order.push_back(name);
    return pairs[name];
  };
  for (const record::StoredResult& result : now) pair_of(result.name).now = result.value;
  for (const record::StoredResult& result : stored) pair_of(result.name).stored = result.value;
  std::size_t compared = 0;
  std::vector<std::string> differences;
  for (const std::string& name : order) {
    const Pair& pair = pairs[name];
    compared += pair.stored && pair.now ? 1 : 0;
    if (auto found = compare_result(name, pair, exactness)) differences.push_back(*found);
  }
  if (differences.empty()) return compared;
  out.differences.push_back(differences.front());
  if (differences.size() > 1)
    out.differences.back() += fmt::format(" (and {} more)", differences.size() - 1);
  return compared;
}

/// Whether an export is rows of columns.
bool is_table(const Export& what) {
  return what.format == Format::kCsv ||
         (what.format == Format::kCorrections && what.file.ends_with(".csv"));
}

std::optional<std::string> compare_export(const Export& what, const std::string& expected,
                                          const std::string& found, const Exactness& exactness) {
  const double tolerance = exactness.tolerance();
  if (what.format == Format::kPdf) {
    // Its bytes are those of a browser and its fonts, and its numbers are drawn: SHA256SUMS holds
    // them. What can be compared is the page that it names, where that is the same bit for bit.
    if (tolerance > 0.0 || is_printed_from(expected, found)) return std::nullopt;
    return "it was printed from another page than the journal gives";
  }
  const bool same = exactness.same_version;
  if (what.format == Format::kJson) {
    return same ? first_json_difference(expected, found, tolerance)
                : compare_json_values(expected, found, tolerance);
  }
  if (is_table(what)) {
    return same ? first_csv_difference(expected, found, tolerance)
                : compare_csv_values(expected, found, tolerance);
  }
  // A page of another version or processor: SHA256SUMS holds it, and report.json has its numbers.
  return tolerance > 0.0 ? std::nullopt : first_text_difference(expected, found);
}

/// A line about one export: the difference, and whether the file or its source was changed.
std::string difference_line(const Export& what, const std::optional<std::string>& difference,
                            const std::optional<State>& state) {
  const bool changed = state == State::kChanged;
  if (!difference) {
    return fmt::format("{}: its bytes were changed after it was written ({})", what.file,
                       record::kChecksumsName);
  }
  std::string note;
  if (changed) {
    note = fmt::format("; the file was changed after it was written ({})", record::kChecksumsName);
  } else if (state == State::kAsWritten) {
    note = fmt::format("; the file itself is as it was written ({})", record::kChecksumsName);
  }
  return fmt::format("{}: {}{}", what.file, *difference, note);
}

/// Whether a missing export was written once: the list names it. Without a list: those that a plan
/// asks for unless it says otherwise.
bool was_written(const Export& what, const record::RunRecord& record, const ListedFiles& listed) {
  if (listed.list_found) return listed.state_of(what.file).has_value();
  const bool usual =
      what.format == Format::kHtml || what.format == Format::kJson || what.format == Format::kCsv;
  return usual && applies(what, record);
}

bool is_correction(const std::string& file) {
  return file.starts_with(std::string(kCorrectionsFolder) + "/");
}

/// The tables of corrections that stand there or that the list names.
std::set<std::string> correction_tables(const fs::path& directory, const ListedFiles& listed) {
  std::set<std::string> out;
  for (const auto& [file, state] : listed.files) {
    if (is_correction(file)) out.insert(file);
  }
  std::error_code ignored;  // no folder, no tables
  for (const auto& entry : fs::directory_iterator(directory / kCorrectionsFolder, ignored)) {
    out.insert(fmt::format("{}/{}", kCorrectionsFolder, entry.path().filename().string()));
  }
  return out;
}

/// Compares each export that exists, with the files that come with it.
/// @return Their names.
core::Result<std::string> compare_exports(const fs::path& directory,
                                          const record::RunRecord& record,
                                          const evaluation::Evaluation& evaluation,
                                          const Exactness& exactness, const ListedFiles& listed,
                                          Verification& out) {
  const auto earlier = read_earlier(directory);
  if (!earlier) {
    out.differences.push_back(earlier.error().what);
    return std::string("none, because of it");
  }
  if (auto fault = fault_of_earlier(*earlier, record)) {
    out.differences.push_back(*std::move(fault));
  }
  std::string names;
  std::string absent;
  std::set<std::string> tables = correction_tables(directory, listed);
  const auto is_there = [&](const Export& e) {
    if (stands_there(directory / e.file)) return true;
    if (was_written(e, record, listed))
      absent += (absent.empty() ? "; not there: " : ", ") + e.file;
    return false;
  };
  const Corrections corrections = corrections_of(record, evaluation);
  for (const Export& e : exports()) {
    // A table for a machine is checked also where the text that names it was taken away.
    const bool has_tables = e.format == Format::kCorrections && !tables.empty();
    const bool there = is_there(e);
    if (!there && !has_tables) continue;
    Edition edition;
    if (there && (e.format == Format::kHtml || e.format == Format::kPdf)) {
      TRY(const auto page, record::read_inside(directory, e.file, record::kMostPointsBytes));
      edition = edition_of(e, page);
    }
    for (const Rendered& rendered :
         render_all(e, record, evaluation, corrections, edition, *earlier)) {
      const auto& [file, made] = rendered;
      tables.erase(file.file);
      if (file.file == e.file ? !there : !is_there(file)) continue;
      TRY(const auto bytes, record::read_inside(directory, file.file, most_bytes_of(rendered)));
      names += (names.empty() ? "" : ", ") + file.file;
      const auto state = listed.state_of(file.file);
      const auto difference = compare_export(file, made, bytes, exactness);
      if (difference || state == State::kChanged) {
        out.differences.push_back(difference_line(file, difference, state));
      }
    }
  }
  for (const std::string& table : tables) {
    if (!stands_there(directory / table)) continue;
    out.differences.push_back(
        fmt::format("{}: the journal gives no such correction", printable(table)));
  }
  return (names.empty() ? "none" : names) + absent;
}

/// Adds damage of the journal and the list that is visible before any computation.
void tell_damage(const record::ReadJournal& read, const ListedFiles& listed, Verification& out) {
  const record::RunRecord& record = read.record;
  for (const record::BrokenTable& broken : read.broken) {
    out.differences.push_back(fmt::format("journal, table {}: {}", broken.table, broken.what));
  }
  for (const std::string& log : read.beside) {
    out.differences.push_back(
        fmt::format("{}: it stands beside the closed journal and was not read; other programs may "
                    "read it in the journal's place: move it away",
                    log));
  }
  const std::string plan_sha256 = record::sha256_hex(record.header.plan_text);
  if (plan_sha256 != record.header.plan_sha256) {
    out.differences.push_back(
        fmt::format("journal, table header: the plan in it is not the one that was measured: its "
                    "SHA-256 is {}, recorded is {}",
                    plan_sha256, printable(record.header.plan_sha256)));
  }
  for (const auto& [file, state] : listed.files) {
    const auto all = exports();
    if (is_correction(file) ||
        std::any_of(all.begin(), all.end(), [&](const Export& e) { return e.file == file; })) {
      continue;
    }
    if (state == State::kAbsent && file != evaluation::kTrialsFile) {
      out.differences.push_back(
          fmt::format("{}: it is not there, and {} names it", file, record::kChecksumsName));
    }
    if (state != State::kChanged) continue;
    const bool hidden = file == record::kJournalName && read.broken.empty();
    out.differences.push_back(fmt::format(
        "{}: its bytes were changed after it was written ({}){}", file, record::kChecksumsName,
        hidden ? "; no value in it differs, the change is in what SQLite keeps beside the values"
               : ""));
  }
  if (record.ending != "finished") {
    out.differences.push_back(
        fmt::format("the run did not finish ({}); it has no results to verify",
                    record.ending.empty() ? "it was interrupted" : record.ending));
  } else if (!record.sealed) {
    out.differences.push_back(
        "the journal was not closed: the run was interrupted after its last touch");
  } else if (listed.list_found && !listed.state_of(record::kJournalName)) {
    out.differences.push_back(fmt::format("{}: its line for {} is missing", record::kChecksumsName,
                                          record::kJournalName));
  }
}

std::string how_exactly(const record::Header& header, const VerifyOptions& options,
                        const Exactness& exactness) {
  std::string words;
  if (!exactness.same_version) {
    words = fmt::format(
        "written by version {}, this is version {}: numbers that both give within 1e-9, wording "
        "and layout of reports not compared",
        header.version, core::kVersion);
  }
  if (!exactness.same_processor) {
    words += fmt::format("{}numbers within 1e-9 (measured on {}, verified on {})",
                         words.empty() ? "" : "; ", header.processor, options.processor);
  }
  return words.empty() ? "bit for bit (same kind of processor)" : words;
}

/// Limits of the comparison that are no differences.
std::vector<std::string> notes_on(const record::ReadJournal& read, const ListedFiles& listed) {
  std::vector<std::string> out;
  const record::Header& header = read.record.header;
  if (header.version != core::kVersion) {
    out.push_back(fmt::format("version {} measured, this is version {}: it verifies what both give",
                              printable(header.version), core::kVersion));
  }
  if (read.record.sealed && !listed.list_found) {
    out.push_back(
        fmt::format("there is no {}, which the run wrote: nothing shows whether {} and the reports "
                    "are still the files that were written",
                    record::kChecksumsName, record::kJournalName));
  }
  return out;
}

/// "part SP-25, serial 0042, conforms".
std::string about_part(const record::Header& header, evaluation::Verdict verdict) {
  const std::string serial =
      header.serial.empty() ? std::string("no serial") : "serial " + printable(header.serial);
  return fmt::format("part {}, {}, {}", printable(header.part_id), serial, name_of(verdict));
}

/// ", 3072 rows of series"; empty without any.
std::string series_in_words(const record::RunRecord& record) {
  std::size_t rows = 0;
  for (const record::Series& series : record.series) rows += series.rows();
  return rows == 0 ? std::string() : fmt::format(", {} rows of series", rows);
}

std::vector<std::string> signed_files(const fs::path& directory, const ListedFiles& listed) {
  std::vector<std::string> files = {record::kJournalName};
  for (const Export& e : exports()) files.push_back(e.file);
  for (const std::string& table : correction_tables(directory, listed)) files.push_back(table);
  files.emplace_back(kEarlierName);
  return files;
}

/// Checks the signature when there is a key.
/// @return The end of the sentence: how far the signature was checked.
core::Result<std::string> about_signature(const fs::path& directory, const VerifyOptions& options,
                                          const ListedFiles& listed, Verification& out) {
  if (!options.public_key_pem) {
    const bool present = stands_there(directory / record::kSignatureName);
    return present ? "; signed, the signature was not checked (--key PUBLIC.pem checks it)" : "";
  }
  TRY_DO(check_signature(directory, *options.public_key_pem, listed,
                         signed_files(directory, listed), out.differences));
  TRY(const auto key, record::key_sha256(*options.public_key_pem));
  return "; the signature holds for this key, " + key;
}

}  // namespace

bool gives_stored_results(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                          const std::string& processor) {
  const Exactness exactness = exactness_of(record.header, processor);
  if (!record.sealed) return false;
  Verification out;
  compare_results(record.results, stored_results(evaluation), exactness, out);
  return out.differences.empty();
}

core::Result<Verification> verify_run(const fs::path& directory, const VerifyOptions& options) {
  TRY(const auto read, record::read_journal(directory));
  const record::RunRecord& record = read.record;
  Verification out;
  TRY(const auto listed, check_listed_files(directory, out.differences));
  tell_damage(read, listed, out);
  TRY(const auto signature, about_signature(directory, options, listed, out));
  out.notes = notes_on(read, listed);
  if (!read.broken.empty()) {  // changed data may ask for any computation
    out.notes.emplace_back("nothing was computed from a journal that is not as it was written");
    return out;
  }

  if (const auto checked = options.check ? options.check(read) : core::Result<void>(); !checked) {
    out.differences.push_back(checked.error().what);
    return out;
  }
  evaluation::KeptDraws draws;
  const auto evaluation = [&] {
    const evaluation::UseOfDraws use(draws);
    return evaluation::evaluate(record);
  }();
  if (!evaluation) {
    if (out.differences.empty()) return core::fail(evaluation.error());
    out.differences.push_back(
        fmt::format("the touches cannot be evaluated: {}", core::to_line(evaluation.error())));
    return out;
  }
  const Exactness exactness = exactness_of(record.header, options.processor);
  if (record.sealed && listed.state_of(evaluation::kTrialsFile) != State::kChanged) {
    TRY_DO(
        compare_trials(directory, options.trials_head, draws.bytes(), out.differences, out.notes));
  }
  const std::size_t results =
      record.sealed ? compare_results(record.results, stored_results(*evaluation), exactness, out)
                    : 0;
  TRY(const auto names, compare_exports(directory, record, *evaluation, exactness, listed, out));
  out.what_was_compared = fmt::format(
      "{}: {} touches{}, {} results follow from the journal, {}; exports compared: {}{}",
      about_part(record.header, evaluation->verdict), record.touches.size(),
      series_in_words(record), results, how_exactly(record.header, options, exactness), names,
      signature);
  return out;
}

}  // namespace rondure::reports
