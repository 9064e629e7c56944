#include "cmm/simulated/internal/contact.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cmm/simulated/internal/surface_shape.h"
#include "core/shortest_turn.h"
#include "random_parts.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

/// What a search by eye would do: sample a function of (theta, z) densely, then walk downhill from
/// the best samples with ever smaller steps. No derivatives, nothing shared with the solver.
template <class Function>
double least_by_sampling(const PartSurface& part, const Function& value) {
  struct Sample {
    double value, theta, z;
  };
  std::vector<Sample> samples;
  const int around = 1440;
  const int along = 160;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j <= along; ++j) {
      const double theta = core::kTwoPi * i / around;
      const double z = part.half_length_mm * (2.0 * j / along - 1.0);
      const double v = value(theta, z);
      if (v < 1e9) samples.push_back({v, theta, z});
    }
  }
  const auto kept = samples.begin() + std::min<std::ptrdiff_t>(40, std::ssize(samples));
  std::partial_sort(samples.begin(), kept, samples.end(),
                    [](const Sample& a, const Sample& b) { return a.value < b.value; });
  double least = 1e9;
  for (auto best = samples.begin(); best != kept; ++best) {
    for (double step = 1.0; step > 1e-8;) {
      const Sample from = *best;
      for (int k = 0; k < 8; ++k) {
        const double theta = from.theta + step * std::cos(k * M_PI / 4) / part.radius_mm;
        const double z = std::clamp(from.z + step * std::sin(k * M_PI / 4), -part.half_length_mm,
                                    part.half_length_mm);
        const double v = value(theta, z);
        if (v < best->value) *best = {v, theta, z};
      }
      if (best->value >= from.value) step *= 0.5;
    }
    least = std::min(least, best->value);
  }
  return least;
}

Vector3d surface_point(const PartSurface& part, double theta, double z) {
  const double r = part.radius_at(theta, z);
  return {r * std::cos(theta), r * std::sin(theta), z};
}

double sampled_travel(const PartSurface& part, const Vector3d& start, const Vector3d& d,
                      double rho) {
  return least_by_sampling(part, [&](double theta, double z) {
    const Vector3d w = surface_point(part, theta, z) - start;
    const double along = d.dot(w);
    const double depth2 = rho * rho - (w - along * d).squaredNorm();
    return depth2 < 0.0 || along < 0.0 ? 1e9 : along - std::sqrt(depth2);
  });
}

double sampled_distance(const PartSurface& part, const Vector3d& p) {
  return least_by_sampling(
      part, [&](double theta, double z) { return (surface_point(part, theta, z) - p).norm(); });
}

struct Line {
  Vector3d start;
  Vector3d direction;
};

/// A line that starts `clear` off the nominal side and heads for it, tilted and off the axis.
Line random_line(core::KeyedNoise& random, const PartSurface& part, double rho, double clear,
                 double tilt_rad) {
  const double theta = between(random, 0.0, core::kTwoPi);
  const double side = part.inside ? -1.0 : 1.0;
  const Vector3d out(std::cos(theta), std::sin(theta), 0.0);
  const double r = part.radius_mm + side * (rho + clear);
  Vector3d start = r * out;
  start.z() = between(random, -0.8, 0.8) * part.half_length_mm;
  return {start, random_tilted(random, -side * out, tilt_rad)};
}

/// Contact, oracle, and the properties that define a contact.
void expect_true_contact(const PartSurface& part, const Line& line, double rho) {
  const auto contact = first_contact(part, line.start, line.direction, rho, 50.0);
  ASSERT_TRUE(contact) << contact.error().what;
  EXPECT_NEAR(contact->travel_mm, sampled_travel(part, line.start, line.direction, rho), 1e-8);
  EXPECT_NEAR(sampled_distance(part, contact->tip_P_mm), rho, 1e-9);
  EXPECT_NEAR((contact->tip_P_mm - contact->point_P_mm).norm(), rho, 1e-12);
  const double theta = std::atan2(contact->point_P_mm.y(), contact->point_P_mm.x());
  EXPECT_NEAR(contact->point_P_mm.head<2>().norm(), part.radius_at(theta, contact->point_P_mm.z()),
              1e-12);
}

