#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/run_record.h"
#include "record/tasks/key_spec.h"

namespace rondure::record {

/// One line of a harmonic mask.
struct HarmonicLimitTask {
  int from = 2;
  int to = 50;
  double amplitude_um = 0.0;
};

/// What a drawing asks of a feature, as a plan spells it. A member initialiser is the default of
/// its key.
struct CharacteristicTask {
  std::string id;
  Form form = Form::kCylindricity;
  std::optional<Reference> reference;
  std::optional<double> tolerance_um;
  std::string drawing_zone;
  std::vector<HarmonicLimitTask> harmonic_limits = {};  ///< For the form "harmonic-limits".
  std::optional<double> lower_um = {};  ///< Of a diameter: deviation from nominal.
  std::optional<double> upper_um = {};
  Indication indication = {};
};

template <class Visitor>
void describe(Visitor& v, HarmonicLimitTask& p) {
  const auto order = [](std::string_view meaning) { return required(range(2, 10'000, meaning)); };
  v.whole("from", p.from, order("First undulation number of this line of the mask."));
  v.whole("to", p.to, order("Last undulation number."));
  v.number(
      "amplitude_um", p.amplitude_um,
      required(above(0.0, 1000.0, "Largest amplitude (half of peak to valley) of each of them.")));
}

template <class Visitor>
void describe(Visitor& v, CharacteristicTask& p) {
  v.text("id", p.id,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name in the report, unique within the feature."});
  v.text("form", p.form,
         {.required = true,
          .meaning =
              "cylindricity (CYLt) of a cylinder; roundness (RONt) of a circle, of the worst "
              "layer of a cylinder or of a spindle feature; harmonic-limits, a mask on the "
              "amplitudes of every layer of at least 350 points. Of a spindle feature also: "
              "roundness-rms (RONq); harmonic-limits; motion-total, motion-synchronous, "
              "motion-asynchronous (values of ISO 230-7, the greater of X and Y). Of a wheel: "
              "roundness of its edge; radius, the departure from nominal; run-out. Of a contour "
              "feature: contour-deviation (peak to valley, the greatest of all parts); "
              "contour-spread (standard deviation from part to part); harmonic-limits. Of "
              "rotary_axes: fixture-residual, the largest distance of a ball from where the "
              "calibration has it, and fixture-residual-rms."});
  v.text("reference", p.reference,
         {.meaning = "Associated feature: mz, minimum zone (the ISO default); ls, least squares; "
                     "mc, minimum circumscribed (a ring gauge on a shaft); mi, maximum inscribed "
                     "(a plug gauge in a bore). Needed with a tolerance."});
  v.number("tolerance_um", p.tolerance_um,
           above(0.0, 10'000.0,
                 "Upper limit on the drawing; without it the value is reported, not judged."));
  v.text("drawing_zone", p.drawing_zone,
         {.meaning = "Where it stands on the drawing, e.g. \"C4\"."});
  v.list("harmonic_limits", p.harmonic_limits,
         {.meaning = "The mask of harmonic-limits, instead of tolerance_um."});
}

/// The characteristic that a journal keeps.
[[nodiscard]] Characteristic characteristic_of(const CharacteristicTask& task);

}  // namespace rondure::record
