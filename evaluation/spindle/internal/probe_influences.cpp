#include "evaluation/spindle/internal/probe_influences.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/units.h"
#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation {
namespace {

using record::DeclaredInfluence;
using record::Influence;

bool is_rectangular(const Influence& influence) {
  return influence->distribution == DeclaredInfluence::Distribution::kRectangular;
}

/// One source for each probe.
void add_of_each(const std::array<const char*, 3>& names, std::string_view id,
                 const Influence& influence, double unit, int first,
                 std::vector<ProbeSource>& out) {
  if (!influence) return;
  for (int i = 0; i < 3; ++i) {
    ProbeSource source{names[static_cast<std::size_t>(i)], std::string(id),
                       static_cast<std::uint64_t>(i)};
    source.per_u[first + i] = influence->standard_uncertainty() * unit;
    source.rectangular = is_rectangular(influence);
    out.push_back(std::move(source));
  }
}

/// The angles by which an arm of another length turns the probes: their lines miss the pin.
/// @param mm  By which the stated arm is too long.
void turn_by_arm(double mm, const fit::SwingArm& arm, const fit::ProbeLayout& layout,
                 ProbeSource& out) {
  const auto angles = layout.angles_rad();
  for (int i = 0; i < 3; ++i) {
    out.per_u[fit::kFirstAngle + i] =
        mm * std::sin(angles[static_cast<std::size_t>(i)]) / arm.pin_radius_mm;
  }
}

InfluenceStatement covered(std::string name, const Influence& influence, core::Phrase what) {
  return {std::move(name), true,
          is_rectangular(influence)
              ? core::phrase("{}: half-width {:g}, rectangular", what, influence->value)
              : core::phrase("{}: standard uncertainty {:g}", what, influence->value)};
}

InfluenceStatement not_covered(std::string name, core::Phrase why) {
  return {std::move(name), false, std::move(why)};
}

}  // namespace

double ProbeSource::draw(std::uint64_t seed, int trial) const {
  if (shared) return shared(seed, trial);
  return rectangular ? uniform_draw(seed, id, instance, trial)
                     : normal_draw(seed, id, instance, trial);
}

std::vector<ProbeSource> probe_sources(const record::SpindleInfluencesTask& declared,
                                       const fit::SwingArm& arm, const fit::ProbeLayout& layout,
                                       const std::optional<MeasuredRadius>& radius) {
  std::vector<ProbeSource> out;
  add_of_each({"probe-1-gain", "probe-2-gain", "probe-3-gain"}, "probe.gain", declared.gain_1, 1.0,
              fit::kFirstGain, out);
  add_of_each({"probe-1-angle", "probe-2-angle", "probe-3-angle"}, "probe.angle",
              declared.angle_deg, core::kDegree, fit::kFirstAngle, out);
  if (arm.pin_radius_mm > 0.0) {
    add_of_each({"probe-1-line", "probe-2-line", "probe-3-line"}, "probe.line", declared.line_um,
                core::kMicrometre / arm.pin_radius_mm, fit::kFirstAngle, out);
  }
  if (declared.arm_mm && arm.swings() && arm.pin_radius_mm > 0.0) {
    ProbeSource source{"arm", "probe.arm"};
    turn_by_arm(declared.arm_mm->standard_uncertainty(), arm, layout, source);
    source.rectangular = is_rectangular(declared.arm_mm);
    out.push_back(std::move(source));
  }
  if (radius && radius->errors && arm.swings() && arm.pin_radius_mm > 0.0) {
    ProbeSource source{"wheel-radius", "wheel.radius"};
    const double u_mm = radius->u_mm();
    turn_by_arm(-u_mm, arm, layout, source);  // a greater radius: the stated one is too short
    source.shared = [errors = *radius->errors, u_mm](std::uint64_t seed, int trial) {
      return u_mm > 0.0 ? drawn_mm(errors, seed, trial) / u_mm : 0.0;
    };
    out.push_back(std::move(source));
  }
  add_of_each({"probe-1-drift", "probe-2-drift", "probe-3-drift"}, "probe.drift",
              declared.drift_um_per_turn, core::kMicrometre, fit::kFirstDrift, out);
  if (declared.encoder_urad) {
    for (int i = 0; i < 2; ++i) {
      ProbeSource source{i == 0 ? "encoder-cosine" : "encoder-sine", "encoder",
                         static_cast<std::uint64_t>(i)};
      source.per_u[fit::kFirstEncoder + i] =
          declared.encoder_urad->standard_uncertainty() * core::kMicroradian;
      source.rectangular = is_rectangular(declared.encoder_urad);
      out.push_back(std::move(source));
    }
  }
  return out;
}

