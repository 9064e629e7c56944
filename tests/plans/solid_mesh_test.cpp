// The oracle of distances: points of a sweep on a grid against every triangle, by a distance
// written here from the definition.

#include "plans/path/solid_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "record/points/triangles.h"
#include "tests/core/full.h"
#include "tests/plans/random_inspection.h"
#include "tests/plans/stl_files.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using test::between;
using test::cylinder_soup;
using test::Soup;
using ::testing::HasSubstr;

std::shared_ptr<const SolidMesh> mesh_of(const Soup& soup) {
  auto made = SolidMesh::build(soup.points, soup.corners);
  EXPECT_TRUE(made) << made.error().what;
  return *std::move(made);  // throws: this test fails, the others continue
}

Vector3d place_in(core::KeyedNoise& random, double size) {
  return {between(random, -size, size), between(random, -size, size), between(random, -size, size)};
}

double to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

double to_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d n = (b - a).cross(c - a).normalized();
  const auto left = [&](const Vector3d& u, const Vector3d& v) {
    return n.dot((v - u).cross(p - u)) >= 0.0;
  };
  if (left(a, b) && left(b, c) && left(c, a)) return std::abs(n.dot(p - a));
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

double to_soup(const Vector3d& p, const Soup& soup) {
  double out = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : soup.corners)
    out = std::min(out, to_triangle(p, soup.points[a], soup.points[b], soup.points[c]));
  return out;
}

Sweep sweep_near(core::KeyedNoise& random) {
  Sweep out = {place_in(random, 60.0), place_in(random, 50.0), place_in(random, 50.0)};
  const double kind = random.uniform();
  if (kind < 0.3) out.up_mm.setZero();
  if (kind < 0.1) out.along_mm.setZero();
  return out;
}

TEST(SolidMesh, NeverOverlooksAndExaggeratesByAMicrometre) {
  constexpr int kSteps = 40;
  const int parts = test::cases(30, 220);
  int hits = 0;
  int misses = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(parts); ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {21});
    Soup soup;  // triangles apart from each other: nothing is inside
    for (int k = 0; k < 6; ++k) {
      const Vector3d at = place_in(random, 40.0);
      soup.add(at, at + place_in(random, 20.0), at + place_in(random, 20.0));
    }
    const auto mesh = mesh_of(soup);
    EXPECT_EQ(mesh->triangles(), 6U);
    const Vector3d p = place_in(random, 60.0);
    EXPECT_NEAR(mesh->distance_mm(p), to_soup(p, soup), 1e-9);
    for (int k = 0; k < 4; ++k) {
      const Sweep s = sweep_near(random);
      const double room_mm = between(random, 0.3, 12.0);
      const double slack_mm = (s.along_mm.norm() + s.up_mm.norm()) / (2.0 * kSteps);
      double least_mm = std::numeric_limits<double>::infinity();
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          const Vector3d q = s.start_mm + s.along_mm * i / kSteps + s.up_mm * j / kSteps;
          least_mm = std::min(least_mm, to_soup(q, soup));
        }
      }
      const bool meets = mesh->meets(s, room_mm);
      if (least_mm < room_mm) {
        ASSERT_TRUE(meets) << "a place is " << least_mm << " mm off, the limit is " << room_mm;
        ++hits;
      } else if (least_mm - slack_mm > room_mm + 1e-3) {
        ASSERT_FALSE(meets) << "no place is nearer than " << least_mm - slack_mm;
        ++misses;
      }
    }
  }
  EXPECT_GT(22 * hits, 10 * parts);
  EXPECT_GT(22 * misses, 15 * parts);
}

TEST(SolidMesh, IsFollowedAMicrometreBesideItsLimit) {
  const auto block = SolidMesh::box({200.0, 40.0, 60.0});
  ASSERT_TRUE(block);
  const Sweep beside = {{-90.0, 25.001, 0.0}, {180.0, 0.0, 0.0}, Vector3d::Zero()};
  EXPECT_FALSE(
      (*block)->meets({beside.start_mm + Vector3d(0, 2e-3, 0), beside.along_mm, {0, 0, 0}}, 5.0));
  EXPECT_TRUE(
      (*block)->meets({beside.start_mm - Vector3d(0, 2e-3, 0), beside.along_mm, {0, 0, 0}}, 5.0));
}

TEST(SolidMesh, OfAClosedSurfaceHasAnInside) {
  const auto block = SolidMesh::box({200.0, 100.0, 100.0});
  ASSERT_TRUE(block);
  EXPECT_TRUE((*block)->is_closed());
  const Sweep within = {{-20.0, 0.0, 0.0}, {40.0, 0.0, 0.0}, {0.0, 5.0, 0.0}};
  EXPECT_TRUE((*block)->meets(within, 1.0)) << "40 mm from the surface, inside";
  Soup open = cylinder_soup(50.0, -50.0, 50.0, 24);
  open.corners.pop_back();  // a hole
  EXPECT_FALSE(mesh_of(open)->is_closed());
  EXPECT_FALSE(mesh_of(open)->meets({{0, 0, 0}, {5, 0, 0}, {0, 0, 0}}, 1.0));
}

