#include "reports/verify/internal/compare_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rondure::reports {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

constexpr const char* kReport = R"({
  "run": "spool",
  "features": [
    {"mz": {"deviation_um": 7.42}, "contacts": [3, 9, 11], "a/b": null}
  ]
}
)";

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST(JsonDifference, IsAbsentForEqualBytes) {
  EXPECT_EQ(first_json_difference(kReport, kReport, 0.0), std::nullopt);
  EXPECT_EQ(first_json_difference(kReport, kReport, 1e-9), std::nullopt);
}

TEST(JsonDifference, NamesThePlaceAndBothValues) {
  EXPECT_EQ(first_json_difference(kReport, changed(kReport, "7.42", "7.43"), 0.0),
            "/features/0/mz/deviation_um: the file says 7.43, the journal gives 7.42");
  EXPECT_EQ(first_json_difference(kReport, changed(kReport, "9,", "\"9\","), 0.0),
            "/features/0/contacts/1: the file says \"9\", the journal gives 9");
  EXPECT_EQ(first_json_difference(kReport, changed(kReport, "null", "0"), 0.0),
            "/features/0/a~1b: the file says 0, the journal gives null");
  EXPECT_EQ(first_json_difference("1", "[]", 0.0),
            "the whole file: the file says null, the journal gives 1");
}

TEST(JsonDifference, NamesMissingAndAddedParts) {
  EXPECT_EQ(first_json_difference(kReport, changed(kReport, R"("run": "spool",)", ""), 0.0),
            "/run: missing in the file, the journal gives \"spool\"");
  EXPECT_EQ(first_json_difference(kReport, changed(kReport, R"("run")", R"("x": 1, "run")"), 0.0),
            "/x: the file says 1, the journal gives nothing there");
  EXPECT_EQ(first_json_difference(kReport, changed(kReport, ", 11]", "]"), 0.0),
            "/features/0/contacts/2: missing in the file, the journal gives 11");
}

TEST(JsonDifference, SaysThatAFileIsNotJsonAnyMore) {
  for (const std::string& text :
       {changed(kReport, "7.42", "7,42"), std::string(), std::string("\xff\xfe")}) {
    EXPECT_THAT(first_json_difference(kReport, text, 0.0),
                Optional(HasSubstr("the text is no JSON from byte ")));
  }
  // Closed brackets are JSON; whoever walks them exhausts the stack.
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  EXPECT_EQ(first_json_difference(kReport, deep, 0.0),
            "the text is nested deeper than 64 levels, from byte 65 on");
}

TEST(JsonDifference, SaysThatEqualValuesAreWrittenDifferently) {
  for (const auto& found : {changed(kReport, "7.42", "7.420"), changed(kReport, "[3, 9", "[3,9"),
                            changed(kReport, R"("run")", R"("run": "other", "run")")}) {
    EXPECT_THAT(first_json_difference(kReport, found, 0.0),
                Optional(HasSubstr("the values are equal, but written differently")));
  }
  EXPECT_THAT(first_json_difference(R"({"a":1,"b":2})", R"({"b":2,"a":1})", 0.0),
              Optional(HasSubstr("order of keys")));
}

TEST(JsonDifference, ToleratesNumbersOnly) {
  EXPECT_EQ(first_json_difference(kReport, changed(kReport, "7.42", "7.4200000009"), 1e-9),
            std::nullopt);
  EXPECT_THAT(first_json_difference(kReport, changed(kReport, "7.42", "7.4200000011"), 1e-9),
              Optional(HasSubstr("the file says 7.4200000011")));
  EXPECT_THAT(first_json_difference(kReport, changed(kReport, "7.42", "7.4200000009"), 0.0),
              Optional(HasSubstr("deviation_um")));
  EXPECT_THAT(first_json_difference(kReport, changed(kReport, "spool", "spoon"), 1e-9),
              Optional(HasSubstr("/run: the file says \"spoon\"")));
}

TEST(JsonDifference, ShowsOnlyTheBeginningOfAHugeValue) {
  const std::string huge = "\"" + std::string(1'000'000, 'q') + "\"";
  EXPECT_LT(first_json_difference(kReport, changed(kReport, "7.42", huge), 0.0)->size(), 200U);
}

