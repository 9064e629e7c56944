#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/terminal/internal/columns.h"
#include "reports/terminal/summary.h"
#include "synthetic.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string answer_of(const Case& made, Language language = Language::kEnglish) {
  return write_answer(made.record, made.evaluation, language);
}

std::string summary_of(const Case& made) { return write_summary(made.record, made.evaluation); }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out.push_back(line);
  return out;
}

/// The call-outs with their heads, up to the blank line.
std::vector<std::string> table_of(const std::string& text) {
  std::vector<std::string> lines = lines_of(text);
  const auto first = std::ranges::find(lines, "") + 1;
  return {first, std::find(first, lines.end(), "")};
}

TEST(Answer, LinesFitEightyColumnsInBothLanguages) {
  for (const Case& made :
       {cylinder_case(4, 7, 3), failing_case(), circle_case(500), unfinished_case(), drawing_case(),
        hostile_case(std::string(300, 'W')),
        hostile_case("圆柱度圆柱度 圆柱度圆柱度圆柱度圆柱度圆柱度圆柱度 圆柱度圆柱度"),
        hostile_case("two words"), hostile_case("")}) {
    for (const Language language : {Language::kEnglish, Language::kChinese}) {
      for (const std::string& text :
           {answer_of(made, language), write_summary(made.record, made.evaluation, language)}) {
        for (const std::string& line : lines_of(text)) EXPECT_LE(columns(line), 80U) << line;
      }
    }
  }
}

TEST(Answer, BeginsWithTheCountAndTheNearestOrTheFailingCallOut) {
  EXPECT_THAT(answer_of(cylinder_case(4, 7, 3)),
              StartsWith("1 of 1 conforms; nearest: cyl-A of land-A, 83 %.\n"
                         "Simulated: no real part was measured.\n"));
  EXPECT_THAT(answer_of(failing_case()),
              StartsWith("1 of 2 conforms; cyl-A of land-A is 2.30 µm over its limit of 6 µm.\n"));
  EXPECT_THAT(answer_of(unfinished_case()), StartsWith("INCOMPLETE: 1 of 2 judged\n"));
  EXPECT_THAT(summary_of(failing_case()), StartsWith("1 of 2 conforms; "));
}

TEST(Answer, OfAFeatureWithoutAResultSaysTheVerdictInFront) {
  Case made = cylinder_case(4, 7, 3);
  made.evaluation.features[0].characteristics.clear();
  made.evaluation.features[0].failure = core::Error{core::Code::kCollinear, "on one line"};
  made.evaluation.verdict = Verdict::kVoid;
  EXPECT_THAT(answer_of(made), AllOf(StartsWith("Void\nNo characteristic has a tolerance.\n"),
                                     HasSubstr("on one line [collinear]")));
}

TEST(Answer, HasALineForEachCallOutBelowItsVerdictFailingFirst) {
  const std::vector<std::string> table = table_of(answer_of(drawing_case()));
  ASSERT_EQ(table.size(), 1U + 2U + 6U);
  EXPECT_THAT(table[0], AllOf(HasSubstr("Feature"), HasSubstr("Call-out"), HasSubstr("Value"),
                              HasSubstr("Limit"), HasSubstr("Share")));
  EXPECT_EQ(table[1], "Does not conform");
  EXPECT_THAT(table[2], AllOf(HasSubstr("  land-A   50h6 E "), HasSubstr("50.0012 / 49.9931"),
                              HasSubstr("49.984 … 50")));
  EXPECT_EQ(table[3], "Conforms");
  EXPECT_THAT(table[4], AllOf(HasSubstr("cyl-A"), HasSubstr(" 83 %")));
  // Values end below one another, by columns and not by bytes.
  const auto end_of = [&](std::size_t line, const char* value) {
    return columns(table[line].substr(0, table[line].find(value))) + std::strlen(value);
  };
  EXPECT_EQ(end_of(2, "49.9931"), end_of(4, "8.3 ") - 1);
}

