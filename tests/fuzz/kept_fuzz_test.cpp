// What is kept of earlier runs: archives, the results beside a run.

#include <array>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "app/verbs/verbs.h"
#include "core/encodings.h"
#include "evaluation/evaluate.h"
#include "record/archive/archive.h"
#include "record/journal/journal.h"
#include "reports/history/earlier_results.h"
#include "reports/history/history.h"
#include "tests/app/files.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/overheard.h"
#include "tests/fuzz/row_damage.h"
#include "tests/fuzz/run_samples.h"
#include "tests/fuzz/seeds.h"

namespace rondure::fuzz {
namespace {

namespace fs = std::filesystem;

/// A result as many runs of one part leave it.
record::ArchiveRun archived_run(int number) {
  record::ArchiveRun out;
  out.head.journal_sha256 = std::string(60, 'a') + std::to_string(1000 + number);
  out.head.run_id = "run " + std::to_string(number);
  out.head.started_utc = "2026-11-21T02:33:" + std::to_string(10 + number) + "Z";
  out.head.part_id = "SP-50-80";
  for (const char* id : {"CYLt", "RONt"}) {
    record::ArchiveResult result;
    result.feature = "running surface";
    result.characteristic = id;
    result.symbol = id;
    result.reference = "MZCY";
    result.filter = "unfiltered";
    result.sampling = "2 x 6 points";
    result.value = 0.005 + 0.0001 * (number % 7);
    result.upper_limit = 0.012;
    result.verdict = "conforms";
    result.certificate = "global";
    out.results.push_back(result);
  }
  return out;
}

std::string archive_bytes() {
  const fs::path file = work_folder() / "archive-seed.db";
  {
    auto archive = record::Archive::open(record::parse_archive_place(file.string()).value(),
                                         record::Archive::Access::kWrite);
    for (int i = 0; archive && i < 30; ++i) {
      if (!archive->push(archived_run(i))) break;
    }
  }
  return app::testing::read(file);
}

TEST(KeptFuzz, NoDamagedArchiveUpsetsTheHistory) {
  const std::string seed_bytes = archive_bytes();
  ASSERT_GT(seed_bytes.size(), 10'000U);
  const fs::path file = work_folder() / "archive.db";
  const std::vector<std::string> tables = {"rondure_run", "rondure_result", "rondure_result"};
  try_cases({300, 30'000}, [&](unsigned seed) {
    std::mt19937 random(seed);
    std::string bytes = seed_bytes;
    const bool by_rows = random() % 3 != 0;
    for (auto left = by_rows ? 0 : 1 + random() % 20; left > 0; --left) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    if (!by_rows && random() % 4 == 0) bytes.resize(random() % bytes.size());
    fs::remove(file.string() + "-wal");
    fs::remove(file.string() + "-journal");
    app::testing::write(file, bytes);
    if (by_rows) damage_rows(file, tables, random);
    app::HistoryArguments arguments;
    arguments.archive = file.string();
    arguments.chart = random() % 2 == 0;
    arguments.json = random() % 2 == 0;
    if (random() % 4 == 0) arguments.csv = (work_folder() / "history.csv").string();
    if (random() % 4 == 0) arguments.svg = (work_folder() / "chart.svg").string();
    return wrong_with_answer([&] { return app::history(arguments); });
  });
}

TEST(KeptFuzz, NoDamagedEarlierResultsUpsetThePage) {
  reports::EarlierResults earlier;
  auto archive = record::Archive::open(
      record::parse_archive_place((work_folder() / "archive-seed.db").string()).value(),
      record::Archive::Access::kWrite);
  ASSERT_TRUE(archive);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(archive->push(archived_run(i)));
  const auto newest = archive->newest({}, 40);
  ASSERT_TRUE(newest);
  earlier = *newest;
  const Mutation mutation({reports::earlier_json(earlier)}, json_words());
  const auto read = record::read_journal(spool_run());
  ASSERT_TRUE(read);
  const auto evaluation = evaluation::evaluate(read->record);
  ASSERT_TRUE(evaluation);
  try_cases({600, 30'000}, [&](unsigned seed) -> std::string {
    const auto parsed = reports::parse_earlier(mutation.input(seed));
    if (!parsed) return wrong_with_text(core::printable(core::to_line(parsed.error())));
    for (const reports::RunChart& chart : reports::run_charts(read->record, *evaluation, *parsed)) {
      std::string text = reports::history_drawing(chart) + reports::history_svg(chart) +
                         reports::history_chart(chart, false) +
                         reports::capability_in_words(chart).english();
      for (const core::Phrase& sentence : reports::history_sentences(chart)) text += sentence;
      if (auto wrong = wrong_with_text(text); !wrong.empty()) return wrong;
    }
    return {};
  });
}

}  // namespace
}  // namespace rondure::fuzz
