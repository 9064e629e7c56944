#pragma once

#include <string>

#include "record/key_spec.h"

namespace rondure::record {

// Errors of the axes of a machine, as plan and journal spell them: hidden ones of a simulation, and
// standard uncertainties of declared ones.

/// One of the nine translations of the axes, e.g. EXX.
struct TranslationError {
  std::string error;
  double linear_um_m = 0.0;
  double quadratic_um_m2 = 0.0;
  double wave_um = 0.0;
  double wave_period_mm = 100.0;
  double wave_phase_deg = 0.0;
};

/// One of their nine rotations, e.g. EAX.
struct RotationError {
  std::string error;
  double linear_urad_m = 0.0;
  double quadratic_urad_m2 = 0.0;
  double wave_urad = 0.0;
  double wave_period_mm = 100.0;
  double wave_phase_deg = 0.0;
};

template <class Visitor>
void describe(Visitor& v, TranslationError& p) {
  v.text("error", p.error,
         {.one_of = {"EXX", "EYX", "EZX", "EXY", "EYY", "EZY", "EXZ", "EYZ", "EZZ"},
          .required = true,
          .meaning = "Which error, as ISO 230-1 names it: EYX is along y, of the x axis."});
  v.number("linear_um_m", p.linear_um_m, within(10'000.0, "In proportion to the travel."));
  v.number("quadratic_um_m2", p.quadratic_um_m2, within(10'000.0, "With its square."));
  v.number("wave_um", p.wave_um, within(1000.0, "Amplitude of a wave along the travel."));
  v.number("wave_period_mm", p.wave_period_mm, range(0.1, 100'000.0, "Its length."));
  v.number("wave_phase_deg", p.wave_phase_deg, within(360.0, "Its phase at the machine origin."));
}

template <class Visitor>
void describe(Visitor& v, RotationError& p) {
  v.text("error", p.error,
         {.one_of = {"EAX", "EBX", "ECX", "EAY", "EBY", "ECY", "EAZ", "EBZ", "ECZ"},
          .required = true,
          .meaning = "Which error, as ISO 230-1 names it: EAX is about x (A), of the x axis."});
  v.number("linear_urad_m", p.linear_urad_m, within(10'000.0, "In proportion to the travel."));
  v.number("quadratic_urad_m2", p.quadratic_urad_m2, within(10'000.0, "With its square."));
  v.number("wave_urad", p.wave_urad, within(1000.0, "Amplitude of a wave along the travel."));
  v.number("wave_period_mm", p.wave_period_mm, range(0.1, 100'000.0, "Its length."));
  v.number("wave_phase_deg", p.wave_phase_deg, within(360.0, "Its phase at the machine origin."));
}

}  // namespace rondure::record
