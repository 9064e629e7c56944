#include "reports/data/wheel_path.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "core/version.h"

namespace rondure::reports {
namespace {

/// Six decimals without "-0.000000".
std::string word(char letter, double value) {
  std::string digits = fmt::format("{:.6f}", value);
  if (digits == "-0.000000") digits.erase(0, 1);
  return fmt::format("{}{}", letter, digits);
}

}  // namespace

std::string wheel_path_csv(const fit::WheelPath& path) {
  std::string out = fmt::format(
      "# wheel-centre path for R = {} mm; xc, zc: wheel {}\n"
      "x_mm,f_mm,slope,xc_mm,zc_mm,phi_deg,R_ks,clearance_um\n",
      core::shortest(path.radius_mm), path.lowest_point ? "lowest point" : "centre");
  for (const fit::WheelPathRow& row : path.rows) {
    const double values[] = {row.x_mm,
                             row.surface.height_mm,
                             row.surface.slope,
                             row.center_mm.x(),
                             path.machine_z_mm(row),
                             row.contact_rad / core::kDegree,
                             row.load,
                             row.clearance_mm / core::kMicrometre};
    const char* separator = "";
    for (const double value : values) {
      out += separator;
      out += core::shortest(value + 0.0);
      separator = ",";
    }
    out += '\n';
  }
  return out;
}

std::string wheel_gcode(const fit::WheelPath& path, const GcodeOptions& options) {
  double top = path.machine_z_mm(path.rows.front());
  for (const fit::WheelPathRow& row : path.rows) top = std::max(top, path.machine_z_mm(row));
  const std::string above = word('Z', top + options.retract_mm);
  const fit::WheelPathRow& first = path.rows.front();
  std::string out = fmt::format(
      "%\n(RONDURE {} WHEEL PATH)\n(WHEEL RADIUS {:.6f} MM, X Z ARE THE WHEEL {})\n"
      "(X AS RADIUS, STEP {:.6f} MM, {} PLACES)\n"
      "G21 G90 G94 G18\nG0 {}\nG0 {}\nG1 {} F{}\n",
      core::kVersion, path.radius_mm, path.lowest_point ? "LOWEST POINT" : "CENTRE", path.step_mm,
      path.rows.size(), above, word('X', first.center_mm.x()), word('Z', path.machine_z_mm(first)),
      core::shortest(options.feed_mm_min));
  for (auto row = path.rows.begin() + 1; row != path.rows.end(); ++row) {
    out += fmt::format("G1 {} {}\n", word('X', row->center_mm.x()),
                       word('Z', path.machine_z_mm(*row)));
  }
  return out + fmt::format("G0 {}\nM30\n%\n", above);
}

}  // namespace rondure::reports