/// At a contact off the rims the way from the point to the tip is perpendicular to the surface.
double tangential_residual(const PartSurface& part, const Contact& contact) {
  const Vector3d& x = contact.point_P_mm;
  const SurfaceJet jet = surface_jet(part, part.radius_mm * std::atan2(x.y(), x.x()), x.z());
  const Vector3d m = contact.tip_P_mm - x;
  return std::max(std::abs(m.dot(jet.u)), std::abs(m.dot(jet.z)));
}

TEST(FirstContact, LeavesNoTangentialResidual) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {7});
    const PartSurface part = random_part(random, seed % 2 == 1, seed % 4 < 2 ? 1.0 : 20.0);
    const Line line = random_line(random, part, 2.0, 4.0, 0.5);
    const auto contact = first_contact(part, line.start, line.direction, 2.0, 50.0);
    ASSERT_TRUE(contact) << contact.error().what;
    if (std::abs(contact->point_P_mm.z()) == part.half_length_mm) continue;
    EXPECT_LT(tangential_residual(part, *contact), 1e-12);
  }
}

/// Signed distance from a solid of ideal form, as a rectangle of the (r, z) half plane.
double distance_to_ideal(const PartSurface& part, const Vector3d& p) {
  const double low = part.inside ? part.radius_mm : -part.radius_mm;
  const double high = part.radius_mm + (part.inside ? kBlockWall_mm : 0.0);
  const double r = p.head<2>().norm();
  const double dr = std::max(low - r, r - high);
  const double dz = std::abs(p.z()) - part.half_length_mm;
  return dr > 0.0 && dz > 0.0 ? std::hypot(dr, dz) : std::max(dr, dz);
}

TEST(FirstContact, SeesEveryObstacleOnRandomWaysAroundAnIdealSolid) {
  int met = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {8});
    PartSurface part = random_part(random, seed % 2 == 1);
    part.form = {};
    const double rho = between(random, 0.5, 4.0);
    const auto anywhere = [&] {
      return Vector3d(between(random, -80, 80), between(random, -80, 80), between(random, -80, 80));
    };
    const Vector3d start = anywhere();
    const Vector3d way = anywhere() - start;
    const auto contact = first_contact(part, start, way.normalized(), rho, way.norm());
    double first = -1.0;  // of 20 000 places along the way
    for (int i = 0; i <= 20000 && first < 0.0; ++i) {
      if (distance_to_ideal(part, start + way * (i / 20000.0)) < rho) first = i / 20000.0;
    }
    if (first == 0.0) {
      ASSERT_FALSE(contact);
      EXPECT_EQ(contact.error().code, core::Code::kCollision);
    } else if (first > 0.0) {
      ++met;
      ASSERT_TRUE(contact) << contact.error().what;
      EXPECT_LE(contact->travel_mm, first * way.norm() + 1e-9);
      EXPECT_NEAR(distance_to_ideal(part, contact->tip_P_mm), rho, 1e-9);
      EXPECT_GE(contact->travel_mm, (first - 1.0 / 20000.0) * way.norm() - 1e-9);
    } else if (contact) {  // a graze between two places
      EXPECT_NEAR(distance_to_ideal(part, contact->tip_P_mm), rho, 1e-9);
    }
  }
  EXPECT_GT(met, 300);
}

TEST(FirstContact, AgreesWithDenseSamplingOnGentleShaftsAndBores) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {1});
    const PartSurface part = random_part(random, seed % 2 == 1);
    const double rho = between(random, 0.5, 3.0);
    const Line line = random_line(random, part, rho, between(random, 0.5, 3.0), 0.9);
    expect_true_contact(part, line, rho);
  }
}

TEST(FirstContact, AgreesWithDenseSamplingOnRoughParts) {
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {2});
    const PartSurface part = random_part(random, seed % 2 == 1, 40.0);
    const double rho = between(random, 0.5, 4.0);
    const Line line = random_line(random, part, rho, 4.0, 0.9);
    expect_true_contact(part, line, rho);
  }
}

PartSurface gear_like(bool inside) {
  PartSurface part;
  part.radius_mm = 25.0;
  part.half_length_mm = 20.0;
  part.inside = inside;
  part.form.lobes = {{60, 0.05, 0.4, 0.7}};
  return part;
}

