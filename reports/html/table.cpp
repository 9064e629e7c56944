#include <fmt/format.h>

#include "reports/html/sections.h"

namespace rondure::reports {

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
