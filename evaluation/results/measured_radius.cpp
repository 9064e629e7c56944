#include "evaluation/results/measured_radius.h"

#include <cmath>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/chain.h"
#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation {

double drawn_mm(const std::vector<RadiusError>& errors, std::uint64_t seed, int trial) {
  double out = 0.0;
  for (const RadiusError& error : errors) {
    out += error.u_mm * (error.rectangular ? uniform_draw(seed, error.id, 0, trial)
                                           : normal_draw(seed, error.id, 0, trial));
  }
  return out;
}

double MeasuredRadius::u_mm() const {
  double squares = 0.0;
  if (errors) {
    for (const RadiusError& error : *errors) squares += error.u_mm * error.u_mm;
  }
  return std::sqrt(squares);
}

core::Result<MeasuredRadius> take_radius(const std::string& id, const RadiusOf& earlier,
                                         std::vector<Gate>& gates) {
  auto out = earlier(id);
  gates.push_back(
      chain_gate(id, out ? std::nullopt : std::optional<core::Phrase>(out.error().said())));
  return out;
}

InfluenceStatement statement_of(const MeasuredRadius& radius) {
  if (!radius.errors) return {"wheel-radius", false, core::phrase("not declared")};
  return {"wheel-radius", true,
          core::phrase("standard uncertainty {} um, of feature {}", core::um(radius.u_mm()),
                       radius.feature)};
}

core::Phrase no_radius_uncertainty(const MeasuredRadius& radius) {
  return core::phrase(
      "feature {} gives the wheel radius and declares no point_um: the uncertainty of the radius "
      "is not known",
      radius.feature);
}

}  // namespace rondure::evaluation
