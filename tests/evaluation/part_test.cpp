// A surface as the characteristics of a drawing see it: windows, sections, filters, outliers.
#include "evaluation/part/surface.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/part/contacts.h"
#include "evaluation/part/find.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/profiles/generatrix.h"
#include "fit/sizes/sizes.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"
#include "tests/fit/drawing_cases.h"

namespace rondure::evaluation {
namespace {

using record::Indication;
using record::SurfaceSettings;
using record::WindowTask;
using test::Layers;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kWorked = 1e-10;  // mm; the specification prints twelve decimals

/// A cylinder (a circle of one layer) whose points come from a file of known layers.
FeatureResult cylinder_of(const Layers& layers, const SurfaceSettings& settings = {}) {
  FeatureResult out;
  out.feature.id = "land";
  out.feature.shape = layers.size() > 1 ? record::Shape::kCylinder : record::Shape::kCircle;
  out.feature.strategy = record::Strategy::kPointsFile;
  out.feature.layers = static_cast<int>(layers.size());
  out.feature.settings = record::settings_of_task(settings);
  out.tip_radius_mm = 0.0;
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    for (std::size_t i = 0; i < layers[layer].size(); ++i) {
      CloudPoint point;
      point.layer = static_cast<int>(layer);
      point.point = static_cast<int>(i);
      point.tip_mm = layers[layer][i];
      out.cloud.push_back(point);
    }
  }
  const auto points = test::all_of(layers);
  if (layers.size() > 1) {
    const auto ls = fit::ls_cylinder(points);
    if (ls) out.ls_cylinder = *ls;
  } else {
    out.section_axis = {fit::mean_point(points), Eigen::Vector3d::UnitZ()};
  }
  return out;
}

core::Result<PreparedSurface> prepared_of(const FeatureResult& feature,
                                          const Indication& indication = {}) {
  return prepared(surfaces_of({&feature, 1}).front(), indication);
}

Indication gaussian(std::optional<double> upr, std::optional<double> mm = std::nullopt) {
  Indication out;
  out.filter = Indication::Filter::kGaussian;
  out.cutoff_upr = upr;
  out.cutoff_mm = mm;
  return out;
}

WindowTask window(double from_deg, double to_deg, double guard_mm = 0.0) {
  WindowTask out;
  out.name = "keyway";
  out.from_deg = from_deg;
  out.to_deg = to_deg;
  out.guard_mm = guard_mm;
  return out;
}

SurfaceSettings with_window(const WindowTask& window) {
  SurfaceSettings out;
  out.exclude = {window};
  return out;
}

std::vector<std::size_t> left_out_rows(const PreparedSurface& surface) {
  std::vector<std::size_t> out;
  for (const LeftOut& row : surface.left_out) out.push_back(row.row);
  return out;
}

std::vector<core::Code> warned(const PreparedSurface& surface) {
  std::vector<core::Code> out;
  for (const core::Error& warning : surface.warnings) out.push_back(warning.code);
  return out;
}

/// `count` points of a circle; r(theta) from the radius of 20 mm.
template <class Profile>
std::vector<Eigen::Vector3d> ring(std::size_t count, double z, const Profile& r,
                                  double center_x = 0.0) {
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = core::kTwoPi * static_cast<double>(i) / static_cast<double>(count);
    const double radius = 20.0 + r(t);
    out.emplace_back(center_x + radius * std::cos(t), radius * std::sin(t), z);
  }
  return out;
}

double w8_profile(double t) {
  return 4e-3 * std::cos(2.0 * t - 0.3) + 3e-3 * std::cos(3.0 * t - 1.1) +
         1.5e-3 * std::cos(7.0 * t + 0.4) + 8e-4 * std::cos(40.0 * t) +
         5e-4 * std::cos(120.0 * t - 0.2);
}

Layers w8(double center_x = 0.0) { return {ring(360, 0.0, w8_profile, center_x)}; }

double ron_ls(const PreparedSurface& surface, std::size_t section = 0) {
  std::vector<Eigen::Vector2d> points;
  const auto layers = layers_of(surface);
  for (const Eigen::Vector3d& p : layers[section]) points.push_back(p.head<2>());
  return fit::ls_circle(points)->deviation_mm;
}

// ---- Windows.

TEST(SurfaceWindows, OfW6GiveItsSizes) {
  FeatureResult bore = cylinder_of(test::w6(), with_window(window(75.0, 105.0)));
  bore.feature.side = record::Side::kInside;
  bore.tip_radius_mm = 1.5;
  const auto surface = prepared_of(bore);
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_THAT(left_out_rows(*surface), ElementsAre(4, 20));
  EXPECT_EQ(surface->left_out[0].window, "keyway");
  ASSERT_EQ(surface->sections.size(), 2U);
  EXPECT_TRUE(surface->sections[0].gap);
  const auto sizes = fit::global_sizes(surface->points_mm, surface->material);
  ASSERT_TRUE(sizes);
  EXPECT_NEAR(sizes->gg_mm, 39.999953257850, kWorked);
  EXPECT_NEAR(*sizes->gx_mm, 39.994130396679, kWorked);
  const auto sections = fit::sections_across(layers_of(*surface), surface->axis);
  ASSERT_TRUE(sections);
  const auto local = fit::two_point_sizes(*sections, surface->material);
  ASSERT_TRUE(local);
  EXPECT_EQ(local->size(), 14U);
  EXPECT_NEAR(fit::rank_sizes(*local).sx_mm, 40.005130701989, kWorked);

  bore.feature.settings.clear();  // the window forgotten
  const auto forgotten = prepared_of(bore);
  ASSERT_TRUE(forgotten);
  EXPECT_NEAR(fit::global_sizes(forgotten->points_mm, forgotten->material)->gg_mm, 40.378788150630,
              kWorked);
  EXPECT_THAT(warned(*forgotten), ElementsAre(core::Code::kOutliers, core::Code::kOutliers));
}

