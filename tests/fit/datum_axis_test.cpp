#include "fit/datums/datum_axis.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/datums/datum.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/plane.h"
#include "fit/least_squares/sections.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "tests/fit/drawing_cases.h"

// Expected numbers: methods, drawing section 12.

namespace rondure::fit {
namespace {

using test::all_of;
using Space = std::vector<Eigen::Vector3d>;
using Association = DatumAssociation;

/// Digits of a value about a datum: its rock magnifies rounding.
double digits(Association association, bool rocks) {
  switch (association) {
    case Association::kOneSided:
      return rocks ? 1e-7 : 1e-10;
    case Association::kEqualised:
      return 1e-8;
    default:
      return 1e-10;
  }
}

struct ShaftRow {
  const char* features;
  Association association;
  double wx, wy, coaxiality;
};

TEST(DatumAxis, GivesEveryRowOfTheSteppedShaft) {
  const Space a = all_of(test::w3_a());
  const Space b = all_of(test::w3_b());
  const auto c = test::w3_c();
  const ShaftRow rows[] = {
      {"AB", Association::kOneSided, 0.00201198922119, -0.00100160135854, 0.013383231729},
      {"AB", Association::kEqualised, 0.00201220465834, -0.00100240537911, 0.013420164686},
      {"AB", Association::kLeastSquares, 0.00200899786760, -0.00100333226044, 0.013283035987},
      {"AB", Association::kZone, 0.00201087632661, -0.00100268689566, 0.013490347282},
      {"A", Association::kOneSided, 0.00190816967184, -0.00105346466556, 0.031569999139},
      {"A", Association::kEqualised, 0.00197779794119, -0.00097036200669, 0.020795802200},
      {"A", Association::kLeastSquares, 0.00199226417517, -0.00096646733366, 0.018443767895}};
  const auto own = ls_cylinder(all_of(c));
  const auto sections = sections_across(c, own->axis);
  ASSERT_TRUE(sections.has_value());
  const Space centers = median_line(*sections);
  for (const ShaftRow& row : rows) {
    SCOPED_TRACE(testing::Message() << row.features << static_cast<int>(row.association));
    const bool common = row.features[1] != '\0';
    std::vector<DatumCylinder> features = {{a, false}};
    if (common) features.push_back({b, false});
    const auto datum = datum_axis(features, row.association);
    ASSERT_TRUE(datum.has_value()) << datum.error().what;
    EXPECT_EQ(datum->ending, ZoneEnding::kConverged);
    const double near = digits(row.association, !common);
    const Eigen::Vector3d w = datum->axis.direction;
    const double angle = std::max(1e-12, 10.0 * near);
    EXPECT_NEAR(w.x() / w.z(), row.wx, angle);
    EXPECT_NEAR(w.y() / w.z(), row.wy, angle);
    EXPECT_NEAR(*coaxiality_mm(centers, datum->axis), row.coaxiality, near);
  }
}

TEST(DatumAxis, HasTheRadiiAndContactsOfTheSteppedShaft) {
  const Space a = all_of(test::w3_a());
  const Space b = all_of(test::w3_b());
  const std::vector<DatumCylinder> both = {{a, false}, {b, false}};
  const auto one_sided = datum_axis(both, Association::kOneSided);
  ASSERT_TRUE(one_sided.has_value());
  EXPECT_NEAR(one_sided->radii_mm[0], 15.001383171068, 1e-10);
  EXPECT_NEAR(one_sided->radii_mm[1], 15.000804969482, 1e-10);
  std::vector<std::size_t> rows;
  for (const Contact& c : one_sided->contacts) rows.push_back(c.index);
  EXPECT_EQ(rows, (std::vector<std::size_t>{6, 9, 12, 14, 16}));
  const auto ls = datum_axis(both, Association::kLeastSquares);
  EXPECT_NEAR(ls->radii_mm[0], 14.999860618471, 1e-10);
  EXPECT_NEAR(ls->radii_mm[1], 14.999982650833, 1e-10);
  const auto alone = datum_axis(std::vector<DatumCylinder>{{a, false}}, Association::kOneSided);
  EXPECT_NEAR(alone->radii_mm[0], 15.001383092884, 1e-10);
  const auto rock = datum_rock(both);
  ASSERT_TRUE(rock.has_value());
  EXPECT_NEAR(rock->sum_mm, 30.002188130882, 1e-11);
  // The specification prints 2.12007, 7.84992 and 4.65115 um: its half length is along the
  // machine's z axis, not along the datum as it says. These are from all vertices of the linear
  // programmes.
  EXPECT_NEAR(rock->play_mm, 2.119321e-3, 1e-8);
  const auto rock_alone = datum_rock(std::vector<DatumCylinder>{{a, false}});
  EXPECT_NEAR(rock_alone->sum_mm, 15.001383123517, 1e-11);
  EXPECT_NEAR(rock_alone->play_mm, 7.822657e-3, 1e-8);
}

struct FaceRow {
  Association association;
  double total, tilt_urad;
};

TEST(DatumAxis, GivesEveryRowOfTheFaceOnAShortBore) {
  const Space bore = all_of(test::w4_bore());
  const std::vector<DatumCylinder> features = {{bore, true}};
  const auto face = test::w4_face();
  const auto plane = ls_plane(all_of(face), Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
  ASSERT_TRUE(plane.has_value());
  const FaceRow rows[] = {{Association::kOneSided, 0.012402190616, 174.857686668},
                          {Association::kEqualised, 0.008706017281, 86.836606038},
                          {Association::kLeastSquares, 0.008123093357, 73.416652149}};
  for (const FaceRow& row : rows) {
    SCOPED_TRACE(static_cast<int>(row.association));
    const auto datum = datum_axis(features, row.association);
    ASSERT_TRUE(datum.has_value()) << datum.error().what;
    EXPECT_EQ(datum->ending, ZoneEnding::kConverged);
    const double near = digits(row.association, true);
    EXPECT_NEAR(*orientation_of_plane_mm(all_of(face), datum->axis.direction), row.total, near);
    const double tilt = plane->plane.normal.cross(datum->axis.direction).norm();
    EXPECT_NEAR(tilt * 1e6, row.tilt_urad, 1e-3);
  }
  const auto one_sided = datum_axis(features, Association::kOneSided);
  EXPECT_NEAR(one_sided->radii_mm[0], 8.998883644807, 1e-10);
  const auto rock = datum_rock(features);
  EXPECT_NEAR(-rock->sum_mm, 8.998883509349, 1e-11);
  EXPECT_NEAR(rock->play_mm, 4.645138e-3, 1e-8);
}

TEST(DatumAxis, OfOneFeatureIsThatOfTheReferenceCylinder) {
  for (const auto& layers : {test::w1(), test::w2(), test::w3_c()}) {
    const Space points = all_of(layers);
    const auto least = min_circumscribed_cylinder(points);
    const auto datum =
        datum_axis(std::vector<DatumCylinder>{{points, false}}, Association::kOneSided);
    ASSERT_TRUE(least && datum);
    EXPECT_NEAR(datum->radii_mm[0], least->radius_mm, 1e-9);
    const auto largest = max_inscribed_cylinder(points);
    const auto bore =
        datum_axis(std::vector<DatumCylinder>{{points, true}}, Association::kOneSided);
    ASSERT_TRUE(largest && bore);
    EXPECT_NEAR(bore->radii_mm[0], largest->radius_mm, 1e-9);
    const auto ls =
        datum_axis(std::vector<DatumCylinder>{{points, false}}, Association::kLeastSquares);
    EXPECT_NEAR(ls->radii_mm[0], ls_cylinder(points)->radius_mm, 1e-12);
  }
}

TEST(DatumAxis, OfSingleSectionsPassesThroughTheirCircumscribedCentres) {
  const std::vector<Space> sections = {test::w3_a()[0], test::w3_b()[1]};
  const auto datum =
      datum_axis(std::vector<DatumCylinder>{{sections[0], false}, {sections[1], false}},
                 Association::kOneSided);
  ASSERT_TRUE(datum.has_value()) << datum.error().what;
  const auto across_axis = across(datum->axis.direction);
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<Eigen::Vector2d> flat;
    for (const auto& p : sections[i]) {
      flat.emplace_back(across_axis.transpose() * (p - datum->axis.point_mm));
    }
    const auto circle = min_circumscribed_circle(flat);
    EXPECT_NEAR(datum->radii_mm[i], circle->radius_mm, 1e-10);
    // Where two opposite points hold a section, the tilt moves its centre along the other
    // direction.
    EXPECT_LT(circle->center_mm.norm(), 1e-5);
  }
}

TEST(DatumAxis, DoesNotDependOnPlaceOrderOrRepeatedPoints) {
  Space a = all_of(test::w3_a());
  Space b = all_of(test::w3_b());
  const auto first =
      datum_axis(std::vector<DatumCylinder>{{a, false}, {b, false}}, Association::kOneSided);
  const auto first_ls =
      datum_axis(std::vector<DatumCylinder>{{a, false}, {b, false}}, Association::kLeastSquares);
  std::ranges::reverse(a);
  a.insert(a.end(), a.begin(), a.begin() + 12);
  const auto again =
      datum_axis(std::vector<DatumCylinder>{{b, false}, {a, false}}, Association::kOneSided);
  ASSERT_TRUE(first && again);
  EXPECT_NEAR(again->radii_mm[1], first->radii_mm[0], 1e-9);
  EXPECT_NEAR(again->radii_mm[0], first->radii_mm[1], 1e-9);
  const auto again_ls =
      datum_axis(std::vector<DatumCylinder>{{b, false}, {a, false}}, Association::kLeastSquares);
  EXPECT_GT((again_ls->axis.direction - first_ls->axis.direction).norm(), 1e-8);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.3, Eigen::Vector3d(2, -1, 0.5).normalized()));
  for (Space* points : {&a, &b}) {
    for (auto& p : *points) p = turn * p + Eigen::Vector3d(1e3, 0.0, -1e3);
  }
  const auto turned =
      datum_axis(std::vector<DatumCylinder>{{a, false}, {b, false}}, Association::kOneSided);
  ASSERT_TRUE(turned.has_value());
  EXPECT_NEAR(turned->radii_mm[0], first->radii_mm[0], 1e-9);
}

