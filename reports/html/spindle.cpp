#include <algorithm>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/spindle/result.h"
#include "reports/html/internal/plot_curve.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::fixed;
using core::um;

std::vector<double> scaled_um(const std::vector<double>& values_mm) {
  std::vector<double> out;
  out.reserve(values_mm.size());
  for (const double value : values_mm) out.push_back(value / core::kMicrometre);
  return out;
}

std::vector<double> profile_angles(const fit::UniformProfile& profile) {
  std::vector<double> out;
  for (std::size_t n = 0; n < profile.r_mm.size(); ++n) out.push_back(profile.angle_rad(n));
  return out;
}

std::string motion_entry(const std::string& direction, const fit::AxisMotion& motion) {
  return entry(
      trf("Motion {}, total", direction),
      with_note(um(motion.total_mm) + " µm",
                trf("synchronous {} µm, {}", um(motion.synchronous_mm),
                    motion.asynchronous_mm ? trf("asynchronous {} µm", um(*motion.asynchronous_mm))
                                           : tr("one revolution shows no asynchronous part"))));
}

std::string key_numbers(const evaluation::SpindleResult& facts) {
  const fit::ThreeProbeResult& s = facts.separation;
  std::string html = R"(<dl class="keys">)";
  for (const fit::Roundness& value : facts.roundness.values) {
    const bool ls = value.reference == fit::CircleReference::kLs;
    std::string note;
    if (ls && value.parameters) {
      note = fmt::format("RONp {}, RONv {}, RONq {} µm", um(value.parameters->peak_mm),
                         um(value.parameters->valley_mm), um(value.parameters->rms_mm));
    }
    const std::string name =
        trf("Part, RONt about {}CI", ls                                             ? "LS"
                                     : value.reference == fit::CircleReference::kMz ? "MZ"
                                     : value.reference == fit::CircleReference::kMc ? "MC"
                                                                                    : "MI");
    html += entry(name, with_note(um(value.total_mm) + " µm", note), ls ? "lead" : "");
  }
  html += motion_entry("X", facts.x) + motion_entry("Y", facts.y);
  html += entry(tr("Eccentricity"),
                with_note(um(s.eccentricity_mm) + " µm",
                          trf("toward {}° on the part; taken out of the motion, with any "
                              "motion of the same shape",
                              deg(s.eccentricity_rad, 2))));
  html +=
      entry(tr("Noise of a reading"),
            with_note(um(s.noise_mm) + " µm", s.noise_estimated ? tr("estimated from the readings")
                                                                : tr("as stated in the plan")));
  html += entry(tr("Profile known to"),
                with_note(um(s.profile_sigma_mm) + " µm",
                          tr("rms, one standard uncertainty from probe noise")));
  html += entry(tr("Check at one undulation"),
                with_note(um(s.first_harmonic_mm) + " µm",
                          trf("must vanish; limit {} µm. A pass is no proof of the angles",
                              um(s.first_harmonic_limit_mm))));
  const auto angles = s.layout.angles_rad();
  html +=
      entry(tr("Probes"),
            trf("{} with probes at 0°, {}° and {}°; weights 1, {}, {}",
                facts.arm.swings() ? tr("tracking") : tr("static"), deg(angles[1]), deg(angles[2]),
                fixed(s.layout.weights()[1], 6), fixed(s.layout.weights()[2], 6)),
            "wide-key");
  return html + "</dl>";
}

/// Adds the truth of a simulation as a curve, if there is any.
void add_truth(const record::Series* truth, const char* column, std::vector<Curve>& curves) {
  if (truth == nullptr) return;
  const auto angles = truth->column("angle_deg");
  auto values = truth->column(column);
  if (!angles || !values) return;
  Curve curve{tr("hidden truth"), "zone-outer", {}, *std::move(values)};
  for (const double angle : *angles) curve.x.push_back(angle * core::kDegree);
  curves.push_back(std::move(curve));
}

std::string part_plot(const evaluation::SpindleResult& facts, const record::Series* truth) {
  std::vector<Curve> curves;
  add_truth(truth, "profile_um", curves);
  const fit::UniformProfile& profile = facts.separation.profile;
  curves.push_back({tr("part"), "profile", profile_angles(profile), scaled_um(profile.r_mm)});
  return polar_chart(tr("Part, harmonics recovered"), curves);
}

std::string motion_plot(const std::string& title, const std::vector<double>& alpha_rad,
                        const fit::AxisMotion& motion) {
  std::vector<Curve> curves;
  for (std::size_t j = 0; j < motion.turns_mm.size() && motion.turns_mm.size() > 1; ++j) {
    curves.push_back({j == 0 ? tr("revolutions") : std::string(), "guide", alpha_rad,
                      scaled_um(motion.turns_mm[j])});
  }
  curves.push_back({tr("synchronous"), "profile", alpha_rad, scaled_um(motion.mean_mm)});
  return polar_chart(title, curves);
}

