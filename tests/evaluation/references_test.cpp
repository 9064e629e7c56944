// Characteristics about all four references, from the record to the reports.

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/internal/warnings.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/feature_values.h"
#include "fit/references/one_sided.h"
#include "reports/data/writers.h"
#include "reports/history/archive_entry.h"
#include "reports/html/report.h"
#include "reports/terminal/summary.h"
#include "tests/evaluation/points_run.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using nlohmann::json;
using record::Reference;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The characteristics of a feature by their ids.
std::map<std::string, evaluation::CharacteristicResult> by_id(
    const evaluation::FeatureResult& feature) {
  std::map<std::string, evaluation::CharacteristicResult> out;
  for (const auto& c : feature.characteristics) out[c.characteristic.id] = c;
  return out;
}

// Eight points of a shaft as long as it is wide lie on three cylinders; the one whose sections are
// the layers is the part. Its zone is that of both sections alike: 2.4864 um, as 15 mm +- 1.2432 um
// at four equal angles have about their centre.
TEST(CylindricityOfFewPoints, IsAboutTheAxisThatTheLayersShow) {
  const auto run_of = [](bool layers) {
    record::RunRecord run;
    std::vector<std::vector<Eigen::Vector3d>> rings(2);
    for (int k = 0; k < 8; ++k) {
      const double r = 15.0 + (k % 2 == 0 ? 1.2432e-3 : -1.2432e-3);
      const double angle = 0.25 * core::kTwoPi * (k % 4);
      rings[static_cast<std::size_t>(k / 4)].emplace_back(r * std::cos(angle), r * std::sin(angle),
                                                          k < 4 ? 0.0 : 21.2);
    }
    if (!layers) {
      rings[0].insert(rings[0].end(), rings[1].begin(), rings[1].end());
      rings.pop_back();
    }
    auto& feature = add_to_points_run(run, "s", record::Shape::kCylinder, rings);
    if (!layers) feature.layers = 0;
    feature.characteristics.push_back(
        {"cyl", record::Form::kCylindricity, Reference::kMinimumZone, 1e-3, ""});
    return evaluated(run).features.front();
  };
  const auto layered = run_of(true);
  ASSERT_FALSE(layered.failure) << layered.failure->what;
  ASSERT_TRUE(layered.mz_cylinder);
  EXPECT_NEAR(layered.mz_cylinder->width_mm(), 2.4864e-3, 1e-9);
  EXPECT_NEAR(std::abs(layered.mz_cylinder->axis.direction.z()), 1.0, 1e-6);
  EXPECT_EQ(layered.characteristics.front().verdict, Verdict::kDoesNotConform);
  const auto unknown = run_of(false);
  ASSERT_TRUE(unknown.failure);
  EXPECT_EQ(unknown.failure->code, core::Code::kSeveralOptima);
  EXPECT_EQ(unknown.characteristics.front().verdict, Verdict::kVoid);
}

/// A circle of 15 mm whose plane leans about y, with noise of the heights and a plane of the plan.
FeatureResult leaning_circle(double lean_deg, double heights_mm, const std::string& plane) {
  record::RunRecord run;
  run.header.decision_rule = "simple-acceptance";
  core::KeyedNoise noise(20261128, {1});
  const double c = std::cos(lean_deg * core::kDegree);
  const double s = std::sin(lean_deg * core::kDegree);
  std::vector<std::vector<Eigen::Vector3d>> ring(1);
  for (int k = 0; k < 36; ++k) {
    const double angle = core::kTwoPi * k / 36.0;
    const Eigen::Vector2d p = 15.0 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    ring[0].emplace_back(100.0 + c * p.x(), 50.0 + p.y(),
                         20.0 - s * p.x() + heights_mm * noise.normal());
  }
  auto& feature = add_to_points_run(run, "c", record::Shape::kCircle, ring);
  if (!plane.empty()) feature.settings.push_back({"source/plane", {}, plane});
  feature.characteristics.push_back(
      {"r", record::Form::kRoundness, Reference::kMinimumZone, 5e-3, ""});
  auto& size = feature.characteristics.emplace_back();
  size = {"d", record::Form::kDiameter, Reference::kMinimumZone, 33.01, "", {}, 32.99};
  size.indication.size = record::Indication::Size::kGG;
  feature.tip_radius_mm = 1.5;
  feature.side = record::Side::kInside;
  return evaluated(run).features.front();
}

