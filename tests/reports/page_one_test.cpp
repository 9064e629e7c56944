// Page one: digits, order, places and words of the call-outs, and what an empty head leaves to fill
// in.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "reports/html/report.h"
#include "reports/words/callouts.h"
#include "synthetic.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> ids_of(const std::vector<Callout>& callouts) {
  std::vector<std::string> out;
  for (const Callout& one : callouts) out.push_back(one.result->characteristic.id);
  return out;
}

/// The interval that the trials of a value of 8.3 um gave, `half_mm` wide to each side.
StatedValue with_interval(const StatedValue& value, double half_mm) {
  UncertaintyResult found;
  found.uncorrected_mm = value.value_mm();
  found.sampled.estimate_mm = value.value_mm();
  found.sampled.low_mm = value.value_mm() - half_mm;
  found.sampled.high_mm = value.value_mm() + half_mm;
  found.trials = 1000;
  return {"CYLt", value.value_mm(), value.value_operator(), UncertaintyStatus::stated(found, 0.95)};
}

TEST(Callouts, DigitsAreThoseOfUOrAHundredthOfTheTolerance) {
  for (const auto& [tolerance_mm, shown] : std::vector<std::pair<double, const char*>>{
           {0.010, "8.3"}, {0.009, "8.30"}, {0.100, "8"}, {0.99, "8"}, {1.5, "8"}}) {
    Case made = cylinder_case(4, 7, 1);
    made.evaluation.features[0].characteristics[0].characteristic.tolerance_mm = tolerance_mm;
    EXPECT_EQ(callouts_of(made.evaluation).at(0).value, shown) << tolerance_mm;
  }
  Case made = cylinder_case(4, 7, 1);
  auto& value = made.evaluation.features[0].characteristics[0].value;
  value.emplace(with_interval(*value, 0.00032));
  const Callout callout = callouts_of(made.evaluation).at(0);
  EXPECT_EQ(callout.value, "8.30");
  EXPECT_EQ(callout.expanded, "0.32");
}

TEST(Callouts, ALimitThatIsPassedIsSeenToBePassed) {
  Case made = cylinder_case(4, 7, 1);
  made.evaluation.features[0].characteristics[0].characteristic.tolerance_mm = 0.008299;
  const Callout callout = callouts_of(made.evaluation).at(0);
  EXPECT_EQ(callout.value, "8.300");
  EXPECT_EQ(callout.limit, "8.299");
  EXPECT_EQ(callout.deviation, "+0.001");
  EXPECT_EQ(callout.beyond, "0.001 µm");
}

TEST(Callouts, FailingOnesStandFirstThenThoseNearestToTheirLimit) {
  const Case made = drawing_case();
  const auto callouts = callouts_of(made.evaluation);
  // Shares by hand: cylindricity 8.3 of 10; mean size 3.5 of 8 off the middle; run-out 12.1 of 15;
  // flatness 2.9 of 4; perpendicularity 5.1 of 8. The envelope is 1.2 um beyond.
  EXPECT_THAT(ids_of(callouts),
              ::testing::ElementsAre("50h6 E", "cyl-A", "run-out", "flat", "square", "50h6 mean"));
  EXPECT_NEAR(callouts[1].share_1.value(), 0.83, 1e-12);
  EXPECT_NEAR(callouts[5].share_1.value(), 0.0035 / 0.008, 1e-9);
  EXPECT_EQ(callouts[0].symbol, "d GN / d LP SN");
  EXPECT_EQ(callouts[0].value, "50.0012 / 49.9931");
  EXPECT_EQ(callouts[0].limit, "49.984 … 50");
  EXPECT_EQ(callouts[0].deviation, "+0.0012");
  EXPECT_EQ(callouts[0].beyond, "1.2 µm");
  EXPECT_THAT(page_of(made), AllOf(HasSubstr("5 of 6 conform; "),
                                   HasSubstr(" is 1.2 µm over its limit of 50 mm.<")));
}