/// Every revolution minus the mean revolution.
std::string asynchronous_plot(const std::string& title, const std::vector<double>& alpha_rad,
                              const fit::AxisMotion& motion) {
  if (motion.turns_mm.size() < 2) return {};
  std::vector<Curve> curves;
  for (const auto& turn : motion.turns_mm) {
    std::vector<double> apart;
    for (std::size_t n = 0; n < turn.size(); ++n)
      apart.push_back((turn[n] - motion.mean_mm[n]) / core::kMicrometre);
    curves.push_back({"", "profile", alpha_rad, std::move(apart)});
  }
  return polar_chart(title, curves, false);
}

std::string harmonic_plots(const evaluation::SpindleResult& facts,
                           const std::vector<record::Characteristic>& asked) {
  std::vector<Bar> amplitudes;
  std::vector<Bar> gains;
  for (const fit::RecoveredHarmonic& h : facts.separation.harmonics) {
    amplitudes.push_back({h.order, h.amplitude_mm / core::kMicrometre, !h.known()});
    gains.push_back({h.order, h.recovered ? h.gain : 0.0, !h.recovered});
  }
  const std::string orders = tr("undulations per revolution");
  return fmt::format(
      R"(<h3>{}</h3><div class="scroll">{}{}</div>)", tr("Harmonics of the part"),
      bar_chart(tr("Amplitudes before the filter; lines: limits of the mask; crosses: not "
                   "recovered"),
                orders, tr("amplitude in µm"), amplitudes, limits_of(asked)),
      bar_chart(tr("Noise gain: how much the separation amplifies the noise of a probe"), orders,
                tr("gain"), gains));
}

/// The ten largest harmonics, and all harmonics that were not recovered.
std::string harmonic_table(const fit::ThreeProbeResult& s) {
  std::vector<fit::RecoveredHarmonic> shown = s.harmonics;
  std::stable_sort(shown.begin(), shown.end(), [](const auto& a, const auto& b) {
    return a.known() != b.known() ? b.known() : a.amplitude_mm > b.amplitude_mm;
  });
  const std::size_t count = std::min(shown.size(), s.unrecovered.size() + 10);
  TableRows rows;
  for (std::size_t i = 0; i < count; ++i) {
    const fit::RecoveredHarmonic& h = shown[i];
    rows.push_back({std::to_string(h.order),
                    h.known() ? fixed(h.amplitude_mm / core::kMicrometre, 4) : tr("not recovered"),
                    h.phase_rad ? deg(*h.phase_rad, 2) : "–",
                    h.known() ? fixed(h.sigma_mm / core::kMicrometre, 4) : "–", fixed(h.gain, 2)});
  }
  return scrolling(table("short", "rrrrr", spoken_caption(tr("Harmonics of the part")),
                         {"UPR", tr("Amplitude µm"), tr("Phase °"), "u µm", tr("Gain")}, rows)) +
         note(tr("The ten largest, and those not recovered; all are in report.json."));
}

std::string words_of_spindle() {
  return explained("RONt, RONq",
                   tr("Roundness of the part alone, free of the motion of the spindle: greatest "
                      "departure from the reference circle, outward plus inward, and root mean "
                      "square departure.")) +
         explained(
             tr("Motion"),
             tr("Error motion of the axis in one fixed direction (ISO 230-7), free of the form "
                "of the part. Synchronous: peak to valley of the mean revolution, which every "
                "revolution repeats. Asynchronous: greatest spread of the revolutions at one "
                "angle, which no correction removes. Total: peak to valley of all.")) +
         explained(
             tr("Noise gain"),
             tr("Three probes at fixed angles see some harmonics weakly: the noise of a probe "
                "is amplified there by this factor."));
}

}  // namespace

std::string analysis_part(const evaluation::SpindleResult& facts, const record::RunRecord& record,
                          int feature) {
  const fit::ThreeProbeResult& s = facts.separation;
  const record::Series* truth = record.truth_series_of(feature, "truth");
  std::string html = fmt::format(
      R"(<h3>{}</h3><p class="note">{}</p><div class="multiples">)", tr("Part and motion"),
      tr("Deviations against a mean circle; every plot has its own magnification, the bar says "
         "which. Motion is shown over the work angle, about the least-squares centre of its mean "
         "revolution (ISO 230-7, fixed direction)."));
  html += part_plot(facts, truth);
  html += motion_plot(tr("Motion X"), s.alpha_rad, facts.x);
  html += motion_plot(tr("Motion Y"), s.alpha_rad, facts.y);
  html += asynchronous_plot(tr("Asynchronous X"), s.alpha_rad, facts.x);
  html += asynchronous_plot(tr("Asynchronous Y"), s.alpha_rad, facts.y);
  html += "</div>" + as_read_note() + key_numbers(facts) + words_of_spindle();
  const auto& asked = record.features[static_cast<std::size_t>(feature)].characteristics;
  return html + harmonic_plots(facts, asked) + harmonic_table(s);
}

}  // namespace rondure::reports