TEST(SurfaceWindows, MayContainAngleZero) {
  const Layers layers = {ring(36, 0.0, [](double) { return 0.0; }),
                         ring(36, 10.0, [](double) { return 0.0; })};
  for (const auto& [from, to] : {std::pair{345.0, 15.0}, std::pair{-15.0, 15.0}}) {
    const auto surface = prepared_of(cylinder_of(layers, with_window(window(from, to))));
    ASSERT_TRUE(surface) << surface.error().what;
    EXPECT_THAT(left_out_rows(*surface), ElementsAre(0, 1, 35, 36, 37, 71));
  }
  const auto other_way = prepared_of(cylinder_of(layers, with_window(window(45.0, 315.0))));
  ASSERT_TRUE(other_way);
  EXPECT_EQ(other_way->points_mm.size(), 18U);
}

TEST(SurfaceWindows, WidenByTheirGuard) {
  const Layers layers = {ring(360, 0.0, [](double) { return 0.0; }),
                         ring(360, 10.0, [](double) { return 0.0; })};
  const auto rows = [&](std::optional<double> guard, double tip_mm) {
    WindowTask hole = window(89.5, 90.5);
    hole.guard_mm = guard;
    hole.to_mm = 5.0;
    FeatureResult feature = cylinder_of(layers, with_window(hole));
    feature.tip_radius_mm = tip_mm;
    const auto surface = prepared_of(feature);
    return surface ? surface->left_out.size() : 999U;
  };
  EXPECT_EQ(rows(0.0, 1.0), 1U);
  // 1.5 mm at a radius of 20 mm are 4.3 deg on each side.
  EXPECT_EQ(rows(std::nullopt, 1.0), 9U);
  EXPECT_EQ(rows(1.5, 0.0), 9U);
  EXPECT_EQ(rows(std::nullopt, 0.0), 3U);  // 0.5 mm
  EXPECT_EQ(rows(5.1, 0.0), 2U * 31U);     // reaches the layer at 10 mm
}

TEST(SurfaceWindows, HaveOpenEnds) {
  const Layers layers = {ring(4, 0.0, [](double) { return 0.0; }),
                         ring(4, 10.0, [](double) { return 0.0; }),
                         ring(4, 20.0, [](double) { return 0.0; })};
  WindowTask band;
  band.name = "groove";
  band.from_mm = 0.0;
  band.to_mm = 10.0;
  band.guard_mm = 0.0;
  const auto surface = prepared_of(cylinder_of(layers, with_window(band)));
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_TRUE(surface->left_out.empty());
}

TEST(SurfaceWindows, ThatTakeALayerLeaveASectionLessAndSaySo) {
  Layers layers;
  for (const double z : {0.0, 10.0, 20.0}) layers.push_back(ring(8, z, [](double) { return 0.0; }));
  WindowTask groove;
  groove.name = "groove";
  groove.from_mm = 8.0;
  groove.to_mm = 12.0;
  const auto surface = prepared_of(cylinder_of(layers, with_window(groove)));
  ASSERT_TRUE(surface) << surface.error().what;
  ASSERT_EQ(surface->sections.size(), 2U);
  EXPECT_EQ(surface->sections[1].layer, 2);
  EXPECT_FALSE(surface->sections[1].gap);
  EXPECT_THAT(left_out_rows(*surface), ElementsAre(8, 9, 10, 11, 12, 13, 14, 15));
  ASSERT_EQ(surface->warnings.size(), 1U);
  EXPECT_THAT(surface->warnings[0].what, HasSubstr("all points of layer 2"));

  groove.from_mm = -2.0;
  const auto refused = prepared_of(cylinder_of(layers, with_window(groove)));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kRank);
  EXPECT_THAT(refused.error().what, HasSubstr("leave 1 of 3 layers; 2 are needed"));
}

TEST(SurfaceWindows, StandAboutTheAxisOfTheRemainingPoints) {
  // A keyway so deep that the axis of all points leans to it by a degree of the circumference.
  const auto keyway = [](double t) {
    return std::abs(t - std::numbers::pi / 2.0) < 31.0 * core::kDegree ? 3.0 : 0.0;
  };
  const Layers layers = {ring(360, 0.0, keyway), ring(360, 10.0, keyway)};
  const auto surface = prepared_of(cylinder_of(layers, with_window(window(58.5, 121.5))));
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_EQ(surface->left_out.size(), 2U * 63U);
  EXPECT_LT(fit::ls_cylinder(surface->points_mm)->deviation_mm, 1e-9);
}

