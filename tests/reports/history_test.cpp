#include "reports/history/history.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/encodings.h"
#include "core/noise.h"
#include "record/files.h"
#include "record/sha256.h"
#include "reports/history/archive_entry.h"
#include "reports/terminal/internal/columns.h"
#include "reports/words/language.h"
#include "tests/core/scratch.h"
#include "tests/reports/page_text.h"
#include "tests/reports/synthetic.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::printable;
using core::well_formed;

using record::ArchivedResult;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// `n` results of one characteristic, newest first; their logarithms are nearly normal.
std::vector<ArchivedResult> results(int n, std::uint64_t seed = 1) {
  std::vector<ArchivedResult> out;
  for (int i = 0; i < n; ++i) {
    ArchivedResult r;
    r.head.run_id = fmt::format("run-{}", i);
    r.head.started_utc = fmt::format("2026-{:02}-{:02}T08:00:00Z", 1 + i / 28 % 12, 1 + i % 28);
    r.head.part_id = "SP-100";
    r.head.serial = fmt::format("{:04}", i);
    r.head.operator_name = "mk";
    r.head.machine = "CMM 7";
    r.head.version = "0.1.0";
    double sum = 0.0;
    for (int k = 0; k < 12; ++k) {
      sum += static_cast<double>(core::splitmix64(seed) >> 11) * 0x1.0p-53;
    }
    r.result = {"journal",
                "cyl",
                "CYLt",
                "MZCY",
                "unfiltered",
                "4 x 7 points",
                0.008 * std::exp(0.1 * (sum - 6.0)),
                0.012,
                "mm",
                "conforms",
                "global"};
    r.time_s = i;
    out.insert(out.begin(), r);
  }
  return out;
}

void expect_plain_80_columns(const std::string& text) {
  for (const std::string& line : testing::lines_of(text)) {
    EXPECT_LE(columns(line), 80U) << line;
    EXPECT_EQ(printable(line), line);
  }
}

