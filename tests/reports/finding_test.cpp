// What a drawing asks beside unfiltered peak-to-valley form, in each file and on the terminal.

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "core/units.h"
#include "evaluation/factors/study.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "reports/data/qif/report.h"
#include "reports/data/writers.h"
#include "reports/formats/exports.h"
#include "reports/history/archive_entry.h"
#include "reports/html/report.h"
#include "reports/terminal/internal/columns.h"
#include "reports/terminal/summary.h"
#include "reports/verify/stored_results.h"
#include "tests/reports/page_text.h"
#include "tests/reports/synthetic.h"

namespace rondure::reports {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// "/features/0/characteristics/1/..." of the drawing.
ordered_json characteristic(int feature, int number) {
  const Case made = drawing_case();
  return ordered_json::parse(
      write_json(made.record, made.evaluation))["features"][feature]["characteristics"][number];
}

TEST(FindingJson, OfASizeHasBothLimitsAndItsUnit) {
  const ordered_json envelope = characteristic(0, 1);
  EXPECT_EQ(envelope["symbol"], "d E");
  EXPECT_EQ(envelope["unit"], "mm");
  EXPECT_TRUE(envelope["tolerance_um"].is_null());
  EXPECT_EQ(envelope["lower_limit_mm"], 49.984);
  EXPECT_EQ(envelope["upper_limit_mm"], 50.0);
  const ordered_json& judged = envelope["finding"]["judged"];
  ASSERT_EQ(judged.size(), 2U);
  EXPECT_EQ(judged[1]["symbol"], "d LP SN");
  EXPECT_EQ(judged[1]["value_mm"], 49.9931);
  EXPECT_EQ(judged[1]["lower_limit_mm"], 49.984);
  EXPECT_TRUE(judged[1]["upper_limit_mm"].is_null());
}

TEST(FindingJson, HasEverySectionAndWhyOneHasNone) {
  const ordered_json finding = characteristic(0, 2)["finding"];
  ASSERT_EQ(finding["local"].size(), 4U);
  EXPECT_EQ(finding["local"][1]["height_mm"], 15.0);
  EXPECT_NEAR(finding["local"][1]["value_mm"].get<double>(), 49.9959, 1e-12);
  EXPECT_TRUE(finding["local"][2]["value_mm"].is_null());
  EXPECT_EQ(finding["local"][2]["none"]["code"], "sparse");
  EXPECT_EQ(finding["worst"], 0);
  EXPECT_EQ(finding["numbers"][0]["value_mm"], 49.9958);
  EXPECT_EQ(finding["numbers"][1]["value"], 12.0);
  EXPECT_EQ(finding["left_out"][0]["window"], "keyway");
  EXPECT_EQ(finding["left_out"][2]["because"], "outlier rule");
}

TEST(FindingJson, NamesDatumsFilterAndTheEqualisedValue) {
  const ordered_json turns = characteristic(0, 3);
  EXPECT_EQ(turns["symbol"], "Run-out radial");
  EXPECT_FALSE(turns.contains("unit"));
  EXPECT_EQ(turns["tolerance_um"], 15.0);
  EXPECT_EQ(turns["datum"][0], "A-B");
  EXPECT_EQ(turns["filter"]["cutoff_upr"], 50.0);
  const ordered_json& datum = turns["finding"]["datums"][0];
  EXPECT_EQ(datum["association"], "one-sided");
  EXPECT_EQ(datum["features"], ordered_json({0, 1}));
  EXPECT_NEAR(datum["play_um"].get<double>(), 7.8, 1e-12);
  EXPECT_EQ(datum["equalised"]["point_mm"][0], 0.001);
  EXPECT_NEAR(turns["finding"]["about_equalised_um"][0].get<double>(), 11.3, 1e-12);
}

TEST(FindingJson, LeavesACharacteristicWithoutOneAsItWas) {
  for (const char* key : {"unit", "lower_limit_mm", "datum", "filter", "finding"}) {
    EXPECT_FALSE(characteristic(0, 0).contains(key)) << key;
  }
}

TEST(FindingJson, IsStoredForVerifyButForTheGeneratrices) {
  const auto stored = stored_results(drawing_case().evaluation);
  const auto value = [&](const std::string& name) {
    const auto found = std::find_if(stored.begin(), stored.end(),
                                    [&](const auto& result) { return result.name == name; });
    return found == stored.end() ? std::nullopt : std::optional(found->value);
  };
  const std::string place = "/features/0/characteristics/";
  EXPECT_EQ(value(place + "2/finding/left_out/2/row"), 9.0);
  EXPECT_TRUE(value(place + "2/finding/local/3/value_mm"));
  EXPECT_TRUE(value(place + "3/finding/datums/0/play_um"));
  EXPECT_FALSE(value(place + "3/finding/lines/0/angle_deg"));
}

TEST(FindingCsv, LimitsOfSizesHaveColumnsWhereThereAreSizes) {
  const Case made = drawing_case();
  EXPECT_THAT(
      write_results_csv(made.record, made.evaluation),
      AllOf(HasSubstr("high_um,lower_limit_mm,upper_limit_mm\n"), HasSubstr(",d E,"),
            HasSubstr(",49.984,50\n"), Not(HasSubstr(",50000,")), HasSubstr(",15,conforms,")));
  const Case plain = cylinder_case(4, 7, 3);
  EXPECT_THAT(write_results_csv(plain.record, plain.evaluation), HasSubstr("high_um\n"));
}

TEST(FindingLimits, ReadBackAsInThePlan) {
  Case made = drawing_case();
  auto& results = made.evaluation.features[0].characteristics;
  results[1].characteristic.lower_mm = 25.4 - 13.0 * core::kMicrometre;
  results[3].characteristic.tolerance_mm = 9.0 * core::kMicrometre;
  ASSERT_NE(results[1].characteristic.lower_mm, 25.387);
  ASSERT_NE(1000.0 * *results[3].characteristic.tolerance_mm, 9.0);
  EXPECT_THAT(write_results_csv(made.record, made.evaluation),
              AllOf(HasSubstr(",25.387,50\n"), HasSubstr(",9,conforms,")));
  const auto document = ordered_json::parse(write_json(made.record, made.evaluation));
  const ordered_json& written = document["features"][0]["characteristics"];
  EXPECT_EQ(written[1]["lower_limit_mm"], 25.387);
  EXPECT_EQ(written[3]["tolerance_um"], 9.0);
}

TEST(FindingLimits, OfAFormAsInEarlierVersionsKeepTheirDigits) {
  Case made = cylinder_case(4, 7, 3);
  made.evaluation.features[0].characteristics[0].characteristic.tolerance_mm =
      9.0 * core::kMicrometre;
  EXPECT_THAT(write_json(made.record, made.evaluation), HasSubstr("9.000000000000002"));
}

TEST(FindingCsv, SectionsHaveARowEach) {
  const Case made = drawing_case();
  const std::string text = write_sections_csv(made.record, made.evaluation);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 4 + 2);
  EXPECT_THAT(text, AllOf(HasSubstr("50h6 mean,d GG ACS,2,25,,,,,2 points are left\n"),
                          HasSubstr("run-out,Run-out radial,1,15,,,12.1,,\n")));
  const auto& all = exports();
  const auto sections = std::find_if(all.begin(), all.end(),
                                     [](const Export& e) { return e.file == "sections.csv"; });
  ASSERT_NE(sections, all.end());
  EXPECT_TRUE(applies(*sections, made.record));
  EXPECT_FALSE(applies(*sections, cylinder_case(4, 7, 3).record));
}