TEST(DatumAxis, ThatRocksEndsAtTheLastContactOfItsValley) {
  // Four points hold the bore to 2e-10 mm; the fifth carries a multiplier of 8e-8 and the axis.
  const Space bore = {{15.7195, 0.2556, 0.0046},   {-0.4723, 16.4492, 0.0282},
                      {-16.6654, 0.2556, -0.0071}, {-0.4723, -15.9374, -0.0355},
                      {15.7597, 0.1576, 48.554},   {-0.4352, 16.3538, 48.5697},
                      {-16.6314, 0.1576, 48.5653}, {-0.4352, -16.0379, 48.5238}};
  const auto datum =
      datum_axis(std::vector<DatumCylinder>{{bore, true}}, DatumAssociation::kOneSided);
  ASSERT_TRUE(datum.has_value());
  EXPECT_EQ(datum->ending, ZoneEnding::kConverged);
  EXPECT_NEAR(datum->radii_mm[0], 16.192441981599988, 1e-12);
  ASSERT_EQ(datum->contacts.size(), 5U);
  EXPECT_EQ(datum->contacts[3].index, 5U);
  EXPECT_NEAR(datum->axis.direction.x(), 0.0006999764421856, 1e-10);
  EXPECT_NEAR(datum->axis.direction.y(), -0.0019653155705871, 1e-10);
}

