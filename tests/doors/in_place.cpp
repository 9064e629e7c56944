// In place of plans/checks/internal/plan_reach.cpp, plans/analyses/contour_simulation.cpp,
// plans/path/solid_mesh.cpp, fit/profiles/roundness.cpp, the least-squares fits and web/page.cpp,
// which need half of the program or CGAL and read nothing: they work with what was read and
// checked, and the page goes out.

#include "core/decompositions.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sections.h"
#include "fit/least_squares/sphere.h"
#include "fit/profiles/roundness.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/checks/internal/plan_reach.h"
#include "plans/path/solid_mesh.h"
#include "web/page.h"

// Of the decompositions of core/decompositions.cpp the readers use two.
namespace Eigen {

template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);

}  // namespace Eigen

namespace rondure {
namespace fit {

core::Result<RoundnessEvaluation> evaluate_profile(std::span<const double> /*angles_rad*/,
                                                   std::span<const double> /*radii_mm*/,
                                                   const RoundnessOptions& /*options*/) {
  return RoundnessEvaluation();
}

// The plan reader compares the size of the points with usual ones: 20 mm is refused nowhere.
template <typename Fit>
Fit of_20_mm() {
  Fit out;
  out.radius_mm = 10.0;
  return out;
}

core::Result<LsCircle> ls_circle(PlanePoints /*points_mm*/) { return of_20_mm<LsCircle>(); }

core::Result<LsCylinder> ls_cylinder(SpacePoints /*points_mm*/,
                                     const std::optional<Eigen::Vector3d>& /*near_direction*/) {
  return of_20_mm<LsCylinder>();
}

core::Result<LsSphere> ls_sphere(SpacePoints /*points_mm*/) { return of_20_mm<LsSphere>(); }

std::optional<Eigen::Vector3d> layer_normal(SpacePoints /*points_mm*/,
                                            std::span<const int> /*layers*/) {
  return std::nullopt;
}

}  // namespace fit
namespace plans {

struct SolidMesh::Impl {
  std::vector<Eigen::Vector3d> points_mm;
};
SolidMesh::SolidMesh(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SolidMesh::~SolidMesh() = default;
const std::vector<Eigen::Vector3d>& SolidMesh::points_mm() const { return impl_->points_mm; }

core::Result<std::shared_ptr<const SolidMesh>> SolidMesh::build(
    std::span<const Eigen::Vector3d> points_mm,
    std::span<const std::array<std::size_t, 3>> /*corners*/) {
  auto impl = std::make_unique<Impl>(Impl{{points_mm.begin(), points_mm.end()}});
  return std::shared_ptr<const SolidMesh>(new SolidMesh(std::move(impl)));
}

core::Result<std::shared_ptr<const SolidMesh>> SolidMesh::box(const Eigen::Vector3d& size_mm) {
  return build(std::array<Eigen::Vector3d, 2>{-0.5 * size_mm, 0.5 * size_mm}, {});
}

core::Result<void> check_room(const Plan& /*plan*/) { return {}; }

core::Result<std::vector<Target>> reachable_targets(const Plan& /*plan*/, std::size_t /*index*/) {
  return std::vector<Target>();
}

core::Result<AnalysisData> simulate_five_axis(const Plan& /*plan*/, std::size_t /*index*/,
                                              std::uint64_t /*seed*/, bool /*errors*/) {
  return core::fail(core::Code::kMeaning, "no simulation here");
}
core::Result<AnalysisData> simulate_contour(const Plan& /*plan*/, std::size_t /*index*/,
                                            std::uint64_t /*seed*/, bool /*errors*/) {
  return AnalysisData();
}

}  // namespace plans

namespace web {

std::string live_page(bool /*control*/) { return "<!DOCTYPE html>\n<title>Page</title>\n"; }

std::string live_style() { return "p{margin:0}\n"; }

}  // namespace web
}  // namespace rondure
