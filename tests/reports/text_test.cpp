#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"
#include "reports/terminal/internal/columns.h"

namespace rondure::reports {
namespace {

using core::f_um;
using core::printable;
using core::signed_um;
using core::um;

TEST(Text, MicrometresHaveThreeDecimalsBelowAMillimetre) {
  EXPECT_EQ(um(0.0083), "8.300");
  EXPECT_EQ(um(-0.0000004), "0.000");
  EXPECT_EQ(um(1.25), "1250.0");
  EXPECT_EQ(signed_um(0.000049), "+0.049");
  EXPECT_EQ(f_um(0.0999), "99.900");
  EXPECT_EQ(f_um(0.25), "250.00");
  EXPECT_EQ(um(std::numeric_limits<double>::quiet_NaN()), "–");
}

TEST(Text, MarkupBecomesEntities) {
  EXPECT_EQ(escaped("<a href=\"x\" b='y'>&"), "&lt;a href=&quot;x&quot; b=&#39;y&#39;&gt;&amp;");
  EXPECT_EQ(escaped(std::string_view("\0\x1b", 2)), "\uFFFD\uFFFD");
  EXPECT_EQ(escaped("\xc3<"), "\uFFFD&lt;");
  EXPECT_EQ(escaped("度 µ"), "度 µ");
}

TEST(Text, NoncharactersStandInNoReport) {
  // Only of a forged journal: plans and the command line refuse them.
  const std::string name = "A\uFFFE\uFDD0\U0002FFFFB";
  EXPECT_EQ(escaped(name), "A\uFFFD\uFFFD\uFFFDB");
  EXPECT_EQ(clean(name), "A\uFFFD\uFFFD\uFFFDB");
  EXPECT_EQ(printable(name), "A???B");
}

TEST(Text, WideCharactersTakeTwoColumns) {
  EXPECT_EQ(columns("abc"), 3U);
  EXPECT_EQ(columns("度µ"), 3U);
  EXPECT_EQ(shortened("abcdefgh", 8), "abcdefgh");
  EXPECT_EQ(shortened("abcdefghi", 8), "abcde...");
  EXPECT_EQ(columns(shortened("度度度度度", 8)), 7U);
}

TEST(Ticks, AreRoundAndInside) {
  EXPECT_EQ(core::round_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  for (const double high : {0.001, 0.7, 3.3, 12.0, 99.0, 4321.0}) {
    for (const double low : {0.0, -0.4 * high, 0.9 * high}) {
      const auto ticks = core::round_ticks(low, high, 5);
      EXPECT_GE(ticks.size(), 3U);
      EXPECT_LE(ticks.size(), 10U);
      EXPECT_GE(ticks.front(), low - 1e-9 * high);
      EXPECT_LE(ticks.back(), high + 1e-9 * high);
    }
  }
  EXPECT_EQ(core::decade_ticks(3.0, 120.0), (std::vector<double>{5, 10, 20, 50, 100}));
}

TEST(Text, AFieldOfATableHoldsNoControlsAndIsQuotedAtASemicolon) {
  EXPECT_EQ(csv_field("a;b"), "\"a;b\"");
  EXPECT_EQ(csv_field("a\x1b[2Jb\x7f"), "a\uFFFD[2Jb\uFFFD");
  EXPECT_EQ(csv_field("a,\"b\"\n"), "\"a,\"\"b\"\"\n\"");
  EXPECT_EQ(csv_field("plain"), "plain");
}

TEST(Degrees, LeaveAsTheNumbersThatWereStated) {
  for (int tenths = -3600; tenths <= 3600; ++tenths) {
    const double stated = tenths / 10.0;
    EXPECT_EQ(core::stated_degrees(stated * core::kDegree), stated);
  }
  EXPECT_EQ(core::shortest(core::stated_degrees(-60.0 * core::kDegree)), "-60");
  for (int i = 1; i < 20000; ++i) {
    const double angle_rad = std::sin(static_cast<double>(i)) * 10.0;
    const double found = core::stated_degrees(angle_rad);
    EXPECT_NEAR(found, angle_rad / core::kDegree, 1e-12);
  }
}

TEST(Text, OfTheProgramShowsUnitsWithTheirSigns) {
  EXPECT_EQ(in_sentence(core::Phrase("5 um is within 12 um")), "<bdi>5 µm is within 12 µm</bdi>");
  EXPECT_EQ(in_sentence(core::Phrase("20.4 degC, an umbrella, <um")),
            "<bdi>20.4 °C, an umbrella, &lt;um</bdi>");
}

TEST(Colours, OfDeviationsAreNeutralAtZeroAndDistinctAtTheEnds) {
  EXPECT_EQ(diverging_colour(0.0), "#fafaf8");
  EXPECT_EQ(diverging_colour(-1.0), "#084582");
  EXPECT_EQ(diverging_colour(1.0), "#984608");
  EXPECT_EQ(diverging_colour(7.0), diverging_colour(1.0));
}

}  // namespace
}  // namespace rondure::reports
