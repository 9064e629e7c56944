// What a simulated run is held against is what its part has, by definitions that share no code with
// the evaluation (true_part.h); those of part V1 and of simple forms.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "fit/references/min_zone.h"
#include "plans/cell/internal/hidden_errors.h"
#include "tests/core/full.h"
#include "tests/plans/least_greatest.h"
#include "tests/plans/random_inspection.h"
#include "tests/plans/true_part.h"
#include "tests/plans/turned_part.h"

namespace rondure::plans {
namespace {

using record::Form;
using record::Shape;
using Indication = record::Indication;

/// Features and what is asked of them.
struct Asked {
  Plan plan;
  std::vector<record::Feature> features;

  FeaturePlan& add(const std::string& id, Shape type, const NominalPlan& nominal, int layers) {
    FeaturePlan& out = plan.features.emplace_back();
    out.id = id;
    out.type = type;
    out.nominal = nominal;
    out.sampling.layers = layers;
    out.sampling.points_per_layer = 6;
    out.sampling.margin_mm = 0.0;
    record::Feature& asked = features.emplace_back();
    asked.id = id;
    asked.shape = type;
    return out;
  }
  Indication& ask(const std::string& id, Form form, const std::vector<std::string>& datum = {}) {
    record::Characteristic c;
    c.id = id;
    c.form = form;
    c.indication.datum = datum;
    return features.back().characteristics.emplace_back(c).indication;
  }
  SimulatedFeaturePlan& form(const std::string& id) {
    plan.simulation->features.emplace_back().id = id;
    return plan.simulation->features.back();
  }
  [[nodiscard]] std::map<std::string, double> truths() const {
    std::map<std::string, double> out;
    for (const record::TruthValue& truth : truths_of(plan, features)) out[truth.name] = truth.value;
    return out;
  }
};

Asked part() {
  Asked out;
  out.plan.simulation.emplace();
  return out;
}

/// Part V1 of the specification, section 10.
Asked v1() {
  Asked out = part();
  out.add("A", Shape::kCylinder, {30.0, 0.0, 30.0}, 2);
  out.add("B", Shape::kCylinder, {30.0, 150.0, 180.0}, 2);
  out.add("C", Shape::kCylinder, {40.0, 90.0, 112.0}, 3);
  out.ask("run-out", Form::kRunOut, {"A-B"});
  out.ask("total", Form::kTotalRunOut, {"A-B"});
  out.ask("coaxiality", Form::kCoaxiality, {"A-B"});
  NominalPlan face;
  face.z_mm = 190.0;
  face.from_diameter_mm = 30.0;
  face.to_diameter_mm = 60.0;
  face.faces = record::Faces::kUp;
  out.add("F", Shape::kPlane, face, 2);
  out.ask("inner", Form::kRunOut, {"A-B"}).direction = Indication::Direction::kAxial;
  out.features.back().characteristics.back().indication.radius_mm = 15.0;
  out.ask("outer", Form::kRunOut, {"A-B"}).direction = Indication::Direction::kAxial;
  out.features.back().characteristics.back().indication.radius_mm = 30.0;
  out.ask("worst", Form::kRunOut, {"A-B"}).direction = Indication::Direction::kAxial;
  out.ask("face total", Form::kTotalRunOut, {"A-B"}).direction = Indication::Direction::kAxial;
  out.ask("square", Form::kPerpendicularity, {"A-B"});
  SimulatedFeaturePlan& c = out.form("C");
  c.offset_x_um = 4.8;
  c.offset_y_um = 3.1;
  c.slope_x_urad = 20.0;
  c.slope_y_urad = -40.0;
  c.lobes = {{2, 1.6, -0.2 / core::kDegree, 0.0}};
  c.taper_um = 3.0;
  SimulatedFeaturePlan& f = out.form("F");
  f.tilt_urad = 70.0;
  f.tilt_toward_deg = 0.9 / core::kDegree;
  f.saucer_um = -4.2;
  f.wave_um = 1.2;
  return out;
}

// Noise and errors of the machine make other values than the part has; what is printed beside them
// is what it has, but for what 60 points a section leave out.
TEST(Truth, OfARunIsWhatThePartHasWhateverTheMachineDoes) {
  Plan plan = testing::turned_part();
  plan.features.resize(2);
  for (FeaturePlan& feature : plan.features) {
    feature.sampling.layers = 4;
    feature.sampling.points_per_layer = 60;
  }
  plan.features[1].letter = "A";
  const auto ask = [&](std::size_t feature, const char* id, Form form, bool about_a) {
    record::CharacteristicTask asked;
    asked.id = id;
    asked.form = form;
    asked.reference = record::Reference::kMinimumZone;
    if (about_a) {
      asked.reference.reset();
      asked.indication.datum = {"A"};
      asked.indication.association = Indication::Association::kLs;
    }
    plan.features[feature].characteristics.push_back(asked);
  };
  ask(1, "CYLt", Form::kCylindricity, false);
  ask(0, "coaxiality", Form::kCoaxiality, true);
  ask(0, "run-out", Form::kRunOut, true);
  plan.simulation->probe.repeatability_um = 1.5;
  plan.simulation->probe.tip_radius_error_um = 3.0;
  plan.probe->qualification.form_limit_um = 50.0;
  plan.simulation->machine.errors = SimulatedMachinePlan::Errors::kTypical;
  const test::Inspection run = test::inspect(plan);
  std::map<std::string, double> whole;
  for (const record::TruthValue& truth : truths_of(plan, run.record.features)) {
    whole[truth.name] = truth.value;
  }
  int compared = 0;
  for (const evaluation::FeatureResult& feature : run.evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      const std::string& id = result.characteristic.id;
      SCOPED_TRACE(id);
      ASSERT_EQ(result.truths_mm.size(), 1U);
      const double truth_um = core::micrometres(result.truths_mm.front());
      EXPECT_NEAR(truth_um, whole.at(id + "_um"), 0.01 * whole.at(id + "_um") + 0.005);
      EXPECT_GT(std::abs(core::micrometres(*result.value_mm()) - truth_um), 0.3);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 3);
}

TEST(Truth, OfPartV1IsThatOfTheSpecification) {
  constexpr double kNanometre_um = 1e-3;
  const auto truth = v1().truths();
  ASSERT_EQ(truth.size(), 8U);
  EXPECT_NEAR(truth.at("run-out_um"), 12.8322472237, kNanometre_um);
  EXPECT_NEAR(truth.at("total_um"), 18.9668157826, kNanometre_um);
  EXPECT_NEAR(truth.at("coaxiality_um"), 11.5772190098, kNanometre_um);
  EXPECT_NEAR(truth.at("inner_um"), 2.3586891559, kNanometre_um);
  EXPECT_NEAR(truth.at("outer_um"), 5.7029433643, kNanometre_um);
  EXPECT_NEAR(truth.at("worst_um"), 5.7029433643, kNanometre_um);
  EXPECT_NEAR(truth.at("face total_um"), 7.2588387416, kNanometre_um);
  EXPECT_NEAR(truth.at("square_um"), 7.2588387416, kNanometre_um);
}

TEST(Truth, OfEachSectionOfPartV1IsThatOfTheSpecification) {
  Asked asked = v1();
  asked.plan.features[2].type = Shape::kCircle;  // touched in the middle
  asked.features[2].characteristics.resize(1);
  EXPECT_NEAR(asked.truths().at("run-out_um"), 12.5850773204, 1e-3);
}

TEST(Truth, OfSimpleFormsIsPlain) {
  Asked asked = part();
  asked.add("oval", Shape::kCylinder, {40.0, 0.0, 20.0}, 3);
  asked.form("oval").lobes = {{2, 2.0, 30.0, 0.0}};
  asked.ask("CYLt", Form::kCylindricity);
  asked.ask("RONt", Form::kRoundness);
  asked.ask("taper", Form::kTaper);
  asked.ask("d GG", Form::kDiameter).size = Indication::Size::kGG;
  asked.ask("d GN", Form::kDiameter).size = Indication::Size::kGN;
  asked.ask("d GX", Form::kDiameter).size = Indication::Size::kGX;
  asked.ask("d GC", Form::kDiameter).size = Indication::Size::kGC;
  asked.ask("d", Form::kDiameter);
  asked.ask("d SA", Form::kDiameter).rank = Indication::Rank::kSA;
  asked.ask("d E", Form::kDiameter).requirement = Indication::Requirement::kEnvelope;
  auto truth = asked.truths();
  EXPECT_NEAR(truth.at("CYLt_um"), 4.0, 1e-4);
  EXPECT_NEAR(truth.at("RONt_um"), 4.0, 1e-4);
  EXPECT_NEAR(truth.at("taper_um"), 0.0, 1e-4);
  EXPECT_NEAR(truth.at("d GG_mm"), 40.0, 1e-7);
  EXPECT_NEAR(truth.at("d GN_mm"), 40.004, 1e-7);
  EXPECT_NEAR(truth.at("d GX_mm"), 39.996, 1e-7);
  EXPECT_NEAR(truth.at("d GC_mm"), 40.0, 1e-7);
  EXPECT_NEAR(truth.at("d SX_mm"), 40.004, 1e-7);
  EXPECT_NEAR(truth.at("d SN_mm"), 39.996, 1e-7);
  EXPECT_NEAR(truth.at("d SA_mm"), 40.0, 1e-7);
  EXPECT_NEAR(truth.at("d E GN_mm"), 40.004, 1e-7);
  EXPECT_NEAR(truth.at("d E SN_mm"), 39.996, 1e-7);

  asked = part();
  asked.add("three", Shape::kCylinder, {40.0, 0.0, 20.0}, 3);
  asked.form("three").lobes = {{3, 2.0, 30.0, 0.0}};
  asked.ask("RONt", Form::kRoundness);
  asked.ask("d", Form::kDiameter);
  truth = asked.truths();
  EXPECT_NEAR(truth.at("RONt_um"), 4.0, 1e-4);
  EXPECT_NEAR(truth.at("d SX_mm"), 40.0, 1e-7) << "odd lobes do not show in opposite points";

  asked = part();
  asked.add("tapered", Shape::kCylinder, {40.0, 0.0, 20.0}, 3);
  asked.form("tapered").taper_um = 3.0;
  asked.plan.simulation->features.back().barrel_um = -1.5;
  asked.ask("taper", Form::kTaper);
  asked.ask("straight", Form::kStraightness);
  asked.ask("facing", Form::kGeneratrixParallelism);
  truth = asked.truths();
  EXPECT_NEAR(truth.at("taper_um"), 6.0, 1e-4) << "change of the radius from end to end";
  EXPECT_NEAR(truth.at("straight_um"), 1.5, 1e-4);

  asked = part();
  NominalPlan ring;
  ring.from_diameter_mm = 20.0;
  ring.to_diameter_mm = 60.0;
  ring.faces = record::Faces::kUp;
  asked.add("dish", Shape::kPlane, ring, 3);
  asked.form("dish").saucer_um = 9.0;
  asked.plan.simulation->features.back().tilt_urad = 100.0;
  asked.ask("flat", Form::kFlatness);
  truth = asked.truths();
  EXPECT_NEAR(truth.at("flat_um"), 8.0, 1e-4) << "from a third of the radius to all of it";
}

TEST(Truth, OfARandomFormIsTheMinimumZoneOfItsPoints) {
  for (int number = 0; number < test::cases(3, 10); ++number) {
    const auto seed = static_cast<std::uint64_t>(number);
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {1});
    Asked asked = part();
    const FeaturePlan& feature =
        asked.add("rough", Shape::kCylinder, {test::between(random, 20.0, 60.0), 0.0, 40.0}, 4);
    SimulatedFeaturePlan& form = asked.form("rough");
    for (const int order : {2, 3, 5}) {
      form.lobes.push_back({order, test::between(random, 0.0, 3.0),
                            test::between(random, 0.0, 360.0), test::between(random, -60.0, 60.0)});
    }
    form.taper_um = test::between(random, -4.0, 4.0);
    form.bend_um = test::between(random, 0.0, 4.0);
    form.offset_x_um = 30.0;
    form.slope_y_urad = -80.0;
    asked.ask("CYLt", Form::kCylindricity);
    const auto placed = placed_surface(*asked.plan.simulation, feature);
    const auto& surface = std::get<cmm::PartSurface>(placed.surface);
    std::vector<Eigen::Vector3d> points;
    for (int layer = 0; layer < 4; ++layer) {
      for (int i = 0; i < 1440; ++i) {
        const double z = -20.0 + 40.0 * layer / 3.0;
        const double theta = core::kTwoPi * i / 1440;
        const double r = surface.radius_at(theta, z);
        points.emplace_back(placed.X_PS *
                            Eigen::Vector3d(r * std::cos(theta), r * std::sin(theta), z));
      }
    }
    const auto zone = fit::min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(zone);
    EXPECT_NEAR(asked.truths().at("CYLt_um"), zone->width_mm() / core::kMicrometre, 1e-3);
  }
}

TEST(Truth, OfADatumWithoutOneIsMissing) {
  Asked asked = v1();
  asked.features[2].characteristics[0].indication.association = Indication::Association::kEqualised;
  asked.features[2].characteristics[1].indication.filter = Indication::Filter::kGaussian;
  asked.features[2].characteristics[2].indication.datum = {"A-X"};
  const auto truth = asked.truths();
  EXPECT_EQ(truth.size(), 5U);
  EXPECT_EQ(truth.count("run-out_um") + truth.count("total_um") + truth.count("coaxiality_um"), 0U);
}

TEST(Truth, OfAPartThatIsOneCylinderAtATimeIsNone) {
  Asked asked = part();
  asked.add("A", Shape::kCylinder, {30.0, 0.0, 30.0}, 2);
  asked.ask("CYLt", Form::kCylindricity);
  EXPECT_TRUE(asked.truths().empty());
}

TEST(LeastGreatest, FindsTheCentreOfTheLeastCircle) {
  // Three points on the unit circle about (3, -2), none in half of it, and one inside.
  const std::vector<Eigen::Vector2d> points = {
      {4.0, -2.0}, {3.0 - std::sqrt(0.75), -1.5}, {3.0, -3.0}, {3.2, -2.1}};
  const auto center = least_greatest(
      [&](const Eigen::VectorXd& x) {
        Functions out{Eigen::VectorXd(4), Eigen::MatrixXd(4, 2)};
        for (Eigen::Index i = 0; i < 4; ++i) {
          const Eigen::Vector2d off = points[static_cast<std::size_t>(i)] - x;
          out.value[i] = off.norm();
          out.gradient.row(i) = -off.transpose() / off.norm();
        }
        return std::vector<Functions>{out};
      },
      Eigen::Vector2d(3.3, -1.8));
  ASSERT_TRUE(center);
  EXPECT_NEAR((*center - Eigen::Vector2d(3.0, -2.0)).norm(), 0.0, 1e-7);
}

}  // namespace
}  // namespace rondure::plans