TEST(SurfaceWindows, AreRefusedWhereTheyAreEmptyOrHalf) {
  const Layers layers = test::w6();
  const auto refusal = [&](const WindowTask& task) {
    const auto surface = prepared_of(cylinder_of(layers, with_window(task)));
    return surface ? std::string() : surface.error().what;
  };
  EXPECT_THAT(refusal(window(90.0, 90.0)), HasSubstr("an empty window or a whole turn?"));
  WindowTask half = window(10.0, 20.0);
  half.to_deg.reset();
  EXPECT_THAT(refusal(half), HasSubstr("belong together"));
  WindowTask turned = window(10.0, 20.0);
  turned.from_mm = 5.0;
  turned.to_mm = 1.0;
  EXPECT_THAT(refusal(turned), HasSubstr("exchange them"));
}

TEST(SurfaceWindows, LeaveOutOnlyWhatLiesOffTheProfile) {
  // A hole of three points somewhere in a wide window, on a part with form of 10 um.
  const auto holed = [](double t) {
    const bool in_hole = std::abs(t - 1.0) < 1.5 * core::kDegree;
    return 5e-3 * std::cos(2.0 * t) + 2e-3 * std::cos(5.0 * t) + (in_hole ? -0.4 : 0.0);
  };
  const Layers layers = {ring(360, 0.0, holed), ring(360, 10.0, w8_profile)};
  WindowTask somewhere = window(20.0, 90.0);
  somewhere.found_beyond_um = 20.0;
  const auto surface = prepared_of(cylinder_of(layers, with_window(somewhere)));
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_THAT(left_out_rows(*surface), ElementsAre(56, 57, 58));

  somewhere.from_deg = 0.0;
  somewhere.to_deg = 180.0;
  somewhere.found_beyond_um = 1e-3;  // so narrow that it would take noise and form
  const auto rough = [](double t) { return 1e-3 * std::cos(90.0 * t); };
  const auto refused = prepared_of(
      cylinder_of({ring(360, 0.0, rough), ring(360, 10.0, rough)}, with_window(somewhere)));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kOutliers);
  EXPECT_THAT(refused.error().what, HasSubstr("more than 20 %"));
}

TEST(SurfaceWindows, OfATouchedPartTurnWithItsPose) {
  // The part leans by 30 deg; its window at 90 deg lies between 10 and 20 mm of part z.
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(30.0 * core::kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Layers layers;
  for (const double z : {100.0, 115.0, 130.0}) {
    layers.push_back(ring(8, z, [](double) { return 0.0; }));
    for (Eigen::Vector3d& p : layers.back()) p = turn * p;
  }
  SurfaceSettings settings = with_window(window(80.0, 100.0));
  settings.exclude[0].from_mm = 10.0;
  settings.exclude[0].to_mm = 20.0;
  settings.first_layer_mm = 0.0;
  FeatureResult feature = cylinder_of(layers, settings);
  feature.feature.strategy = record::Strategy::kGuided;
  feature.part_turn = turn;
  const auto surface = prepared_of(feature);
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_THAT(left_out_rows(*surface), ElementsAre(8 + 2));

  settings.first_layer_mm.reset();
  feature.feature.settings = record::settings_of_task(settings);
  EXPECT_EQ(prepared_of(feature).error().code, core::Code::kMeaning);
}

// ---- Portions and sections.

TEST(SurfaceSections, OfAPortionKeepTheAxisOfTheFeature) {
  Indication low;
  low.to_mm = 25.0;
  const auto surface = prepared_of(cylinder_of(test::w1()), low);
  const auto whole = prepared_of(cylinder_of(test::w1()));
  ASSERT_TRUE(surface && whole);
  EXPECT_EQ(surface->sections.size(), 2U);
  EXPECT_EQ(surface->points_mm.size(), 24U);
  EXPECT_EQ(surface->axis.direction, whole->axis.direction);
  low.to_mm = 5.0;
  const auto nothing = prepared_of(cylinder_of(test::w1()), low);
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().what, HasSubstr("no layer lies in the portion"));
}

TEST(SurfaceSections, OfAFileWithoutLayersAreGroupsOfHeights) {
  FeatureResult feature = cylinder_of(test::w2());
  feature.feature.layers = 0;
  std::reverse(feature.cloud.begin(), feature.cloud.end());
  for (CloudPoint& point : feature.cloud) point.layer = 0;
  const auto surface = prepared_of(feature);
  ASSERT_TRUE(surface) << surface.error().what;
  ASSERT_EQ(surface->sections.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(surface->sections[i].points.size(), 8U);
    EXPECT_NEAR(surface->points_mm[surface->sections[i].points[0]].z(),
                5.0 + 20.0 * static_cast<double>(i), 0.1);
  }
}

TEST(SurfaceSections, ThickerThanHalfAMillimetreAreNone) {
  FeatureResult helix = cylinder_of(test::w2());
  helix.feature.layers = 0;
  for (std::size_t i = 0; i < helix.cloud.size(); ++i) {
    helix.cloud[i].layer = 0;
    helix.cloud[i].tip_mm.z() = 0.2 * static_cast<double>(i);
  }
  const auto surface = prepared_of(helix);
  ASSERT_TRUE(surface) << "cylindricity needs none";
  EXPECT_TRUE(surface->sections.empty());
  ASSERT_TRUE(surface->no_sections);
  EXPECT_EQ(surface->no_sections->code, core::Code::kSampling);
  EXPECT_THAT(surface->no_sections->what, HasSubstr("section 1 is 6."));
  Indication filtered;
  filtered.filter = Indication::Filter::kGaussian;
  EXPECT_EQ(prepared_of(helix, filtered).error().code, core::Code::kSampling);
}

