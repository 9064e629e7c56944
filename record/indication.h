#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/decision_rule.h"
#include "record/key_spec.h"
#include "record/words.h"

namespace rondure::record {

/// What a drawing indicates of a characteristic beside its form, its reference and its limits, as
/// plan and journal spell it. A plan may leave out the optional keys; see with_defaults().
struct Indication {
  /// Peak to valley, peak, valley, root mean square (ISO 12180-1, 12181-1): t, p, v, q.
  enum class Parameter { kTotal, kPeak, kValley, kRms };
  /// ISO 14405-1. kLS is the spherical size, which no plan can have; it is a word so that the
  /// refusal can say why.
  enum class Size { kLP, kGG, kGX, kGN, kGC, kCC, kCA, kCV, kLS };
  /// Rank-order (2016) or statistical (2025) size. kSD is the mid-range, kSQ the standard
  /// deviation.
  enum class Rank { kSX, kSN, kSA, kSM, kSD, kSR, kSQ };
  enum class Section { kAll, kACS, kSCS };  ///< Whole feature, any section, named sections.
  enum class Requirement { kNone, kEnvelope };
  enum class Of { kGeneratrix, kMedianLine };
  enum class Direction { kRadial, kAxial, kConical };
  /// Of a datum (ISO 5459).
  enum class Association { kOneSided, kEqualised, kLs, kZone };
  enum class Filter { kNone, kGaussian, kRobustGaussian, kSpline };
  enum class Outliers { kNone, kFiveScales };
  enum class Axis { kAlpha, kBeta, kC, kA };  ///< Of a fixture; of a head.
  /// Of a rotary axis: the shifts EX, EY, EZ, then the tilts EA, EB, EC. Then the location errors
  /// of a head (ISO 230-7).
  enum class AxisError { kX, kY, kZ, kA, kB, kC, kXOC, kYOC, kAOC, kBOC, kYOA, kZOA, kBOA, kCOA };