// Layers stand 16 mm apart, and the plan has the lowest at part z 12 mm.
TEST(Callouts, ThePlaceIsPartZAndTheAngleOfTheWorstPoint) {
  Case made = cylinder_case(4, 7, 1);
  FeatureResult& feature = made.evaluation.features[0];
  feature.poses.clear();  // the part stands as it is planned
  for (const bool known : {false, true}) {
    if (known) feature.feature.settings.push_back({"first_layer_mm", 12.0, ""});
    const Callout callout = callouts_of(made.evaluation).at(0);
    ASSERT_TRUE(callout.worst_row);
    const CloudPoint& point = feature.cloud.at(*callout.worst_row);
    EXPECT_TRUE(point.outer_contact);
    const std::string angle = std::to_string(std::lround(core::degrees(point.angle_rad))) + "°";
    EXPECT_EQ(callout.place,
              known ? std::to_string(12 + 16 * point.layer) + ".0 mm, " + angle : angle);
  }
}

TEST(PageOne, LeavesLinesToFillInWhereTheHeadIsEmpty) {
  Case made = cylinder_case(4, 7, 1);
  const auto lines = [&] {
    const std::string page = page_of(made);
    const std::string head = page.substr(page.find("class=\"ident\""), page.find("</header>"));
    std::size_t number = 0;
    for (std::size_t at = head.find("class=\"fill\""); at < head.find("id=\"result\"");
         at = head.find("class=\"fill\"", at + 1))
      ++number;
    return number;
  };
  const std::size_t before = lines();
  made.record.header.operator_name.clear();
  made.record.header.serial.clear();
  EXPECT_EQ(lines(), before + 2);
}

TEST(PageOne, SaysWhoMeasuredForWhom) {
  Case made = cylinder_case(4, 7, 1);
  const auto add = [&](const std::string& name, const std::string& text) {
    made.record.settings.push_back({"head/" + name, std::nullopt, text});
  };
  add("order", "4711");
  add("customer", "<b>ACME</b>");
  add("laboratory", "Form room");
  add("country", "DE");
  add("logo", "data:image/png;base64,iVBORw0KGgo=");
  const std::string page = page_of(made);
  EXPECT_THAT(page, AllOf(HasSubstr("<dt>Order</dt><dd><bdi>4711</bdi></dd>"),
                          HasSubstr("<dd><bdi>&lt;b&gt;ACME&lt;/b&gt;</bdi></dd>"),
                          HasSubstr("<b><bdi>Form room</bdi></b><br/><bdi>DE</bdi>"),
                          HasSubstr(R"(<img src="data:image/png;base64,iVBORw0KGgo=" alt=""/>)")));
  for (const char* hostile :
       {"https://example.org/x.png", "data:image/svg+xml;base64,PHN2Zz4=", "javascript:alert(1)"}) {
    made.record.settings.back().text = hostile;
    EXPECT_THAT(page_of(made), Not(HasSubstr("<img "))) << hostile;
  }
  made.record.settings.back().text = "data:image/png;base64,\"onerror=\"alert(1)";
  EXPECT_THAT(page_of(made), Not(HasSubstr("\"onerror")));
}

TEST(PageOne, EverySheetSaysSimulatedAndIncomplete) {
  EXPECT_THAT(page_of(cylinder_case(4, 7, 1)),
              AllOf(HasSubstr("SIMULATED"), Not(HasSubstr("INCOMPLETE"))));
  EXPECT_THAT(page_of(unfinished_case()), HasSubstr("SIMULATED · INCOMPLETE"));
  EXPECT_THAT(page_of(circle_case(60)), Not(HasSubstr("SIMULATED")));
}

TEST(PageOne, NamesWhatItRestsOnInFourLines) {
  const std::string page = page_of(cylinder_case(4, 7, 1));
  EXPECT_THAT(page,
              AllOf(HasSubstr("<dt>Measured</dt><dd><bdi>4 x 7 points, 3 touches each</bdi> "
                              "(<bdi>land-A</bdi>)"),
                    HasSubstr("<dt>Rule</dt>"), HasSubstr("Without U: no uncertainty is stated"),
                    HasSubstr("<dt>Not seen</dt><dd>the surface between the points")));
}