TEST(SurfaceSections, OfOneLayerAreRefusedWithoutAWordOfWindows) {
  FeatureResult one = cylinder_of(test::w2());
  for (CloudPoint& point : one.cloud) point.layer = 0;
  const auto surface = prepared_of(one);
  ASSERT_FALSE(surface);
  EXPECT_THAT(surface.error().what, HasSubstr("all points lie in one layer"));
}

TEST(SurfaceSections, OfAScanAreItsPasses) {
  FeatureResult scan = cylinder_of({ring(720, 0.0, w8_profile), ring(720, 10.0, w8_profile)});
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) scan.cloud[i].pass = static_cast<int>(i % 2);
  const auto surface = prepared_of(scan);
  ASSERT_TRUE(surface);
  ASSERT_EQ(surface->sections.size(), 4U);
  EXPECT_EQ(surface->sections[1].layer, 0);
  EXPECT_EQ(surface->sections[1].points.size(), 360U);
  EXPECT_EQ(surface->sections[2].layer, 1);
}

TEST(SurfaceSections, OfAPlaneAreCirclesAndItsNormalPointsOut) {
  SurfaceSettings settings;
  settings.faces = record::Faces::kDown;
  FeatureResult face;
  face.feature.shape = record::Shape::kPlane;
  face.feature.strategy = record::Strategy::kPointsFile;
  face.feature.layers = 2;
  face.feature.settings = record::settings_of_task(settings);
  const Layers circles = test::w4_face();
  for (const int layer : {0, 1}) {
    for (const Eigen::Vector3d& p : circles[static_cast<std::size_t>(layer)]) {
      CloudPoint point;
      point.layer = layer;
      point.tip_mm = p;
      face.cloud.push_back(point);
    }
  }
  const auto surface = prepared_of(face);
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_LT(surface->axis.direction.z(), -0.99);
  ASSERT_EQ(surface->sections.size(), 2U);
  EXPECT_NEAR(surface->sections[0].height_mm, 15.0, 0.01);
  EXPECT_NEAR(surface->sections[1].height_mm, 30.0, 0.01);
  EXPECT_EQ(prepared_of(face, gaussian(15.0)).error().code, core::Code::kMeaning);
}

TEST(SurfaceSections, OfAConeAreSquareToItsOwnAxis) {
  FeatureResult cone = cylinder_of(test::w7());
  cone.feature.shape = record::Shape::kCone;
  cone.ls_cylinder.reset();
  const auto surface = prepared_of(cone);
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_EQ(surface->sections.size(), 3U);
  EXPECT_NEAR(surface->axis.direction.x(), 0.00019696673504, 1e-10);
  EXPECT_NEAR(surface->axis.direction.y(), -0.00009347580125, 1e-10);
}

// ---- Filters.

TEST(SurfaceFilter, OfW8GivesItsNumbers) {
  const auto surface = prepared_of(cylinder_of(w8()), gaussian(50.0));
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_NEAR(ron_ls(*surface), 0.014761219827, kWorked);
  EXPECT_EQ(surface->filter.english(), "gaussian 50 UPR");
  EXPECT_TRUE(surface->sections[0].dense);
  EXPECT_TRUE(surface->warnings.empty());
  const auto as_measured = prepared_of(cylinder_of(w8()));
  ASSERT_TRUE(as_measured);
  EXPECT_NEAR(ron_ls(*as_measured), 0.016178711019, kWorked);
  EXPECT_EQ(as_measured->filter.english(), "unfiltered");
  EXPECT_THAT(warned(*as_measured), ElementsAre(core::Code::kUnfiltered));
}

TEST(SurfaceFilter, BridgesAWindowAboutTheCircleOfTheOtherPoints) {
  // Rows 100..110. The specification prints 0.015048350530: it filters about the origin of the
  // profile, not about the section circle as its 6.2 says.
  const auto surface =
      prepared_of(cylinder_of(w8(), with_window(window(99.5, 110.5))), gaussian(50.0));
  ASSERT_TRUE(surface) << surface.error().what;
  EXPECT_EQ(surface->left_out.size(), 11U);
  EXPECT_NEAR(ron_ls(*surface), 0.015048352689, 1e-11);
  EXPECT_NEAR(surface->points_mm[100].head<2>().norm(), 19.996527621279, 1e-6);  // row 111
  Indication spline = gaussian(50.0);
  spline.filter = Indication::Filter::kSpline;
  const auto refused = prepared_of(cylinder_of(w8(), with_window(window(99.5, 110.5))), spline);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("not defined beside a window"));
}

TEST(SurfaceFilter, BesideAWindowNeedsTheRestOfTheTurn) {
  // 100..110 deg are the window; at 200..239 deg nothing was measured.
  Layers layers = w8();
  auto& points = layers[0];
  points.erase(points.begin() + 200, points.begin() + 240);
  const auto gap =
      prepared_of(cylinder_of(layers, with_window(window(99.5, 110.5))), gaussian(15.0));
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().code, core::Code::kSampling);
  EXPECT_THAT(gap.error().what, HasSubstr("largest gap between angles is 41 deg"));
}