TEST(FirstContact, BridgesTheValleysOfASteepWave) {
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {3});
    const PartSurface part = gear_like(seed % 2 == 1);
    const double rho = seed % 4 < 2 ? 2.0 : 6.0;  // the valleys have a radius of 3.6 mm
    const Line line = random_line(random, part, rho, 3.0, 0.6);
    expect_true_contact(part, line, rho);
  }
}

TEST(FirstContact, AgreesWithDenseSamplingOnKeywaysAndBurrs) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {9});
    PartSurface part = random_part(random, seed % 2 == 1);
    const double rho = between(random, 0.5, 2.0);
    const Line line = random_line(random, part, rho, 3.0, 0.5);
    const double theta = std::atan2(line.start.y(), line.start.x());
    SurfaceMark mark;
    mark.theta_rad = theta + between(random, -2.0, 2.0) / part.radius_mm;
    mark.z_mm = line.start.z() + between(random, -2.0, 2.0);
    mark.width_mm = between(random, 2.0, 6.0);
    mark.length_mm = between(random, 2.0, 12.0);
    mark.height_mm = seed % 4 < 2 ? between(random, -0.8, -0.2) : between(random, 0.02, 0.3);
    mark.flank_mm = between(random, 0.5, 1.0);
    part.marks = {mark};
    expect_true_contact(part, line, rho);
  }
}

TEST(FirstContact, AMarkOutOfReachChangesNothing) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {10});
    PartSurface part = random_part(random, seed % 2 == 1);
    const Line line = random_line(random, part, 1.0, 3.0, 0.3);
    const auto plain = first_contact(part, line.start, line.direction, 1.0, 20.0);
    ASSERT_TRUE(plain);
    const double theta = std::atan2(plain->point_P_mm.y(), plain->point_P_mm.x());
    part.marks = {{theta + (seed % 3 == 0 ? 1.5 : 3.0), 0.0, 3.0, 10.0, -0.5, 0.3}};
    const auto marked = first_contact(part, line.start, line.direction, 1.0, 20.0);
    ASSERT_TRUE(marked);
    EXPECT_NEAR(marked->travel_mm, plain->travel_mm, 1e-12);
  }
}

TEST(FirstContact, IsNotWhereARadialShortcutWouldPutIt) {
  const PartSurface part = gear_like(false);
  const auto excess = [&part](double theta, double rho) {
    const Vector3d out(std::cos(theta), std::sin(theta), 0.0);
    const auto contact = first_contact(part, 40.0 * out, -out, rho, 20.0);
    return contact->tip_P_mm.norm() - (part.radius_at(theta, 0.0) + rho);
  };
  const double valley = (M_PI - 0.4) / 60.0;  // where the wave is lowest at z = 0
  const double flank = (M_PI / 2 - 0.4) / 60.0;
  EXPECT_NEAR(excess(valley, 2.0), 0.0, 1e-6) << "a small tip finds the bottom";
  EXPECT_GT(excess(valley, 6.0), 0.005) << "a large one bridges the valley";
  EXPECT_GT(excess(flank, 2.0), 0.005) << "and on a flank the contact lies beside the line";
}

TEST(FirstContact, MeetsAnIdealCylinderWhereTheQuadraticSays) {
  PartSurface part;
  part.radius_mm = 25.0;
  part.half_length_mm = 40.0;
  const Vector3d d = Vector3d(-1.0, 0.2, -0.3).normalized();
  const Vector3d start(32.0, 3.0, 5.0);
  const auto contact = first_contact(part, start, d, 2.0, 20.0);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->tip_P_mm.head<2>().norm(), 27.0, 1e-12);
  EXPECT_NEAR(contact->tip_P_mm.z() - contact->point_P_mm.z(), 0.0, 1e-12);
  part.inside = true;
  const auto bore = first_contact(part, {1.0, 2.0, 3.0}, d, 2.0, 50.0);
  ASSERT_TRUE(bore);
  EXPECT_NEAR(bore->tip_P_mm.head<2>().norm(), 23.0, 1e-12);
}

