// The trials of a part: what moves sizes (methods, drawing section 8.1), what datum and toleranced
// feature share, and how often the intervals hold the truth, on parts and errors made here.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/part/trials.h"
#include "fit/datums/datum.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/plane.h"
#include "fit/least_squares/sections.h"
#include "fit/least_squares/sphere.h"
#include "fit/profiles/generatrix.h"
#include "fit/sizes/sizes.h"
#include "fit/zone/fit.h"
#include "tests/core/full.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::kMicrometre;
using Eigen::Vector3d;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A cylinder (or a face) of a simulated part.
struct Place {
  double radius_mm = 12.5;
  double low_mm = 0.0;
  double high_mm = 30.0;
  int layers = 4;
  int points = 8;
  bool inside = false;
  Vector3d center_mm = Vector3d::Zero();
  double slope_x = 0.0;
  /// Radial deviation at an angle and a height, -1..1.
  std::function<double(double, double)> form = [](double, double) { return 0.0; };
};

/// Features with their clouds, and the surfaces of the trials that point to them.
class SimulatedPart {
 public:
  void add(const Place& place, double tip_mm, int repeats = 1) {
    auto& result = features_.emplace_back(std::make_unique<FeatureResult>());
    result->feature.shape = record::Shape::kCylinder;
    result->feature.side = place.inside ? record::Side::kInside : record::Side::kOutside;
    result->feature.strategy = record::Strategy::kGuided;
    result->tip_radius_mm = tip_mm;
    const double tip_radius = place.radius_mm + (place.inside ? -tip_mm : tip_mm);
    for (int j = 0; j < place.layers; ++j) {
      const double q = 2.0 * j / (place.layers - 1) - 1.0;
      const double z = place.low_mm + 0.5 * (q + 1.0) * (place.high_mm - place.low_mm);
      for (int i = 0; i < place.points; ++i) {
        const double angle = core::kTwoPi * i / place.points;
        const double r = tip_radius + place.form(angle, q);
        const Vector3d tip = place.center_mm + Vector3d(place.slope_x * z + r * std::cos(angle),
                                                        r * std::sin(angle), z);
        add_point(*result, j, i, tip, repeats);
      }
    }
  }

  void add_face(double z_mm, const std::vector<double>& radii_mm, int points,
                const std::function<double(double, double)>& form, int repeats = 1) {
    auto& result = features_.emplace_back(std::make_unique<FeatureResult>());
    result->feature.shape = record::Shape::kPlane;
    result->feature.strategy = record::Strategy::kGuided;
    for (std::size_t j = 0; j < radii_mm.size(); ++j) {
      for (int i = 0; i < points; ++i) {
        const double angle = core::kTwoPi * i / points;
        const double q = radii_mm[j] / radii_mm.back();
        add_point(
            *result, static_cast<int>(j), i,
            {radii_mm[j] * std::cos(angle), radii_mm[j] * std::sin(angle), z_mm + form(angle, q)},
            repeats);
      }
    }
  }

  /// As touched, with the noise of the mean of the repeats, along the normals.
  void touch(double sigma_mm, core::KeyedNoise noise) {
    for (const auto& feature : features_) {
      const bool plane = feature->feature.shape == record::Shape::kPlane;
      for (CloudPoint& point : feature->cloud) {
        const Vector3d radial = Vector3d(point.tip_mm.x(), point.tip_mm.y(), 0.0).normalized();
        const Vector3d normal = plane ? Vector3d::UnitZ() : radial;
        point.tip_mm += sigma_mm / std::sqrt(point.repeats) * noise.normal() * normal;
      }
    }
  }

  [[nodiscard]] std::vector<MeasuredSurface> measured() const {
    std::vector<MeasuredSurface> out;
    for (const auto& feature : features_) {
      MeasuredSurface& surface = out.emplace_back();
      surface.of = feature.get();
      surface.tip_radius_mm = feature->tip_radius_mm;
      for (const CloudPoint& point : feature->cloud) surface.tips_mm.push_back(point.tip_mm);
    }
    return out;
  }