// The circumscribed cylinder of an oval rests on its two long generatrices alone, and curvature
// holds it across them: the axis is that of the oval, R the longer half axis.
TEST(DatumAxis, OfANoiseFreeOvalIsHeldByTheCurvatureOfItsGeneratrices) {
  for (const double noise : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5}) {
    for (int seed = 0; seed < (noise == 0.0 ? 1 : 20); ++seed) {
      SCOPED_TRACE(testing::Message() << "noise " << noise << " mm, seed " << seed);
      core::KeyedNoise draw(static_cast<std::uint64_t>(seed), {31});
      const Eigen::Vector3d axis = Eigen::Vector3d(0.004, -0.002, 1.0).normalized();
      const auto frame = across(axis);
      Space oval;
      for (int layer = 0; layer < 5; ++layer) {
        for (int k = 0; k < 24; ++k) {
          const double angle = core::kTwoPi * k / 24;
          const double r = 15.0 + 0.02 * std::cos(2.0 * angle) + noise * draw.normal();
          oval.push_back(Eigen::Vector3d(3.0, -8.0, 0.0) + 10.0 * layer * axis +
                         r * (std::cos(angle) * frame.col(0) + std::sin(angle) * frame.col(1)));
        }
      }
      const auto datum =
          datum_axis(std::vector<DatumCylinder>{{oval, false}}, DatumAssociation::kOneSided);
      ASSERT_TRUE(datum.has_value());
      EXPECT_EQ(datum->ending, ZoneEnding::kConverged);
      EXPECT_NEAR(datum->radii_mm[0], 15.02, 1e-8 + 5.0 * noise);
      // A move d across the generatrices lengthens R by d^2 / (2 R) only.
      const double held = std::sqrt(2.0 * 15.0 * (1e-8 + 5.0 * noise));
      EXPECT_NEAR(distance_mm(datum->axis, Eigen::Vector3d(3.0, -8.0, 0.0)), 0.0, held);
      EXPECT_LT(datum->axis.direction.cross(axis).norm(), held / 20.0);
    }
  }
}

