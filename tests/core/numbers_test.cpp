#include "core/numbers.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include <gtest/gtest.h>

#include "core/noise.h"

namespace rondure::core {
namespace {

TEST(Numbers, ReadBackTheSameBits) {
  std::uint64_t state = 5;
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = splitmix64(state);
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (!is_measurable(value)) continue;  // no reader takes it
    const auto back = parse_number(shortest(value));
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(std::memcmp(&*back, &value, sizeof value), 0) << shortest(value);
  }
}

TEST(Numbers, RefuseWhatIsNotOneFiniteNumber) {
  for (const char* text : {"", "+", "+-1", "1,5", "1 ", " 1", "nan", "inf", "1e999", "0x10",
                           "1.5mm", "--1", "1e155", "-1e10", "1000000001"}) {
    EXPECT_FALSE(parse_number(text).has_value()) << text;
  }
  EXPECT_EQ(parse_number("-1e9"), -kGreatestNumber);
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_EQ(parse_number("-2e-3"), -2e-3);
}

TEST(Numbers, OnTheGridKeepTheirBitsThroughTheirText) {
  KeyedNoise random(1, {1});
  for (int i = 0; i < 20000; ++i) {
    SCOPED_TRACE(i);
    const double value = on_grid(2e4 * (random.uniform() - 0.5), 1e10);
    EXPECT_EQ(on_grid(value, 1e10), value);
    const std::string text = fmt::format("{:.10f}", value);
    EXPECT_EQ(parse_number(text), value) << text;
    EXPECT_EQ(parse_number(shortest(value)), value);
    EXPECT_LE(text.size(), 17U) << "a sign, a point and at most 15 digits: " << text;
  }
}

TEST(Numbers, GridTakesTheNearestStep) {
  EXPECT_EQ(on_grid(0.123456789049, 1e10), 0.123456789);
  EXPECT_EQ(on_grid(-0.123456789051, 1e10), -0.1234567891);
  EXPECT_FALSE(std::signbit(on_grid(-1e-12, 1e10)));
  EXPECT_EQ(on_grid(1e300, 1e10), 1e300);
  EXPECT_EQ(on_grid(std::numeric_limits<double>::infinity(), 1e10),
            std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(on_grid(std::nan(""), 1e10)));
}

}  // namespace
}  // namespace rondure::core
