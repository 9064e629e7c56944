#include "core/numbers.h"

#include <cstring>

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
    if (!(value - value == 0.0)) continue;  // NaN and infinity have no text
    const auto back = parse_number(shortest(value));
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(std::memcmp(&*back, &value, sizeof value), 0) << shortest(value);
  }
}

TEST(Numbers, RefuseWhatIsNotOneFiniteNumber) {
  for (const char* text :
       {"", "+", "+-1", "1,5", "1 ", " 1", "nan", "inf", "1e999", "0x10", "1.5mm", "--1"}) {
    EXPECT_FALSE(parse_number(text).has_value()) << text;
  }
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_EQ(parse_number("-2e-3"), -2e-3);
}

}  // namespace
}  // namespace rondure::core
