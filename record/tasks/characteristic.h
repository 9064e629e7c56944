#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/decision_rule.h"
#include "record/indication.h"
#include "record/key_spec.h"
#include "record/run_record.h"

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
  /// Of a diameter or of the radius of a wheel: deviation from nominal.
  std::optional<double> lower_um = {};
  std::optional<double> upper_um = {};
  std::optional<double> symmetric_um = {};  ///< Both limits of a signed value: -T and +T.
  /// The same limits of an angle.
  std::optional<double> tolerance_urad = {};
  std::optional<double> lower_urad = {};
  std::optional<double> upper_urad = {};
  std::optional<double> symmetric_urad = {};
  Indication indication = {};
};

/// Keys of the characteristics of a feature, or of all features, that do not give them.
struct DefaultsTask : IndicationDefaults {
  std::optional<Reference> reference;
};

/// A level above the characteristic from which it takes what it does not say itself.
struct CharacteristicLevel {
  DefaultsTask defaults;
  std::optional<DecisionRuleTask> decision_rule;  ///< Taken as a whole.
};

template <class Visitor, class Keys>
void describe_reference(Visitor& v, Keys& p) {
  v.text("reference", p.reference,
         {.meaning = "Associated feature: mz, minimum zone (the default, by ISO); ls, least "
                     "squares; mc, minimum circumscribed (ring gauge on a shaft); mi, maximum "
                     "inscribed (plug gauge in a bore)."});
}

template <class Visitor>
void describe(Visitor& v, DefaultsTask& p) {
  describe_reference(v, p);
  describe_operations(v, p);
}

template <class Visitor>
void describe(Visitor& v, HarmonicLimitTask& p) {
  const auto order = [](std::string_view meaning) { return required(range(2, 10'000, meaning)); };
  v.whole("from", p.from, order("First undulation number of this line of the mask."));
  v.whole("to", p.to, order("Last undulation number."));
  v.number("amplitude_um", p.amplitude_um,
           required(above(0.0, 1000.0, "Largest amplitude (half of peak to valley) of each.")));
}

template <class Visitor>
void describe(Visitor& v, CharacteristicTask& p) {
  v.text("id", p.id,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name in the report, unique within the feature."});
  v.text("form", p.form,
         {.required = true,
          .meaning = "What is judged; docs/drawing.md lists the forms of each type."});
  describe_reference(v, p);
  v.number("tolerance_um", p.tolerance_um,
           above(0.0, 10'000.0,
                 "Upper limit of everything but a diameter (of that with rank SR or SQ). Without a "
                 "limit the value is reported, not judged."));
  const NumberSpec deviation =
      within(10'000.0,
             "Limits of a diameter, either or both, as deviations from nominal.diameter_mm: -13 "
             "and 0 for 30 h6. Of the radius of a wheel, both: signed limits of R - "
             "nominal_radius_mm; likewise of an axis-error.");
  v.number("lower_um", p.lower_um, deviation);
  v.number("upper_um", p.upper_um, deviation);
  v.number("symmetric_um", p.symmetric_um,
           above(0.0, 10'000.0,
                 "Of the radius of a wheel or an axis-error, instead: plus and minus this value."));
  v.number(
      "tolerance_urad", p.tolerance_urad,
      above(0.0, 100'000.0, "Of an axis-error EA, EB or EC: limit of the amount of the angle."));
  const NumberSpec angle =
      within(100'000.0, "Of an axis-error EA, EB or EC: signed limits of the angle, both.");
  v.number("lower_urad", p.lower_urad, angle);
  v.number("upper_urad", p.upper_urad, angle);
  v.number(
      "symmetric_urad", p.symmetric_urad,
      above(0.0, 100'000.0, "Of an axis-error EA, EB or EC, instead: plus and minus this value."));
  v.text("drawing_zone", p.drawing_zone, {.meaning = "Place on the drawing, e.g. \"C4\"."});
  v.list("harmonic_limits", p.harmonic_limits,
         {.meaning = "The mask of harmonic-limits, instead of tolerance_um."});
  describe(v, p.indication);
}

/// The characteristic that a journal keeps: limits in mm, those of a size absolute, those of an
/// angle in mrad (core::ValueUnit), and what the levels above say where it says nothing. A filter
/// comes with the cut-offs of its level and of those below it. What the form does not take is left
/// out.
/// @param levels  The nearest first: feature, plan.
[[nodiscard]] Characteristic characteristic_of(const CharacteristicTask& task,
                                               double nominal_diameter_mm = 0.0,
                                               std::span<const CharacteristicLevel> levels = {});

}  // namespace rondure::record
