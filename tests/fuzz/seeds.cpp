#include "tests/fuzz/seeds.h"

#include <cstddef>
#include <sstream>

#include "tests/app/files.h"

namespace rondure::fuzz {
namespace {

/// A file of tests/data with its header and every n-th row.
std::string thinned(const std::string& name, std::size_t every) {
  std::istringstream lines(app::testing::read(app::testing::source_dir() / "tests/data" / name));
  std::string out;
  std::size_t row = 0;
  bool header = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    if (header || row++ % every == 0) out += line + "\n";
    header = false;
  }
  return out;
}

}  // namespace

const std::vector<std::string>& point_tables() {
  static const std::vector<std::string> tables = {
      thinned("axle_mzc_3/points.csv", 1),    thinned("gander1994_circle/points.csv", 1),
      thinned("nist_cir2d_02/points.csv", 1), thinned("nist_cir2d_09/points.csv", 1),
      thinned("nist_cyl_02/points.csv", 1),   thinned("nist_cyl_03/points.csv", 1),
      thinned("nist_cyl_13/points.csv", 9),   thinned("nist_cyl_16/points.csv", 8),
      thinned("nist_cyl_05/points.csv", 20),  thinned("openindy_cyl_tracker_a/points.csv", 1)};
  return tables;
}

const std::vector<std::string>& ball_tables() {
  static const std::vector<std::string> tables = {thinned("spec_rotary/c_axis.csv", 1),
                                                  thinned("spec_rotary/fixture.csv", 1)};
  return tables;
}

const std::vector<std::string>& spindle_tables() {
  static const std::vector<std::string> tables = {thinned("spindle_dynamic/readings.csv", 8),
                                                  thinned("spindle_dynamic/readings.csv", 16)};
  return tables;
}

const std::vector<std::string>& roundness_tables() {
  static const std::vector<std::string> tables = {
      thinned("spec_roundness/profile.csv", 4), thinned("axle_mzc_3/points.csv", 1),
      thinned("nist_cir2d_10/points.csv", 1), thinned("nist_cir2d_06/points.csv", 3)};
  return tables;
}

const std::vector<std::string>& wheel_tables() {
  static const std::vector<std::string> tables = {thinned("spec_wheel/example1.csv", 1),
                                                  thinned("spec_wheel/example2.csv", 1)};
  return tables;
}

const std::vector<std::string>& contour_tables() {
  static const std::vector<std::string> tables = {
      thinned("spec_contour/axes1.csv", 5), thinned("spec_contour/pin1.csv", 4),
      thinned("spec_contour/main1.csv", 4), thinned("spec_contour/axes2.csv", 10)};
  return tables;
}

const std::vector<std::string>& table_words() {
  static const std::vector<std::string> all = {"NaN",
                                               "-INF",
                                               "1e400",
                                               "1e9",
                                               "-1e9",
                                               "1e-320",
                                               "0",
                                               "\n",
                                               ",",
                                               ",,",
                                               "\r\n",
                                               "#",
                                               "\t",
                                               ";",
                                               "\"",
                                               "1,5",
                                               "x",
                                               "x_mm",
                                               "y",
                                               "z",
                                               "+",
                                               "reference",
                                               "\xef\xbb\xbf",
                                               "\xff\xfe",
                                               "\xc3",
                                               "\x1b[2J",
                                               "\xef\xbf\xbf",
                                               "theta_deg",
                                               "r_um",
                                               "axis",
                                               "alpha_deg",
                                               "beta_deg"};
  return all;
}

const std::vector<std::string>& json_words() {
  static const std::vector<std::string> all = {"null",
                                               "-1",
                                               "0",
                                               "1e308",
                                               "1e999",
                                               "\"\"",
                                               "[]",
                                               "{}",
                                               "true",
                                               "\"mm\"",
                                               "\"um\"",
                                               "[[[[",
                                               "]]]",
                                               "NaN",
                                               "\\u0000",
                                               "\\ud800",
                                               "\xff",
                                               "\x1b",
                                               ",",
                                               ":",
                                               "9223372036854775807",
                                               "-5e-324",
                                               "\"1970-01-01T00:00:00Z\"",
                                               "360",
                                               "0.5"};
  return all;
}

}  // namespace rondure::fuzz
