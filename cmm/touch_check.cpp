#include "cmm/touch_check.h"

#include <cmath>

#include <fmt/format.h>

#include "cmm/place_text.h"

namespace rondure::cmm {
namespace {

constexpr double kAtStart_mm = 1e-6;

}  // namespace

Eigen::Vector3d start_of(const TouchCommand& command) {
  return command.expected_tip_W_mm - command.approach_mm * command.direction_W;
}

core::Result<void> check_touch(const TouchCommand& command, const Eigen::Vector3d& position_W_mm) {
  const auto refuse = [](const std::string& why) { return core::fail(core::Code::kMachine, why); };
  const bool finite = command.expected_tip_W_mm.allFinite() && command.direction_W.allFinite() &&
                      std::isfinite(command.approach_mm) && std::isfinite(command.search_mm);
  if (!finite) return refuse(fmt::format("touch {} is not finite; no motion", command.id));
  if (std::abs(command.direction_W.norm() - 1.0) > 1e-9) {
    return refuse(fmt::format("the direction of touch {} has the length {:.9g}, not 1; no motion",
                              command.id, command.direction_W.norm()));
  }
  if (command.approach_mm + command.search_mm < 0.0) {
    return refuse(
        fmt::format("the search of touch {} ends before it starts; no motion", command.id));
  }
  const Eigen::Vector3d start = start_of(command);
  if ((start - position_W_mm).norm() <= kAtStart_mm) return {};
  return refuse(fmt::format("touch {} starts at {}, but the tip stands at {}; move there first",
                            command.id, in_words(start), in_words(position_W_mm)));
}

}  // namespace rondure::cmm
