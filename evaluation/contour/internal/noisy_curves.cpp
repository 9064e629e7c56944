#include "evaluation/contour/internal/noisy_curves.h"

#include <utility>

#include <fmt/format.h>

namespace rondure::evaluation::contour_trials {

NoisyCurves::NoisyCurves(const Basis& basis, Curves measured, std::vector<double> u_mm,
                         std::uint64_t seed, const std::string& id)
    : basis_(basis), measured_(std::move(measured)), u_mm_(std::move(u_mm)), seed_(seed), id_(id) {
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    if (u_mm_[i] <= 0.0) {
      draws_.emplace_back();
      continue;
    }
    MeasuredCurve curve;
    for (std::size_t j = 0; j < basis.size(); ++j) {
      curve.found_mm.push_back(measured_[i][j] / basis.transmission[j]);
      curve.u_mm.push_back(u_mm_[i]);
      curve.group.push_back(octave(Basis::order(j)));
      curve.order.push_back(Basis::order(j));
    }
    draws_.emplace_back(std::in_place, std::move(curve), seed, fmt::format("{}.{}", id, i + 1));
  }
}

void NoisyCurves::add_noise(int trial, Curves& curves) const {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (std::size_t j = 0; j < basis_.size(); ++j) {
      curves[i][j] +=
          basis_.transmission[j] * u_mm_[i] * normal_draw(seed_, id_, i * basis_.size() + j, trial);
    }
  }
}

CurveModel model_of(Curves measured, std::shared_ptr<const NoisyCurves> noise, std::string name) {
  CurveModel out;
  out.measured = std::move(measured);
  out.draw = [noise](int trial) { return noise->draw(trial); };
  out.core_draw = [noise](int trial) { return noise->core_draw(trial); };
  out.core_center = noise->center();
  out.effects.push_back({std::move(name),
                         [noise](int trial, Curves& curves) { noise->add_noise(trial, curves); },
                         {},
                         false,
                         true});
  return out;
}

}  // namespace rondure::evaluation::contour_trials
