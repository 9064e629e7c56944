#include "reports/history/history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "core/encodings.h"
#include "evaluation/decision/decision.h"
#include "reports/data/internal/json_parts.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"
#include "reports/terminal/internal/columns.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

/// Lengths leave the program in um, angles in urad; values in other units stay unchanged.
std::optional<double> outside(const std::optional<double>& value, const std::string& unit) {
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return unit == "mm" || unit == "mrad" ? *value / core::kMicrometre : *value;
}
std::string outside_unit(const std::string& unit) {
  return unit == "mm" || unit == "mrad" ? std::string(name_of(unit_of_archive(unit))) : unit;
}

/// The fields of a result, for the JSON and, in this order, for the CSV file.
Json result_json(const record::ArchivedResult& r) {
  return {{"run_id", r.head.run_id},
          {"started_utc", r.head.started_utc},
          {"part", r.head.part_id},
          {"part_name", r.head.part_name},
          {"serial", r.head.serial},
          {"operator", r.head.operator_name},
          {"machine", r.head.machine},
          {"fixture", r.head.fixture},
          {"simulated", r.head.simulated},
          {"feature", r.result.feature},
          {"characteristic", r.result.characteristic},
          {"symbol", r.result.symbol},
          {"reference", r.result.reference},
          {"filter", r.result.filter},
          {"sampling", r.result.sampling},
          {"value", optional_json(outside(r.result.value, r.result.unit))},
          {"limit", optional_json(outside(r.result.upper_limit, r.result.unit))},
          {"unit", outside_unit(r.result.unit)},
          {"verdict", r.result.verdict},
          {"certificate", r.result.certificate},
          {"plan", r.head.plan_name},
          {"plan_revision", r.head.plan_revision},
          {"plan_sha256", r.head.plan_sha256},
          {"journal_sha256", r.head.journal_sha256},
          {"version", r.head.version},
          {"lower_limit", optional_json(outside(r.result.lower_limit, r.result.unit))}};
}

Json um_json(double mm) { return mm / core::kMicrometre; }

Json chart_json(const RunChart& chart) {
  if (chart.results.empty()) return nullptr;
  const record::ArchivedResult& newest = chart.results.back();
  const std::string suffix = "_" + std::string(name_of(unit_of(chart)));
  Json out = {{"part", newest.head.part_id},
              {"feature", newest.result.feature},
              {"characteristic", newest.result.characteristic},
              {"results", chart.results.size()},
              {"control_limits", nullptr},
              {"beyond_control_limits", Json::array()},
              {"capability", nullptr},
              {"notes", chart.notes}};
  if (chart.limits) {
    out["control_limits"] = {{"method", "I-MR chart of ln x"},
                             {"lower" + suffix, um_json(chart.limits->lower_mm)},
                             {"center" + suffix, um_json(chart.limits->center_mm)},
                             {"upper" + suffix, um_json(chart.limits->upper_mm)}};
  }
  for (const std::size_t i : chart.beyond) {
    out["beyond_control_limits"].push_back(chart.results[i].head.run_id);
  }
  if (!chart.capability) return out;
  const Capability& c = *chart.capability;
  const bool model = c.method == Capability::Method::kLogNormal;
  out["capability"] = {{"name", chart.index_name},
                       {"index", c.index},
                       {"lower_bound_95", optional_json(c.lower_bound)},
                       {"percentiles_of", model ? "log-normal" : "sample"},
                       {"median" + suffix, um_json(c.median_mm)},
                       {"point_99_865" + suffix, um_json(c.upper_point_mm)},
                       {"anderson_darling_p", c.fit_p}};
  return out;
}

}  // namespace

std::string history_csv_header() {
  std::string out;
  const Json fields = result_json({});
  for (const auto& [key, value] : fields.items()) out += (out.empty() ? "" : ",") + key;
  return out + "\n";
}

std::string history_csv_rows(std::span<const record::ArchivedResult> newest_first) {
  std::string out;
  for (const record::ArchivedResult& r : newest_first) {
    const char* separator = "";
    for (const Json& value : result_json(r)) {
      out += separator;
      out += value.is_string()    ? csv_field(value.get<std::string>())
             : value.is_number()  ? core::shortest(value.get<double>())
             : value.is_boolean() ? (value.get<bool>() ? "1" : "0")
                                  : "";
      separator = ",";
    }
    out += "\n";
  }
  return out;
}

