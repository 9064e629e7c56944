#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/numbers.h"
#include "reports/data/writers.h"
#include "synthetic.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

/// Splits one record of RFC 4180; quoted fields may hold commas and doubled quotes.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

TEST(TouchesCsv, HasARowATouchUnderItsHeader) {
  const Case made = cylinder_case(4, 7, 3);
  const auto lines = testing::lines_of(write_touches_csv(made.record));
  ASSERT_EQ(lines.size(), 2 + made.record.touches.size());
  EXPECT_EQ(lines[0], "# rondure touches, run 01_spool_simulated-20261121T023302Z");
  EXPECT_EQ(lines[1],
            "id,purpose,feature,pose,layer,point,repeat,x_mm,y_mm,z_mm,dir_x,dir_y,dir_z,"
            "temperature_degC,time_s,scale_temperature_degC");
  for (std::size_t i = 2; i < lines.size(); ++i) EXPECT_EQ(fields_of(lines[i]).size(), 16U);
}

TEST(TouchesCsv, NumbersReadBackToTheSameDouble) {
  const Case made = cylinder_case(4, 7, 3);
  const auto lines = testing::lines_of(write_touches_csv(made.record));
  for (std::size_t i = 0; i < made.record.touches.size(); ++i) {
    const record::Touch& touch = made.record.touches[i];
    const auto fields = fields_of(lines[i + 2]);
    EXPECT_EQ(fields[0], std::to_string(touch.id));
    EXPECT_EQ(core::parse_number(fields[7]), touch.tip_mm.x());
    EXPECT_EQ(core::parse_number(fields[10]), touch.approach.x());
    EXPECT_EQ(core::parse_number(fields[14]), touch.time_s);
  }
}

TEST(TouchesCsv, QualificationTouchesBelongToNoFeature) {
  const auto lines = testing::lines_of(write_touches_csv(cylinder_case(4, 7, 3).record));
  EXPECT_EQ(fields_of(lines[2])[1], "qualification");
  EXPECT_EQ(fields_of(lines[2])[2], "");
  EXPECT_EQ(fields_of(lines.back())[1], "measure");
  EXPECT_EQ(fields_of(lines.back())[2], "land-A");
}

TEST(TouchesCsv, FeatureNamesWithCommasAndQuotesAreQuoted) {
  Case made = cylinder_case(1, 7, 1);
  made.record.features[0].id = "bore, \"left\"";
  made.record.header.run_id = "a\nb";
  const auto lines = testing::lines_of(write_touches_csv(made.record));
  EXPECT_EQ(lines[0], "# rondure touches, run a?b");
  EXPECT_NE(lines.back().find("\"bore, \"\"left\"\"\""), std::string::npos);
  EXPECT_EQ(fields_of(lines.back())[2], "bore, \"left\"");
}

}  // namespace
}  // namespace rondure::reports
