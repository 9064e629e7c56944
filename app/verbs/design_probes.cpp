// `rondure design-probes`.

#include <array>
#include <cmath>
#include <span>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/verbs/verbs.h"
#include "core/units.h"
#include "fit/spindle/probe_layout.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;

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

core::Result<fit::LayoutSearch> search_of(const DesignArguments& arguments) {
  fit::LayoutSearch out = arguments.search;
  if (arguments.p2_deg.size() != 2 || arguments.p3_deg.size() != 2) {
    return core::fail(core::Code::kBadOption, "--p2 and --p3 need two numbers each: LO,HI");
  }
  out.p2_range_deg = {arguments.p2_deg[0], arguments.p2_deg[1]};
  out.p3_range_deg = {arguments.p3_deg[0], arguments.p3_deg[1]};
  return out;
}

}  // namespace

int design_probes(const DesignArguments& arguments) {
  const auto search = search_of(arguments);
  if (!search) return refuse(search.error());
  const auto found = fit::design_layout(*search);
  if (!found) return refuse(found.error());
  return answer(layouts_json(*found, *search), arguments.json,
                [&] { return layouts_table(*found, *search); });
}

}  // namespace rondure::app