TEST(FindingDmis, HasToleranceAndDatumOfTheDrawing) {
  const Case made = drawing_case();
  const std::string text = write_dmis(made.record, made.evaluation);
  EXPECT_THAT(text, AllOf(HasSubstr("T(F1T3)=TOL/DIAM,-0.016,0\n"),
                          HasSubstr("TA(F1T3)=TOL/DIAM,49.9955,INTOL\n"),
                          HasSubstr("two values are judged"), HasSubstr("T(F2T1)=TOL/FLAT,0.004\n"),
                          HasSubstr("FA(F2)=FEAT/PLANE,CART,0,0,60,0,0,1\n")));
  const std::size_t defined = text.find("DATDEF/FA(F1),DAT(DF1)\nDATDEF/FA(F2),DAT(DF2)\n");
  const std::size_t used = text.find("T(F1T4)=TOL/CRNOUT,0.015,DAT(DF1-DF2)\n");
  ASSERT_NE(defined, std::string::npos);
  ASSERT_NE(used, std::string::npos);
  EXPECT_LT(defined, used);
  EXPECT_THAT(text, HasSubstr("TA(F2T2)=TOL/PERP,0.0051,INTOL,RFS,DAT(DF1)\n"));
}

TEST(FindingQif, NamesTheFamilyLimitsAndDatums) {
  const Case made = drawing_case();
  pugi::xml_document xml;
  ASSERT_TRUE(xml.load_string(write_qif(made.record, made.evaluation).c_str()));
  const pugi::xml_node root = xml.document_element();
  const pugi::xml_node definitions =
      root.child("Characteristics").child("CharacteristicDefinitions");
  const pugi::xml_node size = definitions.child("DiameterCharacteristicDefinition");
  EXPECT_STREQ(size.child("EnvelopeRequirement").text().get(), "true");
  EXPECT_EQ(size.child("Tolerance").child("MaxValue").text().as_double(), 50.0);
  EXPECT_EQ(size.child("Tolerance").child("MinValue").text().as_double(), 49.984);
  const pugi::xml_node mean = size.next_sibling("DiameterCharacteristicDefinition");
  const pugi::xml_node modifiers = mean.child("DimensionModifiers");
  EXPECT_STREQ(modifiers.child("DeterminationModifier").text().get(), "GG");
  EXPECT_STREQ(modifiers.child("SectionModifier").text().get(), "ACS");
  const pugi::xml_node turns = definitions.child("CircularRunoutCharacteristicDefinition");
  const pugi::xml_node frame = root.child("DatumReferenceFrames").child("DatumReferenceFrame");
  EXPECT_STREQ(turns.child("DatumReferenceFrameId").text().get(), frame.attribute("id").value());
  EXPECT_TRUE(frame.child("Datums").child("Datum").child("CompoundDatum"));
  const pugi::xml_node datum = root.child("DatumDefinitions").child("DatumDefinition");
  EXPECT_STREQ(datum.child("DatumLabel").text().get(), "F1");
  EXPECT_TRUE(datum.child("FeatureNominalIds"));
  EXPECT_TRUE(root.child("Features").child("FeatureNominals").child("PlaneFeatureNominal"));
}

