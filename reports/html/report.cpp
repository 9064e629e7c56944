#include "reports/html/report.h"

#include <cctype>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "core/encodings.h"
#include "record/sha256.h"
#include "reports/escaping.h"
#include "reports/html/internal/script.h"
#include "reports/html/sections.h"
#include "reports/html/style.h"
#include "reports/terminal/internal/columns.h"
#include "reports/words/callouts.h"

namespace rondure::reports {
namespace {

using core::printable;

constexpr const char* kDetail = R"( class="detail")";

/// A part of the page that has an entry in the contents.
struct PagePart {
  std::string id;
  std::string name;  ///< HTML.
  std::string html;  ///< Begins with "<section".
};

/// The bytes that hexadecimal digits write.
std::string bytes_of(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    out += static_cast<char>(digit(hex[i]) * 16 + digit(hex[i + 1]));
  }
  return out;
}

/// Content-Security-Policy: nothing is loaded but the logo within the page, and only the script
/// with this digest runs.
std::string policy() {
  return fmt::format(
      R"(<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; )"
      R"(style-src 'unsafe-inline'; script-src 'sha256-{}'; base-uri 'none'; form-action 'none'"/>)",
      core::base64(bytes_of(record::sha256_hex(kScript))));
}

/// A text as a string of CSS within <style>: none of its characters can end the string or the
/// element.
std::string css_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const bool plain = static_cast<unsigned char>(c) >= 0x80 || std::isalnum(c) != 0 || c == ' ';
    out += plain ? std::string(1, c) : fmt::format("\\{:x} ", c);
  }
  return out + "\"";
}

/// Head of every sheet: part, revision and run; simulated, incomplete.
std::string sheet_heads(const record::RunRecord& record) {
  const record::Header& header = record.header;
  const auto text = [](std::string_view name, const std::string& value) {
    constexpr std::size_t kMost = 44;  // columns: a little more than a third of a line
    return fmt::format("{} {}", name,
                       value.empty() ? "\u2013" : shortened(printable(value), kMost));
  };
  const auto field = [](std::string_view place, const std::string& content) {
    return fmt::format(
        "@top-{}{{content:{};font:8pt system-ui,sans-serif;color:#55616d;white-space:nowrap}}",
        place, css_string(content));
  };
  std::string middle = text(tr("Revision"), header.plan_revision);
  if (header.simulated) middle += " · " + tr("SIMULATED");
  if (record.ending != "finished") middle += " · " + tr("INCOMPLETE");
  const std::string part =
      header.serial.empty() ? header.part_id : header.part_id + " / " + header.serial;
  return fmt::format("@page{{{}{}{}}}", field("left", text(tr("Part"), part)),
                     field("center", middle), field("right", text(tr("Run"), header.run_id)));
}

std::string style(bool of_drawing, const record::RunRecord& record) {
  return fmt::format(
      "<style>{0}{2}{3}@media screen{{:root[data-theme=dark]{{{1}}}}}\n"
      "@media screen and (prefers-color-scheme:dark){{:root:not([data-theme=light]){{{1}}}}}\n"
      "</style>",
      kStyle, kDarkColours, of_drawing ? kDrawingStyle : std::string_view(), sheet_heads(record));
}

