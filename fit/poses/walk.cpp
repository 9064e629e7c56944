#include "fit/poses/walk.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/units.h"

namespace rondure::fit {
namespace {

constexpr double kTie = 1e-9;  // mm

/// State of the walk in degrees, so that poses on the grid stay on it.
struct Degrees {
  double alpha = 0.0;
  double beta = 0.0;
};

class Walker {
 public:
  explicit Walker(const PoseFunction& f) : f_(f) {}

  /// Index of the pose in `visited`; nothing if the fixture cannot take it.
  core::Result<std::optional<std::size_t>> visit(const Degrees& at, double step_deg) {
    const std::pair<long long, long long> key{std::llround(at.alpha / 1e-7),
                                              std::llround(at.beta / 1e-7)};
    if (const auto seen = seen_.find(key); seen != seen_.end()) return seen->second;
    const core::Pose pose{at.alpha * core::kDegree, at.beta * core::kDegree};
    const auto value = f_(pose);
    if (!value && value.error().code != core::Code::kPoseRange) return core::fail(value.error());
    std::optional<std::size_t> index;
    if (value) {
      index = walk_.visited.size();
      walk_.visited.push_back({pose, *value, step_deg});
      degrees_.push_back(at);
    }
    seen_[key] = index;
    return index;
  }

  /// Moves to the best pose of the block around the current one until that is its centre.
  core::Result<void> settle(double step_deg) {
    for (;;) {
      const std::size_t center = walk_.best;
      const Degrees around = degrees_[center];
      for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
          TRY(const auto index,
              visit({around.alpha + i * step_deg, around.beta + j * step_deg}, step_deg));
          if (!index) continue;
          if (walk_.visited[*index].f_mm < walk_.visited[walk_.best].f_mm - kTie)
            walk_.best = *index;
        }
      }
      if (walk_.best == center) return {};
    }
  }

  PoseWalk& walk() { return walk_; }

 private:
  const PoseFunction& f_;
  PoseWalk walk_;
  std::vector<Degrees> degrees_;
  std::map<std::pair<long long, long long>, std::optional<std::size_t>> seen_;
};

}  // namespace

core::Result<PoseWalk> walk_poses(const PoseFunction& f, const core::Pose& start,
                                  std::span<const double> steps_deg) {
  Walker walker(f);
  TRY(const auto first,
      walker.visit({start.alpha_rad / core::kDegree, start.beta_rad / core::kDegree},
                   steps_deg.empty() ? 0.0 : steps_deg.front()));
  if (!first) {
    return core::fail(core::Code::kPoseRange, "the start pose of the search cannot be taken");
  }
  for (const double step : steps_deg) {
    TRY_DO(walker.settle(step));
  }
  return walker.walk();
}

std::vector<double> halved_steps(std::span<const double> steps_deg, double least_deg) {
  std::vector<double> out(steps_deg.begin(), steps_deg.end());
  while (!out.empty() && out.back() / 2.0 >= least_deg) out.push_back(out.back() / 2.0);
  return out;
}

}  // namespace rondure::fit
