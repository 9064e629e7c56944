#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/contour/ground_contour.h"
#include "plans/analyses/internal/contour_kind.h"
#include "plans/analyses/internal/simulated_wheel.h"

namespace rondure::plans {
namespace {

using core::kDegree;
using core::kMicrometre;
using record::ContourTask;

constexpr std::uint64_t kPartStream = 0xc0a7u;
constexpr std::uint64_t kAxesStream = 0xc0a8u;
constexpr std::uint64_t kGaugeStream = 0xc0a9u;
constexpr int kHighestSpread = 6;
constexpr std::size_t kPathSamples = 2048;

/// Hidden truth of one ground part.
struct GroundWorld {
  const SimulatedContourPlan& hidden;
  double c_scale = 1.0;
  std::vector<HarmonicPlan> own;  ///< Non-following harmonics of this part only.

  [[nodiscard]] double c_error_deg(double alpha) const {
    double sum = 0.0;
    for (const AngleHarmonicPlan& h : hidden.c_error) {
      sum += h.amplitude_mdeg * std::cos(h.order * alpha - h.phase_deg * kDegree);
    }
    return 1e-3 * c_scale * sum;
  }
  [[nodiscard]] double x_error_um(double alpha) const { return sum_of(hidden.x_error, alpha); }
  [[nodiscard]] double rest_um(double beta) const {
    return sum_of(hidden.rest, beta) + sum_of(own, beta);
  }
};

GroundWorld world_of(const SimulatedContourPlan& hidden, std::uint64_t seed, std::uint64_t feature,
                     std::uint64_t part) {
  core::KeyedNoise noise(seed, {kPartStream, feature, part});
  GroundWorld out{hidden, 1.0 + hidden.c_error_spread * noise.normal(), {}};
  if (hidden.rest_spread_um == 0.0) return out;
  for (int order = 2; order <= kHighestSpread; ++order) {
    const double c = hidden.rest_spread_um * noise.normal();
    const double s = hidden.rest_spread_um * noise.normal();
    out.own.push_back({order, std::hypot(c, s), std::atan2(s, c) / kDegree});
  }
  return out;
}

/// Samples of the controller, in the sense and sign that the plan states.
record::Series axes_of(const GroundWorld& world, const ContourTask& asked, std::uint64_t seed,
                       std::uint64_t feature, std::uint64_t part) {
  const SimulatedContourPlan& hidden = world.hidden;
  const double sign = asked.error == ContourTask::Error::kCommandMinusActual ? -1.0 : 1.0;
  const double sense = asked.c_axis == ContourTask::CAxis::kAgainstWheel ? -1.0 : 1.0;
  const double step = core::kTwoPi * hidden.speed_rpm / 60.0 * hidden.sampling_ms * 1e-3;
  const auto count = static_cast<std::uint64_t>(std::ceil(hidden.turns * core::kTwoPi / step));
  record::Series out;
  out.columns = {{"c_deg", "deg"}, {"c_error_deg", "deg"}, {"x_error_mm", "mm"}};
  for (std::uint64_t i = 0; i < count; ++i) {
    const double alpha = step * static_cast<double>(i);
    core::KeyedNoise noise(seed, {kAxesStream, feature, part, i});
    const double c = world.c_error_deg(alpha) + 1e-3 * hidden.c_noise_mdeg * noise.normal();
    const double x = world.x_error_um(alpha) + hidden.x_noise_um * noise.normal();
    out.values.push_back(sense * std::fmod(alpha / kDegree, 360.0));
    out.values.push_back(sense * sign * c);
    out.values.push_back(sign * x * kMicrometre);
  }
  return out;
}

/// The pin as the envelope of all wheel positions, minus its nominal radius [um].
core::Result<std::vector<double>> ground_um(const GroundWorld& world,
                                            const fit::CrankGeometry& geometry,
                                            std::size_t points) {
  fit::AxisErrors errors;
  for (std::size_t i = 0; i < kPathSamples; ++i) {
    const double alpha = core::kTwoPi * static_cast<double>(i) / static_cast<double>(kPathSamples);
    errors.c_rad.push_back(world.c_error_deg(alpha) * kDegree);
    errors.x_mm.push_back(world.x_error_um(alpha) * kMicrometre);
  }
  TRY(const auto path, fit::wheel_path(geometry, errors));
  auto out = fit::envelope_radii_mm(path, geometry.wheel_radius_mm, points);
  for (double& r : out) r = (r - geometry.pin_radius_mm) / kMicrometre;
  return out;
}

struct GaugeSetting {
  double offset_deg = 0.0;
  double sense = 1.0;
  double roughness_um = 0.0;
};

/// A contour at equal angles beta in the format of the gauge.
record::Series gauge_of(const std::vector<double>& deviation_um, const GaugeSetting& setting,
                        core::KeyedNoise noise) {
  record::Series out;
  out.columns = {{"angle_deg", "deg"}, {"deviation_um", "um"}};
  for (std::size_t m = 0; m < deviation_um.size(); ++m) {
    const double beta_deg =
        360.0 * static_cast<double>(m) / static_cast<double>(deviation_um.size());
    out.values.push_back(setting.offset_deg + setting.sense * beta_deg);
    out.values.push_back(deviation_um[m] + setting.roughness_um * noise.normal());
  }
  return out;
}

void add(AnalysisData& out, record::Series series, std::string name, int feature) {
  series.name = std::move(name);
  series.feature = feature;
  out.series.push_back(std::move(series));
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return values.empty() ? 0.0 : *high - *low;
}

}  // namespace

core::Result<AnalysisData> simulate_contour(const Plan& plan, std::size_t index, std::uint64_t seed,
                                            bool errors) {
  const ContourTask& asked = *plan.features[index].contour;
  SimulatedContourPlan hidden = *plan.simulation->contour;
  if (!errors) hidden.c_noise_mdeg = hidden.x_noise_um = hidden.roughness_um = 0.0;
  fit::CrankGeometry geometry = {asked.crank_radius_mm, asked.wheel_radius_mm, asked.pin_radius_mm};
  if (asked.wheel_radius_from) {
    geometry.wheel_radius_mm = named_wheel(plan, *asked.wheel_radius_from).true_mm;
  }
  const auto points = static_cast<std::size_t>(hidden.gauge_points);
  const double sense = asked.gauge == ContourTask::Gauge::kClockwise ? -1.0 : 1.0;
  const auto feature = static_cast<int>(index);
  AnalysisData out;
  for (int part = 0; part < hidden.parts; ++part) {
    const auto key = static_cast<std::uint64_t>(part);
    const GroundWorld world = world_of(hidden, seed, index, key);
    TRY(auto pin, ground_um(world, geometry, points));
    record::Series truth;
    truth.role = record::Series::Role::kTruth;
    truth.columns = {{"beta_deg", "deg"}, {"ground_um", "um"}, {"rest_um", "um"}};
    std::vector<double> rest(points);
    for (std::size_t m = 0; m < points; ++m) {
      const double beta = core::kTwoPi * static_cast<double>(m) / static_cast<double>(points);
      rest[m] = world.rest_um(beta);
      truth.values.insert(truth.values.end(), {beta / kDegree, pin[m], rest[m]});
      pin[m] += rest[m];
    }
    const int number = part + 1;
    add(out, axes_of(world, asked, seed, index, key), fmt::format("axes {}", number), feature);
    add(out,
        gauge_of(pin, {asked.phase_offset_deg, sense, hidden.roughness_um},
                 core::KeyedNoise(seed, {kGaugeStream, index, key, 0})),
        fmt::format("pin {}", number), feature);
    add(out,
        gauge_of(rest, {asked.main_phase_offset_deg, sense, hidden.roughness_um},
                 core::KeyedNoise(seed, {kGaugeStream, index, key, 1})),
        fmt::format("main {}", number), feature);
    add(out, std::move(truth), fmt::format("truth {}", number), feature);
    out.truths.push_back(
        {feature, fmt::format("rest_{}_peak_to_valley_um", number), range_of(rest)});
  }
  return out;
}

}  // namespace rondure::plans