TEST(SolidMesh, JoinsWhatCadWritesApart) {
  Soup soup = cylinder_soup(30.0, 0.0, 80.0, 36);
  for (std::size_t i = 0; i < soup.corners.size(); i += 3) {  // every third looks to the other side
    std::swap(soup.corners[i][1], soup.corners[i][2]);
  }
  soup.add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});                 // no area
  soup.add(soup.points[0], soup.points[1], soup.points[2]);  // twice
  const auto mesh = mesh_of(soup);
  EXPECT_TRUE(mesh->is_closed());
  EXPECT_EQ(mesh->triangles(), 144U);
  EXPECT_TRUE(mesh->meets({{0, 0, 40}, {0, 0, 1}, {0, 0, 0}}, 0.5));
}

TEST(SolidMesh, KnowsHowFarItsFacetsLieWithinARoundWall) {
  const auto sag = [](double radius, int facets) {
    return mesh_of(cylinder_soup(radius, 0.0, 40.0, facets))->sag_mm();
  };
  EXPECT_NEAR(sag(92.0, 96), 0.049, 0.0005);
  for (const int facets : {12, 48, 200}) {
    EXPECT_NEAR(sag(60.0, facets), 60.0 * (1.0 - std::cos(M_PI / facets)), 1e-9) << facets;
  }
  EXPECT_EQ((*SolidMesh::box({10, 20, 30}))->sag_mm(), 0.0);
}

TEST(SolidMesh, IsDrawnByTheEdgesThatAreSeen) {
  const auto shaft = mesh_of(cylinder_soup(30.0, 0.0, 80.0, 36));
  const auto from_side = shaft->outline_mm({0.0, 1.0, 0.0});
  const auto upright = std::count_if(from_side.begin(), from_side.end(), [](const auto& line) {
    return std::abs(line.first.z() - line.second.z()) > 1.0;
  });
  EXPECT_EQ(from_side.size() - static_cast<std::size_t>(upright), 72U) << "both rims";
  EXPECT_EQ(upright, 2) << "where the wall turns away";
  EXPECT_EQ((*SolidMesh::box({10, 20, 30}))->outline_mm({0, 0, 1}).size(), 12U);
}

TEST(SolidMesh, RefusesWhatIsNoBody) {
  const auto fault = [](const Soup& soup) {
    const auto made = SolidMesh::build(soup.points, soup.corners);
    return made ? std::string("made") : core::to_line(made.error());
  };
  EXPECT_THAT(fault(cylinder_soup(0.03, 0.0, 0.08, 12)), HasSubstr("check its unit"));
  EXPECT_THAT(fault(cylinder_soup(3e3, 0.0, 1.0, 12)), HasSubstr("check its unit"));
  Soup flat;
  flat.add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});
  EXPECT_THAT(fault(flat), HasSubstr("no triangle with an area"));
  EXPECT_THAT(fault({}), HasSubstr("no triangle with an area"));
}

TEST(Triangles, AreReadInTheirUnitAndRefusedWhenCutOff) {
  const Soup soup = cylinder_soup(25.4, 0.0, 50.8, 24);
  const std::string text = test::stl_text(soup, 25.4);
  const auto read = record::read_triangles(text, "a.stl", record::LengthUnit::kInch);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->corners.size(), soup.corners.size());
  EXPECT_EQ(read->points_mm.size(), 50U) << "each place once";
  for (std::size_t i = 0; i < soup.corners.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& found = read->points_mm[read->corners[i][k]];
      EXPECT_LT((found - soup.points[soup.corners[i][k]]).norm(), 1e-12);
    }
  }
  const auto fault = [](const std::string& bytes) {
    const auto got = record::read_triangles(bytes, "a.stl", record::LengthUnit::kMm);
    return got ? std::string("read") : core::to_line(got.error());
  };
  EXPECT_THAT(fault(text.substr(0, text.find("endloop", text.size() / 2))), HasSubstr("cut off"));
  EXPECT_THAT(fault("solid a\nfacet\nvertex 1 2 3\nendsolid\n"), HasSubstr("cut off"));
  EXPECT_THAT(fault("solid a\nfacet\nvertex 1 2 nan\nendsolid\n"), HasSubstr("a.stl:3"));
  EXPECT_THAT(fault("solid a\nfacet\nendsolid\n"), HasSubstr("no STL file with triangles"));
  EXPECT_THAT(fault(""), HasSubstr("no STL file"));
  EXPECT_THAT(fault("1 2 3\n4 5 6\n"), HasSubstr("no STL file"));
}

TEST(Triangles, OfDamagedFilesAreRefusedOrMakeABody) {
  const std::string text = test::stl_text(cylinder_soup(20.0, 0.0, 30.0, 6));
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    core::KeyedNoise random(seed, {22});
    std::string damaged = text;
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(
          between(random, 0.0, static_cast<double>(damaged.size()) - 0.01));
      constexpr std::string_view kBytes = "0123456789.-e +\nvx";
      damaged[at] = kBytes[static_cast<std::size_t>(between(random, 0.0, 17.9))];
    }
    const auto read = record::read_triangles(damaged, "a.stl", record::LengthUnit::kMm);
    if (!read) continue;
    const auto mesh = SolidMesh::build(read->points_mm, read->corners);
    if (!mesh) continue;
    EXPECT_TRUE((*mesh)->meets({(*mesh)->points_mm().front(), {1, 0, 0}, {0, 1, 0}}, 0.5));
  }
}

}  // namespace
}  // namespace rondure::plans
