#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "record/tasks/wheel.h"

namespace CLI {
class App;
}

namespace rondure::app {

/// Arguments of `rondure fit wheel`.
struct WheelArguments {
  std::string file;
  record::WheelTask::Mode mode = record::WheelTask().mode;  ///< Must be given.
  std::vector<double> axis_mm;                              ///< x, z; empty: not known.
  std::optional<double> nominal_radius_mm;
  record::WheelTask::Center center = record::WheelTask().center;
  record::WheelTask::Quadruples quadruples = record::WheelTask().quadruples;
  std::size_t count = static_cast<std::size_t>(record::WheelTask().count);
  std::uint64_t seed = 1;
  std::optional<double> kappa_limit;
  bool robust = false;
  bool override_arc = false;
  std::string surface;
  std::string removal;
  std::vector<double> range_mm;          ///< Contacts; empty: the table's range.
  std::vector<double> surface_range_mm;  ///< Empty: the contacts.
  double step_mm = record::GroundSurfaceTask().step_mm;
  std::optional<double> cusp_um;
  record::GroundSurfaceTask::Radius radius = record::GroundSurfaceTask().radius;
  std::vector<double> wheel_arc_deg;
  double repeatability_um = 0.0;
  std::optional<double> touch_off_mm;
  bool lowest_point = false;
  double feed_mm_min = 100.0;
  double retract_mm = 5.0;
  std::string path;
  std::string gcode;
  bool json = false;
};

/// Adds the verb to `fit`.
void add_wheel(CLI::App& fit_verb, WheelArguments& arguments);
/// Runs the verb. Returns the exit status.
[[nodiscard]] int wheel(const WheelArguments& arguments);

}  // namespace rondure::app