fit::ProbeErrorCovariance covariance_of(const std::vector<ProbeSource>& sources) {
  fit::ProbeErrorCovariance out = fit::ProbeErrorCovariance::Zero();
  for (const ProbeSource& source : sources) out += source.per_u * source.per_u.transpose();
  return out;
}

record::SpindleInfluencesTask usual_probes() {
  record::SpindleInfluencesTask out;
  out.gain_1 = DeclaredInfluence{.value = 0.005};
  out.angle_deg = DeclaredInfluence{.value = 0.1};
  return out;
}

std::vector<InfluenceStatement> probe_declaration(const record::SpindleInfluencesTask& declared,
                                                  const fit::SwingArm& arm,
                                                  const std::optional<MeasuredRadius>& radius,
                                                  double noise_mm, bool states_range) {
  std::vector<InfluenceStatement> out;
  const core::Phrase undeclared = core::phrase("not declared");
  out.push_back({"probe-noise", true,
                 declared.noise_um
                     ? core::phrase("noise of a reading [um]: standard uncertainty {:g}",
                                    declared.noise_um->standard_uncertainty())
                     : core::phrase("noise of a reading: {:.3g} um, not declared as an influence",
                                    core::micrometres(noise_mm))});
  const auto add = [&](std::string name, const Influence& influence, core::Phrase what,
                       const core::Phrase& obstacle = {}) {
    if (!influence) {
      out.push_back(not_covered(std::move(name), undeclared));
    } else if (!obstacle.empty()) {
      out.push_back(not_covered(std::move(name), obstacle));
    } else {
      out.push_back(covered(std::move(name), influence, std::move(what)));
    }
  };
  const core::Phrase no_radius =
      arm.pin_radius_mm > 0.0
          ? core::Phrase()
          : core::phrase("declared, but the plan states no radius of the part (pin_radius_mm)");
  const core::Phrase no_arm =
      arm.swings() ? no_radius : core::phrase("declared, but the probes are not on a swing arm");
  add("probe-gain", declared.gain_1, core::phrase("gain of each probe, relative"));
  add("probe-angle", declared.angle_deg, core::phrase("angle of each probe [deg]"));
  add("probe-line", declared.line_um,
      core::phrase("sideways distance of each measuring line [um]; acts as an angle"), no_radius);
  add("arm", declared.arm_mm, core::phrase("length of the swing arm [mm]; acts as angles"), no_arm);
  // Of a measured radius the arm is what its length did since: another influence.
  if (radius) out.push_back(statement_of(*radius));
  add("probe-drift", declared.drift_um_per_turn, core::phrase("drift of each probe [um/turn]"));
  add("encoder", declared.encoder_urad,
      core::phrase("encoder of the work [urad], as one cycle a turn of any phase"));
  add("channel-skew", declared.skew_us, {},
      core::phrase("declared, but the readings have no time and the plan no speed of the work"));
  add("probe-quadratic", declared.quadratic_1, {},
      states_range
          ? core::phrase("declared; not in the interval, but held against each limit (gate "
                         "quadratic)")
          : core::phrase("declared, but the plan does not state the range of the probes "
                         "(probe_range_um)"));
  return out;
}

}  // namespace rondure::evaluation