TEST(SurfaceFilter, KeepsTheEccentricity) {
  const auto centred = prepared_of(cylinder_of(w8()), gaussian(50.0));
  const auto eccentric = prepared_of(cylinder_of(w8(0.05)), gaussian(50.0));
  ASSERT_TRUE(centred && eccentric);
  EXPECT_NEAR(ron_ls(*eccentric), ron_ls(*centred), 1e-9);
  std::vector<Eigen::Vector2d> before;
  std::vector<Eigen::Vector2d> after;
  const Layers sections = w8(0.05);
  for (const Eigen::Vector3d& p : sections[0]) before.push_back(p.head<2>());
  for (const Eigen::Vector3d& p : eccentric->points_mm) after.push_back(p.head<2>());
  EXPECT_LT((fit::ls_circle(before)->center_mm - fit::ls_circle(after)->center_mm).norm(), 1e-9);
}

TEST(SurfaceFilter, PassesUndulationsAtUnevenAnglesAsTheGaussianDoes) {
  // 40 UPR through a cut-off of 50: half to the power of 0.64.
  core::KeyedNoise noise(4, {19});
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 1800; ++i) {
    const double t = core::kTwoPi * (i + 0.6 * noise.uniform()) / 1800.0;
    const double r = 20.0 + 1e-3 * std::cos(40.0 * t);
    points.emplace_back(r * std::cos(t), r * std::sin(t), 0.0);
  }
  const auto surface = prepared_of(cylinder_of({points}), gaussian(50.0));
  ASSERT_TRUE(surface) << surface.error().what;
  const double passed = 1e-3 * std::exp2(-0.64);
  for (const Eigen::Vector3d& p : surface->points_mm) {
    const double t = std::atan2(p.y(), p.x());
    EXPECT_NEAR(p.head<2>().norm(), 20.0 + passed * std::cos(40.0 * t), 1e-7);
  }
}

TEST(SurfaceFilter, IsRefusedWithTheNumbersThatAreThere) {
  const auto few = prepared_of(cylinder_of({ring(349, 0.0, w8_profile)}), gaussian(50.0));
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().code, core::Code::kSampling);
  EXPECT_THAT(few.error().what, HasSubstr("349 points"));
  EXPECT_THAT(few.error().what, HasSubstr("350 points"));
  EXPECT_THAT(few.error().what, HasSubstr("scan, or plan filter \"none\""));
  EXPECT_TRUE(prepared_of(cylinder_of({ring(350, 0.0, w8_profile)}), gaussian(50.0)));
  const auto touched = prepared_of(cylinder_of(test::w1()), gaussian(50.0));
  ASSERT_FALSE(touched);
  EXPECT_EQ(touched.error().code, core::Code::kSampling);
  // 400 points of which a part of the turn is missing, though no window says so.
  std::vector<Eigen::Vector3d> open = ring(410, 0.0, w8_profile);
  open.resize(400);
  const auto gap = prepared_of(cylinder_of({open}), gaussian(50.0));
  ASSERT_FALSE(gap);
  EXPECT_THAT(gap.error().what, HasSubstr("largest gap between angles"));
  EXPECT_EQ(prepared_of(cylinder_of(w8()), gaussian(std::nullopt)).error().code,
            core::Code::kMissingKey);
  for (const double upr : {0.001, 1.0, 1.99}) {
    const auto eaten = prepared_of(cylinder_of(w8()), gaussian(upr));
    ASSERT_FALSE(eaten) << upr;
    EXPECT_THAT(eaten.error().what, HasSubstr("leaves no form"));
  }
}

TEST(SurfaceFilter, WarnsOfACutOffThatLeavesLessFormThanIsUsual) {
  const FeatureResult circle = cylinder_of(w8());
  const std::vector<MeasuredSurface> part = surfaces_of({&circle, 1});
  record::Characteristic asked{"round", record::Form::kRoundness, record::Reference::kLeastSquares,
                               0.02, ""};
  asked.indication = gaussian(14.0);
  const auto low = find(part, 0, asked);
  ASSERT_TRUE(low) << low.error().what;
  ASSERT_EQ(low->warnings.size(), 1U);
  EXPECT_EQ(low->warnings[0].code, core::Code::kHarmonicLoss);
  EXPECT_THAT(low->warnings[0].what, StartsWith("form above 14 UPR is filtered away"));
  asked.indication = gaussian(15.0);
  const auto usual = find(part, 0, asked);
  ASSERT_TRUE(usual) << usual.error().what;
  EXPECT_TRUE(usual->warnings.empty());
}

