#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/contour/result.h"
#include "reports/data/analyses.h"
#include "reports/escaping.h"
#include "reports/html/internal/plot_curve.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::fixed;
using core::um;

/// Lines of the parts: black, orange, blue, dotted, dashed; then repeated.
constexpr std::array<std::string_view, 5> kLines = {"profile", "zone-outer", "zone-inner", "guide",
                                                    "mean"};

std::vector<double> degrees_of(std::size_t count) {
  std::vector<double> out(count);
  for (std::size_t m = 0; m < count; ++m) {
    out[m] = 360.0 * static_cast<double>(m) / static_cast<double>(count);
  }
  return out;
}

Curve curve_of(std::string name, std::string_view css_class, const std::vector<double>& values,
               double unit) {
  Curve out{std::move(name), std::string(css_class), degrees_of(values.size()), values};
  for (double& value : out.y) value /= unit;
  return out;
}

using CurveOf = std::function<const std::vector<double>*(const fit::ContourPartResult&)>;

/// One line for each part; empty where no part has the curve.
std::string side_by_side(const evaluation::ContourResult& facts, std::string_view title,
                         std::string_view x_title, std::string_view y_title, double unit,
                         const CurveOf& curve) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const std::vector<double>* const values = curve(facts.study.parts[i]);
    if (values == nullptr) continue;
    curves.push_back(
        curve_of(trf("part {}", facts.names[i]), kLines[i % kLines.size()], *values, unit));
  }
  return curves.empty() ? std::string() : line_chart(title, x_title, y_title, curves);
}

constexpr const char* kBetaTitle = translatable("angle β on the pin / °");
constexpr const char* kAlphaTitle = translatable("C position α / °");

/// The hidden remainder of a simulated part, including its harmonics 0 and 1.
void add_truth(const record::RunRecord& record, int feature, std::size_t part,
               std::vector<Curve>& curves) {
  const auto* const truth = record.truth_series_of(feature, fmt::format("truth {}", part + 1));
  if (truth == nullptr) return;
  auto beta = truth->column("beta_deg");
  auto rest = truth->column("rest_um");
  if (!beta || !rest) return;
  curves.push_back({tr("hidden truth of n"), "mean", *std::move(beta), *std::move(rest)});
}

std::string separation_plot(const evaluation::ContourResult& facts, const record::RunRecord& record,
                            int feature, std::size_t i) {
  const fit::ContourPartResult& part = facts.study.parts[i];
  std::vector<Curve> curves;
  curves.push_back(
      curve_of(tr("t, measured"), "profile", part.pin.contour.error_mm, core::kMicrometre));
  curves.push_back(curve_of(part.traced ? tr("f, following") : tr("f, t less the main journal"),
                            "zone-outer", part.following.error_mm, core::kMicrometre));
  curves.push_back(curve_of(part.traced ? tr("n, not following") : tr("n, the main journal"),
                            "zone-inner", part.direct.rest_mm, core::kMicrometre));
  add_truth(record, feature, i, curves);
  return scrolling(
      line_chart(trf("Part {}", facts.names[i]), tr(kBetaTitle), tr("contour error / µm"), curves));
}

/// The separation of the first part, which shows what the analysis is about.
std::string first_separation(const evaluation::ContourResult& facts,
                             const record::RunRecord& record, int feature) {
  return fmt::format(R"(<h3>{}</h3><p class="note">{}</p>)", tr("Separation"),
                     facts.study.traced()
                         ? tr("t = f + n: the contour as measured, the share that follows "
                              "from the axis errors, and the rest.")
                         : tr("t = f + n: the contour as measured, t less the main journal, and "
                              "the main journal. No trace of the axes was taken: f and n are "
                              "those of the pin only as far as pin and main journal see the "
                              "same.")) +
         separation_plot(facts, record, feature, 0);
}

std::string other_separations(const evaluation::ContourResult& facts,
                              const record::RunRecord& record, int feature) {
  if (facts.study.parts.size() < 2) return {};
  std::string html = fmt::format("<h3>{}</h3>", tr("Separation of the other parts"));
  for (std::size_t i = 1; i < facts.study.parts.size(); ++i)
    html += separation_plot(facts, record, feature, i);
  return html;
}

std::string words_of_contour() {
  return explained("t, f, n",
                   tr("Contour error of the pin as measured; the part of it that follows from the "
                      "errors of the C and X axes, which a correction of their commands removes as "
                      "far as it repeats; and the rest, which does not follow from them.")) +
         explained(tr("Stability index"),
                   tr("Share of the mean square of a curve that repeats from part to part: 1 when "
                      "all parts have the same curve, 0 for curves that have nothing in common; "
                      "below 0 by chance. Only what repeats is worth correcting.")) +
         explained(tr("Spread"), tr("Standard deviation of the parts from their mean curve."));
}