  [[nodiscard]] std::vector<TrialSurface> surfaces(const Influences& influences) const {
    std::vector<TrialSurface> out;
    for (MeasuredSurface& measured : measured()) {
      TrialSurface& surface = out.emplace_back();
      for (std::size_t i = 0; i < measured.tips_mm.size(); ++i) surface.rows.push_back(i);
      surface.measured = std::move(measured);
      surface.influences = influences;
    }
    return out;
  }

 private:
  static void add_point(FeatureResult& result, int layer, int point, const Vector3d& tip,
                        int repeats) {
    CloudPoint& out = result.cloud.emplace_back();
    out.layer = layer;
    out.point = point;
    out.repeats = repeats;
    out.time_s = static_cast<double>(result.cloud.size());
    out.tip_mm = tip;
  }

  std::vector<std::unique_ptr<FeatureResult>> features_;
};

using Layers = std::vector<std::vector<Vector3d>>;

Layers layers_of_tips(const MeasuredSurface& surface) {
  Layers out;
  for (std::size_t i = 0; i < surface.tips_mm.size(); ++i) {
    const auto layer = static_cast<std::size_t>(surface.of->cloud[i].layer);
    if (out.size() <= layer) out.resize(layer + 1);
    out[layer].push_back(surface.tips_mm[i]);
  }
  return out;
}

fit::Material material_of(const MeasuredSurface& surface) {
  return {surface.of->feature.side == record::Side::kInside, surface.tip_radius_mm.value_or(0.0)};
}

/// GG, GN, SX and SN of the two-point sizes, mean of them, straightness of the generatrices.
std::vector<double> sizes_of(const MeasuredSurface& surface) {
  const auto axis = fit::ls_cylinder(surface.tips_mm, Vector3d::UnitZ());
  std::vector<double> out(6, kNone);
  if (!axis) return out;
  const fit::CylinderZone ring =
      fit::CylinderZoneFitter().fit_from(surface.tips_mm, axis->axis, fit::kMinimumCircumscribed);
  out[0] = 2.0 * material_of(surface).surface_radius_mm(axis->radius_mm);
  out[1] = 2.0 * material_of(surface).surface_radius_mm(ring.outer_radius_mm);
  const Layers layers = layers_of_tips(surface);
  const auto sections = fit::sections_across(layers, axis->axis);
  if (sections) {
    if (const auto pairs = fit::two_point_sizes(*sections, material_of(surface))) {
      const fit::RankSizes ranks = fit::rank_sizes(*pairs);
      out[2] = ranks.sx_mm;
      out[3] = ranks.sn_mm;
      out[4] = ranks.sa_mm;
    }
  }
  const auto lines = fit::generatrices(layers, axis->axis);
  if (lines) {
    double worst = 0.0;
    for (const fit::Generatrix& line : *lines) {
      const auto straight = fit::generatrix_straightness(line.heights_mm, line.distances_mm);
      if (!straight) return out;
      worst = std::max(worst, straight->zone_mm);
    }
    out[5] = worst;
  }
  return out;
}

/// Greatest minus least distance of points from an axis.
double run_out_mm(std::span<const Vector3d> points_mm, const fit::Axis& datum) {
  return fit::extremes_of(points_mm, [&](const Vector3d& p) { return fit::distance_mm(datum, p); })
      .width();
}

/// Coaxiality, circular and total run-out of the second surface about the axis of the first.
std::vector<double> about_first(std::span<const MeasuredSurface> part) {
  const auto datum = fit::ls_cylinder(part[0].tips_mm, Vector3d::UnitZ());
  const auto own = fit::ls_cylinder(part[1].tips_mm, Vector3d::UnitZ());
  if (!datum || !own) return {kNone, kNone, kNone};
  const Layers layers = layers_of_tips(part[1]);
  std::vector<double> out(3, kNone);
  const auto sections = fit::sections_across(layers, own->axis);
  if (sections) {
    std::vector<Vector3d> centers;
    for (const fit::Section& section : *sections) centers.push_back(section.center_mm);
    if (const auto value = fit::coaxiality_mm(centers, datum->axis)) out[0] = *value;
  }
  out[1] = 0.0;
  for (const auto& layer : layers) out[1] = std::max(out[1], run_out_mm(layer, datum->axis));
  out[2] = run_out_mm(part[1].tips_mm, datum->axis);
  return out;
}

