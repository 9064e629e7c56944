#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/sha.h>
#include <pugixml.hpp>

#include "synthetic.h"
#include "tests/core/processor_time.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using testing::first_unbalanced_tag;
using testing::shows_nan;

bool holds(std::string_view page, std::string_view part) {
  return page.find(part) != std::string_view::npos;
}

std::size_t occurrences(std::string_view text, std::string_view part) {
  std::size_t number = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos;
       at = text.find(part, at + 1)) {
    ++number;
  }
  return number;
}

/// The inside of the drawing with this label.
std::string drawing(std::string_view page, std::string_view label) {
  const std::size_t at = std::min(page.find(label), page.size());
  return std::string(page.substr(at, page.find("</svg>", at) - at));
}

/// Set RONDURE_KEEP to a folder to look at the pages.
void keep(const std::string& name, const std::string& page) {
  if (const char* folder = std::getenv("RONDURE_KEEP")) {
    std::ofstream(std::filesystem::path(folder) / (name + ".html"), std::ios::binary) << page;
  }
}

TEST(Html, PagesOfAllKindsAreBalanced) {
  const std::array<std::pair<const char*, Case>, 10> cases = {
      {{"conforms", cylinder_case(4, 7, 3)},
       {"refined", cylinder_case(4, 7, 150)},
       {"fails", failing_case()},
       {"circle", circle_case(500)},
       {"unfinished", unfinished_case()},
       {"hostile", hostile_case("<script>alert('x')</script> \"quoted\" & 圆柱度 \u202Eabc")},
       {"dense", cylinder_case(12, 360, 8)},
       {"spiral", spiral_case(150)},
       {"long-spiral", spiral_case(20000)},
       {"middle", cylinder_case(6, 48, 1)}}};
  for (const auto& [name, made] : cases) {
    SCOPED_TRACE(name);
    const std::string page = page_of(made);
    keep(name, page);
    EXPECT_EQ(first_unbalanced_tag(page), "");
    EXPECT_FALSE(shows_nan(page));
    EXPECT_FALSE(holds(page, "\"inf"));
  }
}

TEST(Html, TheBalanceCheckSeesAnUnclosedTag) {
  EXPECT_EQ(first_unbalanced_tag("<p><b>x</p>"), "/p");
  EXPECT_EQ(first_unbalanced_tag("<p>x"), "p");
  EXPECT_EQ(first_unbalanced_tag("<p title=\"<\">x</p>"), "< inside p");
  EXPECT_EQ(first_unbalanced_tag("<p>x<br>y<i/></p>"), "");
}

TEST(Html, LoadsNothing) {
  for (const Case& made : {cylinder_case(4, 7, 3), circle_case(500), unfinished_case()}) {
    const std::string page = page_of(made);
    for (const char* part :
         {"http://", "https://", "url(", "@import", "<link", "<img", "src=", "import("}) {
      EXPECT_FALSE(holds(page, part)) << part;
    }
    EXPECT_EQ(occurrences(page, "href="), occurrences(page, "href=\"#"));
  }
}

TEST(Html, RunsOneScriptAndThePolicyNamesItsDigest) {
  const std::string page = page_of(cylinder_case(4, 7, 3));
  ASSERT_EQ(occurrences(page, "<script>"), 1U);
  ASSERT_EQ(occurrences(page, "<script"), 1U);
  const std::size_t from = page.find("<script>") + 8;
  const std::string script = page.substr(from, page.find("</script>") - from);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(script.data()), script.size(), digest.data());
  std::array<unsigned char, 64> base64{};
  EVP_EncodeBlock(base64.data(), digest.data(), static_cast<int>(digest.size()));
  const std::string text(reinterpret_cast<const char*>(base64.data()));
  EXPECT_EQ(text.size(), 44U);
  EXPECT_TRUE(holds(page, "script-src 'sha256-" + text + "'"));
  EXPECT_LT(page.find("Content-Security-Policy"), page.find("<title>"));
}

TEST(Html, IsWellFormedXml) {
  for (const Case& made : {cylinder_case(4, 7, 3), circle_case(500), unfinished_case(),
                           hostile_case("<b>\"R&D' ]]> --> \x01\xff")}) {
    pugi::xml_document document;
    const auto read = document.load_string(page_of(made).c_str(), pugi::parse_full);
    EXPECT_TRUE(read) << read.description() << " at " << read.offset;
    EXPECT_TRUE(document.select_node("/html/body/main/section[@id='result']"));
  }
}