std::string comparison_plots(const evaluation::ContourResult& facts) {
  using Part = fit::ContourPartResult;
  const double um_unit = core::kMicrometre;
  const std::string beta = tr(kBetaTitle);
  const std::string alpha = tr(kAlphaTitle);
  const std::string error = tr("contour error / µm");
  std::string html =
      fmt::format(R"(<h3>{}</h3><div class="scroll">)", tr("All parts side by side"));
  html += side_by_side(facts, tr("Contour errors t of the pins"), beta, error, um_unit,
                       [](const Part& p) { return &p.pin.contour.error_mm; });
  html += side_by_side(facts, tr("Main journals"), beta, error, um_unit,
                       [](const Part& p) { return p.main ? &p.main->contour.error_mm : nullptr; });
  html += side_by_side(facts, tr("Errors of the C axis"), alpha, "dα / mdeg", 1e-3 * core::kDegree,
                       [](const Part& p) { return p.traced ? &p.axes.errors.c_rad : nullptr; });
  html += side_by_side(facts, tr("Errors of the X axis"), alpha, "dd / µm", um_unit,
                       [](const Part& p) { return p.traced ? &p.axes.errors.x_mm : nullptr; });
  html += side_by_side(facts, tr("Following parts f"), beta, error, um_unit,
                       [](const Part& p) { return &p.following.error_mm; });
  html += side_by_side(facts, tr("Non-following parts n"), beta, error, um_unit,
                       [](const Part& p) { return &p.direct.rest_mm; });
  return html + "</div>";
}

/// Amplitudes of the mean contour, or of the only one, with the masks as lines.
std::string harmonic_plot(const evaluation::ContourResult& facts,
                          const std::vector<record::Characteristic>& asked) {
  const bool several = facts.study.total.has_value();
  const auto& curve =
      several ? facts.study.total->mean_curve : facts.study.parts.front().pin.contour.error_mm;
  std::vector<Bar> bars;
  for (const fit::Harmonic& h : fit::contour_harmonics(curve, 50)) {
    bars.push_back({h.number, h.amplitude_mm / core::kMicrometre});
  }
  return fmt::format(
      R"(<h3>{}</h3><div class="scroll">{}</div>)", tr("Harmonics"),
      bar_chart(several ? tr("Mean contour t of all parts") : tr("Contour t"),
                tr("undulations per revolution"), tr("amplitude / µm"), bars, limits_of(asked)));
}

std::string key_numbers(const evaluation::ContourResult& facts) {
  const fit::ContourStudy& study = facts.study;
  std::string html = R"(<dl class="keys">)";
  using Curve = evaluation::ContourNumber::Curve;
  const auto add = [&](const std::string& name, const std::optional<fit::Repeatability>& found,
                       Curve curve) {
    if (!found) return;
    const auto word = found->word();
    std::string words = trf("{}mean curve {} µm rms, spread {} µm",
                            word ? trf("{}; ", tr(fit::name_of(*word))) : std::string(),
                            um(found->mean_rms), um(found->spread));
    const auto stated = std::ranges::find_if(facts.numbers, [&](const auto& number) {
      return number.curve == curve && !number.part && number.uncertainty.result();
    });
    if (stated != facts.numbers.end())
      words += tr("; ") + trf("corrected {}", with_interval(*stated, "&le;"));
    html += entry(name, with_note(found->index ? fixed(*found->index, 4) : "–", words), "lead");
  };
  add(tr("Stability index of t"), study.total, Curve::kTotal);
  add(tr("Stability index of f"), study.following, Curve::kFollowing);
  add(tr("Stability index of n"), study.rest, Curve::kRest);
  add(tr("Stability index of the mains"), study.main, Curve::kMain);
  if (const auto& gain = facts.gain) {
    const double left_mm = fit::peak_to_valley(fit::mean_following(study));
    html += entry(tr("Mean f with the correction"), um(left_mm) + " µm PV", "lead") +
            entry(tr("Without it"),
                  with_note(um(gain->before_mm) + " µm PV",
                            trf("of feature {}: {} times what is left", isolated(gain->with),
                                fixed(gain->before_mm / left_mm, 1))));
  }
  if (study.amplitude_ratio > 0.0)
    html += entry("rms(f) / rms(n)", fixed(study.amplitude_ratio, 4));
  if (study.traced()) {
    html +=
        entry(tr("Correlation would turn f by"),
              with_note(deg(study.offset.angle_rad, 2) + "°",
                        tr("a diagnosis; nothing was turned unless the method is as-published")));
  }
  html += entry(tr("Method"), tr(fit::name_of(facts.options.method)), "wide-key");
  html += entry(tr("Separation"), tr(separation_of(study)), "wide-key");
  return html + "</dl>";
}

