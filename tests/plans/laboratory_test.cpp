// The file that says whose reports a plan writes: what of it is taken, and what is refused before
// anything is measured.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/crc.hpp>

#include "core/encodings.h"
#include "plans/checks/laboratory.h"
#include "tests/core/scratch.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::lines_of;
using ::testing::StartsWith;

/// Bytes as a whole number, the highest first.
std::string number(std::size_t value, int count) {
  std::string out;
  for (int i = count - 1; i >= 0; --i) out += static_cast<char>(value >> (8 * i));
  return out;
}

std::string chunk(const std::string& name, const std::string& data) {
  boost::crc_32_type check;
  check.process_bytes((name + data).data(), name.size() + data.size());
  return number(data.size(), 4) + name + data + number(check.checksum(), 4);
}

/// A grey PNG; its picture is that of one pixel, whatever its head says.
std::string png(std::size_t width, std::size_t height) {
  const std::string pixel("\x78\x9c\x63\x60\x00\x00\x00\x02\x00\x01", 10);
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", number(width, 4) + number(height, 4) + std::string("\x08\0\0\0\0", 5)) +
         chunk("IDAT", pixel) + chunk("IEND", "");
}

/// A grey JPEG: frame, scan, end.
std::string jpeg(std::size_t width, std::size_t height) {
  return "\xFF\xD8\xFF\xC0" + number(11, 2) + "\x08" + number(height, 2) + number(width, 2) +
         "\x01\x01\x11" + number(0, 1) + "\xFF\xDA" + number(8, 2) +
         std::string("\x01\x01\0\0\x3F\0\x2A", 7) + "\xFF\xD9";
}

class LaboratoryOfAPlan : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  /// A plan that names lab.json.
  [[nodiscard]] PlanOrProblems plan() const {
    return parse_plan(R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},
        "machine": {}, "fixture": {}, "probe": {}, "simulation": {},
        "features": [{"id": "f", "type": "cylinder",
                      "nominal": {"diameter_mm": 50, "from_mm": -40, "to_mm": 40}}],
        "reports": {"laboratory": "lab.json"}})",
                      folder_.path(), "plan.json");
  }
  [[nodiscard]] std::string refusal_of(const std::string& laboratory) const {
    write("lab.json", laboratory);
    return lines_of(plan());
  }

 private:
  test::Scratch folder_;
};

TEST_F(LaboratoryOfAPlan, IsTakenWithItsLogo) {
  write("logo.png", png(1, 1));
  write("lab.json", R"({"name": "Form room", "address": "Hall 4", "country": "DE",
                        "contact": "form@example.org", "logo": "logo.png"})");
  const PlanOrProblems read = plan();
  ASSERT_EQ(lines_of(read), "");
  const auto found = laboratory_of(*read);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->laboratory, "Form room");
  EXPECT_EQ(found->address, "Hall 4");
  EXPECT_EQ(found->country, "DE");
  EXPECT_EQ(found->contact, "form@example.org");
  EXPECT_EQ(found->logo, "data:image/png;base64," + core::base64(png(1, 1)));
  EXPECT_EQ(found->order, std::nullopt);
}

TEST_F(LaboratoryOfAPlan, IsRefusedAtItsPlaceWithTheKeyOfItsFile) {
  EXPECT_THAT(lines_of(plan()), AllOf(StartsWith("/reports/laboratory: "), HasSubstr("\"lab.json\" "
                                                                                     "does not")));
  EXPECT_THAT(refusal_of("{}"), AllOf(HasSubstr("/reports/laboratory: \"lab.json\": /name: ")));
  EXPECT_THAT(refusal_of(R"({"name": "a", "adress": "b"})"), HasSubstr("/adress: "));
  EXPECT_THAT(refusal_of("{\"name\": \n"), HasSubstr("/reports/laboratory: lab.json:2:1"));
  EXPECT_THAT(refusal_of("{\"name\": \"a\\u001b[2J\"}"), HasSubstr("no report can show"));
}

TEST_F(LaboratoryOfAPlan, ItsLogoIsAPictureOfLimitedSize) {
  const std::string laboratory = R"({"name": "a", "logo": "logo"})";
  EXPECT_THAT(refusal_of(laboratory), HasSubstr("\"logo\" does not exist"));
  write("logo", "<svg onload='alert(1)'/>");
  EXPECT_THAT(refusal_of(laboratory), HasSubstr("neither a PNG nor a JPEG"));
  write("logo", png(1, 1) + std::string(256 * 1024, ' '));
  EXPECT_THAT(refusal_of(laboratory), HasSubstr("262144"));
  for (const auto& picture : {png, jpeg}) {
    const std::string good = picture(4000, 1);
    write("logo", good);
    EXPECT_EQ(refusal_of(laboratory), "");
    write("logo", picture(1, 4001));
    EXPECT_THAT(refusal_of(laboratory),
                HasSubstr("has 1 x 4001 pixels, a side may have 1 to 4000"));
    write("logo", picture(0, 1));
    EXPECT_THAT(refusal_of(laboratory), HasSubstr("has 0 x 1 pixels"));
    for (const std::string& damaged :
         {good.substr(0, good.size() - 1), good.substr(0, 12), good + "<svg/>"}) {
      write("logo", damaged);
      EXPECT_THAT(refusal_of(laboratory), HasSubstr("is a damaged "));
    }
  }
  std::string flipped = png(1, 1);
  flipped[20] = static_cast<char>(flipped[20] ^ 1);
  write("logo", flipped);
  EXPECT_THAT(refusal_of(laboratory), HasSubstr("\"logo\" is a damaged PNG file"));
}

// Page one shows its words in lines beside others.
TEST_F(LaboratoryOfAPlan, ItsWordsFitALineAndReorderNothing) {
  for (const std::string key : {"name", "address", "country", "contact"}) {
    const auto told = [&](const std::string& value) {
      const std::string name = key == "name" ? "" : R"("name": "a", )";
      return refusal_of("{" + name + "\"" + key + "\": \"" + value + "\"}");
    };
    EXPECT_THAT(told("A\u202EB"), AllOf(HasSubstr("\"lab.json\": /" + key + ": "),
                                        HasSubstr("contains the character U+202E")));
    EXPECT_THAT(told("A\\nB"), HasSubstr("U+000A"));
    EXPECT_THAT(told(std::string(201, 'x')), HasSubstr("has 201 characters, the limit is 200"));
    EXPECT_EQ(told("\u0645\u06CC\u200C\u0634\u0648\u062F"), "") << "a joiner of Persian";
  }
}

// RFC 4648, section 10.
TEST(Base64, OfTheVectorsOfItsStandard) {
  EXPECT_EQ(core::base64(""), "");
  EXPECT_EQ(core::base64("f"), "Zg==");
  EXPECT_EQ(core::base64("fo"), "Zm8=");
  EXPECT_EQ(core::base64("foo"), "Zm9v");
  EXPECT_EQ(core::base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace rondure::plans
