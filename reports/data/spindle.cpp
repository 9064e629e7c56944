#include "reports/data/analyses.h"
#include "reports/data/internal/json_parts.h"

namespace rondure::reports {
namespace {

Json layout_json(const fit::ProbeLayout& layout) {
  return {{"p1_to_p2_deg", in_deg(layout.phi2_rad())},
          {"p2_to_p3_deg", in_deg(layout.phi3_rad())},
          {"weights", layout.weights()},
          {"weight_norm", layout.weight_norm()}};
}

Json harmonic_json(const fit::RecoveredHarmonic& h) {
  return {{"order", h.order},
          {"recovered", h.known()},
          {"amplitude_um", h.known() ? Json(in_um(h.amplitude_mm)) : Json(nullptr)},
          {"phase_deg", h.phase_rad ? Json(in_deg(*h.phase_rad)) : Json(nullptr)},
          {"transfer", h.transfer},
          {"gain", h.gain < 1e300 ? Json(h.gain) : Json(nullptr)},
          {"u_um", h.known() ? Json(in_um(h.sigma_mm)) : Json(nullptr)}};
}

Json motion_json(const fit::AxisMotion& motion) {
  return {{"total_um", in_um(motion.total_mm)},
          {"synchronous_um", in_um(motion.synchronous_mm)},
          {"asynchronous_um", optional_um(motion.asynchronous_mm)},
          {"fundamental_um", in_um(motion.fundamental_mm)}};
}

Json roundness_json(const fit::RoundnessEvaluation& evaluation) {
  const bool filtered = evaluation.filter.filter != fit::ProfileFilter::kNone;
  Json json = {{"filter", filtered ? "gaussian" : "none"},
               {"cutoff_upr", filtered ? Json(evaluation.filter.cutoff_upr) : Json(nullptr)}};
  for (const fit::Roundness& value : evaluation.values) {
    Json one = {{"RONt_um", in_um(value.total_mm)}};
    if (value.parameters) {
      one["RONp_um"] = in_um(value.parameters->peak_mm);
      one["RONv_um"] = in_um(value.parameters->valley_mm);
      one["RONq_um"] = in_um(value.parameters->rms_mm);
    }
    json[std::string(fit::name_of(value.reference))] = std::move(one);
  }
  return json;
}

Json curves_json(const fit::ThreeProbeResult& s) {
  std::vector<double> theta;
  for (std::size_t n = 0; n < s.profile.r_mm.size(); ++n) theta.push_back(s.profile.angle_rad(n));
  return {{"theta_deg", list_json(theta, in_deg)},
          {"alpha_deg", list_json(s.alpha_rad, in_deg)},
          {"profile_um", list_json(s.profile.r_mm, in_um)},
          {"RX_um", list_json(s.mean_motion.x_mm, in_um)},
          {"RY_um", list_json(s.mean_motion.y_mm, in_um)},
          {"RX_before_um", list_json(s.mean_motion_before.x_mm, in_um)},
          {"RY_before_um", list_json(s.mean_motion_before.y_mm, in_um)}};
}

}  // namespace

Json separation_json(const evaluation::SpindleResult& facts) {
  const fit::ThreeProbeResult& s = facts.separation;
  Json json;
  json["mode"] = facts.arm.swings() ? "tracking" : "static";
  json["layout"] = layout_json(s.layout);
  json["revolutions"] = s.revolutions;
  json["readings"] = s.readings;
  json["samples"] = s.profile.r_mm.size();
  json["interpolated"] = s.interpolated;
  json["part"] = roundness_json(facts.roundness);
  json["motion"] = {{"X", motion_json(facts.x)}, {"Y", motion_json(facts.y)}};
  json["eccentricity_um"] = in_um(s.eccentricity_mm);
  json["eccentricity_deg"] = in_deg(s.eccentricity_rad);
  json["noise_um"] = in_um(s.noise_mm);
  json["noise_estimated"] = s.noise_estimated;
  json["profile_u_um"] = in_um(s.profile_sigma_mm);
  json["first_harmonic_um"] = in_um(s.first_harmonic_mm);
  json["first_harmonic_limit_um"] = in_um(s.first_harmonic_limit_mm);
  json["least_error_shown"] = s.least_error_shown < 1.0 ? Json(s.least_error_shown) : Json(nullptr);
  json["residual_rms_um"] = in_um(s.residual_rms_mm);
  json["second_order_passes"] = s.second_order_passes;
  json["unrecovered"] = s.unrecovered;
  json["harmonics"] = list_json(s.harmonics, harmonic_json);
  json["curves"] = curves_json(s);
  return json;
}

}  // namespace rondure::reports