TEST(SurfaceFilter, WarnsOfAliasingThatItSees) {
  const auto near_limit = [](double t) { return w8_profile(t) + 1e-3 * std::cos(170.0 * t); };
  const auto seen = prepared_of(cylinder_of({ring(360, 0.0, near_limit)}), gaussian(50.0));
  ASSERT_TRUE(seen);
  ASSERT_THAT(warned(*seen), ElementsAre(core::Code::kUndersampled));
  EXPECT_THAT(seen->warnings[0].what, HasSubstr("0.707 um rms above 135 UPR"));
  EXPECT_THAT(seen->warnings[0].what, StartsWith("layer 1: content"));
  // Layers 2 and 3 of three: one warning, about the worse one.
  const auto more = [](double t) { return w8_profile(t) + 2e-3 * std::cos(170.0 * t); };
  const auto two = prepared_of(
      cylinder_of({ring(360, 0.0, w8_profile), ring(360, 5.0, near_limit), ring(360, 10.0, more)}),
      gaussian(50.0));
  ASSERT_TRUE(two);
  ASSERT_THAT(warned(*two), ElementsAre(core::Code::kUndersampled));
  EXPECT_THAT(two->warnings[0].what, StartsWith("layer 3, the worst of 2: content near"));
  // 350 undulations look like 10 of them.
  const auto beyond = [](double t) { return 1e-3 * std::cos(350.0 * t); };
  const auto unseen = prepared_of(cylinder_of({ring(360, 0.0, beyond)}), gaussian(50.0));
  ASSERT_TRUE(unseen);
  EXPECT_TRUE(unseen->warnings.empty());
  EXPECT_NEAR(ron_ls(*unseen), 0.001945309895, 1e-9);
}

double w9_profile(double z) {
  return 0.002 * z / 40.0 + 0.003 * std::sin(core::kTwoPi * z / 25.0) +
         0.001 * std::sin(core::kTwoPi * z / 3.0 + 0.5);
}

/// A body of revolution about z with the generatrix of W9; 120 points a layer.
Layers w9_body() {
  Layers out;
  for (int z = 0; z <= 40; ++z) {
    out.push_back(ring(120, z, [&](double) { return w9_profile(z); }));
  }
  return out;
}

/// Straightness of the generatrix at angle 0 about z.
fit::GeneratrixStraightness straightness(const PreparedSurface& surface) {
  std::vector<double> heights;
  std::vector<double> radii;
  for (const SurfaceSection& section : surface.sections) {
    const Eigen::Vector3d& p = surface.points_mm[section.points[0]];
    heights.push_back(p.z());
    radii.push_back(p.head<2>().norm());
  }
  return *fit::generatrix_straightness(heights, radii);
}

TEST(SurfaceFilter, AlongTheAxisOfW9GivesItsNumbers) {
  const FeatureResult body = cylinder_of(w9_body());
  for (const std::optional<double> upr : {std::optional(15.0), std::optional<double>()}) {
    const auto surface = prepared_of(body, gaussian(upr, 8.0));
    ASSERT_TRUE(surface) << surface.error().what;
    const auto line = straightness(*surface);
    EXPECT_NEAR(line.ls.total_mm, 0.005765490675, kWorked);
    EXPECT_NEAR(line.zone_mm, 0.005577732496, kWorked);
    EXPECT_NEAR(line.ls_slope, 0.00003436447581, 1e-12);
    const auto& first = surface->points_mm[surface->sections[20].points[0]];
    EXPECT_NEAR(first.head<2>().norm(), 20.0 - 0.001664907839, kWorked);
    EXPECT_EQ(surface->filter.english(), upr ? "gaussian 15 UPR, 8 mm along the axis"
                                             : "gaussian 8 mm along the axis, round none");
  }
  const auto round = prepared_of(body, gaussian(15.0));
  ASSERT_TRUE(round);
  EXPECT_NEAR(straightness(*round).ls.total_mm, 0.007541207042, kWorked);
  EXPECT_EQ(round->filter.english(), "gaussian 15 UPR, axial none");
}

TEST(SurfaceFilter, AlongTheAxisBridgesAWindow) {
  WindowTask groove;
  groove.name = "groove";
  groove.from_mm = 16.5;
  groove.to_mm = 23.5;
  groove.guard_mm = 0.0;
  const auto surface =
      prepared_of(cylinder_of(w9_body(), with_window(groove)), gaussian(std::nullopt, 8.0));
  ASSERT_TRUE(surface) << surface.error().what;
  const auto line = straightness(*surface);
  EXPECT_NEAR(line.ls.total_mm, 0.004853152471, kWorked);
  EXPECT_NEAR(line.zone_mm, 0.004604884871, kWorked);
  EXPECT_NEAR(surface->points_mm[surface->sections[16].points[0]].head<2>().norm(),
              20.0 - 0.001012355070, kWorked);
}

TEST(SurfaceFilter, AlongTheAxisBesideAWindowNeedsTheOtherPoints) {
  WindowTask hole;
  hole.name = "hole";
  hole.from_deg = 29.0;
  hole.to_deg = 31.0;
  hole.from_mm = 4.5;
  hole.to_mm = 5.5;
  hole.guard_mm = 0.0;
  const auto with_hole = [&](const Layers& layers) {
    return prepared_of(cylinder_of(layers, with_window(hole)), gaussian(std::nullopt, 8.0));
  };
  EXPECT_TRUE(with_hole(w9_body()));
  Layers lost = w9_body();
  lost.erase(lost.begin() + 15, lost.begin() + 25);  // not measured: no window took them
  const auto gap = with_hole(lost);
  ASSERT_FALSE(gap);
  EXPECT_THAT(gap.error().what, HasSubstr("31 layers 11 mm apart"));
  Layers scratched = w9_body();
  for (std::size_t z = 15; z < 25; ++z) scratched[z].erase(scratched[z].begin() + 60);
  const auto one_line = with_hole(scratched);
  ASSERT_FALSE(one_line);
  EXPECT_THAT(one_line.error().what, HasSubstr("41 layers 11 mm apart"));
}

