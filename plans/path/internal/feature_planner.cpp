#include "plans/path/internal/feature_planner.h"

#include <numeric>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {

FeaturePlanner::FeaturePlanner(const Plan& plan, const FeaturePlan& feature)
    : plan_(plan), feature_(feature), scene_(plan, feature) {}

core::Result<CloudPath> FeaturePlanner::lay(const std::vector<Target>& targets,
                                            const PathGeometry& geometry,
                                            const Eigen::Isometry3d& X_WB,
                                            const Eigen::Isometry3d& X_BP) {
  TRY_DO(check_clamp(targets, geometry, *plan_.fixture));
  if (ordered_ != targets || !(ordered_geometry_ == geometry)) {
    order_ = short_tour(targets, bare_cost(targets, geometry));
    ordered_ = targets;
    ordered_geometry_ = geometry;
  }
  const Placement placement = {X_WB * X_BP, X_WB * nominal_seat(*plan_.fixture)};
  CloudPath path(scene_, placement, geometry, plan_.machine->park_mm[2], targets, order_);
  if (!path.unreachable().empty()) {
    return core::fail(core::Code::kUnreachable, in_words(path.unreachable().front()));
  }
  return path;
}

std::vector<Target> FeaturePlanner::reachable(const std::vector<Target>& targets,
                                              const PathGeometry& geometry,
                                              const Eigen::Isometry3d& X_WB,
                                              const Eigen::Isometry3d& X_BP) const {
  std::vector<Target> out;
  for (const Target& target : targets) {
    if (check_clamp({target}, geometry, *plan_.fixture)) out.push_back(target);
  }
  if (out.empty()) return out;
  std::vector<std::size_t> own(out.size());
  std::iota(own.begin(), own.end(), std::size_t{0});
  const Placement placement = {X_WB * X_BP, X_WB * nominal_seat(*plan_.fixture)};
  const CloudPath path(scene_, placement, geometry, plan_.machine->park_mm[2], out, own);
  for (const Unreachable& missed : path.unreachable()) std::erase(out, missed.target);
  return out;
}

std::string in_words(const Unreachable& unreachable) {
  const Target& t = unreachable.target;
  return fmt::format("layer {}, point {} ({:.1f} deg): {}", t.layer + 1, t.point + 1,
                     t.theta_rad / core::kDegree, in_words(unreachable.hit));
}

}  // namespace rondure::plans
