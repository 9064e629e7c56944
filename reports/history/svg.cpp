#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "core/units.h"
#include "reports/drawings/internal/svg.h"
#include "reports/history/history.h"
#include "reports/terminal/internal/columns.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::printable;
using core::um;

constexpr double kRunWidth = 860.0;
constexpr double kRunLeft = 66.0;
constexpr double kRunRight = 738.0;
constexpr double kRunTop = 64.0;
constexpr double kRunBottom = 344.0;
constexpr double kText = 412.0;  ///< Left edge of the sentences.
constexpr double kLine = 18.0;
constexpr std::size_t kSentenceLetters = 112;  ///< Letters in a line of sentences.
constexpr std::size_t kIndexLetters = 84;      ///< Letters in a line of the index, which is bold.

/// Colours of Okabe and Ito, darkened; every mark also differs in shape, every line in its dashes.
constexpr std::string_view kRunStyle =
    "text{font-family:\"DejaVu Sans\",\"Noto Sans\",\"Noto Sans CJK "
    "SC\",Arial,sans-serif;fill:#3c4752;"
    "font-size:12px}.head{font-size:16px;font-weight:bold;fill:#16202a}.index{font-size:13px;"
    "font-weight:bold;fill:#16202a}.frame,.tick{stroke:#7c8792;fill:none}.paper{fill:#fff}"
    ".control{stroke:#0b5e9e;stroke-width:1.2;stroke-dasharray:6 4}"
    ".center{stroke:#0b5e9e;stroke-width:1}.limit{stroke:#16202a;stroke-width:2}"
    ".run{fill:none;stroke:#9aa5af;stroke-width:1}.result{fill:#16202a}"
    ".beyond{fill:#c24e00}.cross{fill:none;stroke:#b93c00;stroke-width:2.2}";

struct RunAxes {
  Scale x;
  Scale y;
};

void draw_frame(Svg& svg, const RunAxes& axes, const RunChart& chart) {
  svg.rect(kRunLeft, kRunTop, kRunRight - kRunLeft, kRunBottom - kRunTop, "frame");
  for (const double value : core::round_ticks(axes.y.low, axes.y.high, 6)) {
    tick_beside(svg, kRunLeft, axes.y.at(value), tick_label(value), 9.0);
  }
  svg.upward_text(
      16.0, 0.5 * (kRunTop + kRunBottom), "title",
      fmt::format("{} / {}", chart.results.back().result.symbol, core::sign_of(unit_of(chart))));
  for (const double number : core::round_ticks(1.0, axes.x.high - 1.0, 8)) {
    if (number != std::floor(number)) continue;
    tick_below(svg, axes.x.at(number), kRunBottom, tick_label(number));
  }
  const auto day = [](const record::ArchivedResult& r) {
    return printable(r.head.started_utc.substr(0, 10));
  };
  svg.text(0.5 * (kRunLeft + kRunRight), kRunBottom + 38.0, "middle", "title",
           trf("number of the result, in the order of time ({} to {})", day(chart.results.front()),
               day(chart.results.back())));
}

/// A line across the plot with its name on the right; names are kept apart from each other.
struct Level {
  double value_mm;
  std::string_view css_class;
  std::string name;
};

void draw_levels(Svg& svg, const RunAxes& axes, const RunChart& chart, bool limit_shown) {
  std::vector<Level> levels;
  if (chart.limits) {
    levels.push_back({chart.limits->upper_mm, "control", "UCL"});
    levels.push_back({chart.limits->center_mm, "center", tr("centre")});
    levels.push_back({chart.limits->lower_mm, "control", "LCL"});
  }
  if (limit_shown) levels.push_back({*chart.upper_limit_mm, "limit", tr("tolerance")});
  if (chart.lower_limit_mm) levels.push_back({*chart.lower_limit_mm, "limit", tr("lower limit")});
  std::sort(levels.begin(), levels.end(),
            [](const Level& a, const Level& b) { return a.value_mm > b.value_mm; });
  double free = 0.0;
  for (const Level& level : levels) {
    const double y = axes.y.at(level.value_mm / core::kMicrometre);
    svg.line(kRunLeft, y, kRunRight, y, level.css_class);
    const double label = std::max(y + 4.0, free);
    svg.text(kRunRight + 7.0, label, "start", "label",
             fmt::format("{} {}", level.name, um(level.value_mm)));
    free = label + 14.0;
  }
}