TEST(FirstContact, MeetsTheRimWhenTheLinePassesTheEnd) {
  PartSurface part;
  part.radius_mm = 25.0;
  part.half_length_mm = 40.0;
  // 1.2 mm above the end: the sphere of radius 2 meets the rim sqrt(4 - 1.44) = 1.6 mm off it.
  const auto contact = first_contact(part, {40.0, 0.0, 41.2}, -Vector3d::UnitX(), 2.0, 30.0);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->tip_P_mm.x(), 26.6, 1e-12);
  EXPECT_LT((contact->point_P_mm - Vector3d(25.0, 0.0, 40.0)).norm(), 1e-9);
  EXPECT_LT(
      ((contact->tip_P_mm - contact->point_P_mm).normalized() - Vector3d(0.8, 0.0, 0.6)).norm(),
      1e-9);
}

TEST(FirstContact, RimContactsAgreeWithDenseSampling) {
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {4});
    const PartSurface part = random_part(random, false, 5.0);
    const double rho = 2.0;
    Line line = random_line(random, part, rho, 3.0, 0.2);
    line.start.z() = part.half_length_mm + between(random, 0.1, 1.3);
    line.direction.z() = 0.0;
    line.direction.normalize();
    expect_true_contact(part, line, rho);
  }
}

TEST(FirstContact, MeetsTheFlatEnds) {
  PartSurface shaft;
  shaft.radius_mm = 25.0;
  shaft.half_length_mm = 40.0;
  const auto top = first_contact(shaft, {3.0, 4.0, 60.0}, -Vector3d::UnitZ(), 2.0, 30.0);
  ASSERT_TRUE(top);
  EXPECT_NEAR(top->travel_mm, 18.0, 1e-12);
  EXPECT_EQ((top->tip_P_mm - top->point_P_mm).normalized(), Vector3d::UnitZ());
  PartSurface bore = shaft;
  bore.inside = true;
  EXPECT_FALSE(first_contact(bore, {3.0, 4.0, 60.0}, -Vector3d::UnitZ(), 2.0, 30.0));
  const auto wall = first_contact(bore, {30.0, 0.0, -60.0}, Vector3d::UnitZ(), 2.0, 30.0);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->travel_mm, 18.0, 1e-12);
}

TEST(FirstContact, MeetsTheOuterWallOfABlock) {
  PartSurface bore;
  bore.radius_mm = 25.0;
  bore.half_length_mm = 40.0;
  bore.inside = true;
  const auto wall = first_contact(bore, {60.0, 0.0, 0.0}, -Vector3d::UnitX(), 2.0, 30.0);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->tip_P_mm.x(), 25.0 + kBlockWall_mm + 2.0, 1e-12);
}

TEST(FirstContact, AStartInContactIsItsOwnError) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {5});
    const PartSurface part = random_part(random, seed % 2 == 1);
    const Line away = random_line(random, part, 2.0, -0.2 * (1.0 + 20.0 * random.uniform()), 0.5);
    for (const double sign : {1.0, -1.0}) {
      const auto contact = first_contact(part, away.start, sign * away.direction, 2.0, 10.0);
      ASSERT_FALSE(contact);
      EXPECT_EQ(contact.error().code, core::Code::kCollision);
    }
  }
}

TEST(FirstContact, ReportsNothingInRange) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {6});
    const PartSurface part = random_part(random, seed % 2 == 1);
    const Line line = random_line(random, part, 2.0, 3.0, 0.3);
    const auto contact = first_contact(part, line.start, line.direction, 2.0, 50.0);
    ASSERT_TRUE(contact);
    EXPECT_TRUE(first_contact(part, line.start, line.direction, 2.0, contact->travel_mm + 1e-9));
    const auto shorter =
        first_contact(part, line.start, line.direction, 2.0, contact->travel_mm - 1e-9);
    ASSERT_FALSE(shorter);
    EXPECT_EQ(shorter.error().code, core::Code::kNoTouch);
  }
}

TEST(FirstContact, ALineThatPassesTheShaftMeetsNothingAndOneThatGrazesItDoes) {
  PartSurface part;
  part.radius_mm = 25.0;
  part.half_length_mm = 40.0;
  const Vector3d d = -Vector3d::UnitX();
  EXPECT_FALSE(first_contact(part, {60.0, 27.0 + 1e-6, 0.0}, d, 2.0, 120.0));
  const auto grazing = first_contact(part, {60.0, 27.0 - 1e-6, 0.0}, d, 2.0, 120.0);
  ASSERT_TRUE(grazing);
  EXPECT_NEAR(grazing->tip_P_mm.x(), std::sqrt(27.0 * 27.0 - std::pow(27.0 - 1e-6, 2)), 1e-6);
}