TEST(SurfaceFilter, AlongTheAxisNeedsLayersCloseTogetherAtEqualAngles) {
  const FeatureResult body = cylinder_of(w9_body());
  const auto wide = prepared_of(body, gaussian(15.0, 2.5));
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().code, core::Code::kSampling);
  EXPECT_THAT(wide.error().what, HasSubstr("41 layers 1 mm apart over 40 mm"));
  EXPECT_THAT(wide.error().what, HasSubstr("leave cutoff_mm out"));
  EXPECT_FALSE(prepared_of(body, gaussian(15.0, 25.0)));  // longer than half of the part
  Layers turned = w9_body();
  for (Eigen::Vector3d& p : turned[7]) {
    p = Eigen::AngleAxisd(1.4 * core::kDegree, Eigen::Vector3d::UnitZ()) * p;
  }
  const auto askew = prepared_of(cylinder_of(turned), gaussian(15.0, 8.0));
  ASSERT_FALSE(askew);
  EXPECT_THAT(askew.error().what, HasSubstr("layer 8 has points at other angles"));
}

// ---- Outliers.

FeatureResult with_a_bad_point(std::size_t row, double off_mm) {
  Layers layers = {ring(36, 0.0, w8_profile), ring(36, 10.0, w8_profile)};
  Eigen::Vector3d& p = layers[row / 36][row % 36];
  p.head<2>() += off_mm * p.head<2>().normalized();
  return cylinder_of(layers);
}

TEST(SurfaceOutliers, AreNamedButTakePart) {
  const FeatureResult feature = with_a_bad_point(41, 0.2);
  const auto part = surfaces_of({&feature, 1});
  const auto surface = prepared(part[0], {});
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->points_mm.size(), 72U);
  EXPECT_TRUE(surface->left_out.empty());
  ASSERT_THAT(warned(*surface), ElementsAre(core::Code::kOutliers));
  EXPECT_THAT(surface->warnings[0].what, HasSubstr("point 41 lies +"));
  EXPECT_THAT(outlying_rows(part[0]), ElementsAre(41));
  const auto without = prepared(without_rows(part[0], std::vector<std::size_t>{41}), {});
  ASSERT_TRUE(without);
  EXPECT_EQ(without->points_mm.size(), 71U);
  EXPECT_EQ(without->sections[1].points.size(), 35U);
}

TEST(SurfaceOutliers, AreLeftOutAndListedWhereTheRuleSaysSo) {
  Indication rule;
  rule.outliers = Indication::Outliers::kFiveScales;
  const auto surface = prepared_of(with_a_bad_point(41, 0.2), rule);
  ASSERT_TRUE(surface);
  EXPECT_THAT(left_out_rows(*surface), ElementsAre(41));
  EXPECT_EQ(surface->left_out[0].window, "");
  EXPECT_TRUE(surface->warnings.empty());
  EXPECT_EQ(surface->points_mm.size(), 71U);
}

TEST(SurfaceOutliers, CarryAShareOfTheValue) {
  const FeatureResult feature = with_a_bad_point(41, 0.2);
  std::vector<MeasuredSurface> part = surfaces_of({&feature, 1});
  record::Characteristic asked;
  asked.form = record::Form::kCylindricity;
  asked.reference = record::Reference::kLeastSquares;
  auto found = find(part, 0, asked);
  ASSERT_TRUE(found) << found.error().what;
  found->warnings.clear();
  warn_of_shares(part, 0, asked, *found);
  const double with_um = found->judged[0].value_mm / core::kMicrometre;
  part[0] = without_rows(part[0], std::vector<std::size_t>{41});
  const double without_um = find(part, 0, asked)->judged[0].value_mm / core::kMicrometre;
  EXPECT_GT(with_um, 5.0 * without_um);
  ASSERT_EQ(found->warnings.size(), 1U);
  EXPECT_EQ(found->warnings[0].what,
            fmt::format("point 41 carries {:.3f} of {:.3f} um", with_um - without_um, with_um));
}

TEST(SurfaceOutliers, ThatAreMoreThanAQuarterAreForm) {
  const auto teeth = [](double t) { return std::cos(12.0 * t) > 0.9 ? 0.1 : 0.0; };  // a third
  const FeatureResult feature = cylinder_of({ring(36, 0.0, teeth), ring(36, 10.0, teeth)});
  Indication rule;
  rule.outliers = Indication::Outliers::kFiveScales;
  const auto refused = prepared_of(feature, rule);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kOutliers);
  EXPECT_THAT(refused.error().what, HasSubstr("24 of 72 points"));
  const auto surface = prepared_of(feature);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->points_mm.size(), 72U);
  EXPECT_TRUE(surface->warnings.empty());
}

