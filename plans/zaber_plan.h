#pragma once

#include <string>

namespace rondure::plans {

// Keys of a fixture on a Zaber controller, named as in the JSON; see plan.h. Keys and meanings:
// zaber_table.h.

struct ZaberAxisPlan {
  int axis = 0;                      ///< 0: 1 for alpha, 2 for beta.
  double microstep_deg = 0.0;        ///< 0: as reported by the controller.
  std::string sense = "as-counted";  ///< Or "reversed".
  double zero_deg = 0.0;             ///< Angle at position 0.
  double max_speed_deg_s = 0.0;      ///< 0: the setting of the controller.
};

struct ZaberPlan {
  std::string connection = "usb";  ///< Or "serial".
  std::string device;              ///< For "serial".
  int baud = 115'200;              ///< For "serial".
  std::string usb_serial;          ///< For "usb"; empty: the only one plugged in.
  int address = 1;
  ZaberAxisPlan alpha;
  ZaberAxisPlan beta;
  double pose_tolerance_deg = 0.01;
  double motion_limit_s = 120.0;
};

}  // namespace rondure::plans