std::string history_json(const std::string& archive,
                         std::span<const record::ArchivedResult> newest_first, bool more,
                         const RunChart& chart) {
  Json out = {{"archive", archive}, {"more", more}, {"results", Json::array()}};
  for (const record::ArchivedResult& r : newest_first) out["results"].push_back(result_json(r));
  out["chart"] = chart_json(chart);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

using core::printable;
using core::um;

constexpr std::size_t kAxis = 8;   ///< Columns of the labels on the left.
constexpr std::size_t kPlot = 56;  ///< Columns of the plot.
constexpr std::size_t kRows = 17;

/// Text in a field of `width` columns.
std::string cell(const std::string& text, std::size_t width) {
  return padded(shortened(printable(text), width), width);
}

/// "2026-11-21 02:33" from "2026-11-21T02:33:02Z".
std::string minute_of(const std::string& utc) {
  std::string out = utc.substr(0, 16);
  if (out.size() > 10) out[10] = ' ';
  return out;
}

/// The drawing as rows of characters, the first row on top.
class TextCanvas {
 public:
  TextCanvas(double low_um, double high_um, core::ValueUnit unit)
      : low_(low_um), high_(high_um), unit_(unit) {
    rows_.fill(std::string(kPlot, ' '));
  }

  [[nodiscard]] std::size_t row_of(double value_um) const {
    const double part = (high_ - value_um) / (high_ - low_);
    return static_cast<std::size_t>(
        std::lround(std::clamp(part, 0.0, 1.0) * static_cast<double>(kRows - 1)));
  }
  void line(double value_um, char mark, const std::string& label) {
    if (value_um > high_ || value_um < low_) return;
    const std::size_t row = row_of(value_um);
    rows_[row] = std::string(kPlot, mark);
    labels_[row].append(labels_[row].empty() ? "" : ", ").append(label);
  }
  void put(std::size_t column, double value_um, char mark) {
    char& at = rows_[row_of(value_um)][column];
    if (at != 'X' && at != '#') at = mark;
  }
  [[nodiscard]] std::string text(bool coloured) const;

 private:
  double low_;
  double high_;
  core::ValueUnit unit_;
  std::array<std::string, kRows> rows_;
  std::array<std::string, kRows> labels_;
};

/// Colours marks beyond a limit red.
std::string painted(const std::string& row) {
  std::string out;
  for (const char c : row) {
    out += c == 'X' || c == '#' ? fmt::format("\x1b[31m{}\x1b[0m", c) : std::string(1, c);
  }
  return out;
}

std::string TextCanvas::text(bool coloured) const {
  std::array<std::string, kRows> ticks;
  for (const double tick : core::round_ticks(low_, high_, 5))
    ticks[row_of(tick)] = tick_label(tick);
  std::string out;
  for (std::size_t i = 0; i < kRows; ++i) {
    std::string line =
        fmt::format("{:>{}} |{}", ticks[i], kAxis - 2, coloured ? painted(rows_[i]) : rows_[i]);
    if (!labels_[i].empty()) line.append(" ").append(labels_[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out + fmt::format("{:>{}} +{}\n", name_of(unit_), kAxis - 2, std::string(kPlot, '-'));
}

/// X beyond a control limit, # beyond the tolerance.
char mark_of(const RunChart& chart, std::size_t index, double value_mm) {
  if (chart.upper_limit_mm && value_mm > *chart.upper_limit_mm) return '#';
  if (chart.lower_limit_mm && value_mm < *chart.lower_limit_mm) return '#';
  return std::binary_search(chart.beyond.begin(), chart.beyond.end(), index) ? 'X' : 'o';
}

void draw_results(TextCanvas& canvas, const RunChart& chart, const std::vector<double>& values_mm) {
  const std::size_t n = values_mm.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t column = (2 * i + 1) * kPlot / (2 * n);
    canvas.put(column, values_mm[i] / core::kMicrometre, mark_of(chart, i, values_mm[i]));
  }
}

std::string head_of(const RunChart& chart) {
  const record::ArchivedResult& r = chart.results.back();
  return wrapped("", fmt::format("{} {} of {} / {}, part {}", r.result.symbol, r.result.reference,
                                 shortened(printable(r.result.feature), 60),
                                 shortened(printable(r.result.characteristic), 60),
                                 shortened(printable(r.head.part_id), 60))) +
         wrapped("", fmt::format("{}; {}; {}", printable(r.result.filter),
                                 shortened(printable(r.result.sampling), 60),
                                 count(chart.results.size(), "result", "results"))) +
         "\n";
}

std::string legend_of(const RunChart& chart) {
  const std::string from = chart.results.front().head.started_utc.substr(0, 10);
  const std::string to = chart.results.back().head.started_utc.substr(0, 10);
  std::string out = fmt::format("{}{}{:>{}}\n\n", std::string(kAxis, ' '), printable(from),
                                printable(to), kPlot - columns(printable(from)));
  out += "o result   X beyond a control limit   # beyond the tolerance\n";
  const double per_column = static_cast<double>(chart.results.size()) / static_cast<double>(kPlot);
  if (per_column > 1.0) {
    out += fmt::format("one column stands for {:.1f} results\n", per_column);
  }
  return out;
}

int severity_of(const record::ArchivedResult& one) {
  for (const auto& word : words_of(evaluation::Verdict::kConforms)) {
    if (one.result.verdict == word.text) return severity(word.value);
  }
  return -1;
}

/// Share of the limit as Callout has it; 0 where there is none.
double share_of(const record::ArchiveResult& one) {
  if (!one.value) return 0.0;
  if (one.upper_limit && one.lower_limit) {
    const double half = 0.5 * (*one.upper_limit - *one.lower_limit);
    return half > 0.0 ? std::abs(*one.value - *one.lower_limit - half) / half : 0.0;
  }
  const bool size = one.symbol.starts_with("d ");
  return one.upper_limit && *one.upper_limit > 0.0 && !size ? *one.value / *one.upper_limit : 0.0;
}

/// One run: how many of its results conform, and the one that decides or is nearest to its limit.
std::string run_line(std::span<const record::ArchivedResult> run) {
  const auto& worst = *std::ranges::max_element(run, {}, [](const record::ArchivedResult& one) {
    return std::pair(severity_of(one), share_of(one.result));
  });
  const auto number = [&](evaluation::Verdict verdict) {
    return std::ranges::count_if(
        run, [&](const auto& one) { return one.result.verdict == name_of(verdict); });
  };
  const auto toleranced = std::ssize(run) - number(evaluation::Verdict::kNotToleranced);
  const std::string value = worst.result.value
                                ? fmt::format("{} {}", um(*worst.result.value),
                                              name_of(unit_of_archive(worst.result.unit)))
                                : "-";
  std::string line =
      fmt::format("{} {} {} {:>7} {} {:>11} {}", cell(minute_of(worst.head.started_utc), 16),
                  cell(worst.head.part_id, 8), cell(worst.head.serial, 7),
                  fmt::format("{}/{}", number(evaluation::Verdict::kConforms), toleranced),
                  cell(worst.result.characteristic, 9), value, cell(worst.result.verdict, 16));
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

bool in_one_run(const record::ArchivedResult& one, const record::ArchivedResult& other) {
  return one.run == other.run && one.head.run_id == other.head.run_id;
}

std::string history_table(std::span<const record::ArchivedResult> newest_first) {
  std::string out = "started (UTC)    part     serial  conform nearest         value verdict\n";
  for (auto left = newest_first; !left.empty();) {
    const auto first = std::ranges::find_if(left.rbegin(), left.rend(), [&](const auto& one) {
                         return !in_one_run(one, left.back());
                       }).base();
    out += run_line({first, left.end()});
    left = {left.begin(), first};
  }
  return out;
}

std::string history_chart(const RunChart& chart, bool coloured) {
  if (chart.results.empty()) return "no result with a value\n";
  const std::vector<double> values_mm = values_of(chart);
  const ChartRange range = range_of(chart);
  TextCanvas canvas(range.low_mm / core::kMicrometre, range.high_mm / core::kMicrometre,
                    unit_of(chart));
  const auto line = [&](double value_mm, char mark, std::string_view name) {
    canvas.line(value_mm / core::kMicrometre, mark, fmt::format("{} {}", name, um(value_mm)));
  };
  if (chart.limits) {
    line(chart.limits->lower_mm, '-', "LCL");
    line(chart.limits->center_mm, '.', "CL");
    line(chart.limits->upper_mm, '-', "UCL");
  }
  if (chart.upper_limit_mm) line(*chart.upper_limit_mm, '=', "U");
  if (chart.lower_limit_mm) line(*chart.lower_limit_mm, '=', "L");
  draw_results(canvas, chart, values_mm);
  std::string out = head_of(chart) + canvas.text(coloured) + legend_of(chart);
  if (chart.limits) {
    out += wrapped("",
                   "UCL, CL, LCL: control limits and centre of individuals (I-MR chart of ln x); "
                   "U: tolerance" +
                       std::string(chart.lower_limit_mm ? "; L: its lower limit" : ""));
  }
  if (chart.upper_limit_mm && !range.limit_shown) {
    out += fmt::format("the tolerance, {} {}, is above the chart\n", um(*chart.upper_limit_mm),
                       name_of(unit_of(chart)));
  }
  if (const std::string words = capability_in_words(chart); !words.empty()) {
    out.append("\n").append(wrapped("", words));
  }
  for (const core::Phrase& note : chart.notes) out += wrapped("note: ", note.english());
  return out;
}

}  // namespace rondure::reports
