// Journals whose rows were changed and whose chain and seal fit again: whoever can write into a run
// directory can make these.

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "plans/record_check.h"
#include "record/journal.h"
#include "reports/defect.h"
#include "reports/evaluation.h"
#include "reports/exports.h"
#include "reports/factor_json.h"
#include "reports/factor_study.h"
#include "reports/factor_text.h"
#include "reports/summary.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/overheard.h"
#include "tests/fuzz/run_samples.h"

namespace rondure::fuzz {
namespace {

/// Every report but the PDF, which is made in one of 50 cases: it takes as long as all others.
std::string wrong_with_reports(const record::RunRecord& record,
                               const reports::Evaluation& evaluation, unsigned seed) {
  for (const reports::Export& what : reports::exports()) {
    if (!reports::applies(what, record)) continue;
    if (what.format == "pdf" && seed % 50 != 0) continue;
    const auto rendered = reports::render(what, record, evaluation);
    if (!rendered) {
      if (rendered.error().what.empty()) return what.file + " refused without a word";
      continue;
    }
    if (what.format == "pdf") continue;
    if (auto wrong = wrong_with_text(rendered->bytes); !wrong.empty()) {
      return what.file + ": " + wrong;
    }
  }
  return wrong_with_text(reports::write_summary(record, evaluation));
}

std::string try_run(const std::filesystem::path& directory, unsigned seed) {
  const auto read = record::read_journal(directory);
  if (!read) return read.error().what.empty() ? "refused without a word" : "";
  if (const auto known = plans::check_record(read->record); !known) {
    return known.error().what.empty() ? "refused without a word" : "";
  }
  const auto checked = reports::evaluate_checked(read->record);
  // Void, with a sentence: an answer, though one that points of a part never get.
  for (const auto& defect : checked.defects) {
    std::printf("case %u is void: %s\n", seed, reports::error_of(defect).what.c_str());
  }
  if (auto wrong = wrong_with_reports(read->record, checked.evaluation, seed); !wrong.empty()) {
    return wrong;
  }
  const auto compared = reports::compare_run(checked.evaluation);
  if (!compared) return {};
  return wrong_with_text(reports::comparison_text("run", *compared, true) +
                         reports::comparison_json("run", *compared));
}

TEST(JournalFuzz, NoResealedJournalUpsetsTheEvaluation) {
  const auto directory = work_folder() / "resealed";
  ASSERT_FALSE(sample_runs().empty());
  try_cases({60, 100'000}, [&](unsigned seed) {
    write_resealed_run(directory, seed);
    return try_run(directory, seed);
  });
}

TEST(JournalFuzz, TheUndamagedRunsAreEvaluated) {
  for (const auto& run : sample_runs()) {
    const auto read = record::read_journal(run);
    ASSERT_TRUE(read) << run << read.error().what;
    const auto known = plans::check_record(read->record);
    EXPECT_TRUE(known) << run << known.error().what;
    EXPECT_EQ(try_run(run, 0), "") << run;
  }
}

}  // namespace
}  // namespace rondure::fuzz
