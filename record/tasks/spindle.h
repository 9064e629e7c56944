#pragma once

#include <optional>
#include <string_view>

#include "record/key_spec.h"
#include "record/tasks/analysis_influences.h"
#include "record/tasks/feature_reference.h"
#include "record/words.h"

namespace rondure::record {

/// Settings of the evaluation of a feature of the type "spindle" in plan and journal: form of a
/// part and motion of its axis, from three probes. A member initialiser is the default of its key.
struct SpindleTask {
  enum class Layout { kAngles, kPublishedA, kPublishedB, kReference };
  enum class SecondOrder { kAuto, kOn, kOff };
  enum class Motion { kLeastSquares, kAsPublished };
  enum class Filter { kGaussian, kNone };

  Layout layout = Layout::kAngles;
  std::optional<double> p1_to_p2_deg;
  std::optional<double> p2_to_p3_deg;  ///< This one or `p1_to_p3_deg`.
  std::optional<double> p1_to_p3_deg;
  double crank_radius_mm = 0.0;  ///< 0: an ordinary shaft; otherwise the arm follows a crank pin.
  double wheel_radius_mm = 0.0;
  std::optional<FeatureReference> wheel_radius_from;  ///< In place of the number.
  double pin_radius_mm = 0.0;
  int samples = 1024;
  int highest_order = 50;
  double greatest_gain = 100.0;
  std::optional<double> probe_noise_um;  ///< None: estimated from the readings.
  SecondOrder second_order = SecondOrder::kAuto;
  Motion motion = Motion::kLeastSquares;
  Filter filter = Filter::kGaussian;  ///< Filter of the profile.
  double cutoff_upr = 50.0;
  std::optional<SpindleInfluencesTask> uncertainty;
  std::optional<double> probe_range_um;  ///< Whole range of a probe; none: not stated.
  std::optional<double> tip_width_mm;    ///< Of tip or spot; none: a point.
};

RONDURE_WORDS(SpindleTask::Layout, {kAngles, "angles"}, {kPublishedA, "published-a"},
              {kPublishedB, "published-b"}, {kReference, "reference"});
RONDURE_WORDS(SpindleTask::SecondOrder, {kAuto, "auto"}, {kOn, "on"}, {kOff, "off"});
RONDURE_WORDS(SpindleTask::Motion, {kLeastSquares, "least-squares"},
              {kAsPublished, "as-published"});
RONDURE_WORDS(SpindleTask::Filter, {kGaussian, "gaussian"}, {kNone, "none"});

template <class Visitor>
void describe_probe_angles(Visitor& v, SpindleTask& p) {
  v.text("layout", p.layout,
         {.meaning = "Places of the probes: by p1_to_p2_deg and one of p2_to_p3_deg and "
                     "p1_to_p3_deg, or a layout by name."});
  v.number("p1_to_p2_deg", p.p1_to_p2_deg,
           within(360.0,
                  "From probe 1 to probe 2, against the rotation of the work; negative: with it."));
  v.number("p2_to_p3_deg", p.p2_to_p3_deg,
           within(360.0, "From probe 2 to probe 3 (a difference)."));
  v.number("p1_to_p3_deg", p.p1_to_p3_deg, within(360.0, "From probe 1 to probe 3 (cumulative)."));
}

template <class Visitor>
void describe_swing_arm(Visitor& v, SpindleTask& p) {
  const auto radius = [](std::string_view meaning) {
    return NumberSpec{.at_least = 0.0,
                      .at_most = 2000.0,
                      .code = core::Code::kUnits,
                      .hint = "that suggests micrometres, give it in mm",
                      .meaning = meaning};
  };
  v.number(
      "crank_radius_mm", p.crank_radius_mm,
      radius("Distance of the pin from the rotation axis, on a swing arm; 0: an ordinary shaft."));
  v.number("wheel_radius_mm", p.wheel_radius_mm,
           radius("Radius of the wheel whose centre is the pivot of the arm."));
  v.object("wheel_radius_from", p.wheel_radius_from,
           {.meaning = "Instead of wheel_radius_mm: radius of an earlier wheel of mode envelope, "
                       "with its uncertainty."});
  v.number("pin_radius_mm", p.pin_radius_mm,
           radius("Radius of the pin or shaft; the second-order correction needs it."));
}

template <class Visitor>
void describe_recovery(Visitor& v, SpindleTask& p) {
  v.whole("samples", p.samples,
          range(8, 1'000'000,
                "Samples of a revolution, uniform in the angle on the part. More readings are "
                "low-passed to them: all count, none alias."));
  v.whole("highest_order", p.highest_order,
          range(2, 10'000, "Highest undulation number that is recovered; below half the samples."));
  v.number("greatest_gain", p.greatest_gain,
           range(1.0, 1e9, "A harmonic with a higher noise gain is not recovered but listed."));
  v.number("probe_noise_um", p.probe_noise_um,
           range(0.0, 1000.0,
                 "Standard deviation of one reading; left out: from the scatter of revolutions, of "
                 "one from harmonics beyond highest_order."));
  v.number("probe_range_um", p.probe_range_um,
           above(0.0, 100'000.0,
                 "Measuring range of each probe, centred at reading 0. Readings in its outer tenth "
                 "void the feature; uncertainty/quadratic_1 refers to it."));
  v.number(
      "tip_width_mm", p.tip_width_mm,
      above(
          0.0, 100.0,
          "Diameter 2 b of each flat tip or spot: undulations of order k are divided by 2 J1(x)/x, "
          "x = k b / pin_radius_mm; orders with x above 2.5 are void. Left out: a point."));
}

template <class Visitor>
void describe(Visitor& v, SpindleTask& p) {
  describe_probe_angles(v, p);
  describe_swing_arm(v, p);
  describe_recovery(v, p);
  v.text(
      "second_order", p.second_order,
      {.meaning = "Correction for the sideways shift of the profile under a probe; auto: above 10 "
                  "um of motion."});
  v.text("motion", p.motion,
         {.meaning = "as-published: RY by the printed formula, which is wrong; for comparison "
                     "only."});
  v.text("filter", p.filter, {.meaning = "Filter of the profile before its roundness."});
  v.number("cutoff_upr", p.cutoff_upr, range(1.0, 10'000.0, "Cut-off of that filter."));
  v.object("uncertainty", p.uncertainty,
           {.meaning = "Declared influences: standard uncertainty, or value and distribution. "
                       "Without them: no interval."});
}

}  // namespace rondure::record
