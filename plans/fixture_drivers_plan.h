#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "record/words.h"

namespace rondure::plans {

// Keys of a fixture on a Zaber controller, named as in the JSON; see plan.h.

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

// Settings of single fixture drivers, as the JSON spells them; see plan.h.

/// One axis on a Thorlabs APT unit.
struct ThorlabsAxisPlan {
  enum class Stage { kK10cr1, kPrm1Z8, kOther };
  enum class Motor { kStepper, kDcServo };

  std::string serial;
  Stage stage = Stage::kK10cr1;
  Motor motor = Motor::kStepper;         ///< For kOther.
  std::optional<double> counts_per_deg;  ///< Replace the numbers of the stage.
  std::optional<double> velocity_per_deg_s;
  std::optional<double> acceleration_per_deg_s2;
  double zero_deg = 0.0;  ///< Angle of the stage where the fixture reads 0.
  StageSense sense = StageSense::kAsCounted;
  double speed_deg_s = 5.0;
  double acceleration_deg_s2 = 5.0;
  double tolerance_deg = 0.01;
};

RONDURE_WORDS(ThorlabsAxisPlan::Stage, {kK10cr1, "K10CR1"}, {kPrm1Z8, "PRM1-Z8"},
              {kOther, "other"});
RONDURE_WORDS(ThorlabsAxisPlan::Motor, {kStepper, "stepper"}, {kDcServo, "dc-servo"});

struct ThorlabsPlan {
  ThorlabsAxisPlan alpha;
  ThorlabsAxisPlan beta;
};

/// A reference sphere that turns with the part.
struct CarriedSpherePlan {
  std::array<double, 3> center_mm = {0.0, 0.0, 0.0};  ///< Certified, frame of the ring.
};

/// Measurement of the pose to which a fixture without encoders was set.
struct ReachedPosePlan {
  double sphere_diameter_mm = 20.0;
  std::vector<CarriedSpherePlan> spheres;
  int points = 7;                        ///< Touches of each sphere.
  double setting_uncertainty_deg = 0.5;  ///< Largest deviation of a pose set by hand.
  double residual_limit_um = 20.0;
};

}  // namespace rondure::plans