// An exact circle is round in its own plane. About z it is an ellipse: R (1 - cos) less in one
// direction, 1.8506 um at 0.9 deg, 904.61 um at 20 deg.
TEST(LeaningCircle, IsRoundInItsPlaneAndVoidWhereThePlaneMattersAndIsNotStated) {
  for (const auto& [lean_deg, about_z] : {std::pair(0.9, "1.851"), std::pair(20.0, "904.611")}) {
    const FeatureResult unsaid = leaning_circle(lean_deg, 0.0, "");
    ASSERT_TRUE(unsaid.about_nominal);
    EXPECT_EQ(unsaid.characteristics[0].verdict, Verdict::kVoid);
    // The size differs by R (1 - cos) as well: 1.85 um are less than a tenth of 20 um.
    EXPECT_EQ(unsaid.characteristics[1].verdict,
              lean_deg < 1.0 ? Verdict::kConforms : Verdict::kVoid);
    EXPECT_THAT(unsaid.characteristics[0].reason.english(),
                testing::AllOf(HasSubstr(fmt::format("leans {:.2f} deg", lean_deg)),
                               HasSubstr("0.000 um"), HasSubstr(about_z)));
    const FeatureResult points = leaning_circle(lean_deg, 0.0, "points");
    EXPECT_NEAR(*points.characteristics[0].value_mm(), 0.0, 1e-9);
    EXPECT_NEAR(*points.characteristics[1].value_mm(), 33.0, 1e-9);
    for (const CharacteristicResult& one : points.characteristics)
      EXPECT_EQ(one.verdict, Verdict::kConforms) << one.reason.english();
    const FeatureResult nominal = leaning_circle(lean_deg, 0.0, "nominal");
    EXPECT_FALSE(nominal.about_nominal);
    EXPECT_NEAR(*nominal.characteristics[0].value_mm(),
                15.0 * (1.0 - std::cos(lean_deg * core::kDegree)), 1e-7);
    EXPECT_THAT(nominal.characteristics[1].reason.english(), Not(HasSubstr("column layer")));
  }
}

// Heights matter by the lean alone: 5 um of noise lean the plane by 0.005 deg, which moves no point
// by 10 nm, and 50 um by 0.05 deg, which is far below a tenth of 5 um.
TEST(LeaningCircle, IsNoneWhereOnlyTheHeightsAreNoisy) {
  EXPECT_FALSE(leaning_circle(0.0, 0.005, "").about_nominal);
  const FeatureResult rough = leaning_circle(0.0, 0.05, "");
  for (const CharacteristicResult& one : rough.characteristics)
    EXPECT_EQ(one.verdict, Verdict::kConforms) << one.reason.english();
}

TEST(SparsePoints, AreWarnedOfAtTheCharacteristicsOfExtremes) {
  record::RunRecord run = points_run(rough_part(1, 3, 5, core::kTwoPi), 3);
  auto& asked = run.features[0].characteristics;
  asked.resize(1);
  asked.front().id = "cyl";
  asked.push_back({"gg", record::Form::kDiameter, Reference::kLeastSquares, 60.0, ""});
  std::vector<std::string> where;
  const Evaluation found = evaluated(run);
  for (const core::Error& warning : found.features[0].warnings) {
    if (warning.code == core::Code::kSparse) where.push_back(warning.where);
  }
  EXPECT_EQ(where, std::vector<std::string>{"cyl"});
}

TEST(Symbols, AreThoseOfTheDrawing) {
  using Indication = record::Indication;
  using record::Form;
  const auto symbol = [](Form form, const auto& indicate) {
    record::Characteristic asked;
    asked.form = form;
    indicate(asked.indication);
    return evaluation::symbol_of(asked);
  };
  const auto nothing = [](Indication&) {};
  EXPECT_EQ(symbol(Form::kCylindricity, nothing), "CYLt");
  EXPECT_EQ(symbol(Form::kCylindricity,
                   [](Indication& i) { i.parameter = Indication::Parameter::kPeak; }),
            "CYLp");
  EXPECT_EQ(
      symbol(Form::kFlatness, [](Indication& i) { i.parameter = Indication::Parameter::kRms; }),
      "FLTq");
  EXPECT_EQ(symbol(Form::kRoundness, [](Indication& i) { i.section = Indication::Section::kSCS; }),
            "RONt SCS");
  EXPECT_EQ(symbol(Form::kDiameter, nothing), "d LP");
  EXPECT_EQ(symbol(Form::kDiameter, [](Indication& i) { i.size = Indication::Size::kGN; }), "d GN");
  EXPECT_EQ(symbol(Form::kDiameter,
                   [](Indication& i) {
                     i.rank = Indication::Rank::kSX;
                     i.section = Indication::Section::kACS;
                   }),
            "d LP SX ACS");
  EXPECT_EQ(symbol(Form::kDiameter,
                   [](Indication& i) { i.requirement = Indication::Requirement::kEnvelope; }),
            "d E");
  EXPECT_EQ(symbol(Form::kStraightness, nothing), "STRt");
  EXPECT_EQ(symbol(Form::kStraightness, [](Indication& i) { i.of = Indication::Of::kMedianLine; }),
            "STRt median line");
  EXPECT_EQ(symbol(Form::kTaper, nothing), "CYLtt");
  EXPECT_EQ(symbol(Form::kRunOut, nothing), "Run-out");  // of a wheel
  EXPECT_EQ(symbol(Form::kRunOut,
                   [](Indication& i) {
                     i.direction = Indication::Direction::kAxial;
                     i.datum = {"A-B"};
                   }),
            "Run-out axial");
  EXPECT_EQ(symbol(Form::kTotalRunOut, [](Indication& i) { i.datum = {"A"}; }),
            "Total run-out radial");
}

