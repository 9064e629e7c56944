#pragma once

#include <string>
#include <vector>

#include "plans/key_spec.h"

namespace rondure::plans {

// The keys of the simulation of a feature of the type "five_axis", as the JSON spells
// them; see plan.h.

/// Location errors as planted. Those that the fit defines differ on an arc.
struct HeadLocationPlan {
  double XOC_um = 0.0;
  double YOC_um = 0.0;
  double AOC_urad = 0.0;
  double BOC_urad = 0.0;
  double YOA_um = 0.0;
  double ZOA_um = 0.0;
  double BOA_urad = 0.0;
  double COA_urad = 0.0;
};

/// A motion error: amplitude (cos(order phi - phase) - cos(phase)).
struct HeadMotionPlan {
  std::string error;
  int order = 1;
  double amplitude_um = 0.0;    ///< Of EX, EY, EZ.
  double amplitude_urad = 0.0;  ///< Of EA, EB, EC.
  double phase_deg = 0.0;
};

/// Hidden truth of a simulated head.
struct SimulatedFiveAxisPlan {
  HeadLocationPlan location;
  std::vector<HeadMotionPlan> errors;
  double sag_urad = 0.0;            ///< EAC that goes with sin A sin C.
  double xy_squareness_urad = 0.0;  ///< Of the slides.
  double noise_um = 0.0;            ///< Of one coordinate of a reading.
  double drift_um = 0.0;            ///< Of the nest along x, from the first reading to the last.
};

// Keys and meanings of the simulation of features of the type "five_axis".

template <class Visitor>
void describe(Visitor& v, HeadLocationPlan& p) {
  const NumberSpec shift = within(10'000.0, "Place of the axis.");
  const NumberSpec tilt = within(10'000.0, "Direction of the axis.");
  v.number("XOC_um", p.XOC_um, shift);
  v.number("YOC_um", p.YOC_um, shift);
  v.number("AOC_urad", p.AOC_urad, tilt);
  v.number("BOC_urad", p.BOC_urad, tilt);
  v.number("YOA_um", p.YOA_um, shift);
  v.number("ZOA_um", p.ZOA_um, shift);
  v.number("BOA_urad", p.BOA_urad, tilt);
  v.number("COA_urad", p.COA_urad, tilt);
}

template <class Visitor>
void describe(Visitor& v, HeadMotionPlan& p) {
  v.text("error", p.error,
         {.one_of = {"EXC", "EYC", "EZC", "EAC", "EBC", "ECC", "EXA", "EYA", "EZA", "EAA", "EBA",
                     "ECA"},
          .required = true,
          .meaning = "Which error, as ISO 230-7 names it: EXC is along x, of C."});
  v.whole("order", p.order, required(range(1, 100, "Undulations a turn.")));
  v.number("amplitude_um", p.amplitude_um, range(0.0, 1000.0, "Of EX, EY, EZ."));
  v.number("amplitude_urad", p.amplitude_urad, range(0.0, 10'000.0, "Of EA, EB, EC."));
  v.number("phase_deg", p.phase_deg, within(360.0, "q: amplitude (cos(order phi - q) - cos q)."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedFiveAxisPlan& p) {
  v.object("location", p.location, {.meaning = "Location errors (ISO 230-7)."});
  v.list("errors", p.errors, {.meaning = "Motion errors of both axes."});
  v.number("sag_urad", p.sag_urad,
           within(10'000.0, "EAC that goes with sin A sin C: no table of single axes holds it."));
  v.number("xy_squareness_urad", p.xy_squareness_urad,
           within(10'000.0, "Squareness of the slides X and Y."));
  v.number("noise_um", p.noise_um, range(0.0, 1000.0, "Standard deviation of one coordinate."));
  v.number("drift_um", p.drift_um,
           within(1000.0, "Of the nest along x, from the first reading to the last."));
}

}  // namespace rondure::plans