  Parameter parameter = Parameter::kTotal;
  Size size = Size::kLP;
  std::optional<Rank> rank;  ///< None with kLP: the greatest and the least, each at its limit.
  Section section = Section::kAll;
  std::vector<double> section_layers;  ///< From 1, the lowest first; for kSCS.
  Requirement requirement = Requirement::kNone;
  Of of = Of::kGeneratrix;
  Direction direction = Direction::kRadial;
  std::optional<double> radius_mm;  ///< Of the circle of an axial run-out; none: every circle.
  std::optional<double> angle_deg;  ///< Nominal, of an angularity.
  std::optional<double> from_mm;    ///< Restricted portion, part z; none: to the end.
  std::optional<double> to_mm;
  std::optional<Axis> axis;  ///< Of an axis-error.
  std::optional<AxisError> error;
  std::vector<std::string> datum;  ///< "A-B", "C": letters or ids of features.
  // The following keys have defaults of the feature and of the plan.
  std::optional<Association> association;
  std::optional<Filter> filter;
  std::optional<double> cutoff_upr;
  std::optional<double> cutoff_mm;
  std::optional<Outliers> outliers;
  std::optional<DecisionRuleTask> decision_rule;
};

RONDURE_WORDS(Indication::Parameter, {kTotal, "total"}, {kPeak, "peak"}, {kValley, "valley"},
              {kRms, "rms"});
RONDURE_WORDS(Indication::Size, {kLP, "LP"}, {kGG, "GG"}, {kGX, "GX"}, {kGN, "GN"}, {kGC, "GC"},
              {kCC, "CC"}, {kCA, "CA"}, {kCV, "CV"}, {kLS, "LS"});
RONDURE_WORDS(Indication::Rank, {kSX, "SX"}, {kSN, "SN"}, {kSA, "SA"}, {kSM, "SM"}, {kSD, "SD"},
              {kSR, "SR"}, {kSQ, "SQ"});
RONDURE_WORDS(Indication::Section, {kAll, "all"}, {kACS, "ACS"}, {kSCS, "SCS"});
RONDURE_WORDS(Indication::Requirement, {kNone, "none"}, {kEnvelope, "envelope"});
RONDURE_WORDS(Indication::Of, {kGeneratrix, "generatrix"}, {kMedianLine, "median-line"});
RONDURE_WORDS(Indication::Direction, {kRadial, "radial"}, {kAxial, "axial"}, {kConical, "conical"});
RONDURE_WORDS(Indication::Association, {kOneSided, "one-sided"}, {kEqualised, "equalised"},
              {kLs, "ls"}, {kZone, "zone"});
RONDURE_WORDS(Indication::Filter, {kNone, "none"}, {kGaussian, "gaussian"},
              {kRobustGaussian, "robust-gaussian"}, {kSpline, "spline"});
RONDURE_WORDS(Indication::Axis, {kAlpha, "alpha"}, {kBeta, "beta"}, {kC, "c"}, {kA, "a"});
RONDURE_WORDS(Indication::AxisError, {kX, "EX"}, {kY, "EY"}, {kZ, "EZ"}, {kA, "EA"}, {kB, "EB"},
              {kC, "EC"}, {kXOC, "XOC"}, {kYOC, "YOC"}, {kAOC, "AOC"}, {kBOC, "BOC"}, {kYOA, "YOA"},
              {kZOA, "ZOA"}, {kBOA, "BOA"}, {kCOA, "COA"});
[[nodiscard]] constexpr bool is_location(Indication::AxisError error) {
  return error > Indication::AxisError::kC;
}
[[nodiscard]] constexpr bool is_angle(Indication::AxisError error) {
  using E = Indication::AxisError;
  return (error >= E::kA && error <= E::kC) || error == E::kAOC || error == E::kBOC ||
         error == E::kBOA || error == E::kCOA;
}
RONDURE_WORDS(Indication::Outliers, {kNone, "none"}, {kFiveScales, "five-scales"});

/// The keys that have defaults of the feature and of the plan.
template <class Visitor, class Keys>
void describe_operations(Visitor& v, Keys& p) {
  v.text("association", p.association,
         {.meaning = "How a datum is taken from its feature: one-sided, from outside the material "
                     "(the default); equalised, midway between the positions in which it rocks; "
                     "ls, least squares; zone, minimum zone."});
  v.text("filter", p.filter,
         {.meaning = "Filter of the profiles before evaluation; none by default. It needs dense "
                     "sections, as from a scan."});
  v.number("cutoff_upr", p.cutoff_upr,
           above(0.0, 100'000.0,
                 "Cut-off round the section, in undulations per revolution: usually 15, 50, 150, "
                 "500 or 1500."));
  v.number("cutoff_mm", p.cutoff_mm,
           above(0.0, 1000.0,
                 "Cut-off along the axis: usually 0.25, 0.8, 2.5, 8 or 25. Left out: no filter "
                 "along the axis."));
  v.text("outliers", p.outliers,
         {.meaning = "five-scales leaves out points more than five robust scales from the "
                     "least-squares feature, and the report lists them; none by default."});
}

template <class Visitor>
void describe(Visitor& v, Indication& p) {
  v.text("parameter", p.parameter,
         {.meaning = "Of a form deviation: total, peak to valley; peak; valley; rms, root mean "
                     "square. All but total are about the least-squares feature."});
  v.text("size", p.size,
         {.meaning = "Of a diameter (ISO 14405-1): LP, two-point size; GG, least squares; GX, "
                     "maximum inscribed; GN, minimum circumscribed; GC, minimax; CC, CA, CV from "
                     "circumference, area, volume of dense sections. LS (spherical) is refused."});
  v.text("rank", p.rank,
         {.meaning = "Of two-point sizes: SX maximum, SN minimum, SA average, SM median, SD "
                     "mid-range, SR range, SQ standard deviation. Left out: the greatest and the "
                     "least are held against their limits."});
  v.text("section", p.section,
         {.meaning = "all: of the whole feature; ACS: of any section, the worst decides; SCS: of "
                     "the sections of section_layers."});
  v.numbers("section_layers", p.section_layers,
            range(1.0, 1000.0, "Layers of section SCS, from 1, the lowest first."));
  v.text("requirement", p.requirement,
         {.meaning = "envelope: mating size and two-point sizes, one verdict (ISO 14405-1, the "
                     "letter E in a circle)."});
  v.text("of", p.of,
         {.meaning = "Straightness of each generatrix, or of the median line of the sections."});
  v.text("direction", p.direction,
         {.meaning = "Of a run-out: radial; axial, of a face; conical, normal to a cone."});
  v.number("radius_mm", p.radius_mm,
           above(0.0, 10'000.0,
                 "Of an axial run-out: radius of the one circle that counts. Left out: the worst "
                 "circle."));
  v.number("angle_deg", p.angle_deg, range(0.0, 90.0, "Of an angularity: nominal, to the datum."));
  v.number(
      "from_mm", p.from_mm,
      within(10'000.0, "Restricted portion: its lower end, part z. Left out: of the feature."));
  v.number("to_mm", p.to_mm, within(10'000.0, "Restricted portion: its upper end, part z."));
  v.text("axis", p.axis,
         {.meaning = "Of an axis-error: alpha is the base-fixed axis of the fixture, beta the "
                     "carried one; c or a, of a head."});
  v.text("error", p.error,
         {.meaning = "Of an axis-error: EX, EY, EZ, shift along this machine axis; EA, EB, EC, "
                     "tilt about its x, y or z, in urad. Of a location: XOC, YOC, YOA, ZOA, or "
                     "AOC, BOC, BOA, COA in urad."});
  v.texts("datum", p.datum,
          {.empty_allowed = false,
           .meaning = "Datums in order, each the letter or id of a feature, or a common datum, "
                      "e.g. \"A-B\"."});
  describe_operations(v, p);
  v.object(
      "decision_rule", p.decision_rule,
      {.meaning = "Rule of this characteristic; it replaces that of feature or plan as a whole."});
}

/// Defaults of a feature or of a plan for the characteristics that do not give these keys.
struct IndicationDefaults {
  std::optional<Indication::Association> association;
  std::optional<Indication::Filter> filter;
  std::optional<double> cutoff_upr;
  std::optional<double> cutoff_mm;
  std::optional<Indication::Outliers> outliers;
};

}  // namespace rondure::record
