#include <array>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/spindle.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/units.h"
#include "evaluation/spindle/result.h"
#include "record/csv/series.h"
#include "record/files.h"

namespace rondure::app {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;

constexpr std::array<record::WantedColumn, 5> kColumns = {
    {{"alpha_deg"}, {"H1_um"}, {"H2_um"}, {"H3_um"}, {"beta_deg", false}}};

/// One way of stating the angles, completely.
core::Result<fit::ProbeLayout> layout_of(const SpindleArguments& a) {
  const int own = (a.p1_to_p2_deg ? 1 : 0) + (a.p2_to_p3_deg ? 1 : 0) + (a.p1_to_p3_deg ? 1 : 0);
  if (a.layout && own > 0) {
    return core::fail(Code::kBadOption, "give --layout or angles of your own, not both");
  }
  using Layout = record::SpindleTask::Layout;
  if (a.layout == Layout::kPublishedA) return fit::published_layout_a();
  if (a.layout == Layout::kPublishedB) return fit::published_layout_b();
  if (a.layout == Layout::kReference) return fit::reference_layout();
  if (own != 2 || !a.p1_to_p2_deg) {
    return core::fail(Code::kBadOption,
                      "the probe angles are not stated: give --p1-to-p2 and either --p2-to-p3 (a "
                      "difference) or --p1-to-p3 (cumulative), or a --layout");
  }
  const double p2 = *a.p1_to_p2_deg;
  const double p3 = a.p2_to_p3_deg ? *a.p2_to_p3_deg : *a.p1_to_p3_deg - p2;
  return fit::ProbeLayout::of(p2 * kDegree, p3 * kDegree);
}

fit::ThreeProbeOptions options_of(const SpindleArguments& a) {
  using Options = fit::ThreeProbeOptions;
  Options out;
  out.samples = a.samples;
  out.highest = a.highest_order;
  out.greatest_gain = a.greatest_gain;
  if (a.probe_noise_um) out.noise_mm = *a.probe_noise_um * kMicrometre;
  out.resample = !a.no_resampling;
  if (a.expected_amplitude_um) {
    out.recovery = Options::Recovery::kTikhonov;
    out.expected_amplitude_mm = *a.expected_amplitude_um * kMicrometre;
  }
  using SecondOrder = record::SpindleTask::SecondOrder;
  if (a.second_order == SecondOrder::kOn) out.second_order = Options::SecondOrder::kOn;
  if (a.second_order == SecondOrder::kOff) out.second_order = Options::SecondOrder::kOff;
  if (a.as_published) out.motion = Options::Motion::kAsPublished;
  return out;
}

core::Result<evaluation::SpindleResult> separate(const SpindleArguments& a) {
  const auto layout = layout_of(a);
  if (!layout) return core::fail(layout.error());
  const auto bytes = record::read_file(a.file);
  if (!bytes) return core::fail(bytes.error());
  const std::string name = std::filesystem::path(a.file).filename().string();
  const auto series = record::parse_series_csv(*bytes, name, kColumns);
  if (!series) return core::fail(series.error());
  auto facts = evaluation::spindle_facts(evaluation::probe_readings(*series),
                                         {a.crank_radius_mm, a.wheel_radius_mm, a.pin_radius_mm},
                                         *layout, options_of(a), a.cutoff_upr, a.inside);
  if (!facts && facts.error().where.empty()) return core::fail(facts.error().at(name));
  return facts;
}

core::Result<fit::LayoutSearch> search_of(const DesignArguments& arguments) {
  fit::LayoutSearch out = arguments.search;
  if (arguments.p2_deg.size() != 2 || arguments.p3_deg.size() != 2) {
    return core::fail(Code::kBadOption, "--p2 and --p3 need two numbers each: LO,HI");
  }
  out.p2_range_deg = {arguments.p2_deg[0], arguments.p2_deg[1]};
  out.p3_range_deg = {arguments.p3_deg[0], arguments.p3_deg[1]};
  return out;
}

}  // namespace

int spindle(const SpindleArguments& arguments) {
  const auto facts = separate(arguments);
  if (!facts) {
    print_error(facts.error());
    return kBadInput;
  }
  return answer(spindle_json(*facts), arguments.json, [&] { return spindle_table(*facts); });
}

int design_probes(const DesignArguments& arguments) {
  const auto search = search_of(arguments);
  if (!search) {
    print_error(search.error());
    return kBadInput;
  }
  const auto found = fit::design_layout(*search);
  if (!found) {
    print_error(found.error());
    return kBadInput;
  }
  return answer(layouts_json(*found, *search), arguments.json,
                [&] { return layouts_table(*found, *search); });
}

}  // namespace rondure::app
