#include "reports/data/qif/internal/parts.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "core/units.h"
#include "evaluation/evaluate.h"
#include "reports/data/qif/report.h"
#include "synthetic.h"
#include "tests/evaluation/points_run.h"
#include "tests/reports/qif_schema.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string qif_of(const Case& made) { return write_qif(made.record, made.evaluation); }

/// A measured and evaluated run, through the real fits.
Case points_case(int layers, int points_per_layer) {
  Case made;
  made.record = points_run(rough_part(3, layers, points_per_layer, core::kTwoPi), layers);
  auto evaluation = evaluate(made.record);
  EXPECT_TRUE(evaluation);
  made.evaluation = *evaluation;
  return made;
}

Case undecided_case() {
  Case made = failing_case();
  made.evaluation.features[0].characteristics[0].verdict = evaluation::Verdict::kUndecided;
  made.evaluation.verdict = evaluation::Verdict::kUndecided;
  return made;
}

/// An analysis without a result: no cylinder, no circle, one characteristic that is void.
Case analysis_case() {
  Case made = unfinished_case();
  made.evaluation.features.erase(made.evaluation.features.begin());
  evaluation::FeatureResult& feature = made.evaluation.features[0];
  feature.feature.shape = record::Shape::kSpindle;
  feature.characteristics[0].characteristic.form = record::Form::kMotionTotal;
  return made;
}

/// A feature that is only measured.
Case bare_case() {
  Case made = points_case(4, 9);
  made.evaluation.features[0].characteristics.clear();
  return made;
}

std::vector<Case> all_cases() {
  return {cylinder_case(4, 7, 3), failing_case(),      undecided_case(), circle_case(500),
          spiral_case(150),       unfinished_case(),   analysis_case(),  points_case(4, 9),
          points_case(1, 40),     hostile_case("x<y"), bare_case(),      drawing_case()};
}

pugi::xml_node characteristic(const pugi::xml_document& xml, int number) {
  return xml.document_element()
      .select_node(("Results/MeasurementResultsSet/MeasurementResults/MeasuredCharacteristics/"
                    "CharacteristicMeasurements/*[" +
                    std::to_string(number) + "]")
                       .c_str())
      .node();
}

std::vector<double> numbers_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<double> out;
  for (double value = 0.0; stream >> value;) out.push_back(value);
  return out;
}

pugi::xml_document read(const std::string& bytes) {
  pugi::xml_document xml;
  EXPECT_TRUE(xml.load_buffer(bytes.data(), bytes.size()));
  return xml;
}

TEST(Qif, EveryDocumentIsSoundAndValid) {
  std::vector<std::string> documents;
  for (const Case& made : all_cases()) {
    documents.push_back(qif_of(made));
    EXPECT_THAT(check_qif(documents.back()), IsEmpty());
  }
  testing::expect_valid_qif(documents);
}

TEST(Qif, TheFourVerdictsHaveAWordEach) {
  std::vector<std::string> words;
  for (const evaluation::Verdict verdict :
       {evaluation::Verdict::kConforms, evaluation::Verdict::kDoesNotConform,
        evaluation::Verdict::kUndecided, evaluation::Verdict::kVoid,
        evaluation::Verdict::kNotToleranced}) {
    Case made = cylinder_case(4, 7, 3);
    made.evaluation.features[0].characteristics[0].verdict = verdict;
    const auto xml = read(qif_of(made));
    words.emplace_back(characteristic(xml, 1).child("Status").first_child().text().get());
  }
  EXPECT_THAT(words, ElementsAre("PASS", "FAIL", "INDETERMINATE", "UNDEFINED", "NOT_ANALYZED"));
}

TEST(Qif, ZoneValueAndAxisAreThoseOfTheReport) {
  const Case made = points_case(4, 9);
  const evaluation::FeatureResult& feature = made.evaluation.features[0];
  const auto xml = read(qif_of(made));
  const pugi::xml_node cylindricity = characteristic(xml, 2);  // ls, mz, mc, mi
  ASSERT_STREQ(cylindricity.name(), "CylindricityCharacteristicMeasurement");
  EXPECT_EQ(cylindricity.child("Value").text().as_double(), feature.mz_cylinder->width_mm());
  EXPECT_EQ(cylindricity.child("ZoneRadii").child("MinRadius").text().as_double(),
            feature.mz_cylinder->inner_radius_mm - 1.5);
  const auto d = numbers_of(cylindricity.child("ZoneAxis").child("Direction").text().get());
  const Eigen::Vector3d direction(d[0], d[1], d[2]);
  EXPECT_EQ(direction, feature.mz_cylinder->axis.direction);
  double low_mm = 1e9;
  double high_mm = -1e9;
  for (const evaluation::CloudPoint& point : feature.cloud) {
    low_mm = std::min(low_mm, point.tip_mm.dot(direction));
    high_mm = std::max(high_mm, point.tip_mm.dot(direction));
  }
  EXPECT_NEAR(cylindricity.child("ZoneAxis").child("Length").text().as_double(), high_mm - low_mm,
              1e-9);
  EXPECT_FALSE(characteristic(xml, 1).child("ZoneRadii"));  // least squares has no such zone
  EXPECT_STREQ(characteristic(xml, 6).name(), "CircularityCharacteristicMeasurement");
  EXPECT_TRUE(characteristic(xml, 6).child("ZonePlane"));
}

