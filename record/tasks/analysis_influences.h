#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "record/key_spec.h"

// The declared influences of the analyses, as the object `uncertainty` of a feature spells them. A
// key that is left out was not declared, and the report says so; 0 means: known to be zero. A plan
// spells an influence as a number, which is its standard uncertainty, or as an object.

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

RONDURE_WORDS(DeclaredInfluence::Distribution, {kNormal, "normal"}, {kRectangular, "rectangular"});

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

/// Of a head read in a gauge nest.
struct HeadInfluencesTask {
  Influence ball_um;      ///< Of one coordinate of a reading.
  Influence slides_um;    ///< Of the slides over the travel of the pivot.
  Influence slides_urad;  ///< Their squareness and turn.
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
  Influence threshold_um;     ///< Bias of the edge detection; moves the radius only.
  Influence axis_um;          ///< Of each coordinate of the axis.
  Influence wear_um;          ///< Since the measurement.
  Influence expansion_per_K;  ///< Of the expansion coefficient of the wheel.
  Influence temperature_K;    ///< Of its temperature.
};

/// The object that spells an influence with its distribution.
/// @param spec  Limits and meaning of its value: those of the key that names the influence.
template <class Visitor>
void describe(Visitor& v, DeclaredInfluence& p, const NumberSpec& spec) {
  v.number("value", p.value, required(spec));
  v.text("distribution", p.distribution,
         {.meaning = "normal: value is the standard uncertainty; rectangular: value is the "
                     "half-width."});
}

template <class Visitor>
void describe(Visitor& v, SpindleInfluencesTask& p) {
  v.influence("noise_um", p.noise_um,
              range(0.0, 100.0, "Of one reading; in place of an estimate from the readings."));
  v.influence("gain_1", p.gain_1,
              range(0.0, 0.1, "Relative gain of each probe, by its certificate."));
  v.influence("angle_deg", p.angle_deg, range(0.0, 5.0, "Angle of each probe."));
  v.influence("line_um", p.line_um,
              range(0.0, 1000.0,
                    "Sideways distance of each measuring line from the common "
                    "centre."));
  v.influence("arm_mm", p.arm_mm,
              range(0.0, 10.0, "Length of the swing arm: wear of the wheel, temperature."));
  v.influence("skew_us", p.skew_us, range(0.0, 1e4, "Time between the samples of the channels."));
  v.influence("drift_um_per_turn", p.drift_um_per_turn, range(0.0, 100.0, "Drift of each probe."));
  v.influence("quadratic_1", p.quadratic_1,
              range(0.0, 0.1, "Non-linearity of each probe, in parts of its range."));
  v.influence("encoder_urad", p.encoder_urad, range(0.0, 1e4, "Encoder of the work."));
}

template <class Visitor>
void describe(Visitor& v, RotaryInfluencesTask& p) {
  v.influence("ball_um", p.ball_um,
              range(0.0, 100.0, "Ball centre itself, beside the scatter of the touches."));
  v.influence("repeat_urad", p.repeat_urad, range(0.0, 1e4, "Repeatability of an axis."));
  v.influence("reading_urad", p.reading_urad, range(0.0, 1e4, "Reading of an angle."));
  v.influence("expansion_per_K", p.expansion_per_K,
              range(0.0, 1e-4, "Expansion coefficient of the fixture."));
}

template <class Visitor>
void describe(Visitor& v, HeadInfluencesTask& p) {
  v.influence("ball_um", p.ball_um, range(0.0, 100.0, "One coordinate of a reading."));
  v.influence("slides_um", p.slides_um,
              range(0.0, 1000.0, "Position of the slides over the travel of the pivot."));
  v.influence("slides_urad", p.slides_urad,
              range(0.0, 1000.0, "Squareness and turn of the slides."));
}

template <class Visitor>
void describe(Visitor& v, ContourInfluencesTask& p) {
  v.influence("gauge_um", p.gauge_um,
              range(0.0, 100.0, "One reading of the gauge, with roughness."));
  v.influence("gauge_form_um", p.gauge_form_um,
              range(0.0, 100.0, "Spindle of the gauge, 2 to 5 UPR."));
  v.influence("gauge_gain_1", p.gauge_gain_1, range(0.0, 0.1, "Relative gain of the gauge."));
  v.influence("gauge_phase_deg", p.gauge_phase_deg,
              range(0.0, 5.0, "Zero of the angle of the gauge."));
  v.influence("c_encoder_urad", p.c_encoder_urad,
              range(0.0, 1e4, "Errors of the encoder of C, which no trace shows."));
  v.influence("x_encoder_um", p.x_encoder_um,
              range(0.0, 100.0, "Errors of the encoder of X, which no trace shows."));
  v.influence("c_trace_mdeg", p.c_trace_mdeg, range(0.0, 1000.0, "Noise of the trace of C."));
  v.influence("x_trace_um", p.x_trace_um, range(0.0, 100.0, "Noise of the trace of X."));
  v.influence("skew_ms", p.skew_ms, range(0.0, 100.0, "Time between the traces of C and X."));
  v.influence("main_differs_um", p.main_differs_um,
              range(0.0, 100.0,
                    "Rms difference, from earlier studies, between the errors of a pin and of its "
                    "main journal that do not follow the axes."));
}

template <class Visitor>
void describe(Visitor& v, WheelInfluencesTask& p) {
  v.influence("point_um", p.point_um, range(0.0, 100.0, "One point, along the radius."));
  v.influence("scale_ppm", p.scale_ppm, range(0.0, 1e4, "Scale of the stage."));
  v.influence("squareness_urad", p.squareness_urad, range(0.0, 1e4, "Squareness of its axes."));
  v.influence("threshold_um", p.threshold_um,
              range(0.0, 100.0, "Bias of the edge detection; moves the radius only."));
  v.influence("axis_um", p.axis_um, range(0.0, 1000.0, "Each coordinate of the spindle axis."));
  v.influence("wear_um", p.wear_um,
              range(0.0, 1000.0, "Wear of the radius since the measurement."));
  v.influence("expansion_per_K", p.expansion_per_K,
              range(0.0, 1e-4, "Expansion coefficient of the wheel: error of the stated one."));
  v.influence("temperature_K", p.temperature_K,
              range(0.0, 100.0,
                    "Temperature of the wheel, where its radius is brought to 20 "
                    "degC."));
}

}  // namespace rondure::record
