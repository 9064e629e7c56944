#include <algorithm>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/drawings/internal/svg.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
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

std::string note(const std::string& html) { return R"(<p class="note">)" + html + "</p>"; }

std::string folded(const std::string& summary, const std::string& html, bool open) {
  if (html.empty()) return {};
  return fmt::format(R"(<details class="fold"{}><summary>{}</summary>{}</details>)",
                     open ? R"( open="open")" : "", summary, html);
}

std::string explained(std::string_view word, std::string_view html) {
  return note(fmt::format("<b>{}</b> {}", word, html));
}

std::string scrolling(const std::string& html) {
  return R"(<div class="scroll">)" + html + "</div>";
}

std::string spoken_caption(std::string_view html) {
  return fmt::format(R"(<caption class="spoken screen-only">{}</caption>)", html);
}

std::string table(std::string_view css_class, std::string_view columns, std::string_view caption,
                  const std::vector<std::string>& names, const TableRows& rows) {
  const auto aligned = [&](std::size_t i) { return columns[i] == 'r' ? R"( class="n")" : ""; };
  std::string html =
      css_class.empty() ? "<table>" : fmt::format(R"(<table class="{}">)", css_class);
  html.append(caption).append("<thead><tr>");
  for (std::size_t i = 0; i < names.size(); ++i)
    html += fmt::format(R"(<th scope="col"{}>{}</th>)", aligned(i), names[i]);
  html += "</tr></thead><tbody>";
  for (const std::vector<std::string>& cells : rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t span = i + 1 < cells.size() ? 1 : columns.size() - i;
      html += fmt::format("<td{}>{}</td>",
                          span > 1 ? fmt::format(R"( colspan="{}")", span) : aligned(i), cells[i]);
    }
    html += "</tr>";
  }
  return html + "</tbody></table>";
}

}  // namespace rondure::reports
