// Tables of measured balls for the calibration of rotary axes.
#include "record/csv/balls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rondure::record {
namespace {

using core::Code;
using ::testing::HasSubstr;

core::Error ball_refusal(std::string_view text) {
  const auto rows = parse_ball_csv(text, "balls.csv");
  return rows ? core::Error{Code::kInternal, "it was read", {}} : rows.error();
}

constexpr std::string_view kHeader = "axis,station_deg,ball,x_mm,y_mm,z_mm,u_um\n";

TEST(BallCsv, ReadsRowsInAnyOrderOfColumns) {
  const auto rows = parse_ball_csv(
      "\xef\xbb\xbf# plate "
      "7\r\nball,axis,direction,z_mm,y_mm,x_mm,station_deg,ux_um,uy_um,uz_um\r\n"
      "a,C,,3,2,+1,reference,0.5,0.6,0.7\r\n\nb 2, C ,-,-3,2e1,1,-15.5,1,1,2\n",
      "balls.csv");
  ASSERT_TRUE(rows) << rows.error().what;
  ASSERT_EQ(rows->size(), 2U);
  const BallRow& first = rows->front();
  EXPECT_EQ(first.axis, "C");
  EXPECT_FALSE(first.station_deg);
  EXPECT_EQ(first.centre_mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(first.u_um, Eigen::Vector3d(0.5, 0.6, 0.7));
  EXPECT_EQ(first.direction, 0);
  const BallRow& second = rows->back();
  EXPECT_EQ(second.ball, "b 2");
  EXPECT_EQ(second.station_deg, -15.5);
  EXPECT_EQ(second.centre_mm, Eigen::Vector3d(1, 20, -3));
  EXPECT_EQ(second.direction, -1);
  EXPECT_EQ(second.line, 5U);
}

TEST(BallCsv, RefusesMixedUnits) {
  const auto inch = ball_refusal("axis,station_deg,ball,x_mm,y_inch,z_mm,u_um\nC,0,a,1,2,3,1\n");
  EXPECT_EQ(inch.code, Code::kWrongUnit);
  EXPECT_EQ(inch.where, "balls.csv:1");
  EXPECT_THAT(inch.what, HasSubstr("\"y_inch\" is not in mm; give y_mm"));
  EXPECT_EQ(ball_refusal("axis,station_rad,ball,x_mm,y_mm,z_mm,u_um\nC,0,a,1,2,3,1\n").code,
            Code::kWrongUnit);
  EXPECT_EQ(ball_refusal("axis,station_deg,ball,x_mm,y_mm,z_mm,u_mm\nC,0,a,1,2,3,1\n").code,
            Code::kWrongUnit);
}

TEST(BallCsv, RefusesWhatIsNotSuchATable) {
  const auto with = [](std::string_view rows) {
    return ball_refusal(std::string(kHeader) += rows);
  };
  EXPECT_EQ(with("C,0,a,1,2,3,1\n").what, "it was read");
  EXPECT_EQ(with("").code, Code::kNoPoints);
  EXPECT_EQ(ball_refusal("").code, Code::kNoPoints);
  EXPECT_THAT(with("C,0,a,1,2,3\n").what, HasSubstr("6 fields"));
  EXPECT_EQ(with("C,0,a,1,2,nan,1\n").code, Code::kNotFinite);
  EXPECT_THAT(with("C,0,a,1,2,-1e155,1\n").what, HasSubstr("z_mm is -1e155 mm, beyond the limit"));
  EXPECT_THAT(with("C,1e10,a,1,2,3,1\n").what, HasSubstr("station_deg is 1e10 deg, beyond"));
  EXPECT_EQ(with("C,0,a,1,2,nan,1\n").where, "balls.csv:2");
  EXPECT_THAT(with("C,0,a,1,,3,1\n").what, HasSubstr("y_mm is empty"));
  EXPECT_THAT(with("C,home,a,1,2,3,1\n").what, HasSubstr("or the word reference"));
  EXPECT_THAT(with("C,0,,1,2,3,1\n").what, HasSubstr("ball is empty"));
  EXPECT_EQ(with("C,0,a,1,2,3,-1\n").code, Code::kOutOfRange);
  EXPECT_THAT(with("C;0;a;1;2;3;1\n").what, HasSubstr("semicolons"));
  EXPECT_THAT(ball_refusal("axis,ball,x_mm,y_mm,z_mm,u_um\n").what,
              HasSubstr("\"station_deg\" is missing"));
  EXPECT_THAT(ball_refusal("axis,axis,station_deg,ball,x_mm,y_mm,z_mm,u_um\n").what,
              HasSubstr("stands twice"));
  EXPECT_THAT(ball_refusal("axis,station_deg,ball,x_mm,y_mm,z_mm,ux_um,uy_um\n").what,
              HasSubstr("all of ux_um"));
  EXPECT_THAT(ball_refusal("axis,station_deg,ball,x_mm,y_mm,z_mm,u_um,temperature\n").what,
              HasSubstr("\"temperature\" is unknown"));
  EXPECT_THAT(
      ball_refusal("axis,station_deg,ball,x_mm,y_mm,z_mm,u_um,direction\nC,0,a,1,2,3,1,up\n").what,
      HasSubstr("direction is \"up\""));
}

}  // namespace
}  // namespace rondure::record
