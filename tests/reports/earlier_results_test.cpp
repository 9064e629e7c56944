#include "reports/history/earlier_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/history/archive_entry.h"
#include "reports/html/report.h"
#include "synthetic.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// `runs` runs of the same part before this one, newest first.
EarlierResults earlier_of(const Case& made, int runs) {
  const record::ArchiveRun own = archive_entry(made.record, made.evaluation, "ab");
  EarlierResults out;
  for (int run = runs; run >= 1; --run) {
    for (const record::ArchiveResult& result : own.results) {
      record::ArchivedResult row{own.head, result, 1'700'000'000 + run, run, 0};
      row.head.run_id = "run-" + std::to_string(run);
      if (row.result.value) *row.result.value *= 1.0 + 0.01 * run / 3.0;
      out.push_back(row);
    }
  }
  return out;
}

TEST(EarlierResults, ComeBackToTheSameBits) {
  EarlierResults earlier = earlier_of(cylinder_case(4, 7, 3), 5);
  earlier[0].result.value.reset();
  earlier[1].head.part_name = "</script>\"\n圆柱";
  const auto back = parse_earlier(earlier_json(earlier));
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), earlier.size());
  for (std::size_t i = 0; i < earlier.size(); ++i) {
    EXPECT_EQ((*back)[i].result.value, earlier[i].result.value);
    EXPECT_EQ((*back)[i].head.part_name, earlier[i].head.part_name);
    EXPECT_EQ((*back)[i].time_s, earlier[i].time_s);
  }
  EXPECT_EQ(earlier_json(*back), earlier_json(earlier));
}

TEST(EarlierResults, AnythingElseIsRefused) {
  for (const char* text :
       {"", "{}", "[1]", "{\"results\": [{}]}", "{\"results\": 3}", "nonsense"}) {
    const auto read = parse_earlier(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, core::Code::kSyntax);
  }
  EarlierResults huge = earlier_of(cylinder_case(4, 7, 3), 5);
  huge[2].result.value = 1e308;  // two of them have no mean
  const auto read = parse_earlier(earlier_json(huge));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what,
              ::testing::HasSubstr("number 3 has a value or limit beyond 1e+09"));
}

TEST(EarlierResults, ThePageHasAChartOfEachCharacteristicWithThem) {
  const Case made = cylinder_case(4, 7, 3);
  const EarlierResults earlier = earlier_of(made, 12);
  const auto charts = run_charts(made.record, made.evaluation, earlier);
  ASSERT_FALSE(charts.empty());
  EXPECT_EQ(charts[0].results.size(), 13U);
  EXPECT_EQ(charts[0].results.back().head.run_id, made.record.header.run_id);
  const std::string page = write_html(made.record, made.evaluation, Language::kEnglish, earlier);
  EXPECT_EQ(testing::first_unbalanced_tag(page), "");
  EXPECT_THAT(page, HasSubstr("<section id=\"history\">"));
  EXPECT_THAT(write_html(made.record, made.evaluation), Not(HasSubstr("id=\"history\"")));
}

TEST(EarlierResults, ResultsOfAnotherPartAreNotInTheChart) {
  const Case made = cylinder_case(4, 7, 3);
  EarlierResults earlier = earlier_of(made, 3);
  for (record::ArchivedResult& row : earlier) row.head.part_id = "another";
  EXPECT_TRUE(run_charts(made.record, made.evaluation, earlier).empty());
}

}  // namespace
}  // namespace rondure::reports
