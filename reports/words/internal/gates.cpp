#include "reports/words/internal/gates.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "reports/words/language.h"

namespace rondure::reports {

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
