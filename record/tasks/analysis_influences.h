#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "record/key_spec.h"

// The declared influences of the analyses, as the object `uncertainty` of a feature spells them. A
// key that is left out was not declared, and the report says so; 0 means: known to be zero.

namespace rondure::record {

/// One declared influence.
struct DeclaredInfluence {
  enum class Distribution { kNormal, kRectangular };

  double value = 0.0;  ///< Standard uncertainty; of kRectangular the half-width. >= 0.
  Distribution distribution = Distribution::kNormal;

  [[nodiscard]] double standard_uncertainty() const {
    return distribution == Distribution::kNormal ? value : value / std::sqrt(3.0);
  }
};

constexpr auto words_of(DeclaredInfluence::Distribution) {
  using Distribution = DeclaredInfluence::Distribution;
  return std::to_array<Word<Distribution>>(
      {{Distribution::kNormal, "normal"}, {Distribution::kRectangular, "rectangular"}});
}

using Influence = std::optional<DeclaredInfluence>;

/// Standard uncertainty of an influence; 0 where it was not declared.
[[nodiscard]] inline double u_of(const Influence& influence) {
  return influence ? influence->standard_uncertainty() : 0.0;
}

/// Of three probes.
struct SpindleInfluencesTask {
  Influence noise_um;           ///< Of one reading; in place of an estimate from the readings.
  Influence gain_1;             ///< Of each probe, relative.
  Influence angle_deg;          ///< Of the place of each probe.
  Influence line_um;            ///< Sideways distance of a measuring line from the centre.
  Influence arm_mm;             ///< Of the length of the swing arm.
  Influence skew_us;            ///< Between the channels.
  Influence drift_um_per_turn;  ///< Of a probe.
  Influence quadratic_1;        ///< Full-scale non-linearity over the range.
  Influence encoder_urad;
};

/// Of the calibration of a fixture.
struct RotaryInfluencesTask {
  Influence ball_um;          ///< Of a ball centre itself, beside the scatter of the touches.
  Influence repeat_urad;      ///< Repeatability of an axis.
  Influence reading_urad;     ///< Of the reading of an angle.
  Influence expansion_per_K;  ///< Of the fixture.
};

/// Of a contour and the traces of the controller.
struct ContourInfluencesTask {
  Influence gauge_um;  ///< Of one reading of the gauge.
  Influence gauge_form_um;
  Influence gauge_gain_1;
  Influence gauge_phase_deg;
  Influence c_encoder_urad;
  Influence x_encoder_um;
  Influence c_trace_mdeg;
  Influence x_trace_um;
  Influence skew_ms;
  Influence main_differs_um;
};

/// Of a wheel.
struct WheelInfluencesTask {
  Influence point_um;  ///< Of one point, along the radius.
  Influence scale_ppm;
  Influence squareness_urad;
  Influence threshold_um;  ///< Bias of the edge detection; moves the radius only.
  Influence axis_um;       ///< Of each coordinate of the axis.
  Influence wear_um;       ///< Since the measurement.
};

template <class Visitor>
void describe(Visitor& v, DeclaredInfluence& p) {
  v.number("value", p.value,
           required(range(0.0, 1e6, "Standard uncertainty, or half-width of a rectangular one.")));
  v.text("distribution", p.distribution,
         {.meaning = "normal: value is the standard uncertainty; rectangular: value is the "
                     "half-width."});
}

template <class Visitor>
void describe(Visitor& v, SpindleInfluencesTask& p) {
  v.object("noise_um", p.noise_um, {.meaning = "Of one reading [um]."});
  v.object("gain_1", p.gain_1, {.meaning = "Relative gain of each probe, by its certificate."});
  v.object("angle_deg", p.angle_deg, {.meaning = "Angle of each probe [deg]."});
  v.object("line_um", p.line_um,
           {.meaning = "Sideways distance of each measuring line from the common centre [um]."});
  v.object("arm_mm", p.arm_mm, {.meaning = "Length of the swing arm [mm]."});
  v.object("skew_us", p.skew_us, {.meaning = "Time between the samples of the channels [us]."});
  v.object("drift_um_per_turn", p.drift_um_per_turn, {.meaning = "Drift of each probe [um/turn]."});
  v.object("quadratic_1", p.quadratic_1,
           {.meaning = "Non-linearity of each probe, in parts of its range."});
  v.object("encoder_urad", p.encoder_urad, {.meaning = "Encoder of the work [urad]."});
}

template <class Visitor>
void describe(Visitor& v, RotaryInfluencesTask& p) {
  v.object("ball_um", p.ball_um,
           {.meaning = "Ball centre, beside the scatter of the touches [um]."});
  v.object("repeat_urad", p.repeat_urad, {.meaning = "Repeatability of an axis [urad]."});
  v.object("reading_urad", p.reading_urad, {.meaning = "Reading of an angle [urad]."});
  v.object("expansion_per_K", p.expansion_per_K,
           {.meaning = "Expansion coefficient of the fixture [1/K]."});
}

template <class Visitor>
void describe(Visitor& v, ContourInfluencesTask& p) {
  v.object("gauge_um", p.gauge_um, {.meaning = "One reading of the gauge, with roughness [um]."});
  v.object("gauge_form_um", p.gauge_form_um, {.meaning = "Spindle of the gauge, 2 to 5 UPR [um]."});
  v.object("gauge_gain_1", p.gauge_gain_1, {.meaning = "Relative gain of the gauge."});
  v.object("gauge_phase_deg", p.gauge_phase_deg, {.meaning = "Zero of the angle [deg]."});
  v.object("c_encoder_urad", p.c_encoder_urad,
           {.meaning = "Errors of the encoder of C, which no trace shows [urad]."});
  v.object("x_encoder_um", p.x_encoder_um, {.meaning = "The same of X [um]."});
  v.object("c_trace_mdeg", p.c_trace_mdeg, {.meaning = "Noise of the trace of C [mdeg]."});
  v.object("x_trace_um", p.x_trace_um, {.meaning = "Noise of the trace of X [um]."});
  v.object("skew_ms", p.skew_ms, {.meaning = "Time between the traces of C and X [ms]."});
  v.object("main_differs_um", p.main_differs_um,
           {.meaning = "Rms difference between the errors of a pin and of its main journal that "
                       "do not follow the axes, from earlier studies [um]."});
}

template <class Visitor>
void describe(Visitor& v, WheelInfluencesTask& p) {
  v.object("point_um", p.point_um, {.meaning = "One point, along the radius [um]."});
  v.object("scale_ppm", p.scale_ppm, {.meaning = "Scale of the stage [ppm]."});
  v.object("squareness_urad", p.squareness_urad, {.meaning = "Squareness of its axes [urad]."});
  v.object("threshold_um", p.threshold_um,
           {.meaning = "Bias of the edge detection; moves the radius only [um]."});
  v.object("axis_um", p.axis_um, {.meaning = "Each coordinate of the spindle axis [um]."});
  v.object("wear_um", p.wear_um, {.meaning = "Wear of the radius since the measurement [um]."});
}

}  // namespace rondure::record
