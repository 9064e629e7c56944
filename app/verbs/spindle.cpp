#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/units.h"
#include "evaluation/spindle/result.h"
#include "fit/spindle/probe_layout.h"
#include "record/csv/series.h"
#include "record/files.h"
#include "reports/data/spindle.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;

std::string harmonic_lines(const fit::ThreeProbeResult& s) {
  std::string out = "   UPR  amplitude um   phase deg       u um    gain  |G|\n";
  for (const fit::RecoveredHarmonic& h : s.harmonics) {
    out += fmt::format("  {:4}  ", h.order);
    out += h.known()
               ? fmt::format("{:12.5f}  {:>10}  {:9.5f}", core::micrometres(h.amplitude_mm),
                             h.phase_rad ? fmt::format("{:.3f}", core::degrees(*h.phase_rad)) : "-",
                             core::micrometres(h.sigma_mm))
               : fmt::format("{:>12}  {:>10}  {:>9}", "lost", "-", "-");
    out += fmt::format("  {:6.2f}  {:.4f}\n", h.gain, h.transfer);
  }
  return out;
}

std::string motion_line(const char* name, const fit::AxisMotion& m) {
  return fmt::format("  motion {}  total {:.4f} um, synchronous {:.4f} um{}\n", name,
                     core::micrometres(m.total_mm), core::micrometres(m.synchronous_mm),
                     m.asynchronous_mm ? fmt::format(", asynchronous {:.4f} um",
                                                     core::micrometres(*m.asynchronous_mm))
                                       : std::string());
}

/// Angles of P2 and P3 from P1, in -180..180 deg.
std::array<double, 2> places_deg(const fit::ProbeLayout& layout) {
  const auto angles = layout.angles_rad();
  return {std::remainder(core::degrees(angles[1]), 360.0),
          std::remainder(core::degrees(angles[2]), 360.0)};
}

double rms_gain(const fit::ProbeLayout& layout, const fit::LayoutSearch& search) {
  double sum = 0.0;
  for (int order = search.first; order <= search.last; ++order)
    sum += std::pow(layout.gain(order), 2);
  return std::sqrt(sum / (search.last - search.first + 1));
}

Json layout_json(const fit::ProbeLayout& layout, const fit::LayoutSearch& search) {
  const auto places = places_deg(layout);
  const fit::WorstGain worst = fit::worst_gain(layout, search.first, search.last);
  return {{"p1_to_p2_deg", places[0]},
          {"p1_to_p3_deg", places[1]},
          {"p2_to_p3_deg", core::degrees(layout.phi3_rad())},
          {"worst_gain", worst.gain},
          {"worst_order", worst.order},
          {"rms_gain", rms_gain(layout, search)},
          {"weights", layout.weights()}};
}

std::string layout_line(std::string_view name, const fit::ProbeLayout& layout,
                        const fit::LayoutSearch& search) {
  const auto places = places_deg(layout);
  const fit::WorstGain worst = fit::worst_gain(layout, search.first, search.last);
  return fmt::format("  {:<12} {:>11.4f} {:>11.4f} {:>10.3f} {:>6} {:>9.3f}\n", name, places[0],
                     places[1], worst.gain, worst.order, rms_gain(layout, search));
}

nlohmann::ordered_json spindle_json(const evaluation::SpindleResult& result) {
  Json out = reports::separation_json(result);
  out["warnings"] = warnings_json(result.separation.warnings);
  for (Json& w : warnings_json(result.roundness.warnings)) out["warnings"].push_back(std::move(w));
  add_no_interval(out, "spindle");
  return out;
}

std::string spindle_table(const evaluation::SpindleResult& result) {
  const fit::ThreeProbeResult& s = result.separation;
  const auto places = places_deg(s.layout);
  std::string out = fmt::format("Three-probe separation, {}: {} readings, {} revolution{}\n",
                                result.arm.swings() ? "tracking" : "static", s.readings,
                                s.revolutions, s.revolutions == 1 ? "" : "s");
  out += fmt::format("  probes    P1 0, P2 {:.4f}, P3 {:.4f} deg; weights 1, {:.6f}, {:.6f}\n",
                     places[0], places[1], s.layout.weights()[1], s.layout.weights()[2]);
  for (const fit::Roundness& value : result.roundness.values) {
    out += fmt::format("  part      RONt {} {:.4f} um{}\n", fit::name_of(value.reference),
                       core::micrometres(value.total_mm),
                       value.parameters ? fmt::format("  RONq {:.4f} um",
                                                      core::micrometres(value.parameters->rms_mm))
                                        : std::string());
  }
  out += motion_line("X", result.x) + motion_line("Y", result.y);
  out += fmt::format("  eccentricity {:.4f} um at {:.2f} deg, taken out of the motion\n",
                     core::micrometres(s.eccentricity_mm), core::degrees(s.eccentricity_rad));
  out += fmt::format("  noise     {:.5f} um a reading ({}); profile known to {:.5f} um rms\n",
                     core::micrometres(s.noise_mm), s.noise_estimated ? "estimated" : "stated",
                     core::micrometres(s.profile_sigma_mm));
  out += fmt::format(
      "  check     {:.5f} um at one undulation, limit {:.5f} um; {}\n",
      core::micrometres(s.first_harmonic_mm), core::micrometres(s.first_harmonic_limit_mm),
      s.least_error_shown < 0.1
          ? fmt::format("shows a probe gain from {:.2g} % off, an angle from {:.2g} deg",
                        100.0 * s.least_error_shown, core::degrees(s.least_error_shown))
      : s.turns_against_work()
          ? std::string("blind to gains and angles")
          : std::string("blind to gains and angles: mount 5 to 20 um off centre"));
  for (const auto* warnings : {&s.warnings, &result.roundness.warnings}) {
    for (const core::Error& w : *warnings) out += fmt::format("  warning   {}\n", core::to_line(w));
  }
  return out + no_interval_text("spindle") + harmonic_lines(s);
}

