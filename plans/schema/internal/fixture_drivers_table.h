#pragma once

#include "plans/fixture_drivers_plan.h"
#include "plans/key_spec.h"

namespace rondure::plans {

// Keys and meanings of a fixture on a Zaber controller.

template <class Visitor>
void describe(Visitor& v, ZaberAxisPlan& p) {
  v.whole("axis", p.axis, range(0.0, 9.0, "Axis of the controller; 0: 1 for alpha, 2 for beta."));
  v.number(
      "microstep_deg", p.microstep_deg,
      range(0.0, 1.0, "Angle of one microstep; 0: one turn by the controller's limit.cycle.dist."));
  v.text("sense", p.sense, {.meaning = "Whether the angle grows with the position of the stage."});
  v.number("zero_deg", p.zero_deg,
           within(360.0, "Angle of the fixture at position 0 of the stage (its reference)."));
  v.number("max_speed_deg_s", p.max_speed_deg_s,
           range(0.0, 360.0, "Greatest speed; 0: as the controller is set."));
}

template <class Visitor>
void describe(Visitor& v, ZaberPlan& p) {
  v.text(
      "connection", p.connection,
      {.meaning = "usb: the program opens the USB device; serial: a serial device of the system."});
  v.text("device", p.device, {.meaning = "serial: its device, e.g. \"/dev/ttyUSB0\"."});
  v.whole("baud", p.baud, range(1200.0, 230'400.0, "serial: its speed; 9600 on old controllers."));
  v.text("usb_serial", p.usb_serial,
         {.meaning = "usb: serial number, as `rondure devices` shows it. Left out: the only device "
                     "plugged in."});
  v.whole("address", p.address, range(1.0, 99.0, "Address of the controller on its line."));
  v.object("alpha", p.alpha, {.meaning = "The stage of the base-fixed axis."});
  v.object("beta", p.beta, {.meaning = "The stage of the carried axis."});
  v.number(
      "pose_tolerance_deg", p.pose_tolerance_deg,
      above(
          0.0, 1.0,
          "Largest difference of a reached pose from the commanded one; beyond it the run stops."));
  v.number("motion_limit_s", p.motion_limit_s,
           range(1.0, 3600.0, "A turn or homing that takes longer is stopped."));
}

// Keys and meanings of the settings of single fixture drivers.

/// Units of a stage that is not in the table of the driver.
template <class Visitor>
void describe_scaling(Visitor& v, ThorlabsAxisPlan& p) {
  v.text("motor", p.motor,
         {.meaning = "Of the stage \"other\": which status messages its controller answers with."});
  v.number("counts_per_deg", p.counts_per_deg,
           above(0.0, 1e9, "Counts of a degree, in place of the stage's."));
  v.number("velocity_per_deg_s", p.velocity_per_deg_s,
           above(0.0, 1e9, "Controller units of 1 deg/s, in place of the stage's."));
  v.number("acceleration_per_deg_s2", p.acceleration_per_deg_s2,
           above(0.0, 1e9, "Controller units of 1 deg/s^2, in place of the stage's."));
}

template <class Visitor>
void describe(Visitor& v, ThorlabsAxisPlan& p) {
  v.text("serial", p.serial,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Serial number of the unit, as `rondure devices` lists it."});
  v.text("stage", p.stage,
         {.meaning = "The stage, for its scaling; PRM1-Z8 with KDC101 or TDC001. other: give motor "
                     "and the three factors."});
  describe_scaling(v, p);
  v.number("zero_deg", p.zero_deg,
           within(360.0, "Angle of the stage, from its home, where the fixture reads 0."));
  v.text("sense", p.sense,
         {.meaning = "reversed: the stage counts against the angle of the fixture."});
  v.number("speed_deg_s", p.speed_deg_s, range(0.01, 25.0, "Greatest speed of its moves."));
  v.number("acceleration_deg_s2", p.acceleration_deg_s2,
           range(0.01, 100.0, "Acceleration of its moves."));
  v.number("tolerance_deg", p.tolerance_deg,
           above(0.0, 1.0,
                 "Largest difference at rest from the commanded angle; beyond it the run ends."));
}

template <class Visitor>
void describe(Visitor& v, ThorlabsPlan& p) {
  v.object("alpha", p.alpha, {.required = true, .meaning = "The unit of the base-fixed axis."});
  v.object("beta", p.beta, {.required = true, .meaning = "The unit of the carried axis."});
}

template <class Visitor>
void describe(Visitor& v, CarriedSpherePlan& p) {
  v.numbers("center_mm", p.center_mm,
            required(within(1000.0, "Certified centre, frame of the clamping ring.")));
}

template <class Visitor>
void describe(Visitor& v, ReachedPosePlan& p) {
  v.number("sphere_diameter_mm", p.sphere_diameter_mm,
           range(1.0, 200.0, "Diameter of the spheres."));
  v.list("spheres", p.spheres,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Two or more on the clamping ring, free from above in every pose. Three not "
                     "on one line tell every pose, two only at different heights."});
  v.whole("points", p.points, range(5, 100, "Touches of each sphere in each pose."));
  v.number("setting_uncertainty_deg", p.setting_uncertainty_deg,
           above(0.0, 5.0,
                 "Largest difference of a hand-set angle from the asked one; beyond it the pose is "
                 "refused."));
  v.number("residual_limit_um", p.residual_limit_um,
           above(0.0, 1000.0,
                 "Largest distance of a sphere from its place in the pose that was found."));
}

}  // namespace rondure::plans
