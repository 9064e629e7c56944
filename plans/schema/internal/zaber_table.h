#pragma once

#include "plans/schema/key_spec.h"
#include "plans/zaber_plan.h"

// The part of plan_table.h for a fixture on a Zaber controller.

namespace rondure::plans {

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

}  // namespace rondure::plans
