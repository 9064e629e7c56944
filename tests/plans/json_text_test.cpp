#include "plans/schema/json_text.h"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "plans/key_spec.h"

namespace rondure::plans {
namespace {

std::string place_of_error(const std::string& text) {
  const auto json = parse_json(text, "p.json");
  return json ? "none" : json.error().where;
}

TEST(JsonText, ASyntaxErrorNamesLineAndColumnInCharacters) {
  EXPECT_EQ(place_of_error("{\n  \"a\": nil\n}"), "p.json:2:9");  // where "nil" departs from "null"
  EXPECT_EQ(place_of_error("{\n\n  x}"), "p.json:3:3");
  EXPECT_EQ(place_of_error("{\"\xC3\xA4\": x}"), "p.json:1:7");  // a-umlaut is one column
  EXPECT_EQ(place_of_error("\xEF\xBB\xBF{x}"), "p.json:1:2");    // a byte order mark is none
  EXPECT_EQ(place_of_error("{\"a\": 1"), "p.json:1:8");
  EXPECT_EQ(place_of_error("{\"a\": \"\xFF\"}"), "p.json:1:8");
  EXPECT_EQ(place_of_error("{} {}"), "p.json:1:4");
}

TEST(JsonText, WhatIsNotAFiniteNumberIsRefusedInEverySpelling) {
  for (const char* word : {"NaN", "nan", "-NaN", "Infinity", "-Infinity", "inf", "+1", ".5", "1.",
                           "01", "0x10", "1e999", "-1e999", "1,5"}) {
    EXPECT_NE(place_of_error(std::string("{\"a\": ") + word + "}"), "none") << word;
  }
}

TEST(JsonText, MembersKeepTheirOrderAndRepetition) {
  const auto json = parse_json(R"({"b": 1, "a": [true, null], "b": "x"})", "p.json");
  ASSERT_TRUE(json);
  ASSERT_EQ(json->members.size(), 3U);
  EXPECT_EQ(json->members[0].key, "b");
  EXPECT_EQ(json->members[2].key, "b");
  EXPECT_EQ(json->find("b")->number, 1.0);
  EXPECT_EQ(json->find("a")->items.size(), 2U);
  EXPECT_LT(json->members[0].value.order, json->members[1].value.order);
  EXPECT_LT(json->members[1].value.items[1].order, json->members[2].value.order);
}

TEST(JsonText, QuotedTextIsOneShortLineCutBetweenCharacters) {
  EXPECT_EQ(in_quotes("a\nb\x01"), "\"a\\nb\\u0001\"");
  std::string long_text;
  for (int i = 0; i < 59; ++i) long_text += 'x';
  EXPECT_EQ(in_quotes(long_text + "\xC3\xA4"), "\"" + long_text + "...\"");
}

TEST(JsonText, QuotesAndPointersHoldNothingThatATerminalObeys) {
  EXPECT_EQ(in_quotes("a\x1b[2J\x7f\u009b31m\uFFFE\xff"),
            R"("a\u001b[2J\u007f\u009b31m\ufffe\xff")");
  EXPECT_EQ(member_pointer("", "\u009b/~"), R"(/\u009b~1~0)");
}

TEST(Utf8, NoncharactersAndControlCharactersAreFound) {
  for (const char* good : {"", "圆柱度\n\tµ \u00A0", "\U0001F600\uFFFD\uFDCF\uFDF0"}) {
    EXPECT_EQ(first_unshowable(good), std::string_view(good).size());
  }
  for (const auto& [text, words] :
       {std::pair("ab\x1b", "the character U+001B"), std::pair("ab\x7f", "the character U+007F"),
        std::pair("ab\u0085", "the character U+0085"),
        std::pair("ab\uFDD0", "the character U+FDD0"),
        std::pair("ab\uFFFE", "the character U+FFFE"),
        std::pair("ab\U0001FFFF", "the character U+1FFFF"), std::pair("ab\xff", "the byte 0xFF")}) {
    EXPECT_EQ(first_unshowable(text), 2U) << words;
    EXPECT_EQ(unshowable_in_words(text, 2), words);
  }
}

TEST(Utf8, WellFormedCharactersPassAndMalformedBytesAreFound) {
  EXPECT_EQ(first_not_utf8("a\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80"), 10U);
  constexpr std::array<const char*, 9> kMalformed = {
      "\x80", "\xC0\xAF", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF8\x88\x80\x80",
      "\xC3", "\xE2\x82", "\xF0\x9F\x98"};
  for (const char* bytes : kMalformed) EXPECT_EQ(first_not_utf8(std::string("ab") + bytes), 2U);
}

TEST(NearWords, ASlipFindsItsWordAndAForeignWordNone) {
  const std::vector<std::string_view> known = {"tolerance_um", "id", "form", "reference"};
  EXPECT_EQ(nearest_word("tolerence_um", known), "tolerance_um");
  EXPECT_EQ(nearest_word("Form", known), "form");
  EXPECT_EQ(nearest_word("from", known), "form");
  EXPECT_EQ(nearest_word("operator", known), "");
  EXPECT_EQ(nearest_word(std::string(100'000, 'x'), known), "");
}

TEST(NearWords, AWordOfTheTradeFindsThatOfThePlan) {
  const std::vector<std::string_view> forms = {"cylindricity", "roundness", "run-out",
                                               "total-run-out", "perpendicularity"};
  EXPECT_EQ(nearest_word("circularity", forms), "roundness");
  EXPECT_EQ(nearest_word("runout", forms), "run-out");
  EXPECT_EQ(nearest_word("Total Runout", forms), "total-run-out");
  EXPECT_EQ(nearest_word("squareness", forms), "perpendicularity");
  EXPECT_EQ(nearest_word("Least squares", {"mz", "ls"}), "ls");
  // A word has its meaning where it is one of those that are known there.
  EXPECT_EQ(nearest_word("bore", {"outside", "inside"}), "inside");
  EXPECT_EQ(nearest_word("bore", {"plane", "cylinder"}), "cylinder");
  EXPECT_EQ(nearest_word("bore", forms), "");
}

TEST(KeySpec, TheUnitIsTheSuffixOfTheKey) {
  EXPECT_EQ(unit_of("touch_speed_mm_s"), "mm/s");
  EXPECT_EQ(unit_of("min_degC"), "degC");
  EXPECT_EQ(unit_of("layers"), "");
  EXPECT_EQ(stem_of("diameter_um"), stem_of("diameter_mm"));
  EXPECT_EQ(stem_of("diameter_inch"), "diameter");
}

}  // namespace
}  // namespace rondure::plans
