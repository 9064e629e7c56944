#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/key_spec.h"
#include "record/tasks/analysis_influences.h"
#include "record/tasks/feature_reference.h"

namespace rondure::record {

/// Files of one ground part.
struct ContourPartTask {
  std::string name;
  std::string axes;  ///< Trace of the controller.
  std::string pin;   ///< Contour of the pin from the gauge.
  std::string main;  ///< File of the neighbouring main journal; empty: none.
};

/// How a feature of the type "contour" is evaluated, as plan and journal spell it: crank pins in
/// follow grinding. A member initialiser is the default of its key.
struct ContourTask {
  enum class Method { kCorrected, kAsPublished };
  enum class Error { kActualMinusCommand, kCommandMinusActual };
  enum class CAxis { kWithWheel, kAgainstWheel };
  enum class Gauge { kCounterClockwise, kClockwise };
  enum class Filter { kGaussian, kNone, kDoneByGauge };
  enum class BaseCircle { kLimacon, kGeometric };

  double crank_radius_mm = 49.0;
  double wheel_radius_mm = 299.88;
  std::optional<FeatureReference> wheel_radius_from;  ///< In place of the number.
  double pin_radius_mm = 24.56;
  double main_radius_mm = 30.0;
  Method method = Method::kCorrected;
  Error error = Error::kActualMinusCommand;
  CAxis c_axis = CAxis::kWithWheel;
  Gauge gauge = Gauge::kCounterClockwise;
  double phase_offset_deg = 0.0;
  double main_phase_offset_deg = 0.0;
  int samples = 1440;
  Filter filter = Filter::kGaussian;
  double cutoff_upr = 50.0;
  BaseCircle base_circle = BaseCircle::kLimacon;
  /// From sample to sample of the control; left out or 0: not known. Without a default: a journal
  /// of this version that was written before the key must still be read.
  std::optional<double> sampling_ms;
  std::optional<ContourInfluencesTask> uncertainty;
  std::vector<ContourPartTask> parts;  ///< Empty: simulated.
};

RONDURE_WORDS(ContourTask::Method, {kCorrected, "corrected"}, {kAsPublished, "as-published"});
RONDURE_WORDS(ContourTask::Error, {kActualMinusCommand, "actual-minus-command"},
              {kCommandMinusActual, "command-minus-actual"});
RONDURE_WORDS(ContourTask::CAxis, {kWithWheel, "with-wheel"}, {kAgainstWheel, "against-wheel"});
RONDURE_WORDS(ContourTask::Gauge, {kCounterClockwise, "counter-clockwise"},
              {kClockwise, "clockwise"});
RONDURE_WORDS(ContourTask::Filter, {kGaussian, "gaussian"}, {kNone, "none"},
              {kDoneByGauge, "done-by-gauge"});
RONDURE_WORDS(ContourTask::BaseCircle, {kLimacon, "limacon"}, {kGeometric, "geometric"});
template <class Visitor>
void describe(Visitor& v, ContourPartTask& p) {
  v.text("name", p.name, {.meaning = "What the part is called in the report."});
  v.text("axes", p.axes,
         {.required = true,
          .empty_allowed = false,
          .meaning = "CSV of the control, relative to the plan: c_deg,c_error_deg,x_error_mm, with "
                     "d_cmd_mm (commanded X) to check crank, wheel and zero of C."});
  v.text("pin", p.pin,
         {.required = true,
          .empty_allowed = false,
          .meaning = "CSV of the gauge, columns angle_deg,deviation_um: the pin."});
  v.text("main", p.main,
         {.meaning = "The same of the neighbouring main journal; left out: not measured."});
}

template <class Visitor>
void describe_crank(Visitor& v, ContourTask& p) {
  const auto radius = [](std::string_view meaning) {
    return NumberSpec{.at_least = 0.1,
                      .at_most = 2000.0,
                      .code = core::Code::kUnits,
                      .hint = "that suggests metres or micrometres, give it in mm",
                      .meaning = meaning};
  };
  v.number("crank_radius_mm", p.crank_radius_mm, radius("Distance of the pin from the axis, R."));
  v.number("wheel_radius_mm", p.wheel_radius_mm, radius("Radius of the grinding wheel, Rgw."));
  v.object("wheel_radius_from", p.wheel_radius_from,
           {.meaning = "Instead of wheel_radius_mm: radius of an earlier wheel of mode envelope, "
                       "with its uncertainty."});
  v.number("pin_radius_mm", p.pin_radius_mm, radius("Radius of the pin, r."));
  v.number("main_radius_mm", p.main_radius_mm, radius("Radius of the main journals."));
}

template <class Visitor>
void describe_senses(Visitor& v, ContourTask& p) {
  v.text("error", p.error,
         {.meaning = "Sign of the axis errors; most controls record command minus actual."});
  v.text("c_axis", p.c_axis,
         {.meaning = "with-wheel: C is the polar angle of the wheel seen from the crankshaft; "
                     "against-wheel: C counts the other way."});
  v.text("gauge", p.gauge, {.meaning = "Sense of the gauge's angles, seen as C."});
  v.number("phase_offset_deg", p.phase_offset_deg,
           within(360.0, "Pins: gauge angle of the direction from crankshaft axis to pin."));
  v.number("main_phase_offset_deg", p.main_phase_offset_deg,
           within(360.0, "The same: main journals."));
}

template <class Visitor>
void describe(Visitor& v, ContourTask& p) {
  describe_crank(v, p);
  v.text("method", p.method,
         {.meaning = "as-published: each following part is turned onto its total by correlation; "
                     "for comparison only."});
  describe_senses(v, p);
  v.whole("samples", p.samples, range(16, 100'000, "Points of a contour."));
  v.text("filter", p.filter,
         {.meaning = "Low pass of all contours; done-by-gauge: pins and mains are filtered "
                     "already, the following part alike."});
  v.number("cutoff_upr", p.cutoff_upr, range(1.0, 10'000.0, "Cut-off of that filter."));
  v.text("base_circle", p.base_circle, {.meaning = "How the base circle is taken away."});
  v.number("sampling_ms", p.sampling_ms,
           range(0.0, 1000.0,
                 "From sample to sample of the control, which uncertainty/skew_ms needs; 0: not "
                 "known."));
  v.object("uncertainty", p.uncertainty,
           {.meaning = "Declared influences: standard uncertainty, or value and distribution. "
                       "Without them: no interval."});
  v.list("parts", p.parts, {.meaning = "The ground parts; left out: simulated."});
}

}  // namespace rondure::record
