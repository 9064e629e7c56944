#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/key_spec.h"
#include "plans/schema/json_text.h"
#include "record/tasks/form_facts.h"

namespace rondure::plans {
namespace {

using core::Code;
using record::Form;
using record::Indication;
using record::LimitKind;
using record::Shape;

/// A characteristic and where it stands.
struct Asked {
  const Plan& plan;
  std::size_t feature_index;
  const record::CharacteristicTask& task;
  record::Characteristic resolved;  ///< With the defaults of feature and plan.
  std::string where;
  Findings& findings;

  [[nodiscard]] const FeaturePlan& feature() const { return plan.features[feature_index]; }
  [[nodiscard]] bool given(std::string_view key) const {
    return findings.is_given(member_pointer(where, key));
  }
  void refuse(std::string_view key, std::string what, Code code = Code::kMeaning) const {
    findings.meaning(code, member_pointer(where, key), std::move(what));
  }
  /// Refuses a key of the characteristic itself that would change nothing.
  void refuse_idle(std::string_view key, std::string_view why) const {
    if (given(key)) refuse(key, fmt::format("has no effect: {}; remove it", why));
  }
};

/// Visitor of a task: its keys.
struct KeyNames {
  std::vector<std::string_view> keys;

  template <class Value>
  void text(std::string_view key, const Value&, const TextSpec&) {
    keys.push_back(key);
  }
  template <class Value>
  void texts(std::string_view key, const Value&, const TextSpec&) {
    keys.push_back(key);
  }
  template <class Value>
  void number(std::string_view key, const Value&, const NumberSpec&) {
    keys.push_back(key);
  }
  template <class Value>
  void numbers(std::string_view key, const Value&, const NumberSpec&) {
    keys.push_back(key);
  }
  template <class Value>
  void object(std::string_view, const Value&, const GroupSpec&) {}  // a rule has always an effect
};

/// "a roundness", "an angularity".
std::string with_article(std::string_view word) {
  const bool vowel = std::string_view("aeiou").find(word.front()) != std::string_view::npos;
  return fmt::format("{} {}", vowel ? "an" : "a", word);
}

// Checks the lines of a mask, and that it has an effect.
void check_mask(const Asked& asked) {
  const record::CharacteristicTask& c = asked.task;
  const bool masked = c.form == Form::kHarmonicLimits;
  if (masked && c.harmonic_limits.empty() && !asked.given("harmonic_limits")) {
    asked.refuse("harmonic_limits",
                 "this key is missing: the mask, e.g. [{\"from\": 2, \"to\": 50, "
                 "\"amplitude_um\": 0.3}]",
                 Code::kMissingKey);
  }
  if (!masked && !c.harmonic_limits.empty()) {
    asked.refuse("harmonic_limits",
                 "has no effect: the form is not \"harmonic-limits\"; remove it");
  }
  for (std::size_t i = 0; i < c.harmonic_limits.size(); ++i) {
    const record::HarmonicLimitTask& line = c.harmonic_limits[i];
    if (line.from <= line.to) continue;
    asked.findings.meaning(
        Code::kMeaning, item_pointer(asked.where + "/harmonic_limits", i),
        fmt::format("from {} is above to {}; exchange them", line.from, line.to));
  }
}

/// Checks that a surface has the form that is asked for.
bool check_form(const Asked& asked) {
  const Shape shape = asked.feature().type;
  const Form form = asked.task.form;
  if (record::facts_of(form).shapes.contains(shape)) return true;
  if (form == Form::kCylindricity && shape == Shape::kCircle) {
    asked.refuse("form",
                 "a circle has no cylindricity; ask for \"roundness\", or make the feature a "
                 "\"cylinder\" with at least 2 layers");
    return false;
  }
  std::string others;
  for (const record::FormFacts& facts : record::kFormFacts) {
    if (!facts.shapes.contains(shape)) continue;
    others += fmt::format("{}\"{}\"", others.empty() ? "" : ", ", name_of(facts.form));
  }
  asked.refuse("form", fmt::format("a {} has no {}; ask for one of {}", name_of(shape),
                                   name_of(form), others));
  return false;
}

/// Checks for keys of the characteristic that its form, or another of its keys, passes over.
void check_idle_keys(const Asked& asked) {
  const Form form = asked.task.form;
  const Indication& i = asked.task.indication;
  KeyNames names;
  Indication all;
  describe(names, all);
  names.keys.push_back("reference");
  for (const std::string_view key : names.keys) {
    if (record::takes(form, key)) continue;
    asked.refuse_idle(key, fmt::format("{} has no {}", with_article(name_of(form)), key));
  }
  if (i.section != Indication::Section::kSCS && record::takes(form, "section_layers")) {
    asked.refuse_idle("section_layers", "the section is not \"SCS\"");
  }
  if (i.direction != Indication::Direction::kAxial && record::takes(form, "radius_mm")) {
    asked.refuse_idle("radius_mm", "the direction is not \"axial\"");
  }
  const bool straight = form == Form::kStraightness;
  const bool median = i.of == Indication::Of::kMedianLine;
  if (straight && median) {
    asked.refuse_idle("reference", "the median line lies in the least cylinder round it");
    asked.refuse_idle("parameter", "the median line lies in the least cylinder round it");
    asked.refuse_idle("cutoff_mm", "the median line is made of sections");
  } else if (straight) {
    asked.refuse_idle("cutoff_upr", "a generatrix has its cut-off along the axis, cutoff_mm");
  }
  const bool filtered = asked.resolved.indication.filter.value_or(Indication::Filter::kNone) !=
                        Indication::Filter::kNone;
  if (filtered) return;
  for (const std::string_view key : {"cutoff_upr", "cutoff_mm"}) {
    const bool refused = straight && key == (median ? "cutoff_mm" : "cutoff_upr");
    if (record::takes(form, key) && !refused) {
      asked.refuse_idle(key, "there is no filter here, in the feature or in the plan");
    }
  }
}

/// Checks the limits of a size.
void check_size_limits(const Asked& asked) {
  const record::CharacteristicTask& c = asked.task;
  const std::string diameter = feature_pointer(asked.feature_index) + "/nominal/diameter_mm";
  if (c.tolerance_um) {
    asked.refuse("tolerance_um",
                 "a diameter has lower_um and upper_um, deviations from nominal; give these");
  }
  if (c.lower_um && c.upper_um && *c.lower_um > *c.upper_um) {
    asked.refuse("lower_um", fmt::format("lower_um {} is above upper_um {}; exchange them",
                                         plain(*c.lower_um), plain(*c.upper_um)));
  }
  if ((c.lower_um || c.upper_um) && !asked.findings.is_given(diameter)) {
    asked.refuse(c.lower_um ? "lower_um" : "upper_um",
                 "the limits of a diameter are deviations from nominal.diameter_mm, which this "
                 "feature does not give; add it",
                 Code::kMissingKey);
  }
  if (c.indication.requirement == Indication::Requirement::kEnvelope &&
      !(c.lower_um && c.upper_um)) {
    asked.refuse("requirement",
                 "the envelope requirement needs both limits of size; give lower_um and upper_um");
  }
}

/// The limits of a characteristic, with the keys that hold them: of an angle they end in _urad.
struct SignedLimits {
  std::string tolerance;
  std::string lower;
  std::string upper;
  std::string symmetric;
  std::optional<double> low;
  std::optional<double> high;
};

SignedLimits signed_limits(const record::CharacteristicTask& c) {
  if (record::is_angle(c.form, c.indication)) {
    return {"tolerance_urad", "lower_urad", "upper_urad",
            "symmetric_urad", c.lower_urad, c.upper_urad};
  }
  return {"tolerance_um", "lower_um", "upper_um", "symmetric_um", c.lower_um, c.upper_um};
}

/// Checks the limits of a value that has a sign.
void check_signed_limits(const Asked& asked) {
  const record::CharacteristicTask& c = asked.task;
  const SignedLimits keys = signed_limits(c);
  const bool lower = asked.given(keys.lower);
  const bool upper = asked.given(keys.upper);
  if (asked.given(keys.tolerance)) {
    for (const std::string& key : {keys.lower, keys.upper, keys.symmetric}) {
      if (!asked.given(key)) continue;
      asked.refuse(key, fmt::format("{} limits the amount already, without its sign; remove one",
                                    keys.tolerance));
    }
  } else if (asked.given(keys.symmetric)) {
    for (const std::string& key : {keys.lower, keys.upper}) {
      if (!asked.given(key)) continue;
      asked.refuse(key, fmt::format("{} holds both limits; remove one", keys.symmetric));
    }
  } else if (lower != upper) {
    asked.refuse(
        lower ? keys.lower : keys.upper,
        fmt::format("one limit leaves the other side open; add {}, or give {} in its place",
                    lower ? keys.upper : keys.lower, keys.symmetric));
  } else if (keys.low && keys.high && *keys.low >= *keys.high) {
    asked.refuse(keys.lower, fmt::format("{} {} is not below {} {}; exchange them", keys.lower,
                                         plain(*keys.low), keys.upper, plain(*keys.high)));
  }
  const auto& rule = asked.resolved.indication.decision_rule;
  const bool prior = rule ? rule->prior.has_value() : asked.plan.decision_rule.prior.has_value();
  if (prior && asked.resolved.lower_mm) {
    asked.refuse("form", fmt::format("the prior describes form deviations; give this {} a "
                                     "decision_rule of its own without it",
                                     name_of(c.form)));
  }
}

/// Refuses limits in um of an angle, and in urad of a length.
void check_unit_of_limits(const Asked& asked) {
  const Form form = asked.task.form;
  const Indication& i = asked.task.indication;
  const bool named = record::takes(form, "error");
  if (named && !i.error) return;  // which unit it has is not known
  const bool angle = record::is_angle(form, i);
  const std::string what =
      named ? std::string(record::name_of(*i.error)) : with_article(name_of(form));
  for (const std::string_view key : {"tolerance", "lower", "upper", "symmetric"}) {
    const std::string wrong = fmt::format("{}_{}", key, angle ? "um" : "urad");
    if (!asked.given(wrong)) continue;
    asked.refuse(wrong, angle
                            ? fmt::format("{} is an angle; give {}_urad", what, key)
                            : fmt::format("{} is a length, no angle; give its limits in um", what));
  }
}

void check_limits_of(const Asked& asked) {
  const Form form = asked.task.form;
  const LimitKind kind = record::limits_of(form, asked.task.indication.rank);
  check_unit_of_limits(asked);
  if (kind == LimitKind::kSigned) return check_signed_limits(asked);
  if (asked.given("symmetric_um")) {
    asked.refuse(
        "symmetric_um",
        kind == LimitKind::kMask
            ? std::string("has no effect: the mask holds the limits; remove it")
            : fmt::format("{} has no sign; give {}", with_article(name_of(form)),
                          kind == LimitKind::kSize ? "lower_um and upper_um" : "tolerance_um"));
  }
  if (kind == LimitKind::kSize) return check_size_limits(asked);
  for (const std::string_view key : {"lower_um", "upper_um"}) {
    if (kind == LimitKind::kMask) {
      asked.refuse_idle(key, "the mask holds the limits");
    } else if (asked.given(key)) {
      asked.refuse(
          key, form == Form::kDiameter
                   ? std::string("a spread of sizes has one limit: tolerance_um")
                   : fmt::format("{} has one limit: tolerance_um", with_article(name_of(form))));
    }
  }
  if (kind == LimitKind::kMask) asked.refuse_idle("tolerance_um", "the mask holds the limits");
}

/// Checks operator and section of a diameter.
void check_size(const Asked& asked) {
  using Size = Indication::Size;
  const Indication& i = asked.task.indication;
  const Shape shape = asked.feature().type;
  const std::string source = feature_pointer(asked.feature_index) + "/source";
  if (asked.feature().source && asked.findings.sound(source) &&
      asked.feature().source->points == record::PointsAre::kTipCentres &&
      !asked.feature().source->tip_diameter_mm) {
    asked.refuse("form",
                 "a size needs the tip that took the points; add source.tip_diameter_mm, or state "
                 "\"points\": \"surface\"",
                 Code::kMissingKey);
  }
  if (i.size == Size::kLS) {
    return asked.refuse("size",
                        "spherical size needs an areal cloud, points all round each centre; ask "
                        "for size \"LP\" or \"GX\"");
  }
  if (shape == Shape::kSphere &&
      (i.size == Size::kLP || i.size == Size::kCC || i.size == Size::kCA || i.size == Size::kCV)) {
    asked.refuse("size", fmt::format("a sphere has no size {}; ask for \"GG\", \"GX\", \"GN\" or "
                                     "\"GC\"",
                                     name_of(i.size)));
  }
  if (i.size == Size::kCV && (shape == Shape::kCircle || i.section != Indication::Section::kAll)) {
    asked.refuse("size",
                 "the size CV is of the volume of a whole cylinder; ask for \"CA\", the size of "
                 "the area of a section");
  }
  const bool envelope = i.requirement == Indication::Requirement::kEnvelope;
  if (i.rank && i.size != Size::kLP && !envelope) {
    asked.refuse("rank", fmt::format("has no effect: {} is one size, ranks are of many; remove "
                                     "it, or ask for size \"LP\"",
                                     name_of(i.size)));
  }
  if (envelope) {
    if (shape != Shape::kCylinder) {
      asked.refuse("requirement",
                   "the envelope requirement is that of a cylinder; make the feature one, with "
                   "at least 2 layers");
    }
    if (i.size != Size::kLP) {
      asked.refuse("size",
                   "the envelope requirement has its own sizes, the mating size and LP; remove "
                   "this key");
    }
    asked.refuse_idle("rank", "the envelope requirement has its own sizes");
    asked.refuse_idle("section", "the envelope requirement is that of the whole feature");
  }
  if (i.size == Size::kCC && asked.resolved.indication.filter == Indication::Filter::kNone) {
    asked.refuse("size",
                 "the circumference grows with every wave that is let in; give filter and "
                 "cutoff_upr");
  }
}

void check_section(const Asked& asked) {
  const Indication& i = asked.task.indication;
  if (i.section == Indication::Section::kSCS && i.section_layers.empty()) {
    asked.refuse("section_layers",
                 "this key is missing: \"SCS\" names its sections, e.g. [1, 3], the lowest is 1",
                 Code::kMissingKey);
  }
  for (std::size_t k = 0; k < i.section_layers.size(); ++k) {
    const double layer = i.section_layers[k];
    const std::string where = item_pointer(asked.where + "/section_layers", k);
    if (layer != static_cast<double>(static_cast<int>(layer))) {
      asked.findings.meaning(Code::kMeaning, where,
                             fmt::format("{} is no layer; give whole numbers", plain(layer)));
    } else if (is_touched(asked.feature()) && layer > asked.feature().sampling.layers) {
      asked.findings.meaning(Code::kMeaning, where,
                             fmt::format("layer {} is none of the {} layers of this feature",
                                         plain(layer), asked.feature().sampling.layers));
    }
  }
  if (asked.task.form == Form::kConcentricity && asked.feature().type == Shape::kCylinder &&
      i.section == Indication::Section::kAll) {
    asked.refuse("section",
                 "concentricity is that of sections; name them by section \"SCS\" and "
                 "section_layers, or ask for \"coaxiality\"");
  }
}

void check_portion(const Asked& asked) {
  const Indication& i = asked.task.indication;
  if (i.from_mm && i.to_mm && *i.from_mm >= *i.to_mm) {
    asked.refuse("from_mm", fmt::format("from_mm {} is not below to_mm {}; exchange or correct "
                                        "them",
                                        plain(*i.from_mm), plain(*i.to_mm)));
  }
}

/// Checks that the form has the association. Where nothing is said it is the ISO default, mz.
void check_reference(const Asked& asked) {
  const record::CharacteristicTask& c = asked.task;
  const Form form = c.form;
  using record::Reference;
  const bool median = form == Form::kStraightness && c.indication.of == Indication::Of::kMedianLine;
  if (!record::takes(form, "reference") || median) return;
  const bool total = c.indication.parameter == Indication::Parameter::kTotal;
  if (!total && c.reference && *c.reference != Reference::kLeastSquares) {
    return asked.refuse("reference",
                        "peak, valley and rms are defined about the least-squares reference; give "
                        "\"ls\"");
  }
  const bool line_or_plane = !record::facts_of(form).about;
  if (line_or_plane && (c.reference == Reference::kMinimumCircumscribed ||
                        c.reference == Reference::kMaximumInscribed)) {
    return asked.refuse(
        "reference", fmt::format("{} is about \"mz\" or \"ls\"; give one of them", name_of(form)));
  }
}

/// Checks the direction of a run-out against the surface.
void check_direction(const Asked& asked) {
  using Direction = Indication::Direction;
  const Shape shape = asked.feature().type;
  const Direction direction = asked.task.indication.direction;
  if (!record::takes(asked.task.form, "direction")) return;
  const std::string_view form = name_of(asked.task.form);
  if (direction == Direction::kAxial && shape != Shape::kPlane) {
    asked.refuse("direction", fmt::format("axial {} is that of a face; of a {} ask for \"radial\"",
                                          form, name_of(shape)));
  } else if (direction == Direction::kConical &&
             (shape != Shape::kCone || asked.task.form == Form::kTotalRunOut)) {
    asked.refuse("direction",
                 fmt::format("conical run-out is that of a cone; of a {} ask for "
                             "\"{}\"",
                             name_of(shape), shape == Shape::kPlane ? "axial" : "radial"));
  } else if (direction == Direction::kRadial && shape == Shape::kPlane) {
    asked.refuse("direction",
                 fmt::format("radial {} is that of a cylinder; of a face ask for \"axial\"", form));
  }
}

/// Checks that a filter has the cut-offs that the form needs.
void check_filter(const Asked& asked) {
  const Indication& i = asked.resolved.indication;
  const Form form = asked.task.form;
  if (i.filter.value_or(Indication::Filter::kNone) == Indication::Filter::kNone) return;
  const bool plane = asked.feature().type == Shape::kPlane;
  if (plane) {
    return asked.refuse("filter",
                        "a face is evaluated unfiltered so far; give \"filter\": \"none\"");
  }
  const bool along = !record::takes(form, "cutoff_upr") ||
                     (form == Form::kStraightness && i.of == Indication::Of::kGeneratrix);
  if (along && !i.cutoff_mm) {
    asked.refuse("cutoff_mm",
                 "this key is missing: the filter has no cut-off along the axis; give cutoff_mm, "
                 "e.g. 0.8, or \"filter\": \"none\"",
                 Code::kMissingKey);
  } else if (!along && !i.cutoff_upr) {
    asked.refuse("cutoff_upr",
                 "this key is missing: the filter has no cut-off; give cutoff_upr, e.g. 50",
                 Code::kMissingKey);
  }
  constexpr double kLeastCutoff_upr = 2.0;
  if (i.cutoff_upr && *i.cutoff_upr < kLeastCutoff_upr && record::takes(form, "cutoff_upr")) {
    asked.refuse("cutoff_upr",
                 fmt::format("a cut-off of {} UPR leaves no form, which begins at 2; give at least "
                             "2, e.g. 50",
                             plain(*i.cutoff_upr)));
  }
}

void check_of_surface(const Asked& asked) {
  if (!check_form(asked)) return;
  check_idle_keys(asked);
  check_limits_of(asked);
  if (asked.task.form == Form::kDiameter) check_size(asked);
  check_section(asked);
  check_portion(asked);
  check_reference(asked);
  check_direction(asked);
  check_filter(asked);
  if (asked.task.form == Form::kAngularity && !asked.task.indication.angle_deg) {
    asked.refuse("angle_deg",
                 "this key is missing: an angularity needs its nominal angle to the datum",
                 Code::kMissingKey);
  }
  const std::string feature = feature_pointer(asked.feature_index);
  const auto& rule = asked.resolved.indication.decision_rule;
  const bool prior = rule ? rule->prior.has_value() : asked.plan.decision_rule.prior.has_value();
  if (prior && asked.resolved.toleranced() && asked.task.form == Form::kDiameter) {
    asked.refuse("form",
                 "the prior describes form deviations; give this diameter a decision_rule of its "
                 "own without it");
  }
  check_datums(asked.plan, asked.feature_index, asked.task, asked.where, asked.findings);
  if (!asked.findings.sound(feature + "/sampling")) return;
  check_sampling_of(asked.feature(), asked.resolved, asked.where, asked.findings);
}

/// Checks axis and error of an axis-error, and the error of a location.
void check_error_keys(const Asked& asked) {
  using Axis = Indication::Axis;
  const Indication& i = asked.task.indication;
  const bool of_head = asked.feature().type == Shape::kFiveAxis;
  const bool location = asked.task.form == Form::kLocation;
  if (!location && asked.task.form != Form::kAxisError) return;
  const char* const axes = of_head ? "c or a" : "alpha or beta";
  const char* const errors =
      location ? "XOC, YOC, AOC, BOC, YOA, ZOA, BOA or COA" : "EX, EY, EZ, EA, EB or EC";
  for (const std::string_view key : {"axis", "error"}) {
    if (asked.given(key) || (location && key == "axis")) continue;
    asked.refuse(key,
                 fmt::format("this key is missing: {} is that of one axis; give {}",
                             with_article(name_of(asked.task.form)), key == "axis" ? axes : errors),
                 Code::kMissingKey);
  }
  if (!location && i.axis && (*i.axis == Axis::kC || *i.axis == Axis::kA) != of_head) {
    asked.refuse("axis", fmt::format("{} is no axis of a {}; give {}", name_of(*i.axis),
                                     name_of(asked.feature().type), axes));
  }
  if (i.error && is_location(*i.error) != location) {
    asked.refuse("error", fmt::format("{} is no {}; give {}", name_of(*i.error),
                                      name_of(asked.task.form), errors));
  }
}

void check_of_analysis(const Asked& asked) {
  KeyNames names;
  Indication all;
  describe(names, all);
  for (const std::string_view key : names.keys) {
    const bool of_error = asked.task.form == Form::kAxisError || asked.task.form == Form::kLocation;
    if (of_error && record::takes(asked.task.form, key)) continue;
    const bool axis_key = key == "axis" || key == "error";
    asked.refuse_idle(
        key, axis_key ? fmt::format("{} has no {}", with_article(name_of(asked.task.form)), key)
                      : std::string("the feature is no surface"));
  }
  if (!record::takes(asked.task.form, "reference")) {
    asked.refuse_idle("reference",
                      fmt::format("{} has no reference", with_article(name_of(asked.task.form))));
  }
  check_error_keys(asked);
  check_limits_of(asked);
}

/// Checks the letter: short, and no other feature has it as letter or id.
void check_letter(const Plan& plan, std::size_t index, Findings& findings) {
  const std::string& letter = plan.features[index].letter;
  const std::string where = feature_pointer(index) + "/letter";
  constexpr std::size_t kLongest = 3;
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  if (letter.empty() || !findings.sound(where)) return;
  if (letter.size() > kLongest || !std::all_of(letter.begin(), letter.end(), is_letter)) {
    return findings.meaning(
        Code::kMeaning, where,
        fmt::format("{} is no datum letter; give 1 to 3 letters, e.g. \"A\"", in_quotes(letter)));
  }
  for (std::size_t k = 0; k < plan.features.size(); ++k) {
    const bool twin = (k < index && plan.features[k].letter == letter) ||
                      (k != index && plan.features[k].id == letter);
    if (!twin) continue;
    return findings.meaning(Code::kMeaning, where,
                            fmt::format("the letter {} names feature {} already; choose another",
                                        in_quotes(letter), k + 1));
  }
}

/// Checks for keys of the nominal that another type has.
void check_nominal_keys(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  struct Owner {
    std::string_view key;
    record::Shapes shapes;
  };
  const record::Shapes round = {Shape::kCylinder, Shape::kCircle, Shape::kCone, Shape::kSphere};
  const std::array<Owner, 8> owners = {{{"diameter_mm", round},
                                        {"from_mm", round},
                                        {"to_mm", round},
                                        {"half_angle_deg", {Shape::kCone}},
                                        {"z_mm", {Shape::kPlane}},
                                        {"faces", {Shape::kPlane}},
                                        {"from_diameter_mm", {Shape::kPlane}},
                                        {"to_diameter_mm", {Shape::kPlane}}}};
  for (const Owner& owner : owners) {
    const std::string place = fmt::format("{}/nominal/{}", where, owner.key);
    if (owner.shapes.contains(feature.type) || !findings.is_given(place)) continue;
    findings.meaning(
        Code::kMeaning, place,
        fmt::format("has no effect: a {} has no {}; remove it", name_of(feature.type), owner.key));
  }
  const std::string center = where + "/nominal/center_mm";
  if (feature.type != Shape::kSphere && findings.is_given(center)) {
    findings.meaning(
        Code::kMeaning, center,
        fmt::format("has no effect: a {} has no center_mm; remove it", name_of(feature.type)));
  }
  constexpr double kLeastHalfAngle_deg = 0.05;
  const std::string angle = where + "/nominal/half_angle_deg";
  const double half_deg = feature.nominal.half_angle_deg;
  if (feature.type == Shape::kCone && findings.is_given(angle) && findings.sound(angle) &&
      half_deg < kLeastHalfAngle_deg && half_deg > -kLeastHalfAngle_deg) {
    findings.meaning(Code::kMeaning, angle,
                     fmt::format("a half angle of {} deg is a cylinder within what the points "
                                 "tell; make the feature a \"cylinder\"",
                                 plain(half_deg)));
  }
}

}  // namespace

void check_drawing(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index);
  if (!findings.sound(where + "/type")) return;
  const bool surface = analysis_kind(feature.type) == nullptr;
  check_letter(plan, index, findings);
  if (surface) check_nominal_keys(feature, where, findings);
  if (surface) check_windows(plan, index, findings);
  if (surface) check_faces(plan, index, findings);
  const auto resolved = characteristics_of(plan, feature);
  for (std::size_t k = 0; k < feature.characteristics.size(); ++k) {
    const std::string place = item_pointer(where + "/characteristics", k);
    if (!findings.sound(place)) continue;
    const Asked asked = {plan, index, feature.characteristics[k], resolved[k], place, findings};
    check_mask(asked);
    if (const auto twin = earlier_with_same_id(feature.characteristics, k)) {
      asked.refuse("id", fmt::format("the id {} is that of {} already; choose another",
                                     in_quotes(asked.task.id),
                                     item_pointer(where + "/characteristics", *twin)));
    }
    surface ? check_of_surface(asked) : check_of_analysis(asked);
  }
}

}  // namespace rondure::plans