/// Ids of the page, and what points to them.
TEST(Html, ContentsPointToEveryPart) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(page_of(cylinder_case(4, 7, 3)).c_str(), pugi::parse_full));
  const auto parts = document.select_nodes("//main/section");
  const auto links = document.select_nodes("//nav//a");
  ASSERT_EQ(parts.size(), links.size());
  EXPECT_EQ(parts.size(), 5U);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(links[i].node().attribute("href").value(),
              "#" + std::string(parts[i].node().attribute("id").value()));
  }
}

TEST(Html, TheCylinderIsDrawnOnlyWhereThereIsOne) {
  EXPECT_TRUE(holds(page_of(cylinder_case(4, 7, 3)), "<figure class=\"solid\">"));
  EXPECT_TRUE(holds(page_of(spiral_case(150)), "<figure class=\"solid\">"));
  EXPECT_FALSE(holds(page_of(circle_case(500)), "<figure class=\"solid\">"));
  EXPECT_FALSE(holds(page_of(cylinder_case(1, 40, 3)), "<figure class=\"solid\">"));
}

TEST(Html, TheCylinderShowsEveryPointOnceAndStatesItsMagnification) {
  const std::string page = page_of(cylinder_case(4, 7, 3));
  const std::size_t from = page.find("<figure class=\"solid\">");
  const std::string figure = page.substr(from, page.find("</figure>", from) - from);
  EXPECT_EQ(occurrences(figure, "<circle class=\"disc\""), 22U);
  EXPECT_EQ(occurrences(figure, "<path class=\"outer\""), 3U);
  EXPECT_EQ(occurrences(figure, "<path class=\"inner\""), 3U);
  // 16 px for half of 8.3 um, against 112 px for 24.999... mm of the surface.
  EXPECT_TRUE(holds(figure, "magnified 861×"));
  EXPECT_TRUE(holds(figure, "heights, from the mean point, are to scale"));
}

TEST(Html, HostileNamesStayText) {
  for (const std::string& name :
       {std::string("<script>alert(1)</script>"), std::string("\"'><svg onload=alert(1)>"),
        std::string("</style></title><script>"), std::string("{0} {{}} %s"),
        std::string("\xff\xc3(\x01\x1b[31m"), std::string(10000, 'W'), std::string()}) {
    SCOPED_TRACE(name.substr(0, 40));
    const std::string page = page_of(hostile_case(name));
    EXPECT_EQ(first_unbalanced_tag(page), "");
    EXPECT_EQ(occurrences(page, "<script"), 1U);
    EXPECT_EQ(occurrences(page, "<svg onload"), 0U);
    EXPECT_EQ(occurrences(page, "</style>"), 1U);
    EXPECT_EQ(page.find('\x1b'), std::string::npos);
  }
}

TEST(Html, NamesAreShownAsTheyAreWritten) {
  const std::string page = page_of(hostile_case("<b>R&D</b> 圆柱度"));
  EXPECT_TRUE(holds(page, "<bdi>&lt;b&gt;R&amp;D&lt;/b&gt; 圆柱度</bdi>"));
}

TEST(Html, TheSameRecordGivesTheSameBytes) {
  EXPECT_EQ(page_of(cylinder_case(4, 7, 3)), page_of(cylinder_case(4, 7, 3)));
}

TEST(Html, VerdictStandsBeforeEverythingThatExplainsIt) {
  const std::string page = page_of(cylinder_case(4, 7, 3));
  const std::size_t verdict = page.find(">Conforms<");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_LT(verdict, page.find("<table"));
  EXPECT_LT(page.find("no real part was measured"), page.find("<table"));
  EXPECT_TRUE(holds(page, "no measurement uncertainty taken into account"));
  EXPECT_TRUE(holds(page, "<b class=\"value\">8.3</b>")) << "a hundredth of the tolerance";
}

TEST(Html, NonConformityIsSaidInWords) {
  const std::string page = page_of(failing_case());
  EXPECT_TRUE(holds(page, ">Does not conform<"));
  EXPECT_TRUE(holds(page, "2.300 µm above the limit"));
  EXPECT_TRUE(
      holds(page, "1 of 2 conforms; CYLt of <bdi>land-A</bdi> is 2.30 µm over its limit of 6 µm."));
}

