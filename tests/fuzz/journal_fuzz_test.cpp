// Journals whose rows were changed and whose chain and seal fit again: whoever can write into a run
// directory can make these.

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "evaluation/defect.h"
#include "evaluation/factors/study.h"
#include "evaluation/results/evaluation.h"
#include "plans/run/record.h"
#include "record/journal/journal.h"
#include "reports/data/analyses.h"
#include "reports/formats/exports.h"
#include "reports/terminal/factors.h"
#include "reports/terminal/summary.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/overheard.h"
#include "tests/fuzz/run_samples.h"

namespace rondure::fuzz {
namespace {

/// Every report but the PDF, which a browser prints from the page.
std::string wrong_with_reports(const record::RunRecord& record,
                               const evaluation::Evaluation& evaluation) {
  for (const reports::Export& what : reports::exports()) {
    if (!reports::applies(what, record)) continue;
    if (what.format == record::Format::kPdf) continue;
    if (auto wrong = wrong_with_text(reports::render(what, record, evaluation)); !wrong.empty()) {
      return what.file + ": " + wrong;
    }
  }
  return wrong_with_text(reports::write_summary(record, evaluation));
}

std::string try_run(const std::filesystem::path& directory, unsigned seed) {
  const auto read = record::read_journal(directory);
  if (!read) return read.error().what.empty() ? "refused without a word" : "";
  if (const auto known = plans::check_record(*read); !known) {
    return known.error().what.empty() ? "refused without a word" : "";
  }
  const auto checked = evaluation::evaluate_checked(read->record);
  // Void, with a sentence: an answer, though one that points of a part never get.
  for (const auto& defect : checked.defects) {
    std::printf("case %u is void: %s\n", seed, evaluation::error_of(defect).what.c_str());
  }
  if (auto wrong = wrong_with_reports(read->record, checked.evaluation); !wrong.empty()) {
    return wrong;
  }
  const auto compared = evaluation::compare_run(checked.evaluation);
  if (!compared) return {};
  return wrong_with_text(reports::comparison_text("run", *compared, true) +
                         reports::comparison_json("run", *compared));
}

TEST(JournalFuzz, NoResealedJournalUpsetsTheEvaluation) {
  const auto directory = work_folder() / "resealed";
  ASSERT_FALSE(sample_runs().empty());
  try_cases({20, 2'000}, [&](unsigned seed) {
    write_resealed_run(directory, seed);
    return try_run(directory, seed);
  });
}

TEST(JournalFuzz, TheUndamagedRunsAreEvaluated) {
  for (const auto& run : sample_runs()) {
    const auto read = record::read_journal(run);
    ASSERT_TRUE(read) << run << read.error().what;
    const auto known = plans::check_record(*read);
    EXPECT_TRUE(known) << run << known.error().what;
    EXPECT_EQ(try_run(run, 0), "") << run;
  }
}

}  // namespace
}  // namespace rondure::fuzz
