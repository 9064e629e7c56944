#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/terminal/internal/columns.h"
#include "reports/terminal/summary.h"
#include "synthetic.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string summary_of(const Case& made) { return write_summary(made.record, made.evaluation); }

TEST(Summary, LinesFitEightyColumns) {
  for (const Case& made :
       {cylinder_case(4, 7, 3), failing_case(), circle_case(500), unfinished_case(),
        hostile_case(std::string(300, 'W')),
        hostile_case("圆柱度圆柱度 圆柱度圆柱度圆柱度圆柱度圆柱度圆柱度 圆柱度圆柱度"),
        hostile_case("two words"), hostile_case("")}) {
    std::istringstream lines(summary_of(made));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(columns(line), 80U) << line;
  }
}

TEST(Summary, StartsWithTheVerdict) {
  EXPECT_THAT(summary_of(cylinder_case(4, 7, 3)), StartsWith("CONFORMS\n"));
  EXPECT_THAT(summary_of(failing_case()), StartsWith("DOES NOT CONFORM\n"));
  EXPECT_THAT(summary_of(unfinished_case()), StartsWith("INCOMPLETE: 1 of 2 judged\n"));
}

TEST(Summary, SaysTheValueItsLimitAndItsVerdictInOneLine) {
  EXPECT_THAT(
      summary_of(failing_case()),
      HasSubstr("  CYLt MZCY      8.300 um   limit 6.000 um      does not conform  cyl-A\n"));
}

TEST(Summary, SaysThatItIsSimulatedAndWhatIsHidden) {
  const std::string text = summary_of(cylinder_case(4, 7, 3));
  EXPECT_THAT(text, HasSubstr("no real part was measured"));
  EXPECT_THAT(text, HasSubstr("CYLt 8.251 um, difference +0.049 um"));
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
