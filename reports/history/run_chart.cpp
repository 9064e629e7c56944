#include "reports/history/run_chart.h"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "evaluation/results/evaluation.h"
#include "reports/terminal/internal/columns.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::printable;
using core::um;

using record::ArchivedResult;

bool has_value(const ArchivedResult& r) {
  return r.result.value && r.result.verdict != name_of(evaluation::Verdict::kVoid);
}

/// Whether values of both may be in one chart.
bool comparable(const ArchivedResult& a, const ArchivedResult& b) {
  return a.head.part_id == b.head.part_id && a.head.simulated == b.head.simulated &&
         a.result.feature == b.result.feature &&
         a.result.characteristic == b.result.characteristic && a.result.symbol == b.result.symbol &&
         a.result.reference == b.result.reference && a.result.filter == b.result.filter &&
         a.result.sampling == b.result.sampling && a.result.unit == b.result.unit;
}

/// "8.312 um"; an angle in urad.
std::string with_unit(std::string_view unit, double value_mm) {
  return fmt::format("{} {}", um(value_mm), name_of(unit_of_archive(unit)));
}

core::Phrase results_were(std::size_t number) {
  return number == 1 ? core::phrase("{} result was", number)
                     : core::phrase("{} results were", number);
}

void choose_results(RunChart& chart, std::span<const ArchivedResult> newest_first) {
  const auto newest = std::find_if(newest_first.begin(), newest_first.end(), has_value);
  std::size_t without = 0;
  std::size_t others = 0;
  for (const ArchivedResult& r : newest_first) {
    if (!has_value(r)) {
      ++without;
    } else if (comparable(r, *newest)) {
      chart.results.push_back(r);
    } else {
      ++others;
    }
  }
  std::reverse(chart.results.begin(), chart.results.end());
  if (others > 0) {
    chart.notes.push_back(
        core::phrase("{} left out: other part, characteristic, reference, filter or sampling, or "
                     "simulated beside real; filter for them to see them",
                     results_were(others)));
  }
  if (without > 0) {
    chart.notes.push_back(
        core::phrase("{} void or without a value and left out", results_were(without)));
  }
}

/// A note when the results differ in something that may move a value, but does not make it
/// another quantity.
void note_mixture(RunChart& chart, const core::Phrase& what,
                  const std::function<std::string(const ArchivedResult&)>& part) {
  std::set<std::string> kinds;
  for (const ArchivedResult& r : chart.results) kinds.insert(part(r));
  if (kinds.size() < 2) return;
  std::string names;
  for (const std::string& kind : kinds) {
    if (names.size() > 60) {
      names += ", ...";
      break;
    }
    names.append(names.empty() ? "" : ", ");
    names.append(kind.empty() ? std::string("not given") : shortened(printable(kind), 30));
  }
  chart.notes.push_back(core::phrase("mixed: {} {} ({})", kinds.size(), what, names));
}

void note_mixtures(RunChart& chart) {
  if (chart.results.front().head.simulated) {
    chart.notes.push_back(core::phrase("simulated: no real part was measured"));
  }
  note_mixture(chart, core::phrase("machines"), [](const auto& r) { return r.head.machine; });
  note_mixture(chart, core::phrase("fixtures"), [](const auto& r) { return r.head.fixture; });
  note_mixture(chart, core::phrase("persons"), [](const auto& r) { return r.head.operator_name; });
  note_mixture(chart, core::phrase("versions of the program"),
               [](const auto& r) { return r.head.version; });
  note_mixture(chart, core::phrase("plans"), [](const auto& r) {
    return fmt::format("{} {} {:.8}", r.head.plan_name, r.head.plan_revision, r.head.plan_sha256);
  });
  note_mixture(chart, core::phrase("upper limits"), [](const auto& r) {
    return r.result.upper_limit ? with_unit(r.result.unit, *r.result.upper_limit)
                                : std::string("none");
  });
  note_mixture(chart, core::phrase("lower limits"), [](const auto& r) {
    return r.result.lower_limit ? with_unit(r.result.unit, *r.result.lower_limit)
                                : std::string("none");
  });
}

/// Repeated measurements of one part show how well it is measured, not the spread of the process.
bool is_one_part(const RunChart& chart) {
  const std::string& serial = chart.results.front().head.serial;
  return !serial.empty() && std::all_of(chart.results.begin(), chart.results.end(),
                                        [&](const auto& r) { return r.head.serial == serial; });
}

void add_limits(RunChart& chart, const std::vector<double>& values) {
  const auto limits = control_limits(values);
  if (!limits) {
    chart.notes.push_back(core::phrase("no control limits: {}", limits.error().said()));
    return;
  }
  chart.limits = *limits;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] > limits->upper_mm || values[i] < limits->lower_mm) chart.beyond.push_back(i);
  }
  chart.allowed_beyond = static_cast<std::size_t>(0.0027 * static_cast<double>(values.size()));
  if (values.size() < kEnoughForLimits) {
    chart.notes.push_back(core::phrase("control limits are provisional: {} results, {} are needed",
                                       values.size(), kEnoughForLimits));
  }
}

