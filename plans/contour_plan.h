#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plans/key_spec.h"
#include "plans/spindle_plan.h"

namespace rondure::plans {

// The keys of the simulation of a feature of the type "contour", as the JSON spells
// them; see plan.h.

struct AngleHarmonicPlan {
  int order = 1;
  double amplitude_mdeg = 0.0;
  double phase_deg = 0.0;
};

/// Hidden truth of simulated pins.
struct SimulatedContourPlan {
  int parts = 4;
  double speed_rpm = 50.0;
  double sampling_ms = 4.0;
  double turns = 1.5;
  std::vector<AngleHarmonicPlan> c_error;  ///< amplitude cos(order alpha - phase).
  std::vector<HarmonicPlan> x_error;
  double c_error_spread = 0.0;  ///< Standard deviation of the size of C errors from part to part.
  std::vector<HarmonicPlan>
      rest;  ///< Non-following harmonics of every part: amplitude cos(order beta - phase).
  double rest_spread_um = 0.0;  ///< Part-to-part variation of `rest`.
  /// What pin and main journal do not share, rms; none: half of the rms of what varies.
  std::optional<double> pin_own_um;
  std::optional<double> main_own_um;
  double c_noise_mdeg = 0.0;
  double x_noise_um = 0.0;
  double roughness_um = 0.0;  ///< Standard deviation of a gauge value.
  int gauge_points = 1440;
};

// Keys and meanings of the simulation of features of the type "contour".

template <class Visitor>
void describe(Visitor& v, AngleHarmonicPlan& p) {
  v.whole("order", p.order, required(range(0, 10'000, "Cycles a turn.")));
  v.number("amplitude_mdeg", p.amplitude_mdeg, range(0.0, 1000.0, "Half of peak to valley."));
  v.number("phase_deg", p.phase_deg, within(360.0, "Phase: amplitude cos(order x - it)."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedContourPlan& p) {
  v.whole("parts", p.parts, range(1, 100, "Parts ground."));
  v.number("speed_rpm", p.speed_rpm, above(0.0, 1000.0, "Turns of C a minute."));
  v.number("sampling_ms", p.sampling_ms,
           above(0.0, 1000.0, "From sample to sample of the control."));
  v.number("turns", p.turns, range(1.0, 100.0, "Turns recorded."));
  v.list("c_error", p.c_error, {.meaning = "Error of C over the command angle."});
  v.list("x_error", p.x_error, {.meaning = "Error of X over the command angle."});
  v.number(
      "c_error_spread", p.c_error_spread,
      range(0.0, 1.0, "Standard deviation of the relative size of C errors from part to part."));
  v.list("rest", p.rest, {.meaning = "Non-following part of every pin, over the angle beta."});
  v.number("rest_spread_um", p.rest_spread_um,
           range(0.0, 1000.0,
                 "Standard deviation of the amplitudes of orders 2 to 6 that differ from part to "
                 "part."));
  const auto own = [&](std::string_view key, std::optional<double>& value, std::string_view of) {
    v.number(key, value, range(0.0, 1000.0, of));
  };
  own("pin_own_um", p.pin_own_um,
      "Rms of what the pin alone has, orders 2 to 6; left out: half of what varies.");
  own("main_own_um", p.main_own_um, "The same of the main journal.");
  v.number("c_noise_mdeg", p.c_noise_mdeg,
           range(0.0, 1000.0, "Standard deviation of one C sample."));
  v.number("x_noise_um", p.x_noise_um, range(0.0, 1000.0, "Standard deviation of one X sample."));
  v.number("roughness_um", p.roughness_um,
           range(0.0, 1000.0, "Standard deviation of one gauge value."));
  v.whole("gauge_points", p.gauge_points, range(360, 100'000, "Values of one gauge contour."));
}

}  // namespace rondure::plans