TEST(Html, RadiiOfAnOutsideFeatureAreReducedByTheTip) {
  Case made = cylinder_case(4, 7, 3);
  EXPECT_TRUE(holds(page_of(made), "24.9959 mm"));
  made.evaluation.features[0].feature.side = record::Side::kInside;
  EXPECT_TRUE(holds(page_of(made), "27.9931 mm"));
  made.evaluation.features[0].tip_radius_mm.reset();
  EXPECT_TRUE(holds(page_of(made), "26.4945 mm"));
  EXPECT_TRUE(holds(page_of(made), "the tip radius is unknown"));
}

TEST(Html, HiddenTruthIsSetApartFromTheMeasurement) {
  Case made = cylinder_case(4, 7, 3);
  EXPECT_FALSE(holds(page_of(made), "truth of the simulation"));
  auto& result = made.evaluation.features.front().characteristics.front();
  result.truths_mm = {result.value->quoted_mm() - 0.049e-3};
  const std::string page = page_of(made);
  EXPECT_TRUE(holds(page, "Held against the truth of the simulation"));
  EXPECT_TRUE(holds(page, "+0.049 µm"));
  EXPECT_TRUE(holds(page, "No verdict uses it."));
}

TEST(Html, UnfinishedRunSaysSoAboveTheVerdict) {
  const std::string page = page_of(unfinished_case());
  const std::size_t said = page.find("This run did not finish.");
  ASSERT_NE(said, std::string::npos);
  EXPECT_LT(said, page.find(">Void<"));
  EXPECT_TRUE(holds(page, "The probe met something 3.1 mm before its target."));
  EXPECT_TRUE(holds(page, "Feature bore-B has no result."));
  EXPECT_TRUE(holds(page, "No cloud of a final pose is on record."));
  EXPECT_FALSE(holds(page_of(cylinder_case(4, 7, 3)), "did not finish"));
}

TEST(Html, LongPoseTableKeepsBothEndsAndSaysWhatIsLeftOut) {
  const std::string page = page_of(cylinder_case(4, 7, 150));
  EXPECT_TRUE(holds(page, "130 poses left out"));
  EXPECT_TRUE(holds(page, "130 of 150 poses were left out here"));
  EXPECT_FALSE(holds(page_of(cylinder_case(4, 7, 40)), "left out"));
}

TEST(Html, EveryContactIsMarkedInTheSections) {
  const std::string page = page_of(cylinder_case(4, 7, 3));
  const std::size_t from = page.find("<div class=\"multiples");
  const std::string sections = page.substr(from, page.find("<figure class=\"solid\">") - from);
  EXPECT_EQ(occurrences(sections, "<path class=\"outer\""), 3U);
  EXPECT_EQ(occurrences(sections, "<rect class=\"inner\""), 3U);
  EXPECT_EQ(occurrences(sections, "<circle class=\"point\""), 22U);
}

TEST(Html, PointsOfManyHeightsAreNotJoinedByALine) {
  const std::string page = page_of(spiral_case(150));
  EXPECT_TRUE(holds(page, "All points, seen along the axis"));
  EXPECT_FALSE(holds(page, "<path class=\"profile\""));
  EXPECT_FALSE(holds(page, "guides the eye"));
  const std::string sections = page.substr(page.find("<div class=\"multiples"));
  EXPECT_EQ(occurrences(sections, "<circle class=\"point\""), 144U);
}

TEST(Html, SaysWhereTheReferenceSphereWasFound) {
  EXPECT_TRUE(holds(page_of(cylinder_case(4, 7, 3)),
                    "radius 12.500000 mm, found at (100.000000, 0.000000, 0.000000) mm"));
}

TEST(Html, TheMedianLineOfACoaxialityIsDrawnInItsZone) {
  Case made = drawing_case();
  CharacteristicResult& about_datum = made.evaluation.features[0].characteristics.back();
  Finding finding = *about_datum.finding;
  finding.centers_mm = {{0.0, 0.0, 0.0}, {0.002, 0.0, 20.0}, {0.001, 0.0, 40.0}};
  about_datum.finding = std::make_shared<const Finding>(finding);
  EXPECT_FALSE(holds(page_of(made), "limits of the zone")) << "of a run-out";
  about_datum.characteristic.form = record::Form::kCoaxiality;
  EXPECT_TRUE(holds(page_of(made), "limits of the zone"));
}

