#include "core/phrase.h"

#include <limits>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/result.h"

namespace rondure::core {
namespace {

TEST(Phrase, InEnglishIsWhatTheFormatMakesOfItsArguments) {
  const double inf = std::numeric_limits<double>::infinity();
  const double small = 1.0 / 3.0;
  EXPECT_EQ(phrase("{:.3f} of {:g}, {:.4g} and {}: {} {} {}", small, 12.0, inf, -3, 7U, "name",
                   std::string("text")),
            fmt::format("{:.3f} of {:g}, {:.4g} and {}: {} {} {}", small, 12.0, inf, -3, 7U, "name",
                        "text"));
  EXPECT_EQ(phrase("{1} of {0}", std::size_t{9}, 2), "2 of 9");
}

TEST(Phrase, HoldsItsPartsAsData) {
  const Phrase inner = phrase("{} um", 5);
  const Phrase outer = phrase("layer {}: {}", 2, inner);
  EXPECT_EQ(outer.format(), "layer {}: {}");
  ASSERT_EQ(outer.arguments().size(), 2U);
  EXPECT_EQ(std::get<Phrase>(outer.arguments()[1].value), inner);
  EXPECT_EQ(outer, "layer 2: 5 um");
  EXPECT_EQ(joined(outer, phrase("scanned")), "layer 2: 5 um; scanned");
  EXPECT_EQ(joined(Phrase(), inner), inner);
  EXPECT_EQ(joined(inner, Phrase()), inner);
  EXPECT_TRUE(as_it_is("").empty());
}

TEST(Phrase, ABraceOfATextIsABrace) {
  EXPECT_EQ(Phrase("{} {0} {{"), "{} {0} {{");
  EXPECT_EQ(phrase("part {}", "{0} {"), "part {0} {");
  EXPECT_EQ(phrase("{}: {}", Phrase("{x}"), as_it_is("{}")), "{x}: {}");
}

TEST(Phrase, IsKeptByTheErrorThatItMakes) {
  const Result<int> failed = fail(Code::kMeaning, phrase("{} of {} touches", 3, 7), "/probe");
  EXPECT_EQ(failed.error(), (Error{Code::kMeaning, "3 of 7 touches", "/probe"}));
  EXPECT_EQ(failed.error().at("/other").said().format(), "{} of {} touches");
  Error longer = failed.error();
  longer.what += "; touch again";
  EXPECT_EQ(longer.said(), "3 of 7 touches; touch again");
  const Error text{Code::kMeaning, "3 of 7 touches", {}};
  EXPECT_EQ(text.said(), "3 of 7 touches");
  EXPECT_TRUE(text.said().arguments().empty());
}

}  // namespace
}  // namespace rondure::core
