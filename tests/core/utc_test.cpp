#include "core/utc.h"

#include <gtest/gtest.h>

namespace rondure::core {
namespace {

TEST(Utc, KnownTimesAreRead) {
  EXPECT_EQ(parse_utc("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(parse_utc("2000-02-29T12:00:00Z"), 951'825'600);  // date -u -d ... +%s
  EXPECT_EQ(parse_utc("2026-11-21T23:59:59Z"), 1'795'305'599);
}

TEST(Utc, ComesBackAsItWas) {
  for (std::int64_t s = 0; s < 10'000'000'000; s += 7'777'777) {
    ASSERT_EQ(parse_utc(utc_text(s)), s) << utc_text(s);
  }
}

TEST(Utc, RefusesEverythingElse) {
  for (const char* text : {"", "2026-11-21", "2026-11-21T02:33:02", "2026-11-21 02:33:02Z",
                           "2026-02-29T00:00:00Z", "2026-13-01T00:00:00Z", "2026-11-21T24:00:00Z",
                           "2026-11-21T02:60:00Z", "2026-11-21T02:33:60Z", "1969-12-31T23:59:59Z",
                           "2026-11-21T02:33:02Z ", "2026-11-2xT02:33:02Z"}) {
    EXPECT_FALSE(parse_utc(text)) << text;
  }
}

}  // namespace
}  // namespace rondure::core
