#pragma once

#include <array>
#include <vector>

#include "plans/key_spec.h"

namespace rondure::plans {

// The keys of the simulation of a feature of the type "spindle", named as in the JSON; see plan.h.
// The keys of the feature itself: record/tasks/spindle.h.

struct HarmonicPlan {
  int order = 2;
  double amplitude_um = 0.0;
  double phase_deg = 0.0;
};

/// Hidden truth of a simulated spindle.
struct SimulatedSpindlePlan {
  int turns = 3;
  int samples_per_turn = 1024;         ///< Equal steps of the work angle.
  std::vector<HarmonicPlan> profile;   ///< amplitude cos(order theta - phase).
  std::vector<HarmonicPlan> motion_x;  ///< amplitude cos(order alpha - phase).
  std::vector<HarmonicPlan> motion_y;
  double asynchronous_um = 0.0;  ///< Amplitude of a motion of 0.37 cycles per turn, X and Y.
  double eccentricity_um = 0.0;
  double eccentricity_deg = 0.0;
  double probe_noise_um = 0.0;
  std::array<double, 3> probe_offset_um = {0.0, 0.0, 0.0};
  std::array<double, 3> probe_gain_error = {0.0, 0.0, 0.0};  ///< Relative error of the gain.
  /// Distance at which the line of each probe passes the axis; acts with a pin radius.
  std::array<double, 3> line_error_um = {0.0, 0.0, 0.0};
  double p2_error_deg = 0.0;  ///< Real minus stated angle of P2; the next member, of P3.
  double p3_error_deg = 0.0;
};

// Keys and meanings of features of the type "spindle" and their simulation.

template <class Visitor>
void describe(Visitor& v, HarmonicPlan& p) {
  v.whole("order", p.order, required(range(0, 10'000, "Cycles a turn.")));
  v.number("amplitude_um", p.amplitude_um, range(0.0, 10'000.0, "Half of peak to valley."));
  v.number("phase_deg", p.phase_deg, within(360.0, "Phase: amplitude cos(order x - it)."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedSpindlePlan& p) {
  v.whole("turns", p.turns, range(1, 1000, "Revolutions recorded."));
  v.whole("samples_per_turn", p.samples_per_turn,
          range(8, 1'000'000, "Readings a revolution, in equal steps of the work angle."));
  v.list("profile", p.profile, {.meaning = "The part: undulations over the angle on the part."});
  v.list("motion_x", p.motion_x, {.meaning = "Motion of its centre, X, over the work angle."});
  v.list("motion_y", p.motion_y, {.meaning = "Motion of its centre, Y, over the work angle."});
  v.number("asynchronous_um", p.asynchronous_um,
           range(0.0, 10'000.0,
                 "Amplitude of a motion of 0.37 cycles a turn in X and Y, which does not repeat."));
  v.number("eccentricity_um", p.eccentricity_um,
           range(0.0, 10'000.0, "Of the part against its nominal centre."));
  v.number("eccentricity_deg", p.eccentricity_deg, within(360.0, "Its direction on the part."));
  v.number("probe_noise_um", p.probe_noise_um,
           range(0.0, 10'000.0, "Standard deviation of one reading."));
  v.numbers("probe_offset_um", p.probe_offset_um, within(10'000.0, "Zero error of each probe."));
  v.numbers("probe_gain_error", p.probe_gain_error,
            within(0.5, "Relative error of each probe's gain."));
  v.numbers("line_error_um", p.line_error_um,
            within(10'000.0,
                   "Distance at which the line of each probe passes the axis; acts with "
                   "spindle.pin_radius_mm."));
  v.number("p2_error_deg", p.p2_error_deg, within(360.0, "Real minus stated place of probe 2."));
  v.number("p3_error_deg", p.p3_error_deg, within(360.0, "Real minus stated place of probe 3."));
}

}  // namespace rondure::plans