nlohmann::ordered_json layouts_json(std::span<const fit::DesignedLayout> layouts,
                                    const fit::LayoutSearch& search) {
  Json out;
  out["first_order"] = search.first;
  out["last_order"] = search.last;
  out["layouts"] = Json::array();
  for (const fit::DesignedLayout& designed : layouts)
    out["layouts"].push_back(layout_json(designed.layout, search));
  for (const fit::NamedLayout& known : fit::named_layouts())
    out["for_comparison"][std::string(known.name)] = layout_json(known.layout, search);
  return out;
}

std::string layouts_table(std::span<const fit::DesignedLayout> layouts,
                          const fit::LayoutSearch& search) {
  std::string out = fmt::format("Least worst noise gain of harmonics {} to {} (P1 at 0 deg)\n",
                                search.first, search.last);
  out += "  layout            P2 deg      P3 deg worst gain  order  rms gain\n";
  int number = 0;
  for (const fit::DesignedLayout& designed : layouts)
    out += layout_line(fmt::format("{}", ++number), designed.layout, search);
  for (const fit::NamedLayout& known : fit::named_layouts())
    out += layout_line(known.name, known.layout, search);
  return out;
}

using core::Code;
using core::kDegree;
using core::kMicrometre;

constexpr std::array<record::WantedColumn, 5> kColumns = {
    {{"alpha_deg"}, {"H1_um"}, {"H2_um"}, {"H3_um"}, {"beta_deg", false}}};

/// Checks that the layout is known by one complete set of angles.
core::Result<void> check_layout(const record::SpindleTask& task) {
  const int own =
      (task.p1_to_p2_deg ? 1 : 0) + (task.p2_to_p3_deg ? 1 : 0) + (task.p1_to_p3_deg ? 1 : 0);
  const bool known = task.layout != record::SpindleTask::Layout::kAngles;
  if (known && own > 0) {
    return core::fail(Code::kBadOption, "give --layout or angles of your own, not both");
  }
  if (known || (own == 2 && task.p1_to_p2_deg)) return {};
  return core::fail(Code::kBadOption,
                    "the probe angles are not stated: give --p1-to-p2 and either --p2-to-p3 (a "
                    "difference) or --p1-to-p3 (cumulative), or a --layout");
}

core::Result<evaluation::SpindleResult> separate(const SpindleArguments& a) {
  TRY_DO(check_layout(a.task));
  TRY(const auto layout, evaluation::probe_layout(a.task));
  TRY(const auto bytes, record::read_file(a.file, record::kMostPointsBytes));
  const std::string name = std::filesystem::path(a.file).filename().string();
  TRY(const auto series, record::parse_series_csv(bytes, name, kColumns));
  auto result = evaluation::spindle_facts(
      evaluation::probe_readings(series),
      {a.task.crank_radius_mm, a.task.wheel_radius_mm, a.task.pin_radius_mm}, layout,
      evaluation::separation_options(a.task), a.task.cutoff_upr, a.inside);
  if (!result && result.error().where.empty()) return core::fail(result.error().at(name));
  return result;
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
  const auto result = separate(arguments);
  if (!result) return refuse(result.error());
  return answer(spindle_json(*result), arguments.json, [&] { return spindle_table(*result); });
}

int design_probes(const DesignArguments& arguments) {
  const auto search = search_of(arguments);
  if (!search) return refuse(search.error());
  const auto found = fit::design_layout(*search);
  if (!found) return refuse(found.error());
  return answer(layouts_json(*found, *search), arguments.json,
                [&] { return layouts_table(*found, *search); });
}

}  // namespace rondure::app
