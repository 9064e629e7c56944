#include "reports/formats/exports.h"

#include <algorithm>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/numbers.h"
#include "reports/data/writers.h"
#include "reports/terminal/internal/columns.h"
#include "synthetic.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::decimal;

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Exports, AnUnknownFormatIsRefusedWithThoseThatAreKnown) {
  const Case made = cylinder_case(4, 7, 3);
  const auto written = write_exports("/nowhere", {"docx"}, made.record, made.evaluation);
  ASSERT_FALSE(written);
  EXPECT_EQ(
      written.error().what,
      "format 'docx' is unknown; html, json, csv, qif, dmis, corrections and pdf can be written");
}

TEST(Decimal, ReadsBackToTheSameDoubleWithoutAnExponent) {
  EXPECT_EQ(decimal(0.0083), "0.0083");
  EXPECT_EQ(decimal(-0.0), "0");
  EXPECT_EQ(decimal(40.0), "40");
  for (const double value : {1e-9, 1.0 / 3.0, 123456789.125, 1e22, 1.7e308, -2.5e-7}) {
    const std::string text = decimal(value);
    EXPECT_EQ(text.find_first_not_of("-0123456789."), std::string::npos) << text;
    EXPECT_EQ(std::stod(text), value) << text;
  }
}

TEST(Dmis, SaysThatItIsOutputAndGivesFeatureAndTolerance) {
  const Case made = failing_case();
  const std::string text = write_dmis(made.record, made.evaluation);
  EXPECT_THAT(text,
              ::testing::StartsWith("FILNAM/'OUTPUT',05.2\n$$ Output block, written by rondure;"));
  EXPECT_THAT(text, HasSubstr("UNITS/MM,ANGDEC\n"));
  EXPECT_THAT(text, HasSubstr("FA(F1)=FEAT/CYLNDR,OUTER,CART,0.012,-0.0065,40,"));
  EXPECT_THAT(text,
              HasSubstr("T(F1T1)=TOL/CYLCTY,0.006\nOUTPUT/FA(F1),TA(F1T1)\nTA(F1T1)=TOL/CYLCTY,"));
  EXPECT_THAT(text, HasSubstr(",OUTOL\n"));
  EXPECT_THAT(text, HasSubstr("TA(F1T2)=TOL/CIRLTY,0.0071,INTOL\n"));
  EXPECT_THAT(text, Not(HasSubstr("TA(F1T3)=")));  // it has no tolerance
  EXPECT_THAT(text, ::testing::EndsWith("ENDFIL\n"));
}

TEST(Dmis, WhatIsVoidOrUndecidedIsNeitherInNorOutOfTolerance) {
  Case made = unfinished_case();
  made.evaluation.features[0].characteristics[0].verdict = evaluation::Verdict::kUndecided;
  const std::string text = write_dmis(made.record, made.evaluation);
  EXPECT_THAT(text, Not(HasSubstr("TOL/")));
  EXPECT_THAT(text, HasSubstr("$$ F1T1: no block in DMIS; "));
  EXPECT_THAT(text, HasSubstr("$$ F2: no result; No cloud of a final pose is on record.\n"));
  EXPECT_THAT(text, HasSubstr("$$ not finished: "));
}

TEST(ResultsCsv, HasARowACharacteristic) {
  const Case made = failing_case();
  std::istringstream lines(write_results_csv(made.record, made.evaluation));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "run,started_utc,part,serial,feature,characteristic,symbol,reference,value_um,"
            "tolerance_um,verdict,reason,verification_operator,quoted_um,low_um,high_um");
  std::getline(lines, line);
  EXPECT_THAT(line,
              ::testing::StartsWith("01_spool_simulated-20261121T023302Z,2026-11-21T02:33:02Z,"
                                    "VS-1180,0042,land-A,cyl-A,CYLt,MZCY,8.3,6,does not "
                                    "conform,"));
  std::getline(lines, line);
  std::getline(lines, line);
  EXPECT_THAT(line, HasSubstr(",cyl-LS,CYLt,LSCY,9.12,,not toleranced,"));
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
}  // namespace rondure::reports