Influences noise_alone(double sigma_mm) {
  Influences out;
  out.probe.emplace().repeatability_mm = sigma_mm;
  return out;
}

UncertaintyOptions options_of(int trials) {
  UncertaintyOptions out;
  out.least_trials = std::min(2000, trials);
  out.most_trials = trials;
  out.budget_trials = 0;
  return out;
}

TrialQuestion question_of(std::vector<std::size_t> surfaces, ValueFunction values,
                          std::span<const MeasuredSurface> read) {
  TrialQuestion out;
  out.surfaces = std::move(surfaces);
  out.read_mm = values(read);
  out.values = std::move(values);
  return out;
}

/// GG of one surface.
ValueFunction gg_of(std::size_t surface) {
  return [surface](std::span<const MeasuredSurface> part) -> std::vector<double> {
    const auto fit = fit::ls_cylinder(part[surface].tips_mm, Vector3d::UnitZ());
    return {fit ? material_of(part[surface]).diameter_mm(fit->radius_mm) : kNone};
  };
}

/// Touches of the reference sphere all over its upper half.
std::vector<Vector3d> reference_touches(double radius_mm) {
  std::vector<Vector3d> out = {{100.0, 200.0, 50.0 + radius_mm}};
  for (const double height : {0.0, 0.5, 0.8}) {
    for (int i = 0; i < 8; ++i) {
      const double angle = core::kTwoPi * i / 8.0;
      const double across = std::sqrt(1.0 - height * height);
      out.emplace_back(Vector3d(100.0, 200.0, 50.0) + radius_mm * Vector3d(across * std::cos(angle),
                                                                           across * std::sin(angle),
                                                                           height));
    }
  }
  return out;
}

double uncertainty_um(const TrialAnswer& answer, std::size_t value = 0) {
  EXPECT_TRUE(answer.values[value]) << answer.values[value].error().what;
  return answer.values[value]->sampled.standard_uncertainty_mm / kMicrometre;
}

