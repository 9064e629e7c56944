#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "cmm/ipp_server/backend.h"

namespace rondure::cmm {

/// A machine without errors or obstacles: every touch meets its target, no move collides. Its tip
/// is that of the recorded dialogue.
class IdealMachine final : public Machine {
 public:
  static constexpr double kTipRadius_mm = 3.0;
  static constexpr int kMostScanPoints = 1000;

  [[nodiscard]] std::string description() const override { return "ideal"; }
  [[nodiscard]] Capabilities capabilities() const override {
    Capabilities out;
    out.name = "ideal";
    out.scans_circles = true;
    out.least = {0.1, 0.1, 0.1};
    out.greatest = {500.0, 100.0, 100.0};
    out.tools = {"RefTool", "Probe1"};
    return out;
  }
  [[nodiscard]] core::Result<MachineStatus> status() override {
    MachineStatus out;
    out.homed = homed;
    out.tool = tool;
    return out;
  }
  [[nodiscard]] core::Result<void> home() override {
    homed = true;
    return move(Eigen::Vector3d::Zero());
  }
  [[nodiscard]] core::Result<void> select_tool(const std::string& name) override {
    tool = name;
    return {};
  }
  [[nodiscard]] core::Result<void> set_speeds(const Speeds& given) override {
    speeds = given;
    return {};
  }
  [[nodiscard]] core::Result<void> move_to(const Eigen::Vector3d& tip_W_mm) override {
    if (tip_W_mm.cwiseAbs().maxCoeff() > 1e4) {
      return core::fail(core::Code::kUnreachable, "beyond 10 m");
    }
    return move(tip_W_mm);
  }
  [[nodiscard]] core::Result<TouchReading> touch(const TouchCommand& command) override {
    ++touches;
    last_touch = command;
    if (nothing_there) return core::fail(core::Code::kNoTouch, "nothing there");
    time += 1.0;
    TouchReading out;
    out.tip_W_mm = command.expected_tip_W_mm;
    out.time_s = time;
    out.tip_radius_mm = kTipRadius_mm;
    return out;
  }
  [[nodiscard]] core::Result<std::vector<TouchReading>> scan_circle(
      const ScanCircleCommand& command) override {
    if (command.points > kMostScanPoints) return core::fail(core::Code::kMachine, "too many");
    time += 1.0;
    std::vector<TouchReading> out;
    const Eigen::Vector3d radius = command.start_tip_W_mm - command.center_W_mm;
    for (int i = 1; i <= command.points; ++i) {
      TouchReading reading;
      const Eigen::AngleAxisd turn(command.sweep_rad * i / command.points, command.axis_W);
      reading.tip_W_mm = command.center_W_mm + turn * radius;
      out.push_back(reading);
    }
    return out;
  }
  void stop() noexcept override {}
  [[nodiscard]] core::Result<void> recover() override { return {}; }
  [[nodiscard]] Eigen::Vector3d position_W_mm() const override { return position; }
  [[nodiscard]] double time_s() const override { return time; }

  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Speeds speeds;
  std::string tool;
  TouchCommand last_touch;
  double time = 0.0;
  int touches = 0;
  bool homed = false;
  bool nothing_there = false;

 private:
  core::Result<void> move(const Eigen::Vector3d& tip_W_mm) {
    time += (tip_W_mm - position).norm() / speeds.travel_mm_s;
    position = tip_W_mm;
    return {};
  }
};

/// An ideal machine with a table that reaches every alignment and reads 0.
class IdealBackend final : public ipp::Backend {
 public:
  [[nodiscard]] IdealMachine& machine() override { return machine_; }
  [[nodiscard]] std::vector<double> table_angles_deg() const override { return {0.0, 0.0}; }
  [[nodiscard]] core::Result<void> home_table() override { return {}; }
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> align_part(
      std::span<const ipp::Alignment> alignments) override {
    std::vector<Eigen::Vector3d> out;
    for (const ipp::Alignment& alignment : alignments) out.push_back(alignment.machine);
    return out;
  }
  [[nodiscard]] core::Result<void> choose_feature(int index) override {
    if (index > 1) return core::fail(core::Code::kOutOfRange, "there are 2 features");
    return {};
  }
  void set_next_turn(std::uint64_t number) override { next_turn = number; }

  std::uint64_t next_turn = 1;

 private:
  IdealMachine machine_;
};

}  // namespace rondure::cmm
