#include "reports/verify/internal/compare_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rondure::reports {
namespace {

using ::testing::HasSubstr;

TEST(CompareJsonValues, PassOverWordsAndKeysOfOneVersion) {
  const std::string now = R"({"schema_version": 2, "a": {"um": 1.5, "new": 7, "text": "in words"},
                             "list": [1, 2, 3], "verdict": "conforms", "then": 3})";
  const std::string old = R"({"schema_version": 1, "a": {"um": 1.5, "text": "otherwise"},
                             "verdict": "conforms", "list": [1, 2], "old": 9, "then": null})";
  EXPECT_EQ(compare_json_values(now, old, 0.0).value_or(""), "");
}

TEST(CompareJsonValues, NameTheFirstNumberThatDiffers) {
  const auto first = [](const std::string& expected, const std::string& found, double tolerance) {
    return compare_json_values(expected, found, tolerance).value_or("");
  };
  EXPECT_EQ(first(R"({"a": [{"um": 1.5}]})", R"({"a": [{"um": 1.25}]})", 1e-9),
            "/a/0/um: the file says 1.25, the journal gives 1.5");
  EXPECT_EQ(first(R"({"um": 1.5})", R"({"um": 1.5000000001})", 1e-9), "");
  EXPECT_EQ(first(R"({"um": 1.5})", R"({"um": 1.500000002})", 1e-9),
            "/um: the file says 1.500000002, the journal gives 1.5");
  EXPECT_EQ(first(R"({"um": null})", R"({"um": 2})", 1e-9),
            "/um: the file says 2, the journal gives null");
  EXPECT_EQ(first(R"({"f": {"verdict": "conforms"}})", R"({"f": {"verdict": "void"}})", 0.0),
            R"(/f/verdict: the file says "void", the journal gives "conforms")");
  EXPECT_EQ(first("{}", "{", 0.0),
            "the text is no JSON from byte 1 of 1 on; the file is cut off or was edited");
}

TEST(CompareCsvValues, GoByTheNamesOfTheColumns) {
  const std::string now = "# version 2\nid,x_mm,new,y_mm\n1,0.5,9,a\n2,1.5,9,\"b,c\"\n";
  const auto first = [&](const std::string& found) {
    return compare_csv_values(now, found, 1e-9).value_or("");
  };
  EXPECT_EQ(first("# v1\nid,y_mm,x_mm\n1,a,0.50\n2,\"b,c\",1.5\n"), "");
  EXPECT_EQ(first("id,y_mm,x_mm\r\n1,a,0.5\r\n2,\"b,c\",1.5\r\n"), "");
  EXPECT_EQ(first("id,x_mm\n1,0.5\n2,1.6\n"),
            "row 2, column x_mm: the file says 1.6, the journal gives 1.5");
  EXPECT_EQ(first("id,y_mm\n1,a\n2,b\n"),
            "row 2, column y_mm: the file says b, the journal gives \"b,c\"");
  EXPECT_EQ(first("id,x_mm\n1,0.5\n2\n"),
            "row 2, column x_mm: the file says , the journal gives 1.5");
  EXPECT_EQ(first("id,x_mm\n1,0.5\n"), "the file has 2 rows, the journal gives 3");
  EXPECT_THAT(first("a\n1\n2\n"), HasSubstr("no column that this version writes"));
  EXPECT_THAT(first(""), HasSubstr("0 rows"));
}

}  // namespace
}  // namespace rondure::reports