TEST(Symbols, OfReferencesAreThoseOfTheShape) {
  record::Characteristic asked;
  asked.reference = Reference::kLeastSquares;
  EXPECT_EQ(evaluation::reference_of(asked), "LSCY");
  asked.form = record::Form::kStraightness;
  EXPECT_EQ(evaluation::reference_of(asked), "LSLI");
  asked.form = record::Form::kFlatness;
  EXPECT_EQ(evaluation::reference_of(asked), "LSPL");
  asked.form = record::Form::kDiameter;
  EXPECT_EQ(evaluation::reference_of(asked), "");
}

TEST(References, ACylinderIsJudgedAboutAllFour) {
  const auto points = rough_part(1, 4, 15, core::kTwoPi);
  const auto evaluation = evaluated(points_run(points, 4));
  const evaluation::FeatureResult& feature = evaluation.features.at(0);
  auto found = by_id(feature);
  ASSERT_EQ(found.size(), 8U);
  const auto axis = feature.ls_cylinder->axis.direction;
  const auto mc = fit::min_circumscribed_cylinder(points, axis);
  const auto mi = fit::max_inscribed_cylinder(points, axis);
  ASSERT_TRUE(mc && mi);
  EXPECT_EQ(found["cylindricity mc"].value_mm(), mc->deviation_mm);
  EXPECT_EQ(found["cylindricity mi"].value_mm(), mi->deviation_mm);
  EXPECT_THAT(found["cylindricity mc"].value->operator_text(),
              StartsWith("MCCY; unfiltered; 4 x 15"));
  EXPECT_THAT(found["cylindricity mi"].value->operator_text(),
              StartsWith("MICY; unfiltered; 4 x 15"));
  EXPECT_THAT(found["roundness mc"].value->operator_text(), StartsWith("MCCI; "));
  EXPECT_THAT(found["roundness mi"].value->operator_text(), StartsWith("MICI; "));
  for (const auto& [id, c] : found) {
    EXPECT_EQ(c.verdict, evaluation::Verdict::kConforms) << id << ": " << c.reason;
    EXPECT_LE(*found["cylindricity mz"].value_mm(), id[0] == 'c' ? *c.value_mm() + 1e-12 : 1.0)
        << id;
  }
  double worst_mi = 0.0;
  for (const evaluation::LayerResult& layer : feature.layers) {
    const auto circle = fit::max_inscribed_circle(layer.points_mm);
    ASSERT_TRUE(circle.has_value());
    worst_mi = std::max(worst_mi, circle->deviation_mm);
  }
  EXPECT_EQ(found["roundness mi"].value_mm(), worst_mi);
}

TEST(References, ReportedRadiiAreThoseOfTheSurface) {
  const auto points = rough_part(2, 3, 12, core::kTwoPi);
  for (const record::Side side : {record::Side::kOutside, record::Side::kInside}) {
    auto run = points_run(points, 3);
    run.features[0].side = side;
    const double offset = side == record::Side::kOutside ? -1.5 : 1.5;
    const auto evaluation = evaluated(run);
    const evaluation::FeatureResult& feature = evaluation.features.at(0);
    const json report = json::parse(write_json(run, evaluation));
    const json& stated = report["features"][0];
    EXPECT_NEAR(stated["mc"]["radius_mm"], feature.mc_cylinder->radius_mm + offset, 1e-12);
    EXPECT_NEAR(stated["mi"]["radius_mm"], feature.mi_cylinder->radius_mm + offset, 1e-12);
    EXPECT_NEAR(stated["layers"][1]["mc"]["radius_mm"], feature.layers[1].mc->radius_mm + offset,
                1e-12);
    EXPECT_LE(stated["mc"]["radius_mm"], stated["mz"]["outer_radius_mm"]);
    EXPECT_GE(stated["mi"]["radius_mm"], stated["mz"]["inner_radius_mm"]);
    EXPECT_EQ(stated["mc"]["contacts"]["outer"].size(), feature.mc_cylinder->contacts.size());
    EXPECT_FALSE(stated["mc"]["contacts"].contains("inner"));
    EXPECT_EQ(stated["mi"]["axis"]["direction"].size(), 3U);
    EXPECT_EQ(stated["mi"]["certificate"]["kind"], "global");
  }
}

