// The file that says whose reports a plan writes: what of it is taken, and what is refused before
// anything is measured.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base64.h"
#include "plans/checks/laboratory.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::lines_of;
using ::testing::StartsWith;

const std::string kPng = "\x89PNG\r\n\x1a\n and so on";

class LaboratoryOfAPlan : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

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
                      folder_, "plan.json");
  }
  [[nodiscard]] std::string refusal_of(const std::string& laboratory) const {
    write("lab.json", laboratory);
    return lines_of(plan());
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(LaboratoryOfAPlan, IsTakenWithItsLogo) {
  write("logo.png", kPng);
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
  EXPECT_EQ(found->logo, "data:image/png;base64,iVBORw0KGgogYW5kIHNvIG9u");
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
  write("logo", kPng + std::string(256 * 1024, ' '));
  EXPECT_THAT(refusal_of(laboratory), HasSubstr("262144"));
  write("logo", "\xFF\xD8\xFF\xE0 JFIF");
  EXPECT_EQ(refusal_of(laboratory), "");
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