void draw_results(Svg& svg, const RunAxes& axes, const RunChart& chart,
                  const std::vector<double>& values_mm) {
  const auto x = [&](std::size_t i) { return axes.x.at(static_cast<double>(i) + 1.0); };
  const auto y = [&](std::size_t i) { return axes.y.at(values_mm[i] / core::kMicrometre); };
  std::string d;
  for (std::size_t i = 0; i < values_mm.size(); ++i) {
    d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', x(i), y(i));
  }
  svg.path(d, "run");
  const double r = values_mm.size() > 300 ? 1.6 : values_mm.size() > 100 ? 2.4 : 3.2;
  for (std::size_t i = 0; i < values_mm.size(); ++i) {
    if ((chart.upper_limit_mm && values_mm[i] > *chart.upper_limit_mm) ||
        (chart.lower_limit_mm && values_mm[i] < *chart.lower_limit_mm)) {
      svg.cross(x(i), y(i), r + 1.6, "cross");
    } else if (std::binary_search(chart.beyond.begin(), chart.beyond.end(), i)) {
      svg.triangle(x(i), y(i), r + 2.0, "beyond");
    } else {
      svg.circle(x(i), y(i), r, "result");
    }
  }
}

void draw_chart(Svg& svg, const RunChart& chart) {
  const std::vector<double> values_mm = values_of(chart);
  const ChartRange range = range_of(chart);
  const RunAxes axes = {
      {0.0, static_cast<double>(values_mm.size()) + 1.0, kRunLeft, kRunRight},
      {range.low_mm / core::kMicrometre, range.high_mm / core::kMicrometre, kRunBottom, kRunTop}};
  draw_frame(svg, axes, chart);
  draw_levels(svg, axes, chart, range.limit_shown);
  draw_results(svg, axes, chart, values_mm);
}

/// Lines of at most kSentenceLetters columns.
std::vector<std::string> lines_within(std::string_view text,
                                      std::size_t letters = kSentenceLetters) {
  std::vector<std::string> out(1);
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (columns(out.back()) + 1 + end > letters) out.emplace_back();
    out.back() += fmt::format("{}{}", out.back().empty() ? "" : " ", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

std::string with_micro_sign(std::string text) {
  for (std::size_t at = text.find(" um"); at != std::string::npos; at = text.find(" um", at + 1)) {
    text.replace(at, 3, " µm");
  }
  for (std::size_t at = text.find(" urad"); at != std::string::npos; at = text.find(" urad", at)) {
    text.replace(at, 5, " µrad");
  }
  return text;
}

}  // namespace

std::string history_drawing(const RunChart& chart) {
  Svg svg(kRunWidth, kRunBottom + 50.0, "wide chart",
          trf("Run chart of {}", printable(chart.results.back().result.characteristic)));
  draw_chart(svg, chart);
  return svg.str();
}

std::vector<core::Phrase> history_sentences(const RunChart& chart) {
  std::vector<core::Phrase> out;
  if (chart.limits) {
    out.push_back(core::phrase(
        "UCL, LCL: control limits of individuals, 3 sigma from moving ranges of ln x (I-MR chart). "
        "Triangle: beyond a control limit; cross: beyond the tolerance."));
  }
  if (chart.upper_limit_mm && !range_of(chart).limit_shown) {
    out.push_back(
        core::phrase("The tolerance, {}, is above the chart.",
                     fmt::format("{} {}", um(*chart.upper_limit_mm), name_of(unit_of(chart)))));
  }
  for (const core::Phrase& note : chart.notes) out.push_back(core::phrase("Note: {}.", note));
  return out;
}

std::string history_svg(const RunChart& chart) {
  std::vector<std::string> lines;
  for (const core::Phrase& sentence : history_sentences(chart)) {
    for (const std::string& line : lines_within(with_micro_sign(sentence))) lines.push_back(line);
  }
  const auto index = lines_within(with_micro_sign(capability_in_words(chart)), kIndexLetters);
  const double height = kText + kLine * static_cast<double>(index.size() + lines.size());
  const record::ArchivedResult& newest = chart.results.back();
  const std::string head =
      fmt::format("{} {} of {} / {}, part {}", newest.result.symbol, newest.result.reference,
                  shortened(printable(newest.result.feature), 24),
                  shortened(printable(newest.result.characteristic), 24),
                  shortened(printable(newest.head.part_id), 24));
  Svg svg(kRunWidth, height, "chart", head);
  svg.rect(0.0, 0.0, kRunWidth, height, "paper");
  svg.text(kRunLeft, 26.0, "start", "head", head);
  svg.text(kRunLeft, 48.0, "start", "label",
           fmt::format("{}; {}; {}", shortened(printable(newest.result.filter), 40),
                       shortened(printable(newest.result.sampling), 60),
                       count(chart.results.size(), "result", "results")));
  draw_chart(svg, chart);
  double y = kText;
  for (const std::string& line : index) {
    svg.text(kRunLeft, y, "start", "index", line);
    if (!line.empty()) y += kLine;
  }
  for (const std::string& line : lines) {
    svg.text(kRunLeft, y, "start", "label", line);
    y += kLine;
  }
  return svg.document(kRunStyle);
}

}  // namespace rondure::reports
