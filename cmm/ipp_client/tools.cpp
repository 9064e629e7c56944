#include "cmm/ipp_client/client.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "cmm/grid.h"
#include "cmm/ipp_client/internal/failure.h"

// Tools and speeds of a machine reached over I++ DME.

namespace rondure::cmm {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out.empty() ? "none" : out;
}

/// Speeds as properties of the active tool, with the member of Speeds for each.
struct SpeedProperty {
  std::string_view name;
  double Speeds::*member;
};
constexpr auto kSpeedProperties = std::to_array<SpeedProperty>({
    {"Tool.GoToPar.Speed", &Speeds::travel_mm_s},
    {"Tool.PtMeasPar.Speed", &Speeds::touch_mm_s},
    {"Tool.ScanPar.Speed", &Speeds::scan_mm_s},
});

}  // namespace

core::Result<void> IppMachine::check_named(const std::string& tool) const {
  const auto& tools = identity_.tools;
  const bool named =
      tool.empty() || tools.empty() || std::find(tools.begin(), tools.end(), tool) != tools.end();
  if (named) return {};
  return core::machine_fault("the machine has no tool {}; its tools: {}", tool, listed(tools));
}

core::Result<void> IppMachine::take_tool(const std::string& name) {
  const auto& tools = identity_.tools;
  if (auto named = check_named(name); !named) return named;
  if (auto changed =
          run("ChangeTool", {ipp::string_item(name)}, 0.0, fmt::format("taking tool {}", name));
      !changed) {
    return core::fail_with(changed.error().code, "{}; its tools: {}", changed.error().what,
                           listed(tools));
  }
  dialogue_->forget_properties();
  last_touch_.reset();
  effective_radius_mm_.reset();
  TRY(tool_, dialogue_->active_tool());
  if (tool_ != name) {
    return core::machine_fault(
        "tool {} was asked for, the machine says that {} is active; see which tool is in its head",
        name, tool_.empty() ? "none" : tool_);
  }
  const auto stands = dialogue_->position_W_mm();  // another tip has another position
  if (!stands) return core::fail(stands.error());
  position_W_mm_ = on_grid_mm(*stands);
  if (auto read = read_tool_radius(); !read) return read;
  return read_speed_limits();
}

core::Result<void> IppMachine::check_tool() {
  if (tool_.empty()) {
    return core::machine_fault(
        "the machine has no tool active; name one of its tools (machine.tool): {}",
        listed(identity_.tools));
  }
  if (options_.tip_radius_mm == 0.0 ||
      std::abs(tool_radius_mm_ - options_.tip_radius_mm) <= options_.tip_tolerance_mm) {
    return {};
  }
  return core::machine_fault(
      "tool {} has an effective radius of {:.4f} mm, the tip of the plan has {:.4f} mm, at most "
      "{:g} mm off: name another tool (machine.tool), correct tip_diameter_mm, or qualify the tool "
      "on the machine",
      tool_, tool_radius_mm_, options_.tip_radius_mm, options_.tip_tolerance_mm);
}

core::Result<void> IppMachine::read_tool_radius() {
  tool_radius_mm_ = options_.tip_radius_mm;
  TRY(const auto listed, dialogue_->tool_may_have("AvrRadius"));
  if (!listed) return {};
  TRY(const auto radius, dialogue_->property("Tool.AvrRadius"));
  // 0: unknown; the qualification of the run determines it.
  if (radius && *radius > 0.0) tool_radius_mm_ = *radius;
  return {};
}

core::Result<void> IppMachine::select_tool(const std::string& name) {
  if (auto ready = check_ready(); !ready) return ready;
  if (name == tool_) return {};
  if (auto taken = take_tool(name); !taken) return taken;
  return send_speeds();
}

core::Result<bool> IppMachine::scans_with_tool() {
  if (!identity_.scans) return false;
  const auto listed = dialogue_->tool_may_have("ScanPar");
  if (!listed || !*listed) return listed;
  TRY(const auto speed, dialogue_->property("Tool.ScanPar.Speed"));
  return speed.has_value() || tool_.empty();  // unknown without a tool
}

core::Result<void> IppMachine::read_speed_limits() {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  for (const SpeedProperty& speed : kSpeedProperties) {
    const bool scan = speed.member == &Speeds::scan_mm_s;
    least_.*speed.member = 0.0;
    greatest_.*speed.member = kNoLimit;
    if (scan) {
      TRY(const auto has, scans_with_tool());
      tool_scans_ = has;
      if (!has) continue;
    }
    TRY(const auto least, dialogue_->property(fmt::format("{}.Min", speed.name)));
    TRY(const auto greatest, dialogue_->property(fmt::format("{}.Max", speed.name)));
    least_.*speed.member = least.value_or(0.0);
    greatest_.*speed.member = greatest.value_or(kNoLimit);
  }
  return {};
}

core::Result<void> IppMachine::send_speeds() {
  std::vector<std::pair<std::string_view, double>> values;
  for (const SpeedProperty& speed : kSpeedProperties) {
    const bool scan = speed.member == &Speeds::scan_mm_s;
    if (scan && !capabilities().scans_circles) continue;
    values.emplace_back(speed.name, options_.speeds.*speed.member);
  }
  return dialogue_->set(values);
}

core::Result<void> IppMachine::set_speeds(const Speeds& speeds) {
  for (const SpeedProperty& speed : kSpeedProperties) {
    const double value = speeds.*speed.member;
    const double least = least_.*speed.member;
    const double greatest = greatest_.*speed.member;
    if (std::isfinite(value) && value > 0.0 && value >= least && value <= greatest) continue;
    return core::fail_with(core::Code::kOutOfRange,
                           "{} of {:g} mm/s is outside {:g}..{:g} mm/s of the machine", speed.name,
                           value, least, greatest);
  }
  options_.speeds = speeds;
  return send_speeds();
}

}  // namespace rondure::cmm
