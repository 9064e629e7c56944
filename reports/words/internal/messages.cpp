#include "reports/words/internal/messages.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::Message;
using core::MessageCode;

/// A count, which messages hold as a number.
int count_in(const Message& m, std::size_t i) { return static_cast<int>(m.number(i)); }

/// A decision of the guided search after a cloud.
std::string step_in_words(const Message& m) {
  switch (m.code) {
    case MessageCode::kLevelToResolution:
      return trf(
          "as level as the fixture can be set: {:.6f} deg is left, its resolution is {:.6f} deg",
          m.number(3), m.number(4));
    case MessageCode::kLevelToScatter:
      return trf(
          "as level as probe and fixture scatter: the step of {:.6f} deg is not below half the "
          "last one",
          m.number(3));
    case MessageCode::kLevelPoseBeyondLimits:
      return trf(
          "not level: the levelling pose ({:.4f}, {:.4f}) deg is beyond the limits of the fixture",
          m.number(3), m.number(4));
    case MessageCode::kNotLevelAfterPoses:
      return trf("not level after {} poses: a step of {:.4f} deg is left", count_in(m, 3),
                 m.number(4));
    default:
      return trf("turning to ({:.4f}, {:.4f}) deg", m.number(3), m.number(4));
  }
}

}  // namespace

std::optional<std::string> in_words(const Message& m) {
  switch (m.code) {
    case MessageCode::kPartLocated:
      return trf(
          "part located in pose ({:.4f}, {:.4f}) deg: its axis is level at ({:.4f}, {:.4f}) deg",
          m.number(0), m.number(1), m.number(2), m.number(3));
    case MessageCode::kLevellingStep:
    case MessageCode::kLevelToResolution:
    case MessageCode::kLevelToScatter:
    case MessageCode::kLevelPoseBeyondLimits:
    case MessageCode::kNotLevelAfterPoses:
      return trf("pose ({:.4f}, {:.4f}) deg: zone of the cloud {:.3f} um; {}", m.number(0),
                 m.number(1), m.number(2), step_in_words(m));
    case MessageCode::kLevelPoseUnreachable: {
      const auto reason = in_words(core::Phrase(m.text(0)));
      return reason ? std::optional(trf("not level: {}", *reason)) : std::nullopt;
    }
    case MessageCode::kPoseSearchEnded:
      return trf(
          "pose search ended at ({:.4f}, {:.4f}) deg after {} poses with f = {:.3f} um, a search "
          "value; that pose is measured anew",
          m.number(0), m.number(1), count_in(m, 2), m.number(3));
    case MessageCode::kTargetsReachable:
      return trf("pose ({:.4f}, {:.4f}) deg: {} of {} targets can be reached", m.number(0),
                 m.number(1), count_in(m, 2), count_in(m, 3));
    case MessageCode::kFixtureBaseFound:
      return trf(
          "base of the fixture, or of a part without one: shifted by ({:.4f}, {:.4f}, {:.4f}) mm, "
          "turned by ({:.5f}, {:.5f}, {:.5f}) deg, largest residual {:.3f} um",
          m.number(0), m.number(1), m.number(2), m.number(3), m.number(4), m.number(5),
          m.number(6));
    case MessageCode::kSingleSteps:
      return trf("single-step mode: travel at {:g} mm/s at most, moves confirmed by the operator",
                 m.number(0));
    case MessageCode::kRunResumed:
      return trf(
          "resumed on {} after {} touches; the last {} repeated, largest difference {:.3f} um, "
          "limit {:g} um",
          m.text(0), count_in(m, 1), count_in(m, 2), m.number(3), m.number(4));
    case MessageCode::kPartLocatedAgain: {
      const auto reason = in_words(core::Phrase(m.text(1)));
      return reason ? std::optional(
                          trf("part located again behind {} touches: {}", count_in(m, 0), *reason))
                    : std::nullopt;
    }
    case MessageCode::kClampingChanged:
      if (m.text(2).empty()) {
        return trf("{} is clamped after {} touches, by the simulation", m.text(1), count_in(m, 0));
      }
      return trf("{} is clamped after {} touches, confirmed on {}", m.text(1), count_in(m, 0),
                 m.text(2));
    case MessageCode::kCalibrationTaken: {
      if (m.text(1).empty()) {
        return tr("its calibration of the fixture holds for the features that follow");
      }
      const auto reason = in_words(core::Phrase(m.text(1)));
      return reason ? std::optional(trf("the features that follow are void, the fixture is taken "
                                        "as nominal: {}",
                                        *reason))
                    : std::nullopt;
    }
    case MessageCode::kCorrectionLoaded:
      return trf("the correction is loaded into the control, confirmed on {}", m.text(0));
  }
  return std::nullopt;
}

std::string english_sentence(const Message& message) {
  const LanguageScope english(Language::kEnglish);
  return in_words(message).value_or("");
}

using evaluation::Gate;

const char* name_of(Gate::Outcome outcome) {
  switch (outcome) {
    case Gate::Outcome::kPassed:
      return "passed";
    case Gate::Outcome::kWarns:
      return "warns";
    case Gate::Outcome::kBounds:
      return "bounds";
    case Gate::Outcome::kVoids:
      return "voids";
  }
  return "voids";
}

std::string effect_of(Gate::Outcome outcome) {
  switch (outcome) {
    case Gate::Outcome::kPassed:
      return tr("passed");
    case Gate::Outcome::kWarns:
      return tr("not passed; the values stand");
    case Gate::Outcome::kBounds:
      return tr("not passed; some values are only bounds");
    case Gate::Outcome::kVoids:
      return tr("not passed; some values prove nothing");
  }
  return tr("not passed; some values prove nothing");
}

std::string number_of(const std::optional<double>& number, const std::string& unit) {
  if (!number || !std::isfinite(*number)) return "-";
  return fmt::format("{:.4g}{}{}", *number, unit.empty() ? "" : " ", unit);
}

std::string in_words(const std::vector<Gate>& gates) {
  const auto passed = std::ranges::count(gates, Gate::Outcome::kPassed, &Gate::outcome);
  std::string text = trf("{} of {} passed", passed, gates.size());
  for (const Gate& gate : gates) {
    if (gate.outcome == Gate::Outcome::kPassed) continue;
    text +=
        tr("; ") + trf("{}: {}", gate.code, in_words(gate.reason).value_or(gate.reason.english()));
  }
  return text;
}

bool is_bound(const evaluation::StatedValue& value) {
  return value.bound() != evaluation::StatedValue::Bound::kNone;
}

std::string_view bound_sign(const evaluation::StatedValue& value, std::string_view at_most,
                            std::string_view at_least) {
  if (!is_bound(value)) return {};
  return value.bound() == evaluation::StatedValue::Bound::kUpper ? at_most : at_least;
}

}  // namespace rondure::reports
