#include "reports/terminal/analysis.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/analysis_result.h"
#include "reports/data/contour.h"

namespace rondure::reports {
namespace {

using core::um;

std::vector<SummaryLine> lines_of(const evaluation::SpindleResult& facts) {
  const fit::ThreeProbeResult& s = facts.separation;
  std::vector<SummaryLine> out;
  std::string part;
  for (const fit::Roundness& value : facts.roundness.values) {
    std::string name(fit::name_of(value.reference));
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return static_cast<char>(c - 'a' + 'A'); });
    part += fmt::format("{}{}CI {} um", part.empty() ? "RONt " : ", ", name, um(value.total_mm));
  }
  out.push_back({"part", part + "; " + filter_text(facts)});
  const auto direction = [](const char* name, const fit::AxisMotion& m) {
    if (!m.asynchronous_mm) {
      return fmt::format("{}: total {} um, synchronous {} um", name, um(m.total_mm),
                         um(m.synchronous_mm));
    }
    return fmt::format("{}: total {} um, synchronous {} um, asynchronous {} um", name,
                       um(m.total_mm), um(m.synchronous_mm), um(*m.asynchronous_mm));
  };
  out.push_back({"motion", direction("X", facts.x) + "; " + direction("Y", facts.y)});
  out.push_back({"eccentricity", um(s.eccentricity_mm) + " um"});
  const fit::WorstGain worst = fit::worst_gain(s.layout, 2, s.harmonics.back().order);
  out.push_back(
      {"noise gain", fmt::format("at most {:.2f}, at harmonic {}; profile known to {} um (rms, one "
                                 "standard uncertainty)",
                                 worst.gain, worst.order, um(s.profile_sigma_mm))});
  return out;
}

std::vector<SummaryLine> lines_of(const evaluation::WheelResult& facts) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  std::vector<SummaryLine> out = {
      {"wheel", fmt::format("R {:.6f} mm, u(R) {} um, PV {} um, centre ({:.6f}, {:.6f}) mm",
                            m.radius_mm, um(m.radius_uncertainty_mm), um(m.deviation_mm),
                            m.center_mm.x(), m.center_mm.y())}};
  if (m.runout) {
    const std::string& bound = m.runout->bound_because;
    out.push_back({"run-out",
                   bound.empty() ? fmt::format("{} um; effective radius {:.6f} mm",
                                               um(m.runout->fim_mm), m.runout->effective_radius_mm)
                                 : fmt::format("at least {} um: {}", um(m.runout->fim_mm), bound)});
  }
  const auto& e = facts.evaluation;
  if (e.path) {
    out.push_back(
        {"path", fmt::format("{} places, R k_s at most {:.4f}, PV left {} um", e.path->rows.size(),
                             e.path->load.load, um(e.forecast->measured.deviation_mm))});
  }
  if (e.refused) out.push_back({"no path", e.refused->what});
  return out;
}

std::vector<SummaryLine> lines_of(const evaluation::ContourResult& facts) {
  std::vector<SummaryLine> out;
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const fit::ContourPartResult& part = facts.study.parts[i];
    out.push_back({"part", fmt::format("{}: contour {} um PV; following {} um, not following {} um",
                                       facts.names[i], um(part.pin.contour.peak_to_valley_mm),
                                       um(part.following.peak_to_valley_mm),
                                       um(fit::peak_to_valley(part.direct.rest_mm)))});
  }
  for (const std::string& verdict : contour_verdicts(facts.study, facts.options.limits)) {
    out.push_back({out.size() == facts.study.parts.size() ? "stability" : "", verdict});
  }
  return out;
}

std::vector<SummaryLine> lines_of(const evaluation::RotaryResult& facts) {
  const fixture::Verification& v = facts.calibration.verification;
  std::vector<SummaryLine> out = {
      {"fixture", fmt::format("{}, valid until {}", facts.calibration.fixture_id,
                              facts.calibration.expires_utc)},
      {"before", fmt::format("{} um rms, {} um at most", um(v.before_rms_mm), um(v.before_max_mm))},
      {"compensated", fmt::format("{} um rms, {} um at most; {} um rms expected", um(v.rms_mm),
                                  um(v.max_mm), um(v.expected_mm))}};
  return out;
}

}  // namespace

std::vector<SummaryLine> summary_lines(const evaluation::AnalysisResult& result) {
  return std::visit([](const auto& found) { return lines_of(found); }, result.found);
}

}  // namespace rondure::reports
