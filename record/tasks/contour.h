#pragma once

#include <cmath>
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
  std::string axes;  ///< Trace of the controller; empty: none.
  std::string pin;   ///< Contour of the pin from the gauge.
  std::string main;  ///< File of the neighbouring main journal; empty: none.
};

/// Where the files have a quantity, and in which unit.
struct ContourColumnTask {
  /// Of the trace; from kAngle on of the gauge, of main journals where they are named otherwise.
  enum class Quantity {
    kC,
    kCError,
    kXError,
    kCommandedC,
    kCommandedX,
    kActualC,
    kActualX,
    kAngle,
    kDeviation,
    kMainAngle,
    kMainDeviation,
  };
  enum class Unit { kDeg, kMilliDeg, kArcSec, kRad, kMilliRad, kMm, kUm, kNm };

  Quantity quantity = Quantity::kC;
  std::string in_file;       ///< Name in the head line.
  std::optional<Unit> unit;  ///< None: that of the quantity without a column.
  double scale = 1.0;        ///< Size of a count in that unit; negative: the other sign.
};

/// Parts ground with the correction that an earlier feature gave.
struct ContourRepeatTask {
  FeatureReference with;
  std::string table;  ///< The file that the control had loaded; empty: simulated.
};

/// The table of a correction of X as a control takes it.
struct ContourCorrectionTask {
  double step_deg = 1.0;
  double resolution_um = 0.0;           ///< Rows are whole multiples; 0: as computed.
  int highest_order = 0;                ///< Of x over C; 0: all that f has.
  std::optional<double> limit_um = {};  ///< A correction beyond it does not leave the run.

  [[nodiscard]] int rows() const { return static_cast<int>(std::lround(360.0 / step_deg)); }
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
  enum class Separation { kAuto, kDirect, kIndirect };

  double crank_radius_mm = 49.0;
  double wheel_radius_mm = 299.88;
  std::optional<FeatureReference> wheel_radius_from;  ///< In place of the number.
  double pin_radius_mm = 24.56;
  double main_radius_mm = 30.0;
  Method method = Method::kCorrected;
  Separation separation = Separation::kAuto;
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
  std::vector<ContourColumnTask> columns;
  std::vector<ContourPartTask> parts;  ///< Empty: simulated.
  std::optional<ContourRepeatTask> repeat;
  std::optional<ContourCorrectionTask> correction;
};

RONDURE_WORDS(ContourTask::Method, {kCorrected, "corrected"}, {kAsPublished, "as-published"});
RONDURE_WORDS(ContourTask::Separation, {kAuto, "auto"}, {kDirect, "direct"},
              {kIndirect, "indirect"});
RONDURE_WORDS(ContourTask::Error, {kActualMinusCommand, "actual-minus-command"},
              {kCommandMinusActual, "command-minus-actual"});
RONDURE_WORDS(ContourTask::CAxis, {kWithWheel, "with-wheel"}, {kAgainstWheel, "against-wheel"});
RONDURE_WORDS(ContourTask::Gauge, {kCounterClockwise, "counter-clockwise"},
              {kClockwise, "clockwise"});
RONDURE_WORDS(ContourTask::Filter, {kGaussian, "gaussian"}, {kNone, "none"},
              {kDoneByGauge, "done-by-gauge"});
RONDURE_WORDS(ContourTask::BaseCircle, {kLimacon, "limacon"}, {kGeometric, "geometric"});
RONDURE_WORDS(ContourColumnTask::Quantity, {kC, "c"}, {kCError, "c_error"}, {kXError, "x_error"},
              {kCommandedC, "alpha_cmd"}, {kCommandedX, "d_cmd"}, {kActualC, "alpha_act"},
              {kActualX, "d_act"}, {kAngle, "angle"}, {kDeviation, "deviation"},
              {kMainAngle, "main_angle"}, {kMainDeviation, "main_deviation"});
RONDURE_WORDS(ContourColumnTask::Unit, {kDeg, "deg"}, {kMilliDeg, "mdeg"}, {kArcSec, "arcsec"},
              {kRad, "rad"}, {kMilliRad, "mrad"}, {kMm, "mm"}, {kUm, "um"}, {kNm, "nm"});

template <class Visitor>
void describe(Visitor& v, ContourColumnTask& p) {
  v.text("quantity", p.quantity,
         {.required = true,
          .meaning = "Of trace or gauge; main_ where main journals have columns of their own."});
  v.text("in_file", p.in_file,
         {.required = true, .empty_allowed = false, .meaning = "Its name in the head line."});
  v.text("unit", p.unit, {.meaning = "Left out: deg, mm; um of a deviation."});
  v.number("scale", p.scale,
           within(1e9, "Size of a count in that unit; negative: the other sign."));
}

template <class Visitor>
void describe(Visitor& v, ContourPartTask& p) {
  v.text("name", p.name, {.meaning = "What the part is called in the report."});
  v.text("axes", p.axes,
         {.meaning = "CSV of the control, relative to the plan: c_deg,c_error_deg,x_error_mm, with "
                     "d_cmd_mm (commanded X) to check crank, wheel and zero of C. Left out of all "
                     "parts: see separation."});
  v.text("pin", p.pin,
         {.required = true,
          .empty_allowed = false,
          .meaning = "CSV of the gauge, columns angle_deg,deviation_um: the pin."});
  v.text("main", p.main,
         {.meaning = "The same of the neighbouring main journal; left out: not measured."});
}

template <class Visitor>
void describe(Visitor& v, ContourCorrectionTask& p) {
  v.number("step_deg", p.step_deg, range(0.1, 30.0, "Step of C, a divisor of 360."));
  v.number("resolution_um", p.resolution_um,
           range(0.0, 10.0, "Rows are rounded to it; 0: as computed."));
  v.whole("highest_order", p.highest_order,
          range(0, 1799, "Last order of x over C, below half the rows; 0: all of f."));
  v.number("limit_um", p.limit_um,
           above(0.0, 1000.0, "A correction beyond it is not written; left out: no limit."));
}

template <class Visitor>
void describe(Visitor& v, ContourRepeatTask& p) {
  v.object("with", p.with,
           {.required = true,
            .meaning = "The earlier contour feature whose correction of X was loaded."});
  v.text("table", p.table,
         {.meaning = "Its file as loaded, columns c_deg,x_um, relative to the plan; left out: "
                     "simulated."});
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
  v.text("separation", p.separation,
         {.meaning = "direct: f from the traces of the axes; indirect: f is t less the main "
                     "journal; auto: direct where there are traces."});
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
  v.list("columns", p.columns, {.meaning = "Columns of the files with other names or units."});
  v.list("parts", p.parts, {.meaning = "The ground parts; left out: simulated."});
  v.object("repeat", p.repeat, {.meaning = "The next parts, ground with a correction of X."});
  v.object("correction", p.correction, {.meaning = "The table of the correction of X."});
}

}  // namespace rondure::record
