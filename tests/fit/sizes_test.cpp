#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sections.h"
#include "fit/profiles/profile_filter.h"
#include "fit/references/one_sided.h"
#include "fit/sizes/sizes.h"
#include "tests/fit/drawing_cases.h"

// Expected numbers: methods, drawing section 12.

namespace rondure::fit {
namespace {

using test::all_of;
constexpr double kDigits = 1e-10;  // of the specification: 12 decimals, of its tests: 1e-10 mm

std::vector<Section> own_sections(const test::Layers& layers) {
  const auto cylinder = ls_cylinder(all_of(layers));
  EXPECT_TRUE(cylinder.has_value());
  auto sections = sections_across(layers, cylinder->axis);
  EXPECT_TRUE(sections.has_value());
  return *sections;
}

RankSizes ranks(const test::Layers& layers, const Material& material) {
  const auto sizes = two_point_sizes(own_sections(layers), material);
  EXPECT_TRUE(sizes.has_value());
  return rank_sizes(*sizes);
}

test::Layers scaled(test::Layers layers, double factor) {
  for (auto& layer : layers) {
    for (auto& p : layer) p *= factor;
  }
  return layers;
}

test::Layers without_row(test::Layers layers, std::ptrdiff_t row) {
  for (auto& layer : layers) layer.erase(layer.begin() + row);
  return layers;
}

const Material kShaft{false, 1.4987};
const Material kPlain{false, 0.0};
const Material kBore{true, 1.5};

TEST(GlobalSizes, AreThoseOfTheThreeLobedShaft) {
  const auto sizes = global_sizes(all_of(test::w1()), kShaft);
  ASSERT_TRUE(sizes && sizes->gx_mm);
  EXPECT_NEAR(sizes->gg_mm, 24.990122662043, kDigits);
  EXPECT_NEAR(sizes->gn_mm, 25.003379302565, kDigits);
  EXPECT_NEAR(*sizes->gx_mm, 24.977528966340, kDigits);
  EXPECT_NEAR(sizes->gc_mm, 24.990454189110, kDigits);
}

TEST(GlobalSizes, ScaleWithTheTemperatureAsTheTipDoes) {
  const double factor = (1.0 + 8e-6 * 1.1) / (1.0 + 11.5e-6 * 2.4);
  EXPECT_NEAR(factor, 0.999981200518866, 1e-15);
  const auto layers = scaled(test::w1(), factor);
  const Material material{false, 1.4987 * factor};
  const auto sizes = global_sizes(all_of(layers), material);
  ASSERT_TRUE(sizes && sizes->gx_mm);
  EXPECT_NEAR(sizes->gg_mm, 24.989652860704, kDigits);
  EXPECT_NEAR(sizes->gn_mm, 25.002909252007, kDigits);
  EXPECT_NEAR(*sizes->gx_mm, 24.977059401755, kDigits);
  const RankSizes local = ranks(layers, material);
  EXPECT_NEAR(local.sx_mm, 24.991825191661, kDigits);
  EXPECT_NEAR(local.sn_mm, 24.987345108986, kDigits);
}

TEST(GlobalSizes, AreThoseOfEverySection) {
  const auto sections = own_sections(test::w1());
  const double gg[] = {24.988230605498, 24.990304803404, 24.991832577303};
  const double gn[] = {24.998545665996, 25.001440240767, 25.003379412312};
  const auto whole = global_sizes(all_of(test::w1()), kShaft);
  const auto least = min_circumscribed_cylinder(all_of(test::w1()));
  const auto own = ls_cylinder(all_of(test::w1()));
  ASSERT_TRUE(whole && least && own);
  const double lean = own->axis.direction.cross(least->axis.direction).norm();
  for (std::size_t j = 0; j < 3; ++j) {
    const auto sizes = global_sizes(sections[j].points_mm, kShaft);
    ASSERT_TRUE(sizes.has_value());
    EXPECT_NEAR(sizes->gg_mm, gg[j], kDigits);
    EXPECT_NEAR(sizes->gn_mm, gn[j], kDigits);
    // The leaning cylinder is 1.1e-7 mm below the circle of the last section.
    EXPECT_GE(whole->gn_mm, sizes->gn_mm - 14.0 * lean * lean);
  }
  EXPECT_LT(whole->gn_mm, gn[2]);
}

TEST(GlobalSizes, AreThoseOfTheTaperedJournalToTheDigitsOfARockingCylinder) {
  const auto sizes = global_sizes(all_of(test::w2()), kPlain);
  ASSERT_TRUE(sizes && sizes->gx_mm);
  EXPECT_NEAR(sizes->gg_mm, 39.998642923760, kDigits);
  EXPECT_NEAR(sizes->gn_mm, 40.007007118519, 1e-7);
  EXPECT_NEAR(*sizes->gx_mm, 39.984416299395, 1e-7);
  EXPECT_NEAR(sizes->gc_mm, 39.996674586266, kDigits);
  EXPECT_NEAR(ranks(test::w2(), kPlain).sx_mm, 40.007007314984, kDigits);
}

TEST(GlobalSizes, OfABoreChangeWithAKeywayExceptTheInscribedCylinder) {
  const auto sizes = global_sizes(all_of(without_row(test::w6(), 4)), kBore);
  ASSERT_TRUE(sizes && sizes->gx_mm);
  EXPECT_NEAR(sizes->gg_mm, 39.999953257850, kDigits);
  EXPECT_NEAR(sizes->gn_mm, 40.005130693014, kDigits);
  EXPECT_NEAR(*sizes->gx_mm, 39.994130396679, kDigits);
  EXPECT_NEAR(sizes->gc_mm, 39.999630265339, kDigits);
  const auto forgotten = global_sizes(all_of(test::w6()), kBore);
  ASSERT_TRUE(forgotten && forgotten->gx_mm);
  EXPECT_NEAR(forgotten->gg_mm, 40.378788150630, kDigits);
  EXPECT_NEAR(forgotten->gn_mm, 42.999503191355, kDigits);
  EXPECT_NEAR(*forgotten->gx_mm, 39.994130396679, kDigits);
}

TEST(GlobalSizes, OfShaftAndBoreDifferByFourTipRadii) {
  const auto shaft = global_sizes(all_of(test::w1()), {false, 1.5});
  const auto bore = global_sizes(all_of(test::w1()), {true, 1.5});
  ASSERT_TRUE(shaft && bore);
  EXPECT_NEAR(bore->gg_mm - shaft->gg_mm, 6.0, 1e-12);
  EXPECT_EQ(global_sizes(all_of(test::w1()), {false, -0.1}).error().code, core::Code::kBadOption);
}

TEST(GlobalSizes, OfAnOpenCapHaveNoInscribedSphere) {
  const auto sizes = global_sizes_of_sphere(test::w10(), kBore);
  ASSERT_TRUE(sizes.has_value());
  EXPECT_NEAR(sizes->gg_mm, 2.0 * (14.499006959907 + 1.5), kDigits);
  EXPECT_NEAR(sizes->gc_mm, 2.0 * (14.499399912845 - 0.0003 + 1.5), kDigits);
  EXPECT_EQ(sizes->gx_mm.error().code, core::Code::kReferenceAbsent);
  EXPECT_EQ(global_sizes_of_sphere(test::w10(), {false, -1.0}).error().code,
            core::Code::kBadOption);
}

TEST(GlobalSizes, OfASphereAreThoseOfTheSpheresThatTouchIt) {
  const std::vector<Eigen::Vector3d> points = {{10.003, 0, 0},          {-9.998, 0, 0},
                                               {0, 10.001, 0},          {0, -10.002, 0},
                                               {0, 0, 9.997},           {0, 0, -10.0},
                                               {5.774, 5.773, 5.772},   {-5.772, -5.774, 5.774},
                                               {5.773, -5.773, -5.774}, {-5.774, 5.773, -5.773}};
  const auto sizes = global_sizes_of_sphere(points, kShaft);
  const auto outside = min_circumscribed_sphere(points);
  const auto inside = max_inscribed_sphere(points);
  ASSERT_TRUE(sizes && sizes->gx_mm && outside && inside);
  EXPECT_NEAR(sizes->gn_mm, 2.0 * (outside->radius_mm - 1.4987), kDigits);
  EXPECT_NEAR(*sizes->gx_mm, 2.0 * (inside->radius_mm - 1.4987), kDigits);
  EXPECT_LT(*sizes->gx_mm, sizes->gg_mm);
  EXPECT_LT(sizes->gg_mm, sizes->gn_mm);
}

TEST(LocalSizes, AreThoseOfTheThreeLobedShaft) {
  const RankSizes sizes = ranks(test::w1(), kShaft);
  EXPECT_EQ(sizes.count, 18U);
  EXPECT_NEAR(sizes.sx_mm, 24.992295033840, kDigits);
  EXPECT_NEAR(sizes.sn_mm, 24.987814866940, kDigits);
  EXPECT_NEAR(sizes.sa_mm, 24.990122662068, kDigits);
  EXPECT_NEAR(sizes.sm_mm, 24.990321456530, kDigits);
  EXPECT_NEAR(sizes.sd_mm, 24.990054950390, kDigits);
  EXPECT_NEAR(sizes.sr_mm, 0.004480166900, kDigits);
  EXPECT_NEAR(sizes.sq_mm, 0.001499276509, kDigits);
}

TEST(LocalSizes, OfATipThatLeavesNoSurfaceAreRefused) {
  Section section;
  for (int i = 0; i < 8; ++i) {
    const double t = core::kTwoPi * i / 8.0;
    section.points_mm.emplace_back(3.0 * std::cos(t), 3.0 * std::sin(t));
  }
  section.circle.radius_mm = 3.0;
  const auto wrong = two_point_sizes({&section, 1}, {false, 25.0});
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, core::Code::kBadOption);
  EXPECT_NE(wrong.error().what.find("-22.0000 mm"), std::string::npos) << wrong.error().what;
  EXPECT_TRUE(two_point_sizes({&section, 1}, {true, 25.0})) << "a bore has a larger one";
}

TEST(LocalSizes, LosePairsToAKeyway) {
  const RankSizes sizes = ranks(without_row(test::w6(), 4), kBore);
  EXPECT_EQ(sizes.count, 14U);
  EXPECT_NEAR(sizes.sx_mm, 40.005130701989, kDigits);
  EXPECT_NEAR(sizes.sn_mm, 39.994129828310, kDigits);
  EXPECT_NEAR(sizes.sa_mm, 39.999972416259, kDigits);
  EXPECT_NEAR(sizes.sq_mm, 0.003750924192, kDigits);
  const RankSizes forgotten = ranks(test::w6(), kBore);
  EXPECT_EQ(forgotten.count, 2U);
  EXPECT_NEAR(forgotten.sx_mm, 42.999503198979, kDigits);
}

/// Points of a circle of radius 12 at directions seen from a point `off` beside its centre.
test::Layers circle_touched(int count, double off, double start = 0.0) {
  test::Layers out(1);
  for (int k = 0; k < count; ++k) {
    const double theta = start + core::kTwoPi * k / count;
    const double reach = std::sqrt(144.0 - std::pow(off * std::sin(theta), 2));
    const double t = reach - off * std::cos(theta);
    out[0].emplace_back(off + t * std::cos(theta), t * std::sin(theta), 3.0);
  }
  return out;
}

const Axis kUpright;

TEST(LocalSizes, OfACircleTouchedBesideItsCentreAreItsDiameter) {
  const auto sections = sections_across(circle_touched(12, 0.05), kUpright);
  ASSERT_TRUE(sections.has_value());
  const auto sizes = two_point_sizes(*sections, kPlain);
  ASSERT_TRUE(sizes.has_value());
  ASSERT_EQ(sizes->size(), 6U);
  double shortest = 24.0;
  for (const LocalSize& size : *sizes) {
    EXPECT_NEAR(size.size_mm, 24.0, 1e-12);
    const auto& points = sections->front().points_mm;
    shortest = std::min(shortest, (points[size.first] - points[size.second]).norm());
  }
  EXPECT_NEAR(shortest, 23.99979167, 1e-8);  // chords are too short
}

TEST(LocalSizes, NeedOppositePoints) {
  const auto pairs = [](int count, double start) {
    return two_point_sizes(*sections_across(circle_touched(count, 0.0, start), kUpright), kPlain);
  };
  EXPECT_EQ(pairs(7, 0.0).error().code, core::Code::kSampling);
  for (const double start : {0.0, 0.3, -2.0}) EXPECT_EQ(pairs(8, start)->size(), 4U);
  const auto one_out = without_row(circle_touched(12, 0.0), 3);
  EXPECT_EQ(two_point_sizes(*sections_across(one_out, kUpright), kPlain)->size(), 5U);
  EXPECT_EQ(two_point_sizes(UniformProfile{0.0, std::vector<double>(7, 1.0)}, kPlain).error().code,
            core::Code::kSampling);
}

TEST(LocalSizes, TakeTheNearestOfSeveralPartners) {
  test::Layers arcs(1);  // at steps of 0.25 deg five points lie opposite each other
  for (const double middle : {-90.0, 90.0}) {
    for (int k = -40; k <= 40; ++k) {
      const double angle = (middle + 0.25 * k) * core::kDegree;
      arcs[0].emplace_back(12.0 * std::cos(angle), 12.0 * std::sin(angle), 0.0);
    }
  }
  const auto sizes = two_point_sizes(*sections_across(arcs, kUpright), kPlain);
  ASSERT_TRUE(sizes.has_value());
  ASSERT_EQ(sizes->size(), 81U);
  for (const LocalSize& size : *sizes) EXPECT_EQ(size.second, size.first + 81);
}

TEST(LocalSizes, AreTheSameWhereverTheSeamOfTheAnglesLies) {
  // 720 points, two lobes of 4 um and noise of 1 um: at steps of half a degree the neighbours of
  // the opposite point are within reach, too. Every diameter is one pair: r(i) + r(i + 360).
  core::KeyedNoise noise(7, {23});
  std::vector<double> r;
  for (int k = 0; k < 720; ++k) {
    r.push_back(15.0 + 0.002 * std::cos(core::kTwoPi * k / 360.0) + 0.001 * noise.normal());
  }
  double mean = 0.0;
  for (const double radius : r) mean += radius / 360.0;
  for (const double turn : {0.0, 1e-13, -1e-13, 0.2, 1.0}) {
    SCOPED_TRACE(turn);
    test::Layers section(1);
    for (int k = 0; k < 720; ++k) {
      const double angle = turn + core::kTwoPi * k / 720.0;
      section[0].emplace_back(r[static_cast<std::size_t>(k)] * std::cos(angle),
                              r[static_cast<std::size_t>(k)] * std::sin(angle), 0.0);
    }
    auto sections = sections_across(section, kUpright);
    ASSERT_TRUE(sections.has_value());
    sections->front().circle.center_mm.setZero();
    const auto sizes = two_point_sizes(*sections, kPlain);
    ASSERT_TRUE(sizes.has_value());
    ASSERT_EQ(sizes->size(), 360U);
    double found = 0.0;
    for (const LocalSize& size : *sizes) {
      EXPECT_EQ((size.first + 360) % 720, size.second);
      found += size.size_mm / 360.0;
    }
    EXPECT_NEAR(found, mean, 1e-12);
  }
}

TEST(LocalSizes, AreUnknownWhereOneSectionHasNoPair) {
  test::Layers layers = circle_touched(8, 0.0);
  layers.push_back(circle_touched(7, 0.0).front());
  for (auto& p : layers.back()) p.z() = 9.0;
  const auto sizes = two_point_sizes(*sections_across(layers, kUpright), kPlain);
  ASSERT_FALSE(sizes.has_value());
  EXPECT_EQ(sizes.error().code, core::Code::kSampling);
  EXPECT_NE(sizes.error().what.find("section 2 of 2, of 7 points"), std::string::npos);
}

/// The dense section of the specification.
UniformProfile dense(double mean_mm = 20.0) {
  UniformProfile out;
  for (int i = 0; i < 360; ++i) {
    const double t = core::kTwoPi * i / 360.0;
    out.r_mm.push_back(mean_mm + 0.004 * std::cos(2 * t - 0.3) + 0.003 * std::cos(3 * t - 1.1) +
                       0.0015 * std::cos(7 * t + 0.4) + 0.0008 * std::cos(40 * t) +
                       0.0005 * std::cos(120 * t - 0.2));
  }
  return out;
}

UniformProfile filtered(const UniformProfile& profile) {
  const auto low = filter_closed(profile.r_mm, {});
  EXPECT_TRUE(low.has_value());
  return {profile.start_rad, low->r_mm};
}

TEST(LocalSizes, OfADenseSectionAreTakenFromItsFilteredProfile) {
  const auto sizes = two_point_sizes(filtered(dense()), {false, 1.0});
  ASSERT_TRUE(sizes.has_value());
  const RankSizes ranked = rank_sizes(*sizes);
  EXPECT_EQ(ranked.count, 180U);
  EXPECT_NEAR(ranked.sx_mm, 38.009035157494, kDigits);
  EXPECT_NEAR(ranked.sn_mm, 37.991094644894, kDigits);
  EXPECT_NEAR(ranked.sa_mm, 38.000000000000, kDigits);
  EXPECT_NEAR(ranked.sm_mm, 38.000279393401, kDigits);
  EXPECT_NEAR(ranked.sd_mm, 38.000064901194, kDigits);
  EXPECT_NEAR(ranked.sr_mm, 0.017940512600, kDigits);
  EXPECT_NEAR(ranked.sq_mm, 0.005697049139, kDigits);
}

TEST(CalculatedSizes, AreExactForASmoothSection) {
  const auto sizes = calculated_sizes(filtered(dense()), {false, 1.0});
  ASSERT_TRUE(sizes.has_value());
  EXPECT_NEAR(sizes->cc_mm, 38.000016866345, kDigits);
  EXPECT_NEAR(sizes->ca_mm, 37.999999832642, kDigits);
}

TEST(CalculatedSizes, OfAnEccentricCircleAreItsDiameter) {
  // The limacon of a circle 2 mm off its centre, whose harmonics are those of a square root.
  for (const int n : {360, 361}) {
    UniformProfile profile;
    for (int i = 0; i < n; ++i) {
      const double t = core::kTwoPi * i / n;
      profile.r_mm.push_back(2.0 * std::cos(t) + std::sqrt(100.0 - std::pow(2.0 * std::sin(t), 2)));
    }
    const auto sizes = calculated_sizes(profile, {true, 1.0});
    ASSERT_TRUE(sizes.has_value());
    EXPECT_NEAR(sizes->cc_mm, 22.0, 1e-12);
    EXPECT_NEAR(sizes->ca_mm, 22.0, 1e-12);
  }
  EXPECT_EQ(calculated_sizes({0.0, std::vector<double>(36, 1.0)}, {true, 1.0}).error().code,
            core::Code::kBadOption);
}

TEST(CalculatedSizes, OfAVolumeFollowFromTheAreas) {
  std::vector<double> areas;
  for (const double mean : {20.0, 20.004, 20.001}) {
    areas.push_back(calculated_sizes(filtered(dense(mean)), {false, 1.0})->area_mm2);
  }
  const auto size = volume_size_mm(std::vector<double>{0.0, 10.0, 25.0}, areas);
  ASSERT_TRUE(size.has_value());
  EXPECT_NEAR(*size, 38.004599991166, kDigits);
  EXPECT_EQ(volume_size_mm(std::vector<double>{0.0}, std::vector<double>{1.0}).error().code,
            core::Code::kRank);
  EXPECT_EQ(
      volume_size_mm(std::vector<double>{1.0, 1.0}, std::vector<double>{1.0, 1.0}).error().code,
      core::Code::kBadOption);
}

TEST(Sections, OfAFileWithoutLayersBeginWhereHeightsAreMoreThanHalfAMillimetreApart) {
  const std::vector<Eigen::Vector3d> points = {{1.0, 0.0, 5.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.4},
                                               {0.0, 1.0, 5.4}, {1.0, 1.0, 0.8}, {0.0, 0.0, 1.31}};
  using Rows = std::vector<std::vector<std::size_t>>;
  EXPECT_EQ(rows_by_height(points, kUpright), (Rows{{1, 2, 4}, {5}, {0, 3}}));
  EXPECT_EQ(rows_by_height(points, {Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()}),
            (Rows{{0, 3}, {5}, {1, 2, 4}}));
}

TEST(Sections, ShowTheirNormal) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const auto frame = across(axis);
  std::vector<Eigen::Vector3d> points;
  std::vector<int> layers;
  for (int k = 0; k < 7; ++k) {  // three and four points, at other angles
    const double angle = k < 3 ? 2.0 * k : 0.4 + 1.5 * k;
    points.push_back(9.0 * (std::cos(angle) * frame.col(0) + std::sin(angle) * frame.col(1)) +
                     (k < 3 ? 2.0 : 5.0) * axis);
    layers.push_back(k < 3 ? 0 : 1);
  }
  const auto normal = layer_normal(points, layers);
  ASSERT_TRUE(normal);
  EXPECT_NEAR(std::abs(normal->dot(axis)), 1.0, 1e-12);
  // Points along generatrices, named layers, show none.
  std::vector<Eigen::Vector3d> lines;
  std::vector<int> lines_of;
  for (int line = 0; line < 4; ++line) {
    for (int k = 0; k < 5; ++k) {
      lines.push_back(
          9.0 * (std::cos(1.57 * line) * frame.col(0) + std::sin(1.57 * line) * frame.col(1)) +
          3.0 * k * axis);
      lines_of.push_back(line);
    }
  }
  EXPECT_FALSE(layer_normal(lines, lines_of));
}

TEST(Sections, RefuseALayerThatIsNotSquareToTheAxis) {
  const auto layers = circle_touched(12, 0.0);
  const Axis leaning{Eigen::Vector3d::Zero(), Eigen::Vector3d(0.05, 0.0, 1.0).normalized()};
  const auto sections = sections_across(layers, leaning);
  ASSERT_FALSE(sections.has_value());
  EXPECT_EQ(sections.error().code, core::Code::kSampling);
  EXPECT_NE(sections.error().what.find("layer 0"), std::string::npos);
}

}  // namespace
}  // namespace rondure::fit