TEST(References, ACircleHasItsOwn) {
  const auto run = points_run(rough_part(3, 1, 30, core::kTwoPi), 1);
  const auto evaluation = evaluated(run);
  const json feature = json::parse(write_json(run, evaluation))["features"][0];
  const evaluation::LayerResult& section = evaluation.features.at(0).layers.at(0);
  EXPECT_NEAR(feature["mc"]["deviation_um"], 1e3 * section.mc->deviation_mm, 1e-12);
  EXPECT_EQ(feature["mc"]["certificate"]["kind"], "global");
  EXPECT_EQ(feature["mi"]["center_mm"].size(), 2U);
  EXPECT_EQ(feature["mi"]["contacts"]["inner"].size(), section.mi->contacts.size());
  EXPECT_THAT(write_summary(run, evaluation), HasSubstr("MCCI radius"));
  EXPECT_THAT(write_html(run, evaluation), HasSubstr("Maximum inscribed circle (MICI)"));
}

TEST(References, TheArchiveHoldsTheCertificateOfEach) {
  const auto run = points_run(rough_part(8, 4, 15, core::kTwoPi), 4);
  const auto entry = archive_entry(run, evaluated(run), "digest");
  std::map<std::string, std::string> certificates;
  for (const auto& result : entry.results) certificates[result.reference] = result.certificate;
  const std::map<std::string, std::string> expected = {
      {"LSCY", "none"}, {"MZCY", "global"}, {"MCCY", "global"}, {"MICY", "global"},
      {"LSCI", "none"}, {"MZCI", "global"}, {"MCCI", "global"}, {"MICI", "global"}};
  EXPECT_EQ(certificates, expected);
}

TEST(References, OneThatDoesNotExistIsNullWithAWarningAndVoid) {
  for (const int layers : {1, 4}) {
    SCOPED_TRACE(layers);
    const auto run = points_run(rough_part(4, layers, 20, 0.4 * core::kTwoPi), layers);
    const auto evaluation = evaluated(run);
    const evaluation::FeatureResult& feature = evaluation.features.at(0);
    const json stated = json::parse(write_json(run, evaluation))["features"][0];
    EXPECT_TRUE(stated["mi"].is_null());
    EXPECT_TRUE(stated["layers"][0]["mi"].is_null());
    EXPECT_TRUE(stated["mz"].is_object());
    int warned = 0;
    for (const core::Error& w : feature.warnings) {
      if (w.code == core::Code::kReferenceAbsent &&
          w.what.find("no maximum inscribed") != std::string::npos)
        ++warned;
    }
    EXPECT_EQ(warned, 1);
    auto found = by_id(feature);
    const evaluation::CharacteristicResult& round = found["roundness mi"];
    EXPECT_EQ(round.verdict, evaluation::Verdict::kVoid);
    EXPECT_FALSE(round.value_mm().has_value());
    EXPECT_THAT(round.reason, HasSubstr("layer 1: "));
    EXPECT_EQ(found["roundness mz"].verdict, evaluation::Verdict::kVoid);
    EXPECT_TRUE(found["roundness mz"].value_mm().has_value()) << "of the part that is seen";
    EXPECT_EQ(evaluation.verdict, evaluation::Verdict::kVoid);
    EXPECT_THAT(write_html(run, evaluation), HasSubstr("reference-absent"));
  }
}

