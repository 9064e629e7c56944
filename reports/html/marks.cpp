#include <algorithm>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/drawings/internal/svg.h"
#include "reports/html/plots.h"
#include "reports/words/internal/gates.h"
#include "reports/words/language.h"

namespace rondure::reports {

using core::fixed;
using core::signed_um;
using core::um;

std::string verdict_mark(evaluation::Verdict verdict, int size_px) {
  std::string_view body;
  switch (verdict) {
    case evaluation::Verdict::kConforms:
      body = R"(<circle class="good" cx="32" cy="32" r="30"/>)"
             R"(<path class="stroke" d="M18 33l10 10 19-21"/>)";
      break;
    case evaluation::Verdict::kDoesNotConform:
      body = R"(<path class="bad" d="M20.5 3h23L61 20.5v23L43.5 61h-23L3 43.5v-23z"/>)"
             R"(<path class="stroke" d="M21 21l22 22M43 21l-22 22"/>)";
      break;
    case evaluation::Verdict::kUndecided:
      body = R"(<path class="open" d="M32 3l29 29-29 29L3 32z"/>)"
             R"(<path class="pen" d="M25 26c0-9 14-9 14 0 0 6-7 6-7 12M32 44v2"/>)";
      break;
    case evaluation::Verdict::kVoid:
      body = R"(<circle class="hollow" cx="32" cy="32" r="27"/>)"
             R"(<path class="pen" d="M13 51L51 13"/>)";
      break;
    case evaluation::Verdict::kNotToleranced:
      body = R"(<circle class="hollow" cx="32" cy="32" r="27"/>)"
             R"(<path class="pen" d="M20 32h24"/>)";
      break;
  }
  return fmt::format(R"(<svg class="mark" viewBox="0 0 64 64" width="{0}" height="{0}" )"
                     R"(aria-hidden="true">{1}</svg>)",
                     size_px, body);
}

namespace {

/// The ISO 1101 symbol; empty of a characteristic that ISO 1101 does not know.
std::string_view symbol_lines(record::Form form) {
  switch (form) {
    case record::Form::kCylindricity:
      return R"(<circle cx="10" cy="10" r="4.5"/><path d="M2 17L8.5 3M11.5 17L18 3"/>)";
    case record::Form::kRoundness:
      return R"(<circle cx="10" cy="10" r="7"/>)";
    case record::Form::kStraightness:
      return R"(<path d="M3 10h14"/>)";
    case record::Form::kFlatness:
      return R"(<path d="M2 14.5L6.5 5.5H18L13.5 14.5z"/>)";
    case record::Form::kCoaxiality:
    case record::Form::kConcentricity:
      return R"(<circle cx="10" cy="10" r="7.2"/><circle cx="10" cy="10" r="3.4"/>)";
    case record::Form::kParallelism:
      return R"(<path d="M4.5 17L10 3M10.5 17L16 3"/>)";
    case record::Form::kPerpendicularity:
      return R"(<path d="M10 3v13.5M2.5 16.5h15"/>)";
    case record::Form::kAngularity:
      return R"(<path d="M17.5 16.5H2.5L15.5 4"/>)";
    case record::Form::kTotalRunOut:
      return R"(<path d="M2 17L10 4M5 5.8L10 4L10.3 9.3M9.5 17L17.5 4M12.5 5.8L17.5 4L17.8 9.3M2 17h7.5"/>)";
    case record::Form::kRunOut:
      return R"(<path d="M4 17L15 4M9.5 5L15 4L14 9.5"/>)";
    default:
      return {};
  }
}

}  // namespace

std::string form_symbol(record::Form form) {
  const std::string_view lines = symbol_lines(form);
  if (lines.empty()) return {};
  return fmt::format(R"(<svg class="symbol" viewBox="0 0 20 20" width="18" height="18" role="img" )"
                     R"(aria-label="{}">{}</svg>)",
                     tr(record::name_of(form)), lines);
}

namespace {

/// The interval as a bar draws it: none where only one of its ends is stated.
const evaluation::UncertaintyStatement* interval_of(const evaluation::StatedValue& value) {
  const evaluation::UncertaintyStatement* known = value.statement();
  return is_bound(value) || (known != nullptr && known->at_most) ? nullptr : known;
}

}  // namespace

std::string tolerance_bar(const evaluation::CharacteristicResult& result, double tolerance_mm) {
  constexpr double kWidth = 150.0;
  const double value_mm = result.value->quoted_mm();
  const evaluation::UncertaintyStatement* known = interval_of(*result.value);
  // Where no rule decided, its limits are the tolerance itself.
  const auto& outcome = result.outcome;
  const auto of_rule = [&](evaluation::Limits evaluation::RuleOutcome::*zone) {
    return outcome ? ((*outcome).*zone).upper_mm.value_or(tolerance_mm) : tolerance_mm;
  };
  const double acceptance_mm = of_rule(&evaluation::RuleOutcome::acceptance);
  const double rejection_mm = of_rule(&evaluation::RuleOutcome::rejection);
  double end_mm = std::max(1.25 * tolerance_mm, 1.05 * value_mm);
  if (known != nullptr) end_mm = std::max(end_mm, 1.05 * known->high_mm);
  end_mm = std::max(end_mm, 1.05 * rejection_mm);
  const Scale x{0.0, end_mm, 1.0, kWidth - 1.0};
  const core::Phrase text = result.value->value_text();
  const std::string_view unit = core::name_of(result.value->unit());
  std::string label =
      trf("{} of {} {}", in_words(text).value_or(text.english()), um(tolerance_mm), unit);
  if (acceptance_mm < tolerance_mm) {
    label += trf(", accepted up to {}", fmt::format("{} {}", um(acceptance_mm), unit));
  }
  Svg svg(kWidth, 26.0, "bar", label);
  svg.rect(x.from, 8.0, x.at(tolerance_mm) - x.from, 10.0, "allowed");
  if (acceptance_mm < rejection_mm) {
    const double from = x.at(std::max(acceptance_mm, 0.0));
    svg.rect(from, 5.0, x.at(rejection_mm) - from, 16.0, "guard");
  }
  svg.rect(x.from, 8.0, x.at(value_mm) - x.from, 10.0,
           result.verdict == evaluation::Verdict::kConforms         ? "good"
           : result.verdict == evaluation::Verdict::kDoesNotConform ? "bad"
                                                                    : "neutral");
  if (known != nullptr) {
    svg.line(x.at(known->low_mm), 13.0, x.at(known->high_mm), 13.0, "interval");
    svg.line(x.at(known->low_mm), 9.5, x.at(known->low_mm), 16.5, "interval");
    svg.line(x.at(known->high_mm), 9.5, x.at(known->high_mm), 16.5, "interval");
  }
  svg.line(x.at(tolerance_mm), 3.0, x.at(tolerance_mm), 23.0, "limit");
  return svg.str();
}

std::string limits_bar(const evaluation::CharacteristicResult& result,
                       const std::vector<evaluation::JudgedValue>& judged) {
  constexpr double kWidth = 150.0;
  const evaluation::UncertaintyStatement* known = interval_of(*result.value);
  double low_mm = judged.front().value_mm;
  double high_mm = low_mm;
  evaluation::Limits limits;
  const auto reach = [&](const std::optional<double>& length_mm) {
    if (!length_mm) return;
    low_mm = std::min(low_mm, *length_mm);
    high_mm = std::max(high_mm, *length_mm);
  };
  for (const evaluation::JudgedValue& value : judged) {
    reach(value.value_mm);
    reach(value.limits.lower_mm);
    reach(value.limits.upper_mm);
    if (value.limits.lower_mm) limits.lower_mm = value.limits.lower_mm;
    if (value.limits.upper_mm) limits.upper_mm = value.limits.upper_mm;
  }
  if (known != nullptr) {
    reach(known->low_mm);
    reach(known->high_mm);
  }
  const double room_mm = std::max(0.2 * (high_mm - low_mm), 0.5 * core::kMicrometre);
  const Scale x{low_mm - room_mm, high_mm + room_mm, 1.0, kWidth - 1.0};
  std::string label = in_words(result.value->value_text()).value_or("");
  for (const evaluation::JudgedValue& value : judged) {
    if (judged.size() > 1)
      label += fmt::format("; {} {}", value.symbol, result.value->in_digits(value.value_mm));
  }
  Svg svg(kWidth, 26.0, "bar", label);
  const double from = limits.lower_mm ? x.at(*limits.lower_mm) : x.from;
  const double to = limits.upper_mm ? x.at(*limits.upper_mm) : x.to;
  svg.rect(from, 8.0, to - from, 10.0, "allowed");
  if (result.outcome) {
    const evaluation::Limits& accepted = result.outcome->acceptance;
    const evaluation::Limits& rejected = result.outcome->rejection;
    const auto band = [&](const std::optional<double>& one, const std::optional<double>& other) {
      if (!one || !other || *one == *other) return;
      const double left = std::clamp(x.at(std::min(*one, *other)), x.from, x.to);
      svg.rect(left, 5.0, std::clamp(x.at(std::max(*one, *other)), x.from, x.to) - left, 16.0,
               "guard");
    };
    band(accepted.lower_mm, rejected.lower_mm);
    band(accepted.upper_mm, rejected.upper_mm);
  }
  if (known != nullptr) {
    svg.line(x.at(known->low_mm), 13.0, x.at(known->high_mm), 13.0, "interval");
    svg.line(x.at(known->low_mm), 9.5, x.at(known->low_mm), 16.5, "interval");
    svg.line(x.at(known->high_mm), 9.5, x.at(known->high_mm), 16.5, "interval");
  }
  for (const evaluation::JudgedValue& value : judged) {
    const bool decided = result.verdict == evaluation::Verdict::kConforms ||
                         result.verdict == evaluation::Verdict::kDoesNotConform;
    svg.diamond(x.at(value.value_mm), 13.0, 5.5,
                !decided                            ? "neutral"
                : value.limits.hold(value.value_mm) ? "good"
                                                    : "bad");
  }
  if (limits.lower_mm) svg.line(from, 3.0, from, 23.0, "limit");
  if (limits.upper_mm) svg.line(to, 3.0, to, 23.0, "limit");
  return svg.str();
}

std::string budget_bars(const std::vector<evaluation::BudgetLine>& budget, core::ValueUnit unit) {
  constexpr double kRow = 24.0;
  constexpr double kFrom = 170.0;
  double most_mm = 0.0;
  std::vector<const evaluation::BudgetLine*> lines;
  for (const evaluation::BudgetLine& line : budget) {
    if (!(line.standard_uncertainty_mm > 0.0)) continue;
    lines.push_back(&line);
    most_mm = std::max(most_mm, line.standard_uncertainty_mm);
  }
  if (lines.empty()) return {};
  const Scale x{0.0, most_mm, kFrom, 500.0};
  Svg svg(760.0, kRow * static_cast<double>(lines.size()) + 8.0, "wide budget",
          tr("standard uncertainty by each influence alone"));
  double y = 4.0;
  for (const evaluation::BudgetLine* line : lines) {
    const double end = x.at(line->standard_uncertainty_mm);
    svg.text(kFrom - 10.0, y + 16.0, "end", "label", tr(line->name));
    svg.rect(kFrom, y + 4.0, end - kFrom, kRow - 8.0,
             line->measurand == evaluation::Measurand::kWholeSurface ? "share surface" : "share");
    const auto with_sign = [&](const std::string& number) {
      return fmt::format("{} {}", number, core::sign_of(unit));
    };
    const std::string size = with_sign(um(line->standard_uncertainty_mm));
    const std::string share = fixed(100.0 * line->share_1, 0);
    // Linear propagation knows no shift, but how the value changes.
    svg.text(
        end + 8.0, y + 16.0, "start", "label",
        line->per_u_mm
            ? trf("{}, {} %; {} for +1 u", size, share, with_sign(signed_um(*line->per_u_mm)))
            : trf("{}, {} %; mean shift {}", size, share, with_sign(signed_um(line->shift_mm))));
    y += kRow;
  }
  return svg.str();
}

}  // namespace rondure::reports
