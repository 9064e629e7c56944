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

bool is_at_most(const evaluation::StatedValue& value) {
  return value.statement() != nullptr && value.statement()->at_most;
}

double shown_mm(const evaluation::StatedValue& value) {
  return is_at_most(value) ? value.statement()->high_mm : value.quoted_mm();
}

}  // namespace rondure::reports
