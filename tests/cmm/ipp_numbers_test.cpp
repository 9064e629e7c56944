#include "cmm/ipp/numbers.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rondure::cmm::ipp {
namespace {

TEST(IppNumbers, AreWrittenShort) {
  EXPECT_EQ(wire_number(0.0), "0");
  EXPECT_EQ(wire_number(-0.0), "0");
  EXPECT_EQ(wire_number(300.0), "300");
  EXPECT_EQ(wire_number(-0.25), "-0.25");
  EXPECT_EQ(wire_number(0.1), "0.1");
  EXPECT_EQ(wire_number(1e-10), "1e-10");
  EXPECT_EQ(wire_number(0.1 + 0.2), "0.3");  // 17 digits
  EXPECT_EQ(read_number(wire_number(-1.5e-20)), -1.5e-20);
}

int digits(const std::string& text) {
  const std::string mantissa = text.substr(0, text.find('e'));
  return static_cast<int>(
      std::count_if(mantissa.begin(), mantissa.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

TEST(IppNumbers, WhatIsOnTheGridTravelsUnchangedInSixteenDigits) {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<std::int64_t> steps(-99'999'999'999'999, 99'999'999'999'999);
  for (int i = 0; i < 20000; ++i) {
    const double position_mm = static_cast<double>(steps(random)) / 1e10;
    const double direction = static_cast<double>(steps(random) * 10 + i % 10) / 1e15;
    SCOPED_TRACE(position_mm);
    EXPECT_EQ(read_number(wire_number(position_mm)), position_mm);
    EXPECT_LE(digits(wire_number(position_mm)), 16);
    EXPECT_EQ(read_number(wire_number(direction)), direction);
    EXPECT_LE(digits(wire_number(direction)), 16);
  }
}

TEST(IppNumbers, AnyDoubleTravelsInSixteenDigitsNearly) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-300, 9);
  for (int i = 0; i < 20000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, exponent(random));
    SCOPED_TRACE(value);
    const auto back = read_number(wire_number(value));
    ASSERT_TRUE(back.has_value()) << wire_number(value);
    EXPECT_NEAR(*back, value, 1e-14 * std::abs(value));
    EXPECT_LE(digits(wire_number(value)), 16);
  }
}

TEST(IppNumbers, SixteenCharactersHoldAnyNumberNearly) {
  std::mt19937_64 random(16);
  std::uniform_real_distribution<double> mantissa(-10.0, 10.0);
  for (int i = 0; i < 10'000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, i % 308 - 300);
    const std::string text = wire_number(value, NumberForm::kSixteenCharacters);
    ASSERT_LE(text.size(), 16U) << text;
    ASSERT_NEAR(read_number(text).value_or(0.0) / value, 1.0, 1e-8) << text;
  }
  EXPECT_EQ(wire_number(-999.12345678905, NumberForm::kSixteenCharacters), "-999.12345678905");
  EXPECT_EQ(wire_number(-0.7071067811865475, NumberForm::kSixteenCharacters), "-0.7071067811865");
}

TEST(IppNumbers, ReadsTheFormsOfTheGrammarAndNoOther) {
  EXPECT_EQ(read_number("+1."), 1.0);
  EXPECT_EQ(read_number(".5"), 0.5);
  EXPECT_EQ(read_number("-2.6E01"), -26.0);
  EXPECT_EQ(read_number("1e+003"), 1000.0);
  EXPECT_EQ(read_number("123456789.1234567"), 123456789.1234567);
  for (const char* text : {"",
                           "+",
                           ".",
                           "-.",
                           "+-1",
                           "1e",
                           "1e+",
                           "1e1234",
                           "1e999",
                           "1 ",
                           " 1",
                           "0x1",
                           "inf",
                           "nan",
                           "1.2.3",
                           "1,5",
                           "1.2345678901234567",
                           "e5",
                           "1e10",
                           "-1e155"}) {
    EXPECT_EQ(read_number(text), std::nullopt) << text;
  }
  EXPECT_EQ(read_number("1.2345678901234567", 20), 1.2345678901234567);
}

}  // namespace
}  // namespace rondure::cmm::ipp