TEST(Html, AnglesRunAnticlockwiseInASection) {
  Case made = spiral_case(150);
  double angle_rad = 0.2;
  for (CloudPoint& point : made.evaluation.features[0].cloud) point.angle_rad = angle_rad += 0.005;
  const std::string section = drawing(page_of(made), "All points, seen along the axis: dev");
  int points = 0;
  for (std::size_t at = section.find("<circle class=\"point\""); at != std::string::npos;
       at = section.find("<circle class=\"point\"", at + 1)) {
    double x = 0.0, y = 0.0;
    std::sscanf(section.c_str() + at, "<circle class=\"point\" cx=\"%lf\" cy=\"%lf\"", &x, &y);
    EXPECT_TRUE(x > 160.0 && y < 160.0) << x << " " << y << " is not right above the centre";
    ++points;
  }
  EXPECT_EQ(points, 144);
}

TEST(Html, CellsOfTheMapReachAsFarDownAsUp) {
  const std::string map = drawing(page_of(spiral_case(4000)), "Deviations on the unrolled surface");
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;
  const std::size_t frame = map.find("<rect class=\"frame\"");
  ASSERT_NE(frame, std::string::npos);
  std::sscanf(map.c_str() + frame,
              "<rect class=\"frame\" x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &left, &top,
              &width, &height);
  double above = height;
  double below = height;
  for (std::size_t at = map.find("<rect class=\"swatch\""); at != std::string::npos;
       at = map.find("<rect class=\"swatch\"", at + 1)) {
    double x = 0.0, y = 0.0, wide = 0.0, high = 0.0;
    std::sscanf(map.c_str() + at,
                "<rect class=\"swatch\" x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x, &y,
                &wide, &high);
    if (x > left + width) continue;  // the bar of the colours
    above = std::min(above, y - top);
    below = std::min(below, top + height - y - high);
  }
  EXPECT_LT(above, height);
  EXPECT_NEAR(above, below, 0.3);
}

TEST(Html, AFeatureWithoutZoneHasNoDrawings) {
  Case made = cylinder_case(4, 7, 3);
  made.evaluation.features[0].mz_cylinder.reset();
  EXPECT_FALSE(holds(page_of(made), "Unrolled"));
  EXPECT_EQ(first_unbalanced_tag(page_of(made)), "");
}

TEST(Html, AZoneOfNoWidthAndPosesWithoutValueAreDrawn) {
  Case made = cylinder_case(2, 3, 4);
  evaluation::FeatureResult& feature = made.evaluation.features[0];
  feature.mz_cylinder->inner_radius_mm = feature.mz_cylinder->outer_radius_mm;
  for (evaluation::CloudPoint& point : feature.cloud) point.deviation_mm = 0.0;
  for (evaluation::PoseValue& pose : feature.poses) pose.valid = false;
  const std::string page = page_of(made);
  EXPECT_EQ(first_unbalanced_tag(page), "");
  EXPECT_FALSE(shows_nan(page));
}

#ifdef __SANITIZE_ADDRESS__
constexpr double kSlower = 30.0;  // under the sanitizers, which are no measure of time
#else
constexpr double kSlower = 1.0;
#endif

/// Writes a page three times and holds its size and its best time against the figures.
void expect_small_and_quick(const std::string& name, const Case& made, std::size_t most_bytes,
                            double most_s) {
  std::string page;
  double best_s = 1e9;
  for (int i = 0; i < 3; ++i) {
    const double start_s = test::processor_seconds();
    page = page_of(made);
    best_s = std::min(best_s, test::processor_seconds() - start_s);
  }
  keep(name, page);
  std::printf("%s: %zu points, %zu bytes, %.1f ms\n", name.c_str(),
              made.evaluation.features[0].cloud.size(), page.size(), 1e3 * best_s);
  EXPECT_LT(page.size(), most_bytes);
  EXPECT_LT(best_s, most_s * kSlower);
}

TEST(Html, APageIsSmallAndWrittenAtOnce) {
  expect_small_and_quick("touches", cylinder_case(4, 7, 3), 1'000'000, 0.05);
  expect_small_and_quick("layers", cylinder_case(100, 1000, 3), 5'000'000, 0.5);
  expect_small_and_quick("section", cylinder_case(1, 100000, 3), 5'000'000, 0.5);
  expect_small_and_quick("spiral", spiral_case(100000), 5'000'000, 0.5);
}

}  // namespace
}  // namespace rondure::reports
