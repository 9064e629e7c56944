#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/result.h"
#include "plans/path/internal/tour.h"
#include "plans/path/scene.h"

namespace rondure::plans {

/// A target that the tool cannot reach in a pose, and the obstacle.
struct Unreachable {
  Target target;
  Hit hit;
};

/// The path of the tip through all targets of a feature in one pose: from the sky (park height)
/// down, from pre-touch point to pre-touch point, and back to the sky. Every move was checked
/// against the scene. Machine frame. Between two targets it takes the shortest clear one of these
/// paths: around at the travel radius; the same further out, where the shaft leans over the part;
/// over the end of the part (in a bore: along its axis); through the sky, which is always clear
/// when both targets are reachable. Bores are entered along their axis. A target whose entries a
/// body of the plan bars is entered by a detour(), where there is one. Keeps a reference to
/// `scene`.
class CloudPath {
 public:
  /// Moves that the detours of one cloud may check: a second or two where nothing is found.
  static constexpr std::size_t kDetourMoves = 8'000;

  /// @param targets   At least one.
  /// @param proposed  Order of touching, as indices; used unless the targets' own order is shorter,
  ///                  which is checked for up to 2000 targets.
  CloudPath(const Scene& scene, const Placement& placement, const PathGeometry& geometry,
            double sky_mm, std::vector<Target> targets, std::vector<std::size_t> proposed,
            std::size_t detour_moves = kDetourMoves);

  /// Targets without a path. @pre for the paths below: this list is empty.
  [[nodiscard]] const std::vector<Unreachable>& unreachable() const { return unreachable_; }
  /// Indices of the targets in the order of touching.
  [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }
  /// The k-th target to touch.
  [[nodiscard]] const Target& target(std::size_t k) const { return targets_[order_[k]]; }
  /// From park height to the pre-touch point of the k-th target.
  [[nodiscard]] Polyline entry_W(std::size_t k) const;
  /// From the previous pre-touch point, or from park height, to that of the k-th target.
  [[nodiscard]] Polyline way_W(std::size_t k) const;
  /// From the pre-touch point of the k-th target to park height.
  [[nodiscard]] Polyline exit_W(std::size_t k) const;

 private:
  enum class Entry { kAlongAxis, kAlongAxisFurther, kVertical, kVerticalFurther, kDetour };

  [[nodiscard]] bool beside_walls() const;
  [[nodiscard]] Way in_machine(const Polyline& path_P, Phase first, Phase middle, Phase last) const;
  [[nodiscard]] Way entry(std::size_t target, Entry kind) const;
  [[nodiscard]] Way touch_way(std::size_t target) const;
  [[nodiscard]] Way between(std::size_t from, std::size_t to) const;
  [[nodiscard]] Way over_the_end(std::size_t from, std::size_t to) const;
  [[nodiscard]] double further_mm() const;
  void find_entries(std::size_t detour_moves);
  void choose_order(std::vector<std::size_t> proposed);
  [[nodiscard]] double tour_mm(const std::vector<std::size_t>& order) const;

  const Scene* scene_;
  Placement placement_;
  PathGeometry geometry_;
  PathGeometry further_;  ///< For a path around further out, because of the shaft.
  double sky_mm_;
  std::vector<Target> targets_;
  std::vector<Entry> entries_;
  std::map<std::size_t, Way> detours_;  ///< By target, for Entry::kDetour.
  std::vector<std::size_t> order_;
  std::vector<Unreachable> unreachable_;
};

/// Plans the paths of the tip for one feature. The scene is built once, and the order of touches is
/// determined once per list of targets. Runs and forecasts use the same planner, so their paths
/// agree.
class FeaturePlanner {
 public:
  FeaturePlanner(const Plan& plan, const FeaturePlan& feature);

  /// @param X_WB  The clamping ring (body frame) in the machine.
  /// @param X_BP  The best estimate of the part in the body frame.
  /// @return kUnreachable with the first unreachable target and the cause.
  [[nodiscard]] core::Result<CloudPath> lay(const std::vector<Target>& targets,
                                            const PathGeometry& geometry,
                                            const Eigen::Isometry3d& X_WB,
                                            const Eigen::Isometry3d& X_BP);

  /// The targets that the tool can reach, in their order.
  [[nodiscard]] std::vector<Target> reachable(const std::vector<Target>& targets,
                                              const PathGeometry& geometry,
                                              const Eigen::Isometry3d& X_WB,
                                              const Eigen::Isometry3d& X_BP) const;

 private:
  const Plan& plan_;
  const FeaturePlan& feature_;
  Scene scene_;
  std::vector<Target> ordered_;  ///< The targets for which `order_` was determined.
  PathGeometry ordered_geometry_;
  std::vector<std::size_t> order_;
};

/// "layer 1, point 3 (102.9 deg): the shaft of the stylus would come nearer than ...".
[[nodiscard]] std::string in_words(const Unreachable& unreachable);

}  // namespace rondure::plans
