#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace rondure::app {

/// Arguments of `rondure fit rotary-axes`.
struct RotaryAxesArguments {
  std::vector<std::string> files;
  std::string axis;               ///< x, y, z or a,b,c; empty: by the name of the axis.
  std::vector<double> origin_mm;  ///< Empty: 0,0,0.
  double reference_deg = 0.0;
  std::vector<double> range_deg;  ///< Of the axis; empty: any.
  std::string method = "exact";
  std::string curve = "spline";
  std::vector<double> place_mm;  ///< Place whose uncertainty is stated; empty: the origin.
  bool keep_outliers = false;
  bool json = false;
};

/// Adds the verb to `fit`.
void add_rotary_axes(CLI::App& fit_verb, RotaryAxesArguments& arguments);
/// Runs the verb. Returns the exit status.
[[nodiscard]] int rotary_axes(const RotaryAxesArguments& arguments);

}  // namespace rondure::app