TEST(DatumAxis, RefusesFeaturesThatFixNoAxis) {
  const Space section = test::w3_a()[0];
  const auto of = [](std::vector<DatumCylinder> features) {
    return datum_axis(features, Association::kOneSided).error().code;
  };
  EXPECT_EQ(of({}), core::Code::kNoPoints);
  EXPECT_EQ(of({{section, false}, {Space{}, false}}), core::Code::kNoPoints);
  EXPECT_EQ(of({{section, false}, {section, false}}), core::Code::kRank);
  Space arc;
  for (int layer = 0; layer < 2; ++layer) {
    for (int k = 0; k < 8; ++k)
      arc.emplace_back(9 * std::cos(0.3 * k), 9 * std::sin(0.3 * k), 20.0 * layer + 0.01 * (k % 3));
  }
  EXPECT_EQ(of({{arc, true}}), core::Code::kReferenceAbsent);
}

TEST(DatumSystem, OfAPlaneAndACylinder) {
  const auto zone = min_zone_plane(test::w5_plane(), Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
  const Space bore = all_of(test::w5_bore());
  const auto datum = datum_axis_square_to(zone->outer, {bore, true});
  ASSERT_TRUE(datum.has_value());
  EXPECT_NEAR(datum->radii_mm[0], 5.998453309577, 1e-10);
  const Axis& axis = datum->axis;
  const Eigen::Vector3d at_zero =
      axis.point_mm - axis.direction * (axis.point_mm.z() / axis.direction.z());
  EXPECT_NEAR(at_zero.x(), 9.996972056616, 1e-10);
  EXPECT_NEAR(at_zero.y(), 12.499954079720, 1e-10);
}

}  // namespace
}  // namespace rondure::fit
