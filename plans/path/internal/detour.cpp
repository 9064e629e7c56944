#include "plans/path/internal/detour.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

/// A place of the grid, in steps from the pre-touch point.
using Place = std::array<int, 3>;

/// The tool hangs from above: where it stands free it mostly rises freely. So the grid is fine
/// sideways and coarse along z.
constexpr std::array<int, 3> kLong = {1, 1, 2};  // of a step along each axis, in kDetourStep_mm
constexpr int kReach = static_cast<int>(kDetourReach_mm / kDetourStep_mm);
/// Their order decides between ways of one length.
constexpr std::array<Place, 6> kSteps = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

Way way_through(Polyline corners) {
  const std::size_t moves = corners.size() - 1;
  return {std::move(corners), std::vector<Phase>(moves, Phase::kNear)};
}

/// The search of one way.
class Grid {
 public:
  Grid(const Scene& scene, const Placement& placement, const PathGeometry& geometry,
       const Vector3d& start_W_mm, double sky_mm, std::size_t& moves_left)
      : scene_(scene),
        placement_(placement),
        geometry_(geometry),
        start_(start_W_mm),
        sky_mm_(sky_mm),
        left_(moves_left) {}

  /// Corners from the start to park height; empty when there is no way.
  Polyline search() {
    if (!clear({start_, start_})) return {};
    // Shortest first, in kDetourStep_mm; among equals the place that comes first.
    using Open = std::pair<int, Place>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    std::map<Place, std::pair<int, Place>> known = {{Place{}, {0, Place{}}}};  // length, from where
    open.push({0, Place{}});
    while (!open.empty() && left_ > 0) {
      const auto [length, here] = open.top();
      open.pop();
      if (length > known.at(here).first) continue;
      if (clear({at(here), above(here)})) return shortened(known, here);
      for (const Place& step : kSteps) {
        const Place next = {here[0] + step[0], here[1] + step[1], here[2] + step[2]};
        int further = length;
        int farthest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          further += std::abs(step[k]) * kLong[k];
          farthest = std::max(farthest, std::abs(next[k]) * kLong[k]);
        }
        if (farthest > kReach || at(next).z() > sky_mm_) continue;
        const auto met = known.find(next);
        if (met != known.end() && met->second.first <= further) continue;
        if (!clear({at(here), at(next)})) continue;
        known[next] = {further, here};
        open.push({further, next});
      }
    }
    return {};
  }

 private:
  [[nodiscard]] Vector3d at(const Place& place) const {
    return start_ +
           kDetourStep_mm * Vector3d(kLong[0] * place[0], kLong[1] * place[1], kLong[2] * place[2]);
  }

  [[nodiscard]] Vector3d above(const Place& place) const {
    Vector3d out = at(place);
    out.z() = std::max(out.z(), sky_mm_);
    return out;
  }

  [[nodiscard]] bool clear(Polyline corners) {
    if (left_ == 0) return false;
    --left_;
    return !scene_.first_hit(way_through(std::move(corners)), placement_, geometry_);
  }

  /// The corners to a place from which the tip rises: from each the farthest one is taken that a
  /// straight move reaches.
  Polyline shortened(const std::map<Place, std::pair<int, Place>>& known, Place last) {
    Polyline all = {above(last), at(last)};
    while (last != Place{}) {
      last = known.at(last).second;
      all.push_back(at(last));
    }
    std::ranges::reverse(all);
    Polyline out = {all.front()};
    for (std::size_t i = 0; i + 2 < all.size();) {
      std::size_t next = all.size() - 2;
      while (next > i + 1 && !clear({all[i], all[next]})) --next;
      out.push_back(all[i = next]);
    }
    out.push_back(all.back());
    return out;
  }

  const Scene& scene_;
  const Placement& placement_;
  const PathGeometry& geometry_;
  Vector3d start_;
  double sky_mm_;
  std::size_t& left_;
};

}  // namespace

std::optional<Way> detour(const Scene& scene, const Placement& placement,
                          const PathGeometry& geometry, const Vector3d& pre_touch_W_mm,
                          double sky_mm, std::size_t& moves_left) {
  Polyline up = Grid(scene, placement, geometry, pre_touch_W_mm, sky_mm, moves_left).search();
  if (up.empty()) return std::nullopt;
  std::ranges::reverse(up);
  return way_through(std::move(up));
}

}  // namespace rondure::plans