TEST(Qif, TipCentresLieAtTheirDistanceFromTheAxisAlongTheirNormals) {
  const Case made = points_case(4, 9);
  const auto xml = read(qif_of(made));
  const pugi::xml_node results =
      xml.document_element().child("Results").child("MeasurementResultsSet").first_child();
  const pugi::xml_node set = results.child("MeasuredPointSets").first_child();
  const std::vector<double> points = numbers_of(set.child("Points").text().get());
  const std::vector<double> normals = numbers_of(set.child("Normals").text().get());
  const std::vector<double> deviations = numbers_of(set.child("Deviations").text().get());
  EXPECT_STREQ(set.child("Compensated").text().get(), "false");
  EXPECT_EQ(set.child("ProbeRadius").text().as_double(), 1.5);
  const fit::MinZoneCylinder& zone = *made.evaluation.features[0].mz_cylinder;
  const double mean_mm = 0.5 * (zone.inner_radius_mm + zone.outer_radius_mm);
  ASSERT_EQ(points.size(), 3U * 36U);
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    const Eigen::Vector3d p(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    const Eigen::Vector3d n(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
    EXPECT_NEAR((p - zone.axis.point_mm).dot(n), mean_mm + deviations[i], 1e-9);
    EXPECT_NEAR(n.dot(zone.axis.direction), 0.0, 1e-12);
  }
}

TEST(Qif, SectionsLieOnTheAxisAtTheirHeight) {
  const Case made = points_case(4, 9);
  const auto xml = read(qif_of(made));
  const auto found = xml.document_element().select_nodes(
      "Results/MeasurementResultsSet/MeasurementResults/MeasuredFeatures/CircleFeatureMeasurement");
  EXPECT_EQ(found.size(), 16U);  // four layers, four references
  const fit::Axis& axis = made.evaluation.features[0].mz_cylinder->axis;
  for (const pugi::xpath_node& node : found) {
    const auto c = numbers_of(node.node().child("Location").text().get());
    const Eigen::Vector3d arm = Eigen::Vector3d(c[0], c[1], c[2]) - axis.point_mm;
    EXPECT_LT((arm - arm.dot(axis.direction) * axis.direction).norm(), 0.02);
    EXPECT_LT(std::abs(arm.dot(axis.direction)), 23.0);
  }
}

TEST(Qif, TheSameRecordGivesTheSameBytes) {
  EXPECT_EQ(qif_of(failing_case()), qif_of(failing_case()));
  Case other = failing_case();
  other.record.header.run_id += "-2";
  EXPECT_NE(qif_of(failing_case()).substr(0, 600), qif_of(other).substr(0, 600));  // its QPId
}

/// What the checker says when `from` stands as `to` in a sound document.
std::string fault_after(const std::string& from, const std::string& to) {
  std::string bytes = qif_of(points_case(4, 9));
  const std::size_t at = bytes.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  bytes.replace(at, from.size(), to);
  std::string said;
  for (const std::string& fault : check_qif(bytes)) said += fault + "\n";
  return said;
}

TEST(QifCheck, FindsEachKindOfFault) {
  EXPECT_THAT(check_qif("<QIFDocument"), ElementsAre(HasSubstr("it is no XML")));
  EXPECT_THAT(check_qif("<a/>"), ElementsAre("it is no QIFDocument"));
  EXPECT_THAT(fault_after("idMax=\"", "idMax=\"1\" was=\""), HasSubstr("idMax is 1"));
  EXPECT_THAT(fault_after("<Standard id=\"2\"", "<Standard id=\"1\""),
              HasSubstr("id 1 stands twice"));
  EXPECT_THAT(fault_after("<Standard id=\"2\"", "<Standard id=\"two\""), HasSubstr("no number"));
  EXPECT_THAT(fault_after("<FeatureItemId>", "<FeatureItemId>99"), HasSubstr("leads nowhere"));
  EXPECT_THAT(fault_after("<FormalStandardId>1<", "<FormalStandardId>4<"),
              HasSubstr("leads to a <Software>"));
  EXPECT_THAT(fault_after("<WholePointSetId>", "<WholePointSetId>1"), HasSubstr("PointSetId"));
  EXPECT_THAT(fault_after("<StandardsDefinitions n=\"3\"", "<StandardsDefinitions n=\"4\""),
              HasSubstr("says n = 4 and holds 3"));
  EXPECT_THAT(fault_after("range=\"28 36\"", "range=\"28 37\""), HasSubstr("not within the 36"));
  EXPECT_THAT(fault_after("count=\"36\"", "count=\"35\""), HasSubstr("35 points holds 108"));
  EXPECT_THAT(fault_after("<Normals>", "<Normals>2 "), HasSubstr("numbers"));
  EXPECT_THAT(fault_after("<Direction>0 0 1<", "<Direction>0 0.001 1<"),
              HasSubstr("has the length 1.0000005"));
  EXPECT_THAT(fault_after("<MinRadius>2", "<MinRadius>1"), HasSubstr("the zone is"));
}

}  // namespace
}  // namespace rondure::reports