TEST(FirstContact, TurnsWithThePart) {
  // Turning a lobed part without twist about its axis turns the contact with it.
  PartSurface part;
  part.radius_mm = 20.0;
  part.half_length_mm = 30.0;
  part.form.lobes = {{3, 0.01, 0.2, 0.0}};
  PartSurface turned = part;
  turned.form.lobes[0].phase_rad -= 3 * 0.5;
  const Eigen::AngleAxisd turn(0.5, Vector3d::UnitZ());
  const Vector3d start(26.0, 1.0, 2.0);
  const Vector3d d = Vector3d(-1.0, 0.1, 0.2).normalized();
  const auto one = first_contact(part, start, d, 2.0, 10.0);
  const auto two = first_contact(turned, turn * start, turn * d, 2.0, 10.0);
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(one->travel_mm, two->travel_mm, 1e-12);
}

TEST(FirstContact, WithASteepConeIsTheLeastTravelToAnyOfItsPoints) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {11});
    PartSurface part = random_part(random, false);
    const double slope = std::tan(between(random, -40.0, 40.0) * core::kDegree);
    part.half_length_mm = between(random, 8.0, 12.0);
    part.radius_mm = 20.0;
    part.form.taper_mm = slope * part.half_length_mm;
    const double theta = between(random, 0.0, core::kTwoPi);
    const Vector3d normal =
        Vector3d(std::cos(theta), std::sin(theta), -slope) / std::hypot(1.0, slope);
    const Vector3d met = surface_point(part, theta, between(random, -4.0, 4.0));
    const Line line = {met + 5.0 * normal, random_tilted(random, -normal, 0.3)};
    expect_true_contact(part, line, 2.0);
  }
}

/// Least distance of a place from the graph of a function over two parameters, near a start.
template <class Point>
double least_distance(const Point& point, const Vector3d& from, Eigen::Vector2d at) {
  const auto distance = [&](const Eigen::Vector2d& where) { return (point(where) - from).norm(); };
  double best = distance(at);
  for (double step = 1.0; step > 1e-9;) {
    const double before = best;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector2d next =
          at + step * Eigen::Vector2d(std::cos(k * M_PI / 4), std::sin(k * M_PI / 4));
      if (distance(next) >= best) continue;
      at = next;
      best = distance(next);
    }
    if (best >= before) step *= 0.5;
  }
  return best;
}

TEST(FirstContactWithAFace, TouchesItAndOverlapsItNowhere) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {12});
    FaceSurface face;
    face.inner_mm = 10.0;
    face.outer_mm = 40.0;
    face.mirrored = seed % 2 == 1;
    face.tilt_rad = between(random, -0.01, 0.01);
    face.toward_rad = between(random, 0.0, core::kTwoPi);
    face.saucer_mm = between(random, -0.5, 0.5);
    face.wave_mm = between(random, -0.1, 0.1);
    face.wave_order = static_cast<int>(seed % 5);
    const auto point = [&](const Eigen::Vector2d& xy) {
      return Vector3d(xy.x(), xy.y(), face.height_at(xy.x(), xy.y()));
    };
    const double theta = between(random, 0.0, core::kTwoPi);
    const Vector3d start(22.0 * std::cos(theta), 22.0 * std::sin(theta), 7.0);
    const Vector3d d = random_tilted(random, -Vector3d::UnitZ(), 0.4);
    const auto contact = first_contact(face, start, d, 2.0, 20.0);
    ASSERT_TRUE(contact) << contact.error().what;
    EXPECT_NEAR((contact->tip_P_mm - contact->point_P_mm).norm(), 2.0, 1e-11);
    EXPECT_NEAR(contact->point_P_mm.z(), point(contact->point_P_mm.head<2>()).z(), 1e-12);
    EXPECT_NEAR((start + contact->travel_mm * d - contact->tip_P_mm).norm(), 0.0, 1e-12);
    EXPECT_NEAR(least_distance(point, contact->tip_P_mm, contact->tip_P_mm.head<2>()), 2.0, 1e-10);
    EXPECT_EQ(first_contact(face, start, d, 2.0, contact->travel_mm - 1e-9).error().code,
              core::Code::kNoTouch);
  }
}