TEST(SurfaceOutliers, ThatAreNeighboursAreForm) {
  Indication rule;
  rule.outliers = Indication::Outliers::kFiveScales;
  // The error of the rule for five layers with 0.05 mm more at some places.
  const auto sentence = [&](auto is_off) {
    Layers layers;
    for (int j = 0; j < 5; ++j) {
      layers.push_back(ring(36, 10.0 * j, w8_profile));
      for (int i = 0; i < 36; ++i) {
        Eigen::Vector3d& p = layers.back()[static_cast<std::size_t>(i)];
        if (is_off(j, i)) p.head<2>() += 0.05 * p.head<2>().normalized();
      }
    }
    const FeatureResult feature = cylinder_of(layers);
    EXPECT_TRUE(prepared_of(feature)) << "without the rule all points take part";
    const auto surface = prepared_of(feature, rule);
    if (surface) return std::string();
    EXPECT_EQ(surface.error().code, core::Code::kOutliers);
    return surface.error().what;
  };
  EXPECT_EQ(sentence([](int j, int i) { return j == 1 && i == 5; }), "");
  EXPECT_EQ(sentence([](int j, int i) { return (j == 1 && (i == 5 || i == 15)) || j * i == 75; }),
            "");
  EXPECT_EQ(sentence([](int j, int i) { return (j == 0 || j == 2) && i == 5; }), "");
  EXPECT_THAT(sentence([](int j, int i) { return j == 1 && (i == 5 || i == 6); }),
              HasSubstr("2 of 36 points of layer 2, next to each other"));
  EXPECT_THAT(sentence([](int j, int i) { return (j == 2 || j == 3) && i == 5; }),
              HasSubstr("points of 2 layers, one above the other at 50.0 deg"));
  EXPECT_THAT(sentence([](int j, int i) { return j == 1 && (i == 35 || i < 2); }),
              HasSubstr("3 of 36 points of layer 2, next to each other"));
  EXPECT_THAT(sentence([](int j, int) { return j == 4; }), HasSubstr("36 of 36 points of layer 5"));
  EXPECT_THAT(sentence([](int, int i) { return i == 9; }),
              HasSubstr("points of 5 layers, one above the other"));
}

/// A helix of ten turns with two lobes of 4 um.
FeatureResult helix_with(const std::vector<std::size_t>& gross_rows) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 720; ++i) {
    const double t = 5.0 * i * core::kDegree;
    const double r = 20.0 + 4e-3 * std::cos(2.0 * t);
    points.emplace_back(r * std::cos(t), r * std::sin(t), i * 40.0 / 719.0);
  }
  for (const std::size_t row : gross_rows)
    points[row].head<2>() += 0.3 * points[row].head<2>().normalized();
  FeatureResult feature = cylinder_of({points});
  feature.feature.shape = record::Shape::kCylinder;
  feature.feature.layers = 0;
  if (const auto ls = fit::ls_cylinder(points)) feature.ls_cylinder = *ls;
  return feature;
}

record::Characteristic helix_form(bool rule) {
  record::Characteristic asked;
  asked.form = record::Form::kCylindricity;
  asked.reference = record::Reference::kMinimumZone;
  if (rule) asked.indication.outliers = Indication::Outliers::kFiveScales;
  return asked;
}

TEST(SurfaceOutliers, OfAHelixAreLeftOutAndListed) {
  const FeatureResult feature = helix_with({100, 333, 600});
  const auto part = surfaces_of({&feature, 1});
  const auto found = find(part, 0, helix_form(true));
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->judged[0].value_mm, 8e-3, 1e-6);
  EXPECT_FALSE(found->no_verdict);
  std::vector<std::size_t> rows;
  for (const LeftOut& left : found->left_out) rows.push_back(left.row);
  EXPECT_THAT(rows, ElementsAre(100, 333, 600));
  record::Characteristic round = helix_form(true);
  round.form = record::Form::kRoundness;
  const auto sections = find(part, 0, round);
  ASSERT_FALSE(sections);
  EXPECT_THAT(sections.error().what, HasSubstr("mm thick"));
}

TEST(SurfaceOutliers, OfAHelixThatAreNeighboursAreForm) {
  for (const auto& rows : {std::vector<std::size_t>{100, 101, 600},
                           std::vector<std::size_t>{100, 172, 244}}) {  // of three turns
    const FeatureResult feature = helix_with(rows);
    const auto found = find(surfaces_of({&feature, 1}), 0, helix_form(true));
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, core::Code::kOutliers);
    EXPECT_THAT(found.error().what, HasSubstr("neighbours are form"));
  }
}

TEST(SurfaceOutliers, OfAPlainFormAreNamedWithTheirShare) {
  FeatureResult feature = helix_with({333});
  const auto part = surfaces_of({&feature, 1});
  warn_of_shares(part, 0, helix_form(false), feature);
  ASSERT_EQ(feature.warnings.size(), 2U);
  EXPECT_THAT(feature.warnings[0].what, HasSubstr("point 333 lies +29"));
  EXPECT_THAT(feature.warnings[1].what, HasSubstr("point 333 carries "));
}

// ---- Trials.

TEST(SurfaceTrials, NeverChangeWhichPointsTakePart) {
  Indication rule;
  rule.outliers = Indication::Outliers::kFiveScales;
  const FeatureResult feature = with_a_bad_point(41, 0.2);
  MeasuredSurface trial = surfaces_of({&feature, 1}).front();
  trial.tips_mm[7] *= 1.01;  // would be an outlier itself
  const auto surface = prepared(trial, rule);
  ASSERT_TRUE(surface);
  EXPECT_THAT(left_out_rows(*surface), ElementsAre(41));
  EXPECT_EQ(surface->points_mm[7], trial.tips_mm[7]);
  EXPECT_TRUE(prepared(trial, {})->warnings.empty());
  trial.layout = nullptr;  // found anew, with the same result
  EXPECT_THAT(left_out_rows(*prepared(trial, rule)), ElementsAre(41));
}

}  // namespace
}  // namespace rondure::evaluation
