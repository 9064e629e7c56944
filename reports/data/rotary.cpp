
#include "core/units.h"
#include "evaluation/five_axis/result.h"
#include "evaluation/rotary/result.h"
#include "reports/data/internal/json_parts.h"

namespace rondure::reports {
namespace {

using core::kMicroradian;

Json um_list(const Eigen::Vector3d& v_mm) {
  return Json::array({in_um(v_mm.x()), in_um(v_mm.y()), in_um(v_mm.z())});
}

Json urad_list(const Eigen::Vector3d& v_rad) {
  return Json::array(
      {v_rad.x() / kMicroradian, v_rad.y() / kMicroradian, v_rad.z() / kMicroradian});
}

Json location_json(const std::optional<fit::AxisOffset>& offset) {
  if (!offset) return nullptr;
  return {{"d_um", um_list(offset->d_mm)},
          {"u_d_um", um_list(offset->d_u_mm)},
          {"e_urad", urad_list(offset->e_rad)},
          {"u_e_urad", urad_list(offset->e_u_rad)},
          {"zero_point_urad", offset->zero_point_rad / kMicroradian}};
}

Json station_json(const fixture::AxisStation& station) {
  const Eigen::Matrix<double, 6, 1> u = station.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return {{"angle_deg", in_deg(station.angle_rad)},
          {"shift_um", um_list(station.errors.shift_mm)},
          {"u_shift_um", um_list(u.head<3>())},
          {"tilt_urad", urad_list(station.errors.tilt_rad)},
          {"u_tilt_urad", urad_list(u.tail<3>())}};
}

Json measured_json(const fit::RotaryStation& station) {
  return {{"angle_deg", in_deg(station.angle_rad)},
          {"balls", station.balls.size()},
          {"removed", station.removed},
          {"undetermined", station.undetermined},
          {"flagged", station.flagged},
          {"chi2", station.chi2},
          {"chi2_limit", station.chi2_limit},
          {"condition", station.condition}};
}

Json axis_json(const evaluation::AxisFacts& axis) {
  return {{"s0", axis.study->s0},
          {"drift_um", in_um(axis.study->drift_mm)},
          {"location", location_json(axis.study->offset)},
          {"measured", list_json(axis.study->stations, measured_json)},
          {"stations", list_json(axis.motion->stations(), station_json)}};
}

Json combined_json(const evaluation::CombinedPose& pose) {
  return {{"alpha_deg", in_deg(pose.pose.alpha_rad)},
          {"beta_deg", in_deg(pose.pose.beta_rad)},
          {"balls", pose.points},
          {"rms_um", in_um(pose.rms_mm)},
          {"max_um", in_um(pose.max_mm)},
          {"tilt_urad", pose.tilt_rad / kMicroradian},
          {"before_rms_um", in_um(pose.before_rms_mm)}};
}

}  // namespace

Json rotary_json(const evaluation::RotaryResult& facts) {
  const fixture::Calibration& c = facts.calibration;
  const fixture::Verification& v = c.verification;
  Json json = {{"fixture", c.fixture_id},
               {"measured_utc", c.measured_utc},
               {"expires_utc", c.expires_utc},
               {"temperature_degC", c.temperature_degC ? Json(*c.temperature_degC) : Json(nullptr)},
               {"balls", facts.balls.size()},
               {"poses", facts.poses},
               {"touches", facts.touches},
               {"touch_sigma_um", in_um(facts.touch_sigma_mm)},
               {"center_u_um", in_um(facts.center_u_mm)},
               {"condition", facts.condition}};
  json["verification"] = {{"poses", list_json(facts.combined, combined_json)},
                          {"rms_um", in_um(v.rms_mm)},
                          {"max_um", in_um(v.max_mm)},
                          {"tilt_urad", v.max_tilt_rad / kMicroradian},
                          {"expected_rms_um", in_um(v.expected_mm)},
                          {"before_rms_um", in_um(v.before_rms_mm)},
                          {"before_max_um", in_um(v.before_max_mm)}};
  for (const evaluation::AxisFacts& axis : axes_of(facts)) json[axis.key] = axis_json(axis);
  return json;
}

Json five_axis_json(const evaluation::FiveAxisResult& facts) {
  const auto rms = [](const fit::HeadRms& of) -> Json {
    return {{"rms_um", in_um(of.rms_mm)}, {"max_um", in_um(of.max_mm)}};
  };
  Json json = {{"machine", facts.task.machine_id},
               {"expires_utc", facts.expires_utc},
               {"readings", facts.readings},
               {"reading_u_um", in_um(facts.noise_mm)},
               {"condition", facts.condition},
               {"reference_step_um", in_um(facts.study.reference_step_mm)},
               {"before", rms(facts.study.before)},
               {"left", rms(facts.left())},
               {"expected_rms_um", in_um(facts.study.expected_mm)},
               {"repeat", nullptr}};
  if (facts.gain) {
    json["repeat"] = {{"with", facts.gain->with},
                      {"before", rms(facts.gain->before)},
                      {"forecast_rms_um", in_um(facts.gain->forecast_mm)}};
  }
  json["locations"] = list_json(locations_of(facts), [](const evaluation::HeadLocation& one) {
    return Json{{"error", record::name_of(one.error)},
                {"unit", record::is_angle(one.error) ? "urad" : "um"},
                {"found", in_um(one.value_mm)},
                {"u", in_um(one.u_mm)}};
  });
  json["poses"] = list_json(facts.combined, [](const evaluation::CombinedPose& pose) {
    return Json{{"c_deg", in_deg(pose.pose.alpha_rad)},
                {"a_deg", in_deg(pose.pose.beta_rad)},
                {"balls", pose.points},
                {"rms_um", in_um(pose.rms_mm)},
                {"max_um", in_um(pose.max_mm)},
                {"before_rms_um", in_um(pose.before_rms_mm)}};
  });
  for (const evaluation::AxisFacts& axis : axes_of(facts)) json[axis.key] = axis_json(axis);
  return json;
}

}  // namespace rondure::reports