TEST(FirstContactWithAFace, IsOnItsRingAndFromItsFreeSideOnly) {
  FaceSurface face;
  face.inner_mm = 10.0;
  face.outer_mm = 30.0;
  const Vector3d down = -Vector3d::UnitZ();
  // The failure, or none for a contact.
  const auto code = [&](const Vector3d& start, const Vector3d& d) -> std::optional<core::Code> {
    const auto contact = first_contact(face, start, d, 2.0, 20.0);
    if (contact) return std::nullopt;
    return contact.error().code;
  };
  EXPECT_EQ(code({20.0, 0.0, 8.0}, down), std::nullopt);
  EXPECT_EQ(code({9.9, 0.0, 8.0}, down), core::Code::kNoTouch);
  EXPECT_EQ(code({30.1, 0.0, 8.0}, down), core::Code::kNoTouch);
  EXPECT_EQ(code({20.0, 0.0, 8.0}, -down), core::Code::kNoTouch);
  EXPECT_EQ(code({20.0, 0.0, -8.0}, -down), core::Code::kNoTouch);
  EXPECT_EQ(code({20.0, 0.0, 1.9}, down), core::Code::kCollision);
  face.wave_mm = 0.9;
  face.wave_order = 15;
  EXPECT_EQ(code({20.0, 0.0, 8.0}, down), std::nullopt);
  face.wave_mm = 1.1;
  EXPECT_EQ(code({20.0, 0.0, 8.0}, down), core::Code::kNotConverged);
}

TEST(FirstContactWithABall, TouchesItAndOverlapsItNowhere) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {13});
    BallSurface ball;
    ball.radius_mm = between(random, 3.0, 30.0);
    for (const int order : {2, 3, 5}) {
      ball.lobes.push_back(
          {order, between(random, 0.0, 0.01), between(random, 0.0, core::kTwoPi), 0.0});
    }
    const Vector3d out = random_tilted(random, Vector3d::UnitX(), 1.2);
    const Eigen::Matrix3d turn = core::shortest_turn(Vector3d::UnitZ(), out);
    const auto point = [&](const Eigen::Vector2d& at) {
      const Vector3d u =
          turn * Vector3d(at.x() / ball.radius_mm, at.y() / ball.radius_mm, 1.0).normalized();
      return Vector3d(ball.radius_at(u) * u);
    };
    const Vector3d start = (ball.radius_mm + 6.0) * out;
    const Vector3d d = random_tilted(random, -out, 0.2);
    const auto contact = first_contact(ball, start, d, 2.0, 20.0);
    ASSERT_TRUE(contact) << contact.error().what;
    EXPECT_NEAR((contact->tip_P_mm - contact->point_P_mm).norm(), 2.0, 1e-11);
    EXPECT_NEAR((start + contact->travel_mm * d - contact->tip_P_mm).norm(), 0.0, 1e-12);
    EXPECT_NEAR(least_distance(point, contact->tip_P_mm, {0.0, 0.0}), 2.0, 1e-10);
    EXPECT_EQ(first_contact(ball, start, d, 2.0, contact->travel_mm - 1e-9).error().code,
              core::Code::kNoTouch);
    EXPECT_EQ(first_contact(ball, start, -d, 2.0, 20.0).error().code, core::Code::kNoTouch);
  }
}

TEST(FirstContactWithSphere, StopsAtTheSumOfTheRadii) {
  const auto contact =
      first_contact_with_sphere({1, 2, 3}, 12.5, {1, 2, 30}, -Vector3d::UnitZ(), 2.0, 20.0);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->tip_P_mm.z(), 3 + 14.5, 1e-12);
  EXPECT_EQ(first_contact_with_sphere({1, 2, 3}, 12.5, {1, 2, 17}, -Vector3d::UnitZ(), 2.0, 20.0)
                .error()
                .code,
            core::Code::kCollision);
  EXPECT_EQ(first_contact_with_sphere({1, 2, 3}, 12.5, {1, 2, 30}, Vector3d::UnitZ(), 2.0, 20.0)
                .error()
                .code,
            core::Code::kNoTouch);
}

}  // namespace
}  // namespace rondure::cmm