double correlation(const TrialAnswer& a, const TrialAnswer& b) {
  double mean_a = 0.0;
  double mean_b = 0.0;
  const auto count = static_cast<double>(a.rows_mm.size());
  for (std::size_t t = 0; t < a.rows_mm.size(); ++t) {
    mean_a += a.rows_mm[t][0] / count;
    mean_b += b.rows_mm[t][0] / count;
  }
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  for (std::size_t t = 0; t < a.rows_mm.size(); ++t) {
    const double x = a.rows_mm[t][0] - mean_a;
    const double y = b.rows_mm[t][0] - mean_b;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  return ab / std::sqrt(aa * bb);
}

/// Drawing, section 8.1: d 25, 36 points, sigma 0.5 um, u(rho) 0.2 um, u(a) 1e-6 with dT 2.4 K,
/// u(T) 0.1 K with a 11.5e-6.
TEST(PartTrials, GiveTheUncertaintyOfASizeOfTheSpecification) {
  SimulatedPart part;
  part.add({.layers = 3, .points = 12}, 1.0);
  part.touch(0.5 * kMicrometre, core::KeyedNoise(3, {1}));
  Influences influences = noise_alone(0.5 * kMicrometre);
  std::vector<TrialSurface> surfaces = part.surfaces(influences);
  const auto gg = question_of({0}, gg_of(0), part.measured());
  const auto of = [&](const std::vector<TrialSurface>& with) {
    return uncertainty_um(PartTrials(with, {}, options_of(8000)).answers({&gg, 1}).front());
  };
  EXPECT_NEAR(of(surfaces), 2.0 * 0.5 / 6.0, 0.02 * 0.1667);
  surfaces[0].growth_1 = std::hypot(2.4 * 1e-6, 11.5e-6 * 0.1);
  surfaces[0].influences.probe->tip_radius_mm = 0.2 * kMicrometre;
  EXPECT_NEAR(of(surfaces), 0.43841115, 0.02 * 0.4384);
}

/// The sphere that the tip was qualified on is measured with the scale of the part: eps 1e-5,
/// R = R_ref = 12.5 moves no shaft, and a bore by 2 eps (R + R_ref) = 0.5 um.
TEST(PartTrials, AScaleErrorIsThatOfTheQualificationToo) {
  constexpr double kBall = 1.0;
  SimulatedPart part;
  part.add({.layers = 3, .points = 12}, kBall);
  part.add({.layers = 3, .points = 12, .inside = true}, kBall);
  Influences influences = noise_alone(1e-4 * kMicrometre);
  // Three scales of one error each: the error common to all is their mean.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    influences.machine.emplace(influences.machine.value_or(MachineInfluences()))
        .terms.axes[axis]
        .translation[axis]
        .linear_1_mm = 1e-5;
  }
  const std::vector<TrialQuestion> questions = {question_of({0}, gg_of(0), part.measured()),
                                                question_of({1}, gg_of(1), part.measured())};
  const auto spread = [&](const ReferenceTouches& reference) {
    const auto found =
        PartTrials(part.surfaces(influences), reference, options_of(20'000)).answers(questions);
    return std::pair(uncertainty_um(found[0]), uncertainty_um(found[1]));
  };
  // The radius of the part takes x and y by half each; the tip takes all three by a third each,
  // or as the touches of the sphere weigh them. Independent scales: squares add.
  const auto sphere = reference_touches(12.5 + kBall);
  const auto [shaft, bore] = spread({sphere});
  const auto [shaft_alone, bore_alone] = spread({});
  EXPECT_NEAR(shaft_alone, 1e-2 * 2.0 * 13.5 * std::sqrt(0.5), 0.02 * 0.19);
  EXPECT_NEAR(bore_alone, 1e-2 * 2.0 * 11.5 * std::sqrt(0.5), 0.02 * 0.16);
  // A column of the size of the shaft takes x and y as the shaft does.
  ReferenceTouches column{{}, true};
  for (int i = 0; i < 24; ++i) {
    const double angle = i * core::kTwoPi / 8.0;
    column.tips_mm.emplace_back(300.0 + 13.5 * std::cos(angle), 13.5 * std::sin(angle),
                                10.0 * (i / 8));
  }
  const auto [shaft_by_column, bore_by_column] = spread(column);
  EXPECT_LT(shaft_by_column, 0.002);
  EXPECT_NEAR(bore_by_column, 1e-2 * (11.5 + 13.5) * std::sqrt(2.0), 0.02 * 0.35);
  // Weights of the fit of the sphere, by brute force: the radius with one scale stretched.
  std::array<double, 3> weight{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Vector3d> stretched = sphere;
    for (Vector3d& p : stretched) {
      p[static_cast<Eigen::Index>(axis)] *= 1.0 + 1e-5;
    }
    weight[axis] =
        (fit::ls_sphere(stretched)->radius_mm - fit::ls_sphere(sphere)->radius_mm) / 1e-5;
  }
  const auto expected = [&](double radius, double side) {
    const double x = radius / 2.0 - side * weight[0];
    const double y = radius / 2.0 - side * weight[1];
    return 1e-2 * 2.0 * std::sqrt(x * x + y * y + weight[2] * weight[2]);
  };
  EXPECT_NEAR(shaft, expected(13.5, 1.0), 0.03 * expected(13.5, 1.0));
  EXPECT_NEAR(bore, expected(11.5, -1.0), 0.02 * expected(11.5, -1.0));
  // With one error for all three scales nothing is left of the shaft, and 0.5 um of the bore.
  EXPECT_NEAR(2.0 * 1e-2 * (13.5 - (weight[0] + weight[1] + weight[2])), 0.0, 1e-5);
  EXPECT_NEAR(2.0 * 1e-2 * (11.5 + (weight[0] + weight[1] + weight[2])), 0.5, 1e-5);
}

TEST(PartTrials, TheTipMovesShaftAndBoreAgainstEachOther) {
  SimulatedPart part;
  part.add({.layers = 3, .points = 12}, 1.0);
  part.add({.layers = 3, .points = 12, .inside = true}, 1.0);
  part.touch(0.01 * kMicrometre, core::KeyedNoise(4, {1}));
  Influences influences = noise_alone(0.01 * kMicrometre);
  const std::vector<TrialQuestion> questions = {question_of({0}, gg_of(0), part.measured()),
                                                question_of({1}, gg_of(1), part.measured())};
  influences.probe->reference_sphere_mm = 0.3 * kMicrometre;
  const auto found = PartTrials(part.surfaces(influences), {}, options_of(2000)).answers(questions);
  EXPECT_LT(correlation(found[0], found[1]), -0.999);
  EXPECT_NEAR(uncertainty_um(found[0]), 0.6, 0.03);
}

/// A guideway that bends by a quadratic law bends nothing of a short feature, but moves the feature
/// in the middle against the line through the ends.
TEST(PartTrials, AnErrorThatAllFeaturesShareMovesOneAgainstTheOther) {
  SimulatedPart part;
  for (const double z : {0.0, 100.0, 200.0}) {
    part.add({.low_mm = z, .high_mm = z + 10.0, .layers = 2, .points = 12}, 1.0);
  }
  Influences influences = noise_alone(1e-4 * kMicrometre);
  MachineInfluences& machine = influences.machine.emplace();
  machine.terms.axes[2].translation[0].quadratic_1_mm2 = 1e-7;  // 1 um over 100 mm, from the middle
  const ValueFunction bow = [](std::span<const MeasuredSurface> features) -> std::vector<double> {
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = fit::ls_cylinder(features[k].tips_mm, Vector3d::UnitZ());
      if (!axis) return {kNone};
      x[k] = axis->axis.point_mm.x();
    }
    return {x[1] - 0.5 * (x[0] + x[2])};
  };
  const auto question = question_of({0, 1, 2}, bow, part.measured());
  const auto found =
      PartTrials(part.surfaces(influences), {}, options_of(4000)).answers({&question, 1}).front();
  EXPECT_NEAR(uncertainty_um(found), 1.0, 0.03);
}

TEST(PartTrials, ShareWithinCountsTrialsThatHoldTogether) {
  TrialAnswer answer;
  answer.rows_mm = {{1.0, 2.0}, {1.0, 4.0}, {3.0, 2.0}, {3.0, kNone}};
  const std::array<Limits, 2> limits = {Limits{{}, 2.0}, Limits{{}, 3.0}};
  // Each condition holds in half of the trials; the product would be a quarter of them, too, were
  // they independent, and with the last row it is not.
  EXPECT_EQ(share_within(answer, limits), 0.25);
  const std::array<Limits, 2> wide = {Limits{{}, 5.0}, Limits{3.0, 5.0}};
  EXPECT_EQ(share_within(answer, wide), 0.25);
  EXPECT_EQ(share_within({}, limits), 0.0);
}

TEST(PartTrials, AreTheSameAtAnyNumberOfThreads) {
  SimulatedPart part;
  part.add({}, 1.0);
  part.add_face(60.0, {5.0, 10.0}, 8, [](double, double) { return 0.0; });
  part.touch(0.3 * kMicrometre, core::KeyedNoise(5, {1}));
  const std::vector<TrialQuestion> questions = {question_of({0}, gg_of(0), part.measured())};
  UncertaintyOptions options = options_of(200);
  options.least_trials = 200;
  const auto rows = [&](int threads) {
    options.threads = threads;
    return PartTrials(part.surfaces(noise_alone(0.3 * kMicrometre)), {}, options)
        .answers(questions)
        .front()
        .rows_mm;
  };
  EXPECT_EQ(rows(1), rows(3));
}

TEST(PartTrials, StateNoIntervalWithoutNoiseOfATouch) {
  SimulatedPart part;
  part.add({}, 1.0);
  part.add({.low_mm = 50.0, .high_mm = 80.0}, 1.0);
  std::vector<TrialSurface> surfaces = part.surfaces(noise_alone(0.3 * kMicrometre));
  surfaces[1].influences.probe.emplace().repeatability_known = false;
  const std::vector<TrialQuestion> questions = {question_of({0}, gg_of(0), part.measured()),
                                                question_of({1, 0}, gg_of(1), part.measured()),
                                                question_of({0, 1}, gg_of(0), part.measured())};
  UncertaintyOptions options = options_of(200);
  options.least_trials = 200;
  const auto found = PartTrials(surfaces, {}, options).answers(questions);
  EXPECT_TRUE(found[0].values[0]);
  for (const std::size_t q : {1, 2}) {  // its own points, or those of its datum
    ASSERT_FALSE(found[q].values[0]);
    EXPECT_EQ(found[q].values[0].error().code, core::Code::kMeaning);
    EXPECT_TRUE(found[q].rows_mm.empty());
  }
}

TEST(PartTrials, ALengthLimitNeedsNoDeclarationOfASurfaceThatNoQuestionAsksAbout) {
  SimulatedPart part;
  part.add({}, 1.0);
  part.add({.low_mm = 50.0, .high_mm = 80.0}, 1.0);
  part.touch(0.3 * kMicrometre, core::KeyedNoise(7, {1}));
  Influences limit = noise_alone(0.3 * kMicrometre);
  limit.machine.emplace().length_limit_mm = 1.5 * kMicrometre;
  std::vector<TrialSurface> surfaces = part.surfaces(limit);
  surfaces[1].rows.clear();
  surfaces[1].influences = {};
  const auto gg = question_of({0}, gg_of(0), part.measured());
  const auto found = PartTrials(surfaces, {}, options_of(400)).answers({&gg, 1}).front();
  EXPECT_TRUE(found.values[0]);
}

TEST(PartTrials, AValueThatSomeTrialsLackHasNoInterval) {
  SimulatedPart part;
  part.add({}, 1.0);
  part.touch(0.3 * kMicrometre, core::KeyedNoise(6, {1}));
  const MeasuredSurface read = part.measured().front();
  const ValueFunction fragile = [&](std::span<const MeasuredSurface> features) {
    const double moved = features[0].tips_mm[0].x() - read.tips_mm[0].x();
    return std::vector<double>{moved > 0.5 * kMicrometre ? kNone : 1.0, 2.0};
  };
  const auto question = question_of({0}, fragile, part.measured());
  const auto found = PartTrials(part.surfaces(noise_alone(0.3 * kMicrometre)), {}, options_of(400))
                         .answers({&question, 1})
                         .front();
  ASSERT_FALSE(found.values[0]);
  EXPECT_EQ(found.values[0].error().code, core::Code::kReferenceAbsent);
  EXPECT_TRUE(found.values[1]);
}

TEST(PartTrials, PointsThatTakeNoPartStayWhereTheyAre) {
  SimulatedPart part;
  part.add({}, 1.0);
  part.touch(0.3 * kMicrometre, core::KeyedNoise(7, {1}));
  const MeasuredSurface read = part.measured().front();
  std::vector<TrialSurface> surfaces = part.surfaces(noise_alone(0.3 * kMicrometre));
  surfaces[0].rows.erase(surfaces[0].rows.begin() + 3);
  const ValueFunction how_far = [&](std::span<const MeasuredSurface> features) {
    return std::vector<double>{(features[0].tips_mm[3] - read.tips_mm[3]).norm(),
                               (features[0].tips_mm[4] - read.tips_mm[4]).norm()};
  };
  const auto question = question_of({0}, how_far, part.measured());
  const auto found = PartTrials(surfaces, {}, options_of(400)).answers({&question, 1}).front();
  for (const std::vector<double>& row : found.rows_mm) EXPECT_EQ(row[0], 0.0);
  EXPECT_GT(found.rows_mm[0][1], 0.0);
}

/// The lobed, tapered, barrelled form of a simulated part, scaled. Its lobes are those that 7
/// points resolve: noise beside lobes that they do not resolve counts as form, and the truth lies
/// below.
struct DrawnForm {
  explicit DrawnForm(core::KeyedNoise noise, double scale_mm) : scale(scale_mm) {
    for (std::size_t k = 0; k < kLobes.size(); ++k) {
      amplitude[k] = noise.normal() / kLobes[k];
      phase[k] = core::kTwoPi * noise.uniform();
      twist[k] = 2.0 * noise.uniform() - 1.0;
    }
    taper = 0.5 * noise.normal();
    barrel = 0.5 * noise.normal();
  }
  [[nodiscard]] double at(double angle, double q) const {
    double sum = taper * q + barrel * (q * q - 1.0 / 3.0);
    for (std::size_t k = 0; k < kLobes.size(); ++k) {
      sum += amplitude[k] * std::cos(kLobes[k] * angle + phase[k] + twist[k] * q);
    }
    return scale * sum;
  }
  static constexpr std::array<int, 2> kLobes = {2, 3};
  std::array<double, 2> amplitude{};
  std::array<double, 2> phase{};
  std::array<double, 2> twist{};
  double taper = 0.0;
  double barrel = 0.0;
  double scale = 1.0;
};

/// A datum journal and a seat that is a little off its axis, and a face.
struct CoverageCase {
  std::string name;
  int layers = 4;
  int points = 8;
  int repeats = 5;
  double sigma_mm = 0.5e-3;
  double form_mm = 1.5e-3;
  double offset_mm = 0.004;  ///< Of the seat from the axis of the datum.
  int inspections = 6;       ///< 200 with RONDURE_FULL=1, 1000 with RONDURE_FULL=all.
  friend std::ostream& operator<<(std::ostream& out, const CoverageCase& c) {
    return out << c.name;
  }
};

constexpr std::array<const char*, 10> kNames = {
    "GG",           "GN",         "LP SX",   "LP SN",         "LP SA",
    "straightness", "coaxiality", "run-out", "total run-out", "flatness"};

std::vector<TrialQuestion> questions_about(std::span<const MeasuredSurface> read) {
  const ValueFunction sizes = [](std::span<const MeasuredSurface> part) {
    return sizes_of(part[1]);
  };
  const ValueFunction flat = [](std::span<const MeasuredSurface> part) -> std::vector<double> {
    const auto plane = fit::ls_plane(part[2].tips_mm);
    return {plane ? plane->deviation_mm : kNone};
  };
  return {question_of({1}, sizes, read), question_of({1, 0}, about_first, read),
          question_of({2}, flat, read)};
}

class PartCoverage : public testing::TestWithParam<CoverageCase> {};

TEST_P(PartCoverage, TheIntervalsHoldTheTruth) {
  const CoverageCase& c = GetParam();
  const int count = test::cases(c.inspections, 200, 1000);
  std::array<int, kNames.size()> held{};
  std::array<int, kNames.size()> stated{};
  std::array<int, kNames.size()> above{};
  std::array<double, kNames.size()> bias{};
  std::array<double, kNames.size()> read_bias{};
  std::array<double, kNames.size()> width{};
  for (int p = 0; p < count; ++p) {
    const auto number = static_cast<std::uint64_t>(p);
    SimulatedPart part;
    std::array<std::shared_ptr<DrawnForm>, 3> forms;
    for (std::size_t f = 0; f < forms.size(); ++f) {
      forms[f] = std::make_shared<DrawnForm>(core::KeyedNoise(20261123, {1, f, number}), c.form_mm);
    }
    const auto form = [&](std::size_t f) {
      return [shape = forms[f]](double angle, double q) { return shape->at(angle, q); };
    };
    part.add(
        {.low_mm = 0.0, .high_mm = 40.0, .layers = c.layers, .points = c.points, .form = form(0)},
        1.0, c.repeats);
    part.add({.low_mm = 50.0,
              .high_mm = 90.0,
              .layers = c.layers,
              .points = c.points,
              .center_mm = {c.offset_mm, 0.0, 0.0},
              .form = form(1)},
             1.0, c.repeats);
    part.add_face(100.0, {5.0, 8.0, 12.0}, c.points, form(2), c.repeats);
    std::vector<double> truth;
    for (const TrialQuestion& question : questions_about(part.measured())) {
      truth.insert(truth.end(), question.read_mm.begin(), question.read_mm.end());
    }
    part.touch(c.sigma_mm, core::KeyedNoise(20261123, {2, number}));
    UncertaintyOptions options = options_of(test::cases(200, 400));
    options.least_trials = options.most_trials;
    options.seed = number + 1;
    const auto questions = questions_about(part.measured());
    const auto found =
        PartTrials(part.surfaces(noise_alone(c.sigma_mm)), {}, options).answers(questions);
    std::size_t v = 0;
    for (std::size_t q = 0; q < found.size(); ++q) {
      for (std::size_t k = 0; k < found[q].values.size(); ++k, ++v) {
        if (!found[q].values[k]) continue;
        const UncertaintyStatement& s = found[q].values[k]->sampled;
        ++stated[v];
        held[v] += s.low_mm <= truth[v] && truth[v] <= s.high_mm ? 1 : 0;
        const double read = questions[q].read_mm[k];
        above[v] += truth[v] > s.high_mm ? 1 : 0;
        bias[v] += (s.estimate_mm - truth[v]) / kMicrometre;
        read_bias[v] += (read - truth[v]) / kMicrometre;
        width[v] += s.expanded_mm() / kMicrometre;
      }
    }
  }
  for (std::size_t v = 0; v < kNames.size(); ++v) {
    if (stated[v] == 0) continue;
    const double share = 100.0 * held[v] / stated[v];
    std::printf(
        "%-24s %-13s stated %4d held %5.1f %% truth above %5.1f %%  bias %+.3f um (as read %+.3f)  "
        "U %.3f um\n",
        c.name.c_str(), kNames[v], stated[v], share, 100.0 * above[v] / stated[v],
        bias[v] / stated[v], read_bias[v] / stated[v], width[v] / stated[v]);
    EXPECT_GE(stated[v], count * 9 / 10) << kNames[v];
    // Chance of the inspections: three standard deviations of their share.
    const double chance = 300.0 * std::sqrt(0.93 * 0.07 / stated[v]);
    EXPECT_GE(share, 93.0 - chance) << kNames[v];
  }
  // So few show a wrong width late. That of the least-squares size is known: 1.96 u of the mean of
  // all touches of the radius, twice.
  const double touches = c.layers * c.points * c.repeats;
  const double expanded_um = 1.96 * 2.0 * c.sigma_mm / std::sqrt(touches) / kMicrometre;
  EXPECT_NEAR(width[0] / stated[0], expanded_um, 0.1 * expanded_um);
}

INSTANTIATE_TEST_SUITE_P(
    Parts, PartCoverage,
    testing::Values(CoverageCase{.name = "4 x 7, 5 repeats", .points = 7},
                    CoverageCase{.name = "4 x 8, 5 repeats"},
                    CoverageCase{.name = "4 x 8, single", .repeats = 1},
                    CoverageCase{.name = "4 x 8, quiet", .sigma_mm = 0.1e-3},
                    CoverageCase{
                        .name = "4 x 36, single", .points = 36, .repeats = 1, .inspections = 3}));

}  // namespace
}  // namespace rondure::reports