TEST(Answer, ChineseColumnsStandBelowEachOther) {
  const std::vector<std::string> table =
      table_of(answer_of(cylinder_case(4, 7, 3), Language::kChinese));
  const auto end_of = [&](std::size_t line, std::string_view cell) {
    return columns(table.at(line).substr(0, table[line].find(cell) + cell.size()));
  };
  EXPECT_EQ(table.at(1), "合格");
  EXPECT_EQ(end_of(0, "测得值"), end_of(2, "8.3"));
}

TEST(Answer, LeavesOutColumnsAndShortensNamesOnlyWhereALineIsTooLong) {
  const Case made = cylinder_case(4, 7, 3);
  EXPECT_THAT(table_of(answer_of(made))[0],
              AllOf(HasSubstr("Characteristic"), HasSubstr("Worst at")));
  EXPECT_THAT(table_of(answer_of(made))[2], Not(HasSubstr("...")));
  const std::string head = table_of(answer_of(hostile_case(std::string(300, 'W'))))[0];
  EXPECT_THAT(head, AllOf(HasSubstr("Value"), HasSubstr("Limit"), Not(HasSubstr("Worst at"))));
}

TEST(Answer, TellsDetailsOnlyOfWhatDoesNotConform) {
  EXPECT_THAT(answer_of(cylinder_case(4, 7, 3)), Not(HasSubstr("feature ")));
  const std::string failing = answer_of(failing_case());
  EXPECT_THAT(failing, AllOf(HasSubstr("feature        land-A: "), HasSubstr("stated"),
                             HasSubstr("\n    worst at   "), Not(HasSubstr("certificate")),
                             Not(HasSubstr("hidden truth"))));
  // The call-out that conforms stands in its line alone.
  const std::string all = summary_of(failing_case());
  EXPECT_EQ(failing.find("round-A", failing.find("round-A") + 1), std::string::npos);
  EXPECT_NE(all.find("round-A", all.find("round-A") + 1), std::string::npos);
}

TEST(Answer, EndsWithWhatIsInU) {
  EXPECT_THAT(
      answer_of(cylinder_case(4, 7, 3)),
      EndsWith("\nWithout U: no uncertainty is stated (the plan declares no uncertainty).\n"));
  EXPECT_EQ(write_whereabouts("runs/7/report.html", "rondure sign runs/7 --key KEY.pem"),
            "Report: runs/7/report.html; next: rondure sign runs/7 --key KEY.pem");
  EXPECT_EQ(write_whereabouts("runs/7/report.html", "", Language::kChinese),
            "报告：runs/7/report.html");
}

TEST(Summary, DetailsBeginWithTheCallOutAndItsVerdict) {
  EXPECT_THAT(answer_of(failing_case()),
              HasSubstr("\n  CYLt MZCY    cyl-A: does not conform\n    stated "));
}

TEST(Summary, SaysThatItIsSimulatedAndWhatIsHidden) {
  Case made = cylinder_case(4, 7, 3);
  auto& result = made.evaluation.features.front().characteristics.front();
  result.truths_mm = {result.value->quoted_mm() - 0.049e-3};
  const std::string text = summary_of(made);
  EXPECT_THAT(text, HasSubstr("no real part was measured"));
  EXPECT_THAT(text, HasSubstr("truth 8.251 µm, difference +0.049 µm"));
  EXPECT_THAT(text, HasSubstr("no measurement uncertainty taken into account"));
}

TEST(Summary, SaysWhyARunDidNotFinish) {
  const std::string text = summary_of(unfinished_case());
  EXPECT_THAT(text, HasSubstr("not finished   failed: collision"));
  EXPECT_THAT(text, HasSubstr("Feature bore-B has no result."));
  EXPECT_THAT(text, HasSubstr("[no-points]"));
}

TEST(Summary, ControlCharactersOfNamesDoNotReachTheTerminal) {
  const std::string text = summary_of(hostile_case("a\x1b[2Jb\u202Ec\u0085"));
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.find("\u202E"), std::string::npos);
  EXPECT_EQ(text.find("\u0085"), std::string::npos);
}

}  // namespace
}  // namespace rondure::reports
