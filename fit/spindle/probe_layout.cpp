#include "fit/spindle/probe_layout.h"

#include <cmath>
#include <limits>

#include "core/units.h"

namespace rondure::fit {
namespace {

constexpr double kLeastSine = 1e-3;
constexpr double kAlikeGains = 1e-9;  ///< Relative; smaller differences of gains are rounding.

/// The angle of a number of samples, with 1024 per turn.
double of_1024(int samples) { return samples * core::kTwoPi / 1024.0; }

}  // namespace

ProbeLayout::ProbeLayout(double phi2_rad, double phi3_rad)
    : phi2_(phi2_rad),
      phi3_(phi3_rad),
      weights_{1.0, -std::sin(phi2_rad + phi3_rad) / std::sin(phi3_rad),
               std::sin(phi2_rad) / std::sin(phi3_rad)} {}

core::Result<ProbeLayout> ProbeLayout::of(double phi2_rad, double phi3_rad) {
  if (!std::isfinite(phi2_rad) || !std::isfinite(phi3_rad)) {
    return core::fail(core::Code::kNotFinite, "a probe angle is not a finite number");
  }
  struct Pair {
    const char* probes;
    double angle_rad;
  };
  for (const Pair& pair : {Pair{"P1 and P2", phi2_rad}, Pair{"P2 and P3", phi3_rad},
                           Pair{"P1 and P3", phi2_rad + phi3_rad}}) {
    if (std::abs(std::sin(pair.angle_rad)) >= kLeastSine) continue;
    return core::fail_with(core::Code::kRank,
                           "the probes {} are in line ({:.6g} deg apart): they see only a "
                           "diameter; |sin| must be at least {:g}",
                           pair.probes, pair.angle_rad / core::kDegree, kLeastSine);
  }
  return ProbeLayout(phi2_rad, phi3_rad);
}

double ProbeLayout::weight_norm() const {
  return std::sqrt(1.0 + weights_[1] * weights_[1] + weights_[2] * weights_[2]);
}

std::complex<double> ProbeLayout::transfer(int order) const {
  return 1.0 + weights_[1] * std::polar(1.0, order * phi2_) +
         weights_[2] * std::polar(1.0, order * (phi2_ + phi3_));
}

double ProbeLayout::gain(int order) const {
  if (order == 1) return std::numeric_limits<double>::infinity();  // rounding leaves 1e-16 there
  const double size = std::abs(transfer(order));
  return size > 0.0 ? weight_norm() / size : std::numeric_limits<double>::infinity();
}

core::Result<ProbeLayout> turned_by_arm(const ProbeLayout& layout, const SwingArm& arm,
                                        double set_on_mm) {
  if (!arm.swings()) return layout;
  if (!(arm.pin_radius_mm > 0.0)) {
    return core::fail(core::Code::kOutOfRange, "an arm that swings needs the radius of the pin");
  }
  const auto places = layout.angles_rad();
  const double per_sine = (set_on_mm - arm.wheel_radius_mm) / arm.pin_radius_mm;
  const double second = places[1] + per_sine * std::sin(places[1]);
  const double third = places[2] + per_sine * std::sin(places[2]);
  return ProbeLayout::of(second, third - second);  // P1 stands on the arm: its sine is 0
}

ProbeLayout published_layout_a() { return *ProbeLayout::of(of_1024(256), of_1024(515)); }
ProbeLayout published_layout_b() { return *ProbeLayout::of(of_1024(173), of_1024(683)); }
ProbeLayout reference_layout() { return *ProbeLayout::of(of_1024(149), of_1024(708)); }

std::array<NamedLayout, 3> named_layouts() {
  return {{{"published-a", published_layout_a()},
           {"published-b", published_layout_b()},
           {"reference", reference_layout()}}};
}

core::Result<ProbeLayout> stated_layout(std::string_view name, std::optional<double> p1_to_p2_deg,
                                        std::optional<double> p2_to_p3_deg,
                                        std::optional<double> p1_to_p3_deg) {
  for (const NamedLayout& known : named_layouts()) {
    if (known.name == name) return known.layout;
  }
  const double second = p1_to_p2_deg.value_or(0.0);
  const double third = p2_to_p3_deg.value_or(p1_to_p3_deg.value_or(0.0) - second);
  return ProbeLayout::of(second * core::kDegree, third * core::kDegree);
}

WorstGain worst_gain(const ProbeLayout& layout, int first, int last) {
  WorstGain out;
  for (int order = first; order <= last; ++order) {
    const double gain = layout.gain(order);
    if (gain > out.gain * (1.0 + kAlikeGains)) out = {order, gain};
  }
  return out;
}

}  // namespace rondure::fit