/// Head of the page on a screen: link to the result, contents, switch of the theme.
std::string top_of(const std::vector<PagePart>& parts) {
  std::string links;
  for (const PagePart& part : parts) {
    links += fmt::format(R"(<li><a href="#{}">{}</a></li>)", part.id, part.name);
  }
  return fmt::format(
      R"(<a class="skip screen-only" href="#main">{}</a><header class="top screen-only"><nav )"
      R"(aria-label="{}"><ul>{}</ul></nav><button type="button" class="theme" )"
      R"(aria-pressed="false" hidden="hidden">{}</button></header>)",
      tr("Skip to the result"), tr("Contents"), links, tr("Dark colours"));
}

/// The parts of the page in their order; empty ones are omitted.
std::vector<PagePart> parts_of(const record::RunRecord& record,
                               const evaluation::Evaluation& evaluation,
                               const EarlierResults& earlier,
                               const std::vector<FeatureCorrections>& corrections, bool detail) {
  const std::vector<Callout> callouts = callouts_of(evaluation);
  const Callout* drawn = drawn_callout(callouts);
  std::vector<PagePart> parts;
  const auto add = [&](std::string id, std::string name, std::string html) {
    if (!html.empty()) parts.push_back({std::move(id), std::move(name), std::move(html)});
  };
  add("result", tr("Result"), verdict_section(record, evaluation, callouts));
  for (std::size_t i = 0; i < evaluation.features.size(); ++i) {
    add(fmt::format("feature-{}", i + 1), feature_title(evaluation.features[i].feature),
        feature_section(record, i, evaluation.features[i], detail,
                        drawn != nullptr && drawn->feature == &evaluation.features[i],
                        i < corrections.size() ? corrections[i] : FeatureCorrections()));
  }
  add("uncertainty", tr("Uncertainty"), uncertainties_section(evaluation, callouts));
  add("history", tr("Earlier runs"), history_section(record, evaluation, earlier));
  add("settings", tr("Settings"), probe_section(record, evaluation));
  add("decisions", tr("Decisions"), decisions_section(record));
  add("provenance", tr("Provenance"), provenance_section(record));
  return parts;
}

/// What stands after the name of the program. Several kinds together are an inspection.
std::string kind_of_page(const evaluation::Evaluation& evaluation, bool of_drawing) {
  if (of_drawing) return tr("inspection report");
  bool surface = false;
  std::set<record::Shape> analyses;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    if (record::is_analysis(feature.feature.shape)) {
      analyses.insert(feature.feature.shape);
    } else {
      surface = true;
    }
  }
  if (analyses.empty()) return tr("cylindricity report");
  if (surface || analyses.size() > 1) return tr("inspection report");
  switch (*analyses.begin()) {
    case record::Shape::kSpindle:
      return tr("spindle report");
    case record::Shape::kWheel:
      return tr("grinding-wheel report");
    case record::Shape::kContour:
      return tr("crank-pin contour report");
    case record::Shape::kRotaryAxes:
    case record::Shape::kFiveAxis:
      return tr("calibration report");
    default:
      return tr("inspection report");
  }
}

}  // namespace

std::string write_html(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                       Edition edition, const EarlierResults& earlier,
                       const std::vector<FeatureCorrections>& corrections) {
  const LanguageScope scope(edition.language);
  const bool of_drawing = has_findings(evaluation);
  const std::vector<PagePart> parts =
      parts_of(record, evaluation, earlier, corrections, edition.detail);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\"{}>\n<head>\n<meta charset=\"utf-8\"/>\n{}\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{} {} - {}</title>\n{}\n</head>\n<body>\n{}\n<main id=\"main\">\n{}\n",
      tag_of(edition.language), edition.detail ? kDetail : "", policy(),
      escaped(printable(record.header.part_id)), escaped(printable(record.header.serial)),
      tr(name_of(evaluation.verdict)), style(of_drawing, record), top_of(parts),
      head_section(record, kind_of_page(evaluation, of_drawing), &evaluation));
  constexpr std::string_view kTag = "<section";
  for (const PagePart& part : parts) {
    html += fmt::format("{} id=\"{}\"{}\n", kTag, part.id, part.html.substr(kTag.size()));
  }
  html += fmt::format("</main>\n<footer>{}</footer>\n<script>",
                      record.series.empty()
                          ? tr("Made by Rondure from the touches on record; the raw data are in "
                               "journal.db and touches.csv beside this page.")
                          : tr("Made by Rondure from the data on record; the raw data are in "
                               "journal.db and series.csv beside this page."));
  html += kScript;
  return html + "</script>\n</body>\n</html>\n";
}

Edition edition_of_page(std::string_view page) {
  const std::string_view head = page.substr(0, 200);
  const std::string chinese = fmt::format("<html lang=\"{}\"", tag_of(Language::kChinese));
  return {head.find(chinese) == std::string_view::npos ? Language::kEnglish : Language::kChinese,
          head.find(kDetail) != std::string_view::npos};
}

}  // namespace rondure::reports