TEST(FindingSummary, SaysLimitsWorstSectionDatumAndWhatIsLeftOut) {
  const Case made = drawing_case();
  for (const Language language : {Language::kEnglish, Language::kChinese}) {
    const std::string text = write_summary(made.record, made.evaluation, language);
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t end = text.find('\n', from);
      EXPECT_LE(columns(text.substr(from, end - from)), kTerminalColumns);
      from = end + 1;
    }
  }
  const std::string text = write_summary(made.record, made.evaluation, Language::kEnglish);
  EXPECT_THAT(text, AllOf(HasSubstr("49.995500 mm"), HasSubstr("49.984 … 50 "),
                          HasSubstr("d GN 50.001200 mm; d LP SN 49.993100 mm"),
                          HasSubstr("layer 2 at 15.000 mm: 12.100 µm, one of 2"),
                          HasSubstr("1 of 4: layer 3 at 25.000 mm: 2 points are left"),
                          HasSubstr("datum A-B rocks by 7.800 µm"),
                          HasSubstr("11.300 µm about the equalised"),
                          HasSubstr("3 points: keyway 2, outlier rule 1")));
}

TEST(FindingSummary, SaysOnceThatTheScanOfAFeatureIsUnfiltered) {
  Case made = drawing_case();
  auto& results = made.evaluation.features[0].characteristics;
  for (const std::size_t i : {2U, 3U}) {
    evaluation::Finding finding = *results[i].finding;
    finding.warnings = {{core::Code::kUnfiltered, "of dense points"},
                        {core::Code::kOutliers, "of one point"}};
    results[i].finding = std::make_shared<const evaluation::Finding>(std::move(finding));
  }
  const std::string text = write_summary(made.record, made.evaluation, Language::kEnglish);
  const auto times = [&](std::string_view words) {
    std::size_t out = 0;
    for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at) ++out;
    return out;
  };
  EXPECT_EQ(times("of dense points"), 1U);
  EXPECT_EQ(times("of one point"), 2U);
}

TEST(FindingSummary, ASizeIsStatedInChinese) {
  const Case made = drawing_case();
  EXPECT_THAT(write_summary(made.record, made.evaluation, Language::kChinese),
              AllOf(HasSubstr("d GG = 49.995500 mm（"), HasSubstr("49.984 … 50 "),
                    HasSubstr("基准 A-B 摆动 7.800 µm")));
}

TEST(FindingArchive, KeepsLowerLimitReferenceAndFilter) {
  const Case made = drawing_case();
  const record::ArchiveRun run = archive_entry(made.record, made.evaluation, "");
  ASSERT_EQ(run.results.size(), 6U);
  EXPECT_EQ(run.results[1].lower_limit, 49.984);
  EXPECT_EQ(run.results[1].upper_limit, 50.0);
  EXPECT_EQ(run.results[1].reference, "GN");
  EXPECT_EQ(run.results[0].lower_limit, std::nullopt);
}

TEST(FindingCompare, NamesWhatItLeavesOut) {
  const Case made = drawing_case();
  const evaluation::FeatureResult& journal = made.evaluation.features[0];
  for (const std::size_t i : {1U, 2U, 3U}) {
    const auto study = evaluation::study_factors(journal, journal.characteristics[i]);
    ASSERT_FALSE(study);
    EXPECT_EQ(study.error().code, core::Code::kMeaning);
  }
}

