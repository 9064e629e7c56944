#pragma once

#include <string>

#include "record/words.h"

namespace rondure::plans {

// Keys of a fixture on a Zaber controller, named as in the JSON; see plan.h. Keys and meanings:
// zaber_table.h.

/// Whether the angle of the fixture grows with the position of a stage.
enum class StageSense { kAsCounted, kReversed };

RONDURE_WORDS(StageSense, {kAsCounted, "as-counted"}, {kReversed, "reversed"});

struct ZaberAxisPlan {
  int axis = 0;                ///< 0: 1 for alpha, 2 for beta.
  double microstep_deg = 0.0;  ///< 0: from the controller.
  StageSense sense = StageSense::kAsCounted;
  double zero_deg = 0.0;         ///< Angle at position 0.
  double max_speed_deg_s = 0.0;  ///< 0: the setting of the controller.
};

struct ZaberPlan {
  enum class Connection { kUsb, kSerial };

  Connection connection = Connection::kUsb;
  std::string device;      ///< For kSerial.
  int baud = 115'200;      ///< For kSerial.
  std::string usb_serial;  ///< For kUsb; empty: the only one plugged in.
  int address = 1;
  ZaberAxisPlan alpha;
  ZaberAxisPlan beta;
  double pose_tolerance_deg = 0.01;
  double motion_limit_s = 120.0;
};

RONDURE_WORDS(ZaberPlan::Connection, {kUsb, "usb"}, {kSerial, "serial"});

}  // namespace rondure::plans
