#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace rondure::app {

/// Arguments of `rondure fit wheel`.
struct WheelArguments {
  std::string file;
  std::string mode;
  std::vector<double> axis_mm;  ///< x, z; empty: not known.
  std::optional<double> nominal_radius_mm;
  std::string center = "least-squares";
  std::string quadruples = "all";
  std::size_t count = 6;
  std::uint64_t seed = 1;
  std::optional<double> kappa_limit;
  bool robust = false;
  bool override_arc = false;
  std::string surface;
  std::string removal;
  std::vector<double> range_mm;          ///< Contacts; empty: the table's range.
  std::vector<double> surface_range_mm;  ///< Empty: the contacts.
  double step_mm = 0.1;
  std::optional<double> cusp_um;
  std::string radius = "mean";
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
