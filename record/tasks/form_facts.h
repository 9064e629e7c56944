#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "record/run_record.h"

namespace rondure::record {

/// A set of shapes.
class Shapes {
 public:
  constexpr Shapes(std::initializer_list<Shape> shapes) {
    for (const Shape shape : shapes) bits_ |= bit(shape);
  }
  [[nodiscard]] constexpr bool contains(Shape shape) const { return (bits_ & bit(shape)) != 0; }

 private:
  static constexpr unsigned bit(Shape shape) { return 1U << static_cast<unsigned>(shape); }
  unsigned bits_ = 0;
};

/// The keys that hold the limits of a form.
enum class LimitKind {
  kUpper,   ///< tolerance_um.
  kSize,    ///< lower_um and upper_um, deviations from the nominal diameter.
  kSigned,  ///< lower_um and upper_um, or symmetric_um; tolerance_um limits the amount. Of an angle
            ///< the same keys end in _urad.
  kMask     ///< harmonic_limits.
};
enum class DatumNeed { kNone, kAxis, kAxisOrPlane };

/// What holds for every characteristic of a form.
struct FormFacts {
  Form form = Form::kCylindricity;
  std::string_view symbol;  ///< In reports, e.g. "CYLt".
  /// Shape of the reference that a plan may choose; none: there is nothing to choose.
  std::optional<Shape> about = std::nullopt;
  Shapes shapes = {};           ///< Features that have it.
  std::string_view takes = {};  ///< Keys of Indication that count, of a surface; "a b c".
  LimitKind limits = LimitKind::kUpper;
  DatumNeed datum = DatumNeed::kNone;
};

/// One row for each form, in the order of the enumerators.
inline constexpr auto kFormFacts = std::to_array<FormFacts>(
    {{Form::kCylindricity,
      "CYLt",
      Shape::kCylinder,
      {Shape::kCylinder},
      "reference parameter from_mm to_mm filter cutoff_upr cutoff_mm outliers"},
     {Form::kRoundness,
      "RONt",
      Shape::kCircle,
      {Shape::kCylinder, Shape::kCircle, Shape::kSpindle, Shape::kWheel},
      "reference parameter section section_layers from_mm to_mm filter cutoff_upr outliers"},
     {Form::kDiameter,
      "d",
      std::nullopt,
      {Shape::kCylinder, Shape::kCircle, Shape::kSphere},
      "size rank section section_layers requirement from_mm to_mm filter cutoff_upr outliers",
      LimitKind::kSize},
     {Form::kStraightness,
      "STRt",
      std::nullopt,
      {Shape::kCylinder, Shape::kCone},
      "of reference parameter from_mm to_mm filter cutoff_upr cutoff_mm outliers"},
     {Form::kGeneratrixParallelism,
      "GPRt",
      std::nullopt,
      {Shape::kCylinder},
      "from_mm to_mm filter cutoff_mm outliers"},
     {Form::kTaper,
      "CYLtt",
      std::nullopt,
      {Shape::kCylinder},
      "from_mm to_mm filter cutoff_mm outliers"},
     {Form::kFlatness, "FLTt", std::nullopt, {Shape::kPlane}, "reference parameter outliers"},
     {Form::kCoaxiality,
      "COAX",
      std::nullopt,
      {Shape::kCylinder},
      "datum association filter cutoff_upr outliers",
      LimitKind::kUpper,
      DatumNeed::kAxis},
     {Form::kConcentricity,
      "CONC",
      std::nullopt,
      {Shape::kCylinder, Shape::kCircle},
      "section section_layers datum association filter cutoff_upr outliers",
      LimitKind::kUpper,
      DatumNeed::kAxis},
     {Form::kParallelism,
      "PAR",
      std::nullopt,
      {Shape::kCylinder, Shape::kPlane},
      "datum association filter cutoff_upr outliers",
      LimitKind::kUpper,
      DatumNeed::kAxisOrPlane},
     {Form::kPerpendicularity,
      "PER",
      std::nullopt,
      {Shape::kCylinder, Shape::kPlane},
      "datum association filter cutoff_upr outliers",
      LimitKind::kUpper,
      DatumNeed::kAxisOrPlane},
     {Form::kAngularity,
      "ANG",
      std::nullopt,
      {Shape::kCylinder, Shape::kPlane},
      "angle_deg datum association filter cutoff_upr outliers",
      LimitKind::kUpper,
      DatumNeed::kAxisOrPlane},
     {Form::kTotalRunOut,
      "Total run-out",
      std::nullopt,
      {Shape::kCylinder, Shape::kPlane},
      "direction datum association filter cutoff_upr cutoff_mm outliers",
      LimitKind::kUpper,
      DatumNeed::kAxis},
     {Form::kRoundnessRms, "RONq", std::nullopt, {Shape::kSpindle}},
     {Form::kHarmonicLimits,
      "A(k)",
      std::nullopt,
      {Shape::kCylinder, Shape::kCircle, Shape::kSpindle, Shape::kContour},
      "",
      LimitKind::kMask},
     {Form::kMotionTotal, "EM total", std::nullopt, {Shape::kSpindle}},
     {Form::kMotionSynchronous, "EM sync", std::nullopt, {Shape::kSpindle}},
     {Form::kMotionAsynchronous, "EM async", std::nullopt, {Shape::kSpindle}},
     {Form::kRadius, "dR", std::nullopt, {Shape::kWheel}, "", LimitKind::kSigned},
     {Form::kRunOut,
      "Run-out",
      std::nullopt,
      {Shape::kCylinder, Shape::kCircle, Shape::kPlane, Shape::kCone, Shape::kWheel},
      "direction radius_mm datum association filter cutoff_upr outliers",
      LimitKind::kUpper,
      DatumNeed::kAxis},
     {Form::kContourDeviation, "Contour", std::nullopt, {Shape::kContour}},
     {Form::kContourSpread, "Spread", std::nullopt, {Shape::kContour}},
     {Form::kFollowingDeviation, "Following", std::nullopt, {Shape::kContour}},
     {Form::kFixtureResidual, "Left max", std::nullopt, {Shape::kRotaryAxes}},
     {Form::kFixtureResidualRms, "Left rms", std::nullopt, {Shape::kRotaryAxes}},
     {Form::kAxisError,
      "E max",
      std::nullopt,
      {Shape::kRotaryAxes, Shape::kFiveAxis},
      "axis error",
      LimitKind::kSigned},
     {Form::kLeftRms, "Left rms", std::nullopt, {Shape::kFiveAxis}},
     {Form::kLeftLargest, "Left max", std::nullopt, {Shape::kFiveAxis}},
     {Form::kLocation, "Location", std::nullopt, {Shape::kFiveAxis}, "error", LimitKind::kSigned}});

[[nodiscard]] constexpr const FormFacts& facts_of(Form form) {
  return kFormFacts[static_cast<std::size_t>(form)];
}

/// Whether a key of Indication, or `reference`, counts in a form of a surface.
[[nodiscard]] constexpr bool takes(Form form, std::string_view key) {
  std::string_view rest = facts_of(form).takes;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ') < rest.size() ? rest.find(' ') : rest.size();
    if (rest.substr(0, end) == key) return true;
    rest.remove_prefix(end < rest.size() ? end + 1 : end);
  }
  return false;
}

/// How a characteristic is limited: a range or a standard deviation of sizes is no size and has one
/// limit, as a form deviation.
[[nodiscard]] constexpr LimitKind limits_of(Form form,
                                            const std::optional<Indication::Rank>& rank) {
  const bool spread =
      form == Form::kDiameter && (rank == Indication::Rank::kSR || rank == Indication::Rank::kSQ);
  return spread ? LimitKind::kUpper : facts_of(form).limits;
}

/// Whether value and limits of a characteristic are angles.
[[nodiscard]] constexpr bool is_angle(Form form, const Indication& indication) {
  return (form == Form::kAxisError || form == Form::kLocation) && indication.error &&
         is_angle(*indication.error);
}

/// Whether each form has its row and its word.
[[nodiscard]] constexpr bool form_facts_are_complete() {
  for (const auto& word : words_of(Form{})) {
    const auto index = static_cast<std::size_t>(word.value);
    if (index >= kFormFacts.size() || kFormFacts[index].form != word.value) return false;
  }
  return words_of(Form{}).size() == kFormFacts.size();
}
static_assert(form_facts_are_complete());

}  // namespace rondure::record