/// Peak to valley, rms and index of every curve with their intervals, and why some have none.
std::string interval_table(const evaluation::ContourResult& facts) {
  using Number = evaluation::ContourNumber;
  const auto symbol = [](Number::Curve curve) -> std::string {
    switch (curve) {
      case Number::Curve::kTotal:
        return "t";
      case Number::Curve::kFollowing:
        return "f";
      case Number::Curve::kRest:
        return "n";
      case Number::Curve::kIndirect:
        return tr("f from main");
      case Number::Curve::kMain:
        return tr("main journals");
    }
    return {};
  };
  TableRows rows;
  std::vector<std::string> reasons;
  for (const Number& number : facts.numbers) {
    const std::string curve = symbol(number.curve);
    const std::string value = with_interval(number, "&le;");
    if (!number.part) {
      rows.push_back({curve, "–", "–", "–", value});
    } else if (number.kind == Number::Kind::kPeakToValley) {
      rows.push_back({curve, isolated(facts.names[*number.part]), value, "–", "–"});
    } else {
      rows.back()[3] = value;  // the rms of a part follows its peak to valley
    }
    if (number.uncertainty.result()) continue;
    std::string reason =
        fmt::format("<li>{}: {}</li>", curve, in_sentence(number.uncertainty.why()));
    if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end()) {
      reasons.push_back(std::move(reason));
    }
  }
  if (rows.empty()) return {};
  std::string html =
      fmt::format(R"(<h3>{}</h3>{})", tr("Intervals"),
                  scrolling(table("short", "llrrr", spoken_caption(tr("Intervals")),
                                  {tr("Curve"), tr("Part"), "PV µm", "rms µm", "S"}, rows)));
  if (reasons.empty()) return html;
  html += fmt::format(R"(<p class="note">{}</p><ul>)", tr("As measured, without an interval:"));
  for (const std::string& reason : reasons) html += reason;
  return html + "</ul>";
}

std::string part_table(const evaluation::ContourResult& facts) {
  TableRows rows;
  const auto square = [](double mm2) {
    return fixed(mm2 / (core::kMicrometre * core::kMicrometre), 4);
  };
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const fit::ContourPartResult& part = facts.study.parts[i];
    const fit::ContourSeparation& d = part.direct;
    rows.push_back({isolated(facts.names[i]), um(part.pin.contour.peak_to_valley_mm),
                    um(part.following.peak_to_valley_mm), um(fit::peak_to_valley(d.rest_mm)),
                    square(d.total_mm2), square(d.following_mm2), square(d.rest_mm2),
                    square(d.cross_mm2), d.enlarges() ? tr("enlarges") : tr("reduces"),
                    part.indirect ? fixed(part.indirect->correlation, 4) : "–"});
  }
  return fmt::format(R"(<h3>{}</h3>{}<p class="note">{}</p>)", tr("Balance"),
                     scrolling(table("short", "lrrrrrrrlr", spoken_caption(tr("Balance")),
                                     {tr("Part"), "t µm", "f µm", "n µm", tr("mean t² µm²"), "f²",
                                      "n²", "2 f n", "n … t", tr("f from main")},
                                     rows)),
                     tr("t, f, n: peak to valley. The squares add up, the cross term included; rms "
                        "and peak to "
                        "valley do not. Last column: correlation of f with what the main journal "
                        "leaves of t.")) +
         interval_table(facts);
}

std::string verdict_list(const evaluation::ContourResult& facts) {
  std::string html = "<ul>";
  for (const core::Phrase& verdict : contour_verdicts(facts.study)) {
    html += fmt::format("<li>{}</li>", in_sentence(verdict));
  }
  return html + "</ul>";
}

}  // namespace

std::string analysis_part(const evaluation::ContourResult& facts, const record::RunRecord& record,
                          int feature) {
  const auto& asked = record.features[static_cast<std::size_t>(feature)].characteristics;
  return first_separation(facts, record, feature) + as_read_note() + key_numbers(facts) +
         words_of_contour() + verdict_list(facts) + part_table(facts) + comparison_plots(facts) +
         other_separations(facts, record, feature) + harmonic_plot(facts, asked);
}

}  // namespace rondure::reports