constexpr const char* kTouches = "touch,tip_x_mm,note\n0,1.5,a\n1,2.5,\"b,c\"\n";

TEST(CsvDifference, NamesLineColumnAndBothValues) {
  EXPECT_EQ(first_csv_difference(kTouches, kTouches, 0.0), std::nullopt);
  EXPECT_EQ(first_csv_difference(kTouches, changed(kTouches, "2.5", "2.6"), 0.0),
            "line 3, column tip_x_mm: the file says \"2.6\", the journal gives \"2.5\"");
  EXPECT_EQ(first_csv_difference(kTouches, changed(kTouches, "b,c", "b,d"), 0.0),
            "line 3, column note: the file says \"\"b,d\"\", the journal gives \"\"b,c\"\"");
  EXPECT_THAT(first_csv_difference(kTouches, changed(kTouches, "tip_x", "tip_y"), 0.0),
              Optional(HasSubstr("line 1, column tip_x_mm: the file says \"tip_y_mm\"")));
}

TEST(CsvDifference, CountsFieldsAndLines) {
  EXPECT_EQ(first_csv_difference(kTouches, changed(kTouches, "1.5,a", "1.5,a,"), 0.0),
            "line 2, the file has 4 fields, the journal gives 3");
  EXPECT_EQ(first_csv_difference(kTouches, std::string(kTouches) + "2,3.5,d\n", 0.0),
            "line 4, column touch: the file says \"2\", the journal gives \"\"");
  EXPECT_EQ(first_csv_difference(kTouches, changed(kTouches, "\"b,c\"\n", "\"b,c\""), 0.0),
            "the file has 3 lines, the journal gives 4");
  EXPECT_THAT(first_csv_difference(kTouches, changed(kTouches, "a\n", "a\r\n"), 0.0),
              Optional(HasSubstr("the line ends differ")));
}

TEST(CsvDifference, ToleratesNumbersOnly) {
  EXPECT_EQ(first_csv_difference(kTouches, changed(kTouches, "2.5", "2.4999999995"), 1e-9),
            std::nullopt);
  EXPECT_NE(first_csv_difference(kTouches, changed(kTouches, "2.5", "2.4999999985"), 1e-9),
            std::nullopt);
  EXPECT_NE(first_csv_difference(kTouches, changed(kTouches, ",a", ",A"), 1e-9), std::nullopt);
  EXPECT_EQ(first_csv_difference("# 1.5 um\na\n1\n", "# 1.6 um\na\n1\n", 1e-9), std::nullopt);
  EXPECT_NE(first_csv_difference("# 1.5 um\na\n1\n", "# 1.6 um\na\n1\n", 0.0), std::nullopt);
}

constexpr const char* kPage = "<html>\n<td>7.42 um</td>\n<path d=\"M1.25,2L-3.5e-2 4\"/>\n";

TEST(TextDifference, NamesTheLineAndShowsBoth) {
  EXPECT_EQ(first_text_difference(kPage, kPage), std::nullopt);
  EXPECT_EQ(first_text_difference(kPage, changed(kPage, "7.42", "7.43")),
            "line 2: the file says \"<td>7.43 um</td>\", the journal gives \"<td>7.42 um</td>\"");
  EXPECT_EQ(first_text_difference(kPage, std::string(kPage) + "x"),
            "line 4: the file says \"x\", the journal gives \"\"");
  EXPECT_EQ(first_text_difference(kPage, changed(kPage, "<html>\n", "<html>\r\n")),
            "line 1: the file says \"<html>\\x0d\", the journal gives \"<html>\"");
}

TEST(TextDifference, ShowsOnlyTheSurroundingsInALongLine) {
  const std::string left = std::string(100'000, 'a') + "1" + std::string(100'000, 'b');
  const std::string right = changed(left, "1", "2");
  const auto difference = first_text_difference(left, right);
  ASSERT_TRUE(difference);
  EXPECT_LT(difference->size(), 250U);
  EXPECT_THAT(*difference, HasSubstr("aaa2bbb"));
  EXPECT_THAT(*difference, HasSubstr("aaa1bbb"));
}

}  // namespace
}  // namespace rondure::reports