TEST(References, AWorseOptimumNextToTheLeastSquaresOneIsToldNotHidden) {
  auto evaluation = evaluated(points_run(rough_part(7, 4, 15, core::kTwoPi), 4));
  evaluation::FeatureResult& feature = evaluation.features.at(0);
  const auto told = [&] {
    feature.warnings.clear();
    warn(feature);
    std::vector<std::string> out;
    for (const core::Error& w : feature.warnings) {
      if (w.code != core::Code::kSeveralOptima) continue;
      EXPECT_FALSE(w.phrase.arguments().empty()) << "no words of another language";
      out.push_back(w.what);
    }
    return out;
  };
  EXPECT_THAT(told(), ::testing::IsEmpty());
  feature.mc_cylinder->radius_mm = feature.mz_cylinder->outer_radius_mm + 2e-3;
  feature.layers[1].mi->radius_mm = feature.layers[1].mz->inner_radius_mm - 3e-3;
  EXPECT_THAT(told(), ::testing::ElementsAre(
                          ::testing::AllOf(StartsWith("the minimum circumscribed cylinder"),
                                           HasSubstr(" 2 um better")),
                          ::testing::AllOf(StartsWith("layer 2: the maximum inscribed circle"),
                                           HasSubstr(" 3 um better"))));
}

// Dents at 0 and 180 deg hold the inscribed circle, which slides across them: RONt is anything from
// 17.07 to 28 um about circles whose radius agrees to 1 nm.
TEST(References, AnInscribedCircleThatIsNotUniqueGivesNoVerdictInItsRange) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 360; ++k) {
    const double angle = k * core::kDegree;
    const double r = 25.0 + (k % 180 == 0 ? -0.010 : k == 90 ? 0.008 : 0.0);
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
  }
  const auto judged_at = [&](double limit_mm) {
    record::RunRecord run = points_run(points, 1);
    for (record::Feature& feature : run.features) {
      for (auto& c : feature.characteristics) c.tolerance_mm = limit_mm;
    }
    const auto evaluation = evaluated(run);
    const json stated = json::parse(write_json(run, evaluation))["features"][0];
    EXPECT_NEAR(stated["mi"]["deviation_range_um"][0], 17.07, 0.3);
    EXPECT_NEAR(stated["mi"]["deviation_range_um"][1], 28.0, 0.1);
    EXPECT_TRUE(stated["mc"]["deviation_range_um"].is_null());
    EXPECT_THAT(write_summary(run, evaluation),
                ::testing::ContainsRegex("maximum inscribed[ \n]+circle[ \n]+is[ \n]+not"));
    return by_id(evaluation.features.at(0))["roundness mi"];
  };
  const auto above = judged_at(0.030);
  EXPECT_EQ(above.verdict, evaluation::Verdict::kConforms) << above.reason;
  EXPECT_NEAR(*above.value_mm(), 0.028, 1e-4);
  const auto between = judged_at(0.022);
  EXPECT_EQ(between.verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(between.reason, HasSubstr("the limit of 22 um lies between"));
  const auto below = judged_at(0.015);
  EXPECT_EQ(below.verdict, evaluation::Verdict::kDoesNotConform) << below.reason;
  EXPECT_NEAR(*below.value_mm(), 0.01707, 3e-4);
}

TEST(References, ThreePointsHaveNoRoundnessAboutAny) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 3; ++i) {
    const double t = core::kTwoPi * i / 3.0;
    points.emplace_back(25.0 * std::cos(t), 25.0 * std::sin(t), 0.0);
  }
  const auto evaluation = evaluated(points_run(points, 1));
  for (const auto& c : evaluation.features.at(0).characteristics) {
    EXPECT_EQ(c.verdict, evaluation::Verdict::kVoid) << c.characteristic.id;
    EXPECT_THAT(c.reason, HasSubstr("three different points")) << c.characteristic.id;
  }
}

TEST(PointsOfAFile, FarOffTheNominalDiameterHaveNoVerdict) {
  auto run = points_run(rough_part(3, 4, 40, core::kTwoPi), 4);
  const auto reasons = [&](double nominal_mm) {
    run.features.front().nominal_diameter_mm = nominal_mm;
    std::string out;
    const Evaluation made = evaluated(run);
    for (const auto& asked : made.features.front().characteristics) {
      if (asked.reason.english().find("the points show") == std::string::npos) continue;
      EXPECT_EQ(asked.verdict, Verdict::kVoid);
      out = asked.reason.english();
    }
    return out;
  };
  const double radius_mm = evaluated(run).features.front().ls_cylinder->radius_mm - 1.5;  // tip
  EXPECT_EQ(reasons(2.0 * radius_mm + 0.9), "");
  EXPECT_THAT(reasons(2.0 * radius_mm + 1.1), HasSubstr("check the unit of the file, the tip"));
  EXPECT_THAT(reasons(2.0 * radius_mm * 25.4), HasSubstr("is the file in inches?"));
}

}  // namespace
}  // namespace rondure::reports
