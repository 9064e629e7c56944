#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "reports/data/writers.h"
#include "synthetic.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using nlohmann::ordered_json;

ordered_json document_of(const Case& made) {
  return ordered_json::parse(write_json(made.record, made.evaluation));
}

template <class T>
T at(const ordered_json& document, const char* pointer) {
  return document.at(ordered_json::json_pointer(pointer)).get<T>();
}

TEST(Json, PublishedPointersHoldTheNumbersInTheUnitOfTheirKey) {
  const ordered_json document = document_of(cylinder_case(4, 7, 3));
  EXPECT_EQ(at<int>(document, "/schema_version"), 1);
  EXPECT_EQ(at<std::string>(document, "/verdict"), "conforms");
  EXPECT_EQ(at<std::string>(document, "/header/run_id"), "01_spool_simulated-20261121T023302Z");
  EXPECT_NEAR(at<double>(document, "/features/0/mz/deviation_um"), 8.3, 1e-9);
  EXPECT_NEAR(at<double>(document, "/features/0/mz/inner_radius_mm"), 24.99585, 1e-12);
  EXPECT_EQ(at<std::string>(document, "/features/0/mz/radii_of"), "surface");
  EXPECT_EQ(at<std::string>(document, "/features/0/mz/certificate/kind"), "local");
  EXPECT_NEAR(at<double>(document, "/features/0/ls/deviation_um"), 9.12, 1e-9);
  EXPECT_NEAR(at<double>(document, "/features/0/poses/2/alpha_deg"), 1.2, 1e-12);
  EXPECT_TRUE(at<bool>(document, "/features/0/poses/2/final"));
  EXPECT_EQ(at<double>(document, "/features/0/characteristics/0/tolerance_um"), 10.0);
  EXPECT_NEAR(at<double>(document, "/probe/form_um"), 0.9, 1e-12);
  EXPECT_EQ(document["features"][0]["cloud"].size(), 28U);
}

TEST(Json, AValueStandsBesideItsTruth) {
  Case made = cylinder_case(4, 7, 3);
  EXPECT_FALSE(document_of(made)["features"][0]["characteristics"][0].contains("simulation"));
  auto& result = made.evaluation.features.front().characteristics.front();
  result.truths_mm = {result.value->quoted_mm() - 0.049e-3};
  const ordered_json document = document_of(made);
  const ordered_json& row = document["features"][0]["characteristics"][0]["simulation"][0];
  EXPECT_NEAR(row["difference_um"], 0.049, 1e-9);
  EXPECT_NEAR(row["truth_um"], row["found_um"].get<double>() - 0.049, 1e-9);
}

TEST(Json, ContactsNameTheirPointOfTheCloud) {
  const ordered_json document = document_of(cylinder_case(4, 7, 3));
  const ordered_json& feature = document["features"][0];
  ASSERT_EQ(feature["mz"]["contacts"]["outer"].size(), 3U);
  for (const char* side : {"outer", "inner"}) {
    for (const ordered_json& contact : feature["mz"]["contacts"][side]) {
      const ordered_json& point = feature["cloud"][contact["row"].get<std::size_t>()];
      EXPECT_EQ(point["contact"], side);
      EXPECT_EQ(point["layer"], contact["layer"]);
      EXPECT_EQ(point["point"], contact["point"]);
    }
  }
}

TEST(Json, ACircleHasACentreInPlaceOfAnAxis) {
  const ordered_json document = document_of(circle_case(500));
  const ordered_json& mz = document["features"][0]["mz"];
  EXPECT_FALSE(mz.contains("axis"));
  EXPECT_EQ(mz["center_mm"].size(), 2U);
  EXPECT_EQ(mz["radii_of"], "points");
  EXPECT_EQ(mz["contacts"]["outer"].size(), 3U);
}

TEST(Json, KeysKeepTheirPublishedOrder) {
  const ordered_json document = document_of(cylinder_case(4, 7, 3));
  std::string keys;
  for (const auto& item : document.items()) keys += item.key() + " ";
  EXPECT_EQ(keys,
            "schema_version header verdict measurement_uncertainty rule probe fixture_calibration "
            "features "
            "decisions simulation ");
}

TEST(Json, NumbersReadBackToTheSameDouble) {
  const Case made = cylinder_case(4, 7, 3);
  const ordered_json document = document_of(made);
  const evaluation::CloudPoint& point = made.evaluation.features[0].cloud[5];
  const ordered_json& written = document["features"][0]["cloud"][5];
  EXPECT_EQ(written["tip_mm"][0].get<double>(), point.tip_mm.x());
  EXPECT_EQ(written["deviation_um"].get<double>(), point.deviation_mm * 1000.0);
}

TEST(Json, FailureStandsWithItsCodeAndTheZoneIsNull) {
  const ordered_json document = document_of(unfinished_case());
  EXPECT_TRUE(document["features"][1]["mz"].is_null());
  EXPECT_EQ(document["features"][1]["failure"]["code"], "no-points");
  EXPECT_EQ(document["header"]["failure"]["code"], "collision");
  EXPECT_TRUE(document["features"][1]["characteristics"][0]["value_um"].is_null());
}

TEST(Json, BytesThatAreNotUtf8AndNumbersThatAreNotFiniteStillMakeJson) {
  Case made = hostile_case("\xff\xfe \"x\" \x01");
  made.evaluation.features[0].temperatures.reset();
  const ordered_json document = document_of(made);
  EXPECT_TRUE(document["features"][0]["mean_temperature_degC"].is_null());
}

TEST(Json, TheSameRecordGivesTheSameBytes) {
  const Case a = failing_case();
  const Case b = failing_case();
  EXPECT_EQ(write_json(a.record, a.evaluation), write_json(b.record, b.evaluation));
}

}  // namespace
}  // namespace rondure::reports