void add_capability(RunChart& chart, const std::vector<double>& values) {
  if (!chart.upper_limit_mm && !chart.lower_limit_mm) {
    chart.notes.push_back(core::phrase("no capability: the characteristic has no tolerance"));
    return;
  }
  if (values.size() > 1 && is_one_part(chart)) {
    chart.notes.push_back(core::phrase(
        "no capability: all results are of one serial number; they show how well it is measured, "
        "not what the process makes"));
    return;
  }
  const auto capability = capability_between(values, chart.lower_limit_mm, chart.upper_limit_mm);
  if (!capability) {
    chart.notes.push_back(core::phrase("no capability: {}", capability.error().said()));
    return;
  }
  chart.capability = *capability;
  const bool controlled = chart.limits && chart.beyond.size() <= chart.allowed_beyond &&
                          values.size() >= kEnoughForIndex;
  const std::string side = !chart.lower_limit_mm ? "U" : !chart.upper_limit_mm ? "L" : "";
  chart.index_name = (controlled ? "Cpk" : "Ppk") + side;
  if (values.size() < kEnoughForIndex) {
    chart.notes.push_back(core::phrase("{} is a rough estimate: {} results, {} are needed",
                                       chart.index_name, values.size(), kEnoughForIndex));
  } else if (!controlled) {
    chart.notes.push_back(
        core::phrase("performance ({}), not capability ({}): {} beyond the control limits, {} "
                     "expected of a stable process",
                     "Ppk" + side, "Cpk" + side,
                     chart.beyond.size() == 1 ? core::phrase("{} result", chart.beyond.size())
                                              : core::phrase("{} results", chart.beyond.size()),
                     chart.allowed_beyond));
  }
}

}  // namespace

core::ValueUnit unit_of_archive(std::string_view unit) {
  return unit == "mrad" ? core::ValueUnit::kUrad : core::ValueUnit::kUm;
}

core::ValueUnit unit_of(const RunChart& chart) {
  return chart.results.empty() ? core::ValueUnit::kUm
                               : unit_of_archive(chart.results.back().result.unit);
}

RunChart run_chart_of(std::span<const ArchivedResult> newest_first) {
  RunChart chart;
  choose_results(chart, newest_first);
  if (chart.results.empty()) return chart;
  chart.upper_limit_mm = chart.results.back().result.upper_limit;
  chart.lower_limit_mm = chart.results.back().result.lower_limit;
  const std::vector<double> values = values_of(chart);
  add_limits(chart, values);
  add_capability(chart, values);
  note_mixtures(chart);
  return chart;
}

ChartRange range_of(const RunChart& chart) {
  const std::vector<double> values_mm = values_of(chart);
  const auto [low, high] = std::minmax_element(values_mm.begin(), values_mm.end());
  ChartRange out;
  out.low_mm = std::min(*low, chart.limits ? chart.limits->lower_mm : *low);
  out.high_mm = std::max(*high, chart.limits ? chart.limits->upper_mm : *high);
  if (chart.lower_limit_mm) {  // a size: what counts is its place between the limits
    out.limit_shown = chart.upper_limit_mm.has_value();
    out.low_mm = std::min(out.low_mm, *chart.lower_limit_mm);
    out.high_mm = std::max(out.high_mm, chart.upper_limit_mm.value_or(out.high_mm));
    const double room_mm = std::max(0.06 * (out.high_mm - out.low_mm), core::kMicrometre);
    out.low_mm -= room_mm;
    out.high_mm += room_mm;
    return out;
  }
  const double span_mm = std::max(out.high_mm - out.low_mm, 0.1 * out.high_mm);
  if (chart.upper_limit_mm && *chart.upper_limit_mm < out.low_mm + 4.0 * span_mm) {
    out.limit_shown = true;
    out.low_mm = std::min(out.low_mm, *chart.upper_limit_mm);
    out.high_mm = std::max(out.high_mm, *chart.upper_limit_mm);
  }
  const double room_mm = 0.06 * std::max(out.high_mm - out.low_mm, 0.02 * out.high_mm);
  out.low_mm = std::max(out.low_mm - room_mm, 0.0);
  out.high_mm += std::max(room_mm, 1e-9);
  return out;
}

std::vector<double> values_of(const RunChart& chart) {
  std::vector<double> out;
  for (const ArchivedResult& r : chart.results) out.push_back(r.result.value.value_or(0.0));
  return out;
}

core::Phrase capability_in_words(const RunChart& chart) {
  if (!chart.capability) return {};
  const Capability& c = *chart.capability;
  core::Phrase index = core::phrase("{} {}", chart.index_name, fixed(c.index, 2));
  if (c.lower_bound) {
    index = core::phrase("{}, at least {} with 95 % confidence", index, fixed(*c.lower_bound, 2));
  }
  const bool model = c.method == Capability::Method::kLogNormal;
  const auto number = [&](double value_mm) {
    return with_unit(chart.results.back().result.unit, value_mm);
  };
  const core::Phrase model_words =
      model ? core::phrase("fitted log-normal distribution") : core::phrase("results themselves");
  if (c.lower_point_mm) {
    const core::Phrase between = core::phrase(
        "0.135 % point {}, median {}, 99.865 % point {} of the {}", number(*c.lower_point_mm),
        number(c.median_mm), number(c.upper_point_mm), model_words);
    return core::phrase("{} ({})", joined(index, between),
                        core::phrase("Anderson-Darling p = {:.2g}", c.fit_p));
  }
  const core::Phrase percentiles =
      core::phrase("median {}, 99.865 % point {} of the {}", number(c.median_mm),
                   number(c.upper_point_mm), model_words);
  return core::phrase("{} ({})", joined(index, percentiles),
                      core::phrase("Anderson-Darling p = {:.2g}", c.fit_p));
}

}  // namespace rondure::reports