const std::vector<std::string>& hostile_fields() {
  static const std::vector<std::string> texts = {
      "<script>alert(1)</script>",
      "a\nb\x1b[31mred\r",
      "\"; drop table x; --",
      "\xe5\x9c\x86\xe6\x9f\xb1\xe5\xba\xa6\xe5\x9c\x86\xe6\x9f\xb1\xe5\xba\xa6",
      "=1+1",
      std::string(10'000, 'x'),
      "\xff\xfe\xed\xa0\x80"};
  return texts;
}

std::vector<ArchivedResult> hostile_results(const std::string& text) {
  auto out = results(30);
  for (ArchivedResult& r : out) {
    record::ArchiveHead& h = r.head;
    for (std::string* field :
         {&h.run_id, &h.part_id, &h.part_name, &h.machine, &h.fixture, &h.plan_name,
          &r.result.feature, &r.result.characteristic, &r.result.sampling, &r.result.filter}) {
      *field = text;
    }
    h.operator_name = text + h.serial;
  }
  return out;
}

TEST(RunChart, HoldsWhatMeansTheSameAndSaysWhatItLeavesOut) {
  auto all = results(60);
  all[3].result.reference = "LSCY";
  all[4].result.sampling = "8 x 15 points";
  all[5].head.simulated = true;
  all[6].head.part_id = "SP-200";
  all[7].result.filter = "gaussian 50 upr";
  all[8].result.verdict = "void";
  all[9].result.value.reset();
  all[10].head.machine = "CMM 8";
  all[11].head.operator_name = "";
  const RunChart chart = run_chart_of(all);
  EXPECT_EQ(chart.results.size(), 53U);
  EXPECT_EQ(chart.results.front().head.run_id, "run-0");
  EXPECT_THAT(chart.notes, Contains(HasSubstr("5 results were left out")));
  EXPECT_THAT(chart.notes, Contains(HasSubstr("2 results were void or without a value")));
  EXPECT_THAT(chart.notes, Contains(HasSubstr("mixed: 2 machines (CMM 7, CMM 8)")));
  EXPECT_THAT(chart.notes, Contains(HasSubstr("mixed: 2 persons (not given, mk)")));
}

TEST(RunChart, CallsCapabilityOnlyWhatIsInControlAndOftenEnough) {
  const RunChart stable = run_chart_of(results(100));
  ASSERT_TRUE(stable.capability);
  ASSERT_THAT(stable.beyond, IsEmpty());
  EXPECT_EQ(stable.index_name, "CpkU");
  const RunChart few = run_chart_of(results(30));
  ASSERT_TRUE(few.capability);
  EXPECT_EQ(few.index_name, "PpkU");
  EXPECT_THAT(few.notes, Contains(HasSubstr("rough estimate")));
  auto shifted = results(100);
  for (int i = 0; i < 50; ++i) *shifted[static_cast<std::size_t>(i)].result.value *= 1.3;
  const RunChart chart = run_chart_of(shifted);
  EXPECT_FALSE(chart.beyond.empty());
  if (chart.capability) {
    EXPECT_EQ(chart.index_name, "PpkU");
  }
}

TEST(RunChart, SaysWhyThereIsNoIndex) {
  EXPECT_TRUE(run_chart_of({}).results.empty());
  const RunChart few = run_chart_of(results(5));
  EXPECT_FALSE(few.limits);
  EXPECT_FALSE(few.capability);
  EXPECT_THAT(few.notes, AllOf(Contains(HasSubstr("no control limits: 5 results, at least 10")),
                               Contains(HasSubstr("no capability: 5 results, at least 25"))));
  auto one_part = results(60);
  for (ArchivedResult& r : one_part) r.head.serial = "0042";
  EXPECT_THAT(run_chart_of(one_part).notes, Contains(HasSubstr("of one serial number")));
  auto open = results(60);
  for (ArchivedResult& r : open) r.result.upper_limit.reset();
  EXPECT_THAT(run_chart_of(open).notes, Contains(HasSubstr("has no tolerance")));
}

TEST(History, TableAndChartFitATerminal) {
  for (const int n : {1, 2, 9, 30, 57, 400}) {
    SCOPED_TRACE(n);
    const auto all = results(n);
    auto wide = all;
    for (ArchivedResult& r : wide) {
      r.result.value = 123.4567891;
      r.result.upper_limit = 0.1;
      r.result.verdict = "does not conform";
    }
    expect_plain_80_columns(history_table(wide));
    expect_plain_80_columns(history_table(all));
    expect_plain_80_columns(history_chart(run_chart_of(all), false));
    EXPECT_EQ(testing::lines_of(history_table(all)).size(), static_cast<std::size_t>(n) + 1);
  }
}

// Of a run the table shows what decides: what fails, else what is nearest to its limit.
TEST(History, HasALineForEachRun) {
  std::vector<ArchivedResult> all;
  for (const ArchivedResult& one : results(2)) {  // run-1, then run-0
    const bool failing = one.head.run_id == "run-0";
    for (const auto& [id, value, upper, verdict] :
         {std::tuple{"near", 0.009, 0.010, "conforms"},
          {"far", 0.001, 0.010, "conforms"},
          {"reported", 0.5, 0.1, "not toleranced"},
          {"over", 0.0045, 0.004, failing ? "does not conform" : "conforms"}}) {
      if (std::string_view(id) == "over" && !failing) continue;
      all.push_back(one);
      all.back().result.characteristic = id;
      all.back().result.value = value;
      all.back().result.upper_limit = upper;
      all.back().result.verdict = verdict;
    }
  }
  EXPECT_EQ(history_table(all),
            "started (UTC)    part     serial  conform nearest         value verdict\n"
            "2026-01-01 08:00 SP-100   0000        2/3 over         4.500 um does not conform\n"
            "2026-01-02 08:00 SP-100   0001        2/2 near         9.000 um conforms\n");
  // Of a size between two limits the middle is farthest from them, of one limit there is no share.
  for (ArchivedResult& one : all) one.result.verdict = "conforms";
  all[0].result = {"f", "middle", "d GN", "", "", "", 30.0, 30.01, "mm", "conforms", "", 29.99};
  all[1].result = {"f", "one side", "d GN", "", "", "", 29.0, 30.0, "mm", "conforms", ""};
  all[2].result = {"f", "edge", "d GN", "", "", "", 30.009, 30.01, "mm", "conforms", "", 29.99};
  EXPECT_THAT(history_table(all), HasSubstr("edge       30009.0 um conforms"));
}

TEST(History, OfASizeShowsBothLimits) {
  auto sizes = results(60);
  for (ArchivedResult& r : sizes) {
    r.result.symbol = "d GN";
    r.result.value = 30.0 + (*r.result.value - 0.008);
    r.result.lower_limit = 29.995;
    r.result.upper_limit = 30.004;
  }
  const RunChart chart = run_chart_of(sizes);
  ASSERT_TRUE(chart.capability);
  EXPECT_EQ(chart.index_name.substr(1), "pk");
  EXPECT_EQ(chart.lower_limit_mm, 29.995);
  const std::string text = history_chart(chart, false);
  expect_plain_80_columns(text);
  EXPECT_THAT(text, AllOf(HasSubstr("L 29995.0"), HasSubstr("U 30004.0"),
                          HasSubstr("L: its lower limit"), HasSubstr("0.135 % point")));
  expect_plain_80_columns(history_table(sizes));
  EXPECT_THAT(history_svg(chart), HasSubstr("lower limit 29995.0"));
  EXPECT_THAT(history_csv_header(), HasSubstr(",lower_limit\n"));
  EXPECT_THAT(history_csv_rows(sizes), HasSubstr(",29995\n"));
  sizes.front().result.value = 29.9;
  EXPECT_THAT(history_chart(run_chart_of(sizes), false), HasSubstr("#"));
}

// The archive keeps angles in mrad, which leave it in urad.
TEST(History, OfAnAngleIsInMicroradians) {
  auto angles = results(60);
  for (ArchivedResult& r : angles) {
    r.result.symbol = "EC \u03b1";
    r.result.unit = "mrad";
    r.result.value = 4.25e-3;
    r.result.upper_limit = 12.5e-3;
  }
  const RunChart chart = run_chart_of(angles);
  EXPECT_EQ(unit_of(chart), core::ValueUnit::kUrad);
  EXPECT_THAT(history_chart(chart, false), AllOf(HasSubstr("  urad +"), Not(HasSubstr("  um +"))));
  EXPECT_THAT(history_svg(chart), HasSubstr("EC \u03b1 / \u00b5rad"));
  EXPECT_THAT(history_table(angles), HasSubstr(" 4.250 urad conforms\n"));
  EXPECT_THAT(history_csv_rows(angles), HasSubstr(",4.25,12.5,urad,"));
  EXPECT_THAT(history_table(results(3)), Not(HasSubstr("urad")));
}

TEST(History, KeepsHostileTextAsText) {
  for (const std::string& text : hostile_fields()) {
    SCOPED_TRACE(text.substr(0, 40));
    const auto all = hostile_results(text);
    const RunChart chart = run_chart_of(all);
    expect_plain_80_columns(history_table(all));
    expect_plain_80_columns(history_chart(chart, false));
    const std::string svg = history_svg(chart);
    EXPECT_THAT(svg, Not(HasSubstr("<script")));
    EXPECT_THAT(svg, Not(HasSubstr("\x1b")));
    const auto written = nlohmann::json::parse(history_json("archive.db", all, false, chart));
    EXPECT_EQ(written["results"].size(), all.size());
  }
}

TEST(History, SvgIsWellFormed) {
  const test::Scratch folder;
  int number = 0;
  std::vector<std::vector<ArchivedResult>> cases = {results(1), results(20), results(100),
                                                    results(1'000)};
  for (const std::string& text : hostile_fields()) cases.push_back(hostile_results(text));
  for (const auto& all : cases) {
    const std::string file = (folder / fmt::format("{}.svg", number++)).string();
    ASSERT_TRUE(record::write_file(file, history_svg(run_chart_of(all))));
    const std::string command = fmt::format(
        "/usr/bin/python3 -c \"import xml.dom.minidom;xml.dom.minidom.parse('{}')\"", file);
    EXPECT_EQ(std::system(command.c_str()), 0);
  }
}

TEST(History, CsvQuotesAndDisarmsFormulas) {
  auto all = results(1);
  all[0].head.part_id = "a,\"b\"";
  all[0].head.operator_name = "=cmd()";
  all[0].result.value.reset();
  const std::string rows = history_csv_rows(all);
  EXPECT_THAT(rows, AllOf(HasSubstr("\"a,\"\"b\"\"\""), HasSubstr(",'=cmd(),"),
                          HasSubstr(",,12,um,conforms,global,")));
  const std::string header = history_csv_header();
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), 25);
}

TEST(ArchiveEntry, HoldsEveryCharacteristic) {
  const Case sample = cylinder_case(4, 7, 3);
  const record::ArchiveRun run =
      archive_entry(sample.record, sample.evaluation, record::sha256_hex("journal"));
  std::size_t expected = 0;
  for (const evaluation::FeatureResult& feature : sample.evaluation.features) {
    expected += feature.characteristics.size();
  }
  ASSERT_EQ(run.results.size(), expected);
  ASSERT_GT(expected, 0U);
  EXPECT_EQ(run.head.run_id, sample.record.header.run_id);
  EXPECT_EQ(run.results[0].symbol, "CYLt");
  EXPECT_EQ(run.results[0].reference, "MZCY");
  EXPECT_THAT(run.results[0].sampling, HasSubstr("4 x 7 points"));
  EXPECT_EQ(run.results[0].value, sample.evaluation.features[0].characteristics[0].value_mm());
}

TEST(WellFormed, LeavesOnlyWhatADatabaseTakes) {
  EXPECT_EQ(well_formed("a\xe5\x9c\x86\n"), "a\xe5\x9c\x86\n");
  EXPECT_EQ(well_formed(std::string("a\0b", 3)),
            "a\xef\xbf\xbd"
            "b");
  EXPECT_EQ(well_formed("\xff"), "\xef\xbf\xbd");
  // A surrogate, an overlong form, beyond Unicode.
  for (const char* wrong : {"\xed\xa0\x80", "\xe0\x80\x80", "\xf4\x90\x80\x80"}) {
    EXPECT_THAT(well_formed(wrong), ::testing::MatchesRegex("(\xef\xbf\xbd)+"));
  }
}

}  // namespace
}  // namespace rondure::reports