TEST(FindingPage, StatesSizesInMillimetresWithBothLimits) {
  const std::string page = page_of(drawing_case());
  EXPECT_THAT(page,
              AllOf(HasSubstr(">49.984 … 50<"), HasSubstr(">50.0012 / 49.9931</b>"),
                    HasSubstr(">d GN / d LP SN <"), HasSubstr("<span>0</span><span>-0.016</span>"),
                    HasSubstr("<span class=\"modifier\">E</span>")));
}

TEST(FindingPage, FramesNameTheirDatums) {
  const std::string page = page_of(drawing_case());
  EXPECT_THAT(page, AllOf(HasSubstr("<span>0.015</span><span><bdi>A-B</bdi></span></span>"),
                          HasSubstr("aria-label=\"perpendicularity\""),
                          HasSubstr("about the one-sided datum, 11.300 µm about the equalised")));
  const std::string first = page.substr(0, page.find("<h2", page.find("class=\"results\"")));
  EXPECT_THAT(first, HasSubstr("about the one-sided datum")) << "beside the value on page one";
}

TEST(FindingPage, HasEverySectionAndThePointsThatTakeNoPart) {
  const std::string page = page_of(drawing_case());
  EXPECT_THAT(page, AllOf(HasSubstr("<b>layer 2 at 15.000 mm</b> ◆ worst"),
                          HasSubstr("2 points left out in the window <bdi>keyway</bdi>"),
                          HasSubstr("1 points left out by the outlier rule"),
                          HasSubstr("2 points are left"), HasSubstr("size minus 50 mm / µm")));
}

TEST(FindingPage, APlaneHasItsFormAndItsMap) {
  const std::string page = page_of(drawing_case());
  EXPECT_THAT(page, AllOf(HasSubstr("Minimum zone FLTt (MZPL)</dt><dd>2.900 µm"),
                          HasSubstr("Least squares (LSPL)</dt><dd>3.100 µm"),
                          HasSubstr("Map of the face")));
}

TEST(FindingPage, SectionsAreDrawnWithoutThePointsInWindows) {
  Case made = drawing_case();
  evaluation::FeatureResult& journal = made.evaluation.features.front();
  constexpr double kDeep = 3.0;
  for (const std::size_t row : {3U, 4U}) {
    journal.cloud[row].deviation_mm -= kDeep;
    journal.cloud[row].left_out = true;
  }
  const auto outside = evaluation::outside_windows(journal);
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->cloud.size(), journal.cloud.size() - 2);
  EXPECT_THAT(page_of(made),
              AllOf(HasSubstr("2 of 28 points lie in windows"), HasSubstr("class=\"window\"")));
  EXPECT_FALSE(evaluation::outside_windows(made.evaluation.features.back()));
}

TEST(FindingPage, SeesTheMedianLineAlongTheAxesThatItNames) {
  Case made = drawing_case();
  auto& shown = made.evaluation.features.front().characteristics[2].finding;
  evaluation::Finding mean = *shown;
  // It leans by 5 mrad toward x and bends by 4 um toward x alone.
  mean.centers_mm = {{0.0, 0.0, 0.0}, {0.054, 0.0, 10.0}, {0.1, 0.0, 20.0}};
  shown = std::make_shared<const evaluation::Finding>(std::move(mean));
  const std::string page = page_of(made);
  const auto is_flat = [&](const std::string& seen) {
    const std::size_t view = page.find("aria-label=\"" + seen);
    const std::string start = "class=\"profile\" d=\"M";
    const std::size_t profile = page.find(start, view);
    EXPECT_NE(profile, std::string::npos) << seen;
    std::istringstream path(page.substr(profile + start.size(), 60));
    double x = 0.0;
    double first = 0.0;
    double second = 0.0;
    char to = ' ';
    path >> x >> first >> to >> x >> second;
    EXPECT_EQ(to, 'L') << seen;
    return first == second;
  };
  EXPECT_FALSE(is_flat("Side view: offset along x"));
  EXPECT_TRUE(is_flat("Side view: offset along y"));
}

TEST(FindingPage, IsBalancedInBothLanguages) {
  const Case made = drawing_case();
  for (const Language language : {Language::kEnglish, Language::kChinese}) {
    const std::string page = write_html(made.record, made.evaluation, language);
    EXPECT_EQ(testing::first_unbalanced_tag(page), "");
    EXPECT_FALSE(testing::shows_nan(page));
  }
}

TEST(FindingPage, APageWithoutAnyNeedsNoMoreStyle) {
  EXPECT_THAT(page_of(cylinder_case(4, 7, 3)),
              AllOf(::testing::Not(HasSubstr(".span-limit")), HasSubstr("Cylindricity report")));
  EXPECT_THAT(page_of(drawing_case()), HasSubstr(".span-limit"));
}

}  // namespace
}  // namespace rondure::reports