TEST(PageOne, CallOutsThatConformAreFoldedUnlessAllIsOpen) {
  const Case made = failing_case();
  const std::string page = page_of(made);
  const std::size_t fold = page.find("<details class=\"fold\">");
  ASSERT_NE(fold, std::string::npos);
  EXPECT_LT(page.find("<h3><bdi>cyl-A</bdi>"), fold);
  EXPECT_GT(page.find("<h3><bdi>round-A</bdi>"), fold);
  EXPECT_FALSE(edition_of_page(page).detail);
  const Edition open(Language::kChinese, true);
  const std::string all = write_html(made.record, made.evaluation, open);
  EXPECT_EQ(edition_of_page(all), open);
  EXPECT_THAT(all, AllOf(HasSubstr("<details class=\"fold\" open=\"open\">"),
                         Not(HasSubstr("<details class=\"fold\">"))));
  EXPECT_EQ(testing::first_unbalanced_tag(all), "");
}

TEST(PageOne, SaysTheProbabilityOfUAndTheNameOnTheDrawing) {
  Case made = cylinder_case(4, 7, 1);
  auto& result = made.evaluation.features[0].characteristics[0];
  EXPECT_THAT(page_of(made), HasSubstr(">U</th>"));
  result.value.emplace(with_interval(*result.value, 0.00032));
  result.characteristic.id = "28h6";
  const std::string page = page_of(made);
  EXPECT_THAT(page, AllOf(HasSubstr(">U, 95 %</th>"), HasSubstr("<small><bdi>28h6</bdi></small>")));
  result.characteristic.id = "CYLt 10";  // what frame and symbol say already
  EXPECT_THAT(page_of(made), Not(HasSubstr("<small><bdi>CYLt 10")));
}

TEST(PageOne, SaysWhichTemperatureCounted) {
  Case made = cylinder_case(4, 7, 1);
  made.evaluation.features[0].temperatures = Temperatures{20.3, 20.3, 20.3, false};
  EXPECT_THAT(page_of(made), HasSubstr("<dt>Temperature</dt><dd>20.3 °C</dd>"));
  made.record.settings.push_back({"environment/assumed_degC", 20.5, ""});
  EXPECT_THAT(page_of(made), HasSubstr("20.3 °C measured; 20.5 °C of the plan not used"));
  made.evaluation.features[0].temperatures->declared = true;
  EXPECT_THAT(page_of(made), HasSubstr("20.3 °C, declared, not measured"));
}

// Layers stand 16 mm apart from part z 12 mm on: nobody looked below 12 and above 60 mm.
TEST(PageOne, NamesTheHeightsBeyondWhichNothingWasSeen) {
  Case made = cylinder_case(4, 7, 1);
  FeatureResult& feature = made.evaluation.features[0];
  feature.poses.clear();
  EXPECT_THAT(page_of(made), Not(HasSubstr("outside these part z")));
  feature.feature.settings.push_back({"first_layer_mm", 12.0, ""});
  EXPECT_THAT(page_of(made), HasSubstr("all outside these part z: <bdi>" + feature.feature.id +
                                       "</bdi> 12.0 … 60.0 mm"));
}

TEST(PageOne, ThePictureOfASizeOrAFilteredValueClaimsNoMoreThanItShows) {
  Case made = cylinder_case(4, 7, 1);
  auto& result = made.evaluation.features[0].characteristics[0];
  EXPECT_THAT(page_of(made),
              AllOf(HasSubstr(": where it is worst</h3>"), HasSubstr("as read, unfiltered")));
  Finding finding;
  finding.filter = core::phrase("gaussian {} UPR", "50");
  finding.rows = {0};
  finding.judged = {{"CYLt", result.value->value_mm(), {}}};
  result.finding = std::make_shared<const Finding>(finding);
  EXPECT_THAT(page_of(made), Not(HasSubstr(">gaussian 50 UPR</text>")));
  result.characteristic.form = record::Form::kDiameter;
  result.characteristic.id = "28h6";
  EXPECT_THAT(page_of(made),
              AllOf(HasSubstr(": form of the section where the size is worst</h3>"),
                    HasSubstr("<bdi>28h6</bdi> of "), Not(HasSubstr(": where it is worst</h3>"))));
}

}  // namespace
}  // namespace rondure::reports
