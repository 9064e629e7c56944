#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/contour/ground_contour.h"
#include "fit/contour/separation.h"
#include "fit/contour/study.h"
#include "plans/analyses/internal/kinds.h"

namespace rondure::plans {
namespace {

using core::kDegree;
using core::kMicrometre;
using record::ContourTask;

constexpr std::uint64_t kPartStream = 0xc0a7u;
constexpr std::uint64_t kAxesStream = 0xc0a8u;
constexpr std::uint64_t kGaugeStream = 0xc0a9u;
constexpr std::uint64_t kPinOwnStream = 0xc0aau;
constexpr std::uint64_t kMainOwnStream = 0xc0abu;
constexpr int kHighestSpread = 6;
constexpr std::size_t kPathSamples = 2048;

/// Whether the control counts C as the method does.
double sense_of(const ContourTask& asked) {
  return asked.c_axis == ContourTask::CAxis::kAgainstWheel ? -1.0 : 1.0;
}

/// Hidden truth of one ground part.
struct GroundWorld {
  const SimulatedContourPlan& hidden;
  double c_scale = 1.0;
  std::vector<HarmonicPlan> own = {};      ///< Non-following harmonics of this part only,
  std::vector<HarmonicPlan> of_pin = {};   ///< of its pin,
  std::vector<HarmonicPlan> of_main = {};  ///< and of its main journal.
  std::vector<double> table_mm = {};       ///< Loaded in the control, over alpha; empty: none.

  [[nodiscard]] double c_error_deg(double alpha) const {
    double sum = 0.0;
    for (const AngleHarmonicPlan& h : hidden.c_error) {
      sum += h.amplitude_mdeg * std::cos(h.order * alpha - h.phase_deg * kDegree);
    }
    return 1e-3 * c_scale * sum;
  }
  [[nodiscard]] double x_error_um(double alpha) const { return sum_of(hidden.x_error, alpha); }
  [[nodiscard]] double common_um(double beta) const {
    return sum_of(hidden.rest, beta) + sum_of(own, beta);
  }
  [[nodiscard]] double rest_um(double beta) const { return common_um(beta) + sum_of(of_pin, beta); }
  [[nodiscard]] double main_um(double beta) const {
    return common_um(beta) + sum_of(of_main, beta);
  }
};

/// Cosines and sines of the orders 2 to 6 that scatter by `deviation_um`.
std::vector<HarmonicPlan> scattered(double deviation_um, core::KeyedNoise noise) {
  std::vector<HarmonicPlan> out;
  if (deviation_um == 0.0) return out;
  for (int order = 2; order <= kHighestSpread; ++order) {
    const double c = deviation_um * noise.normal();
    const double s = deviation_um * noise.normal();
    out.push_back({order, std::hypot(c, s), std::atan2(s, c) / kDegree});
  }
  return out;
}

GroundWorld world_of(const SimulatedContourPlan& hidden, std::uint64_t seed, std::uint64_t feature,
                     std::uint64_t part) {
  core::KeyedNoise noise(seed, {kPartStream, feature, part});
  GroundWorld out{hidden, 1.0 + hidden.c_error_spread * noise.normal()};
  out.own = scattered(hidden.rest_spread_um, std::move(noise));
  const double orders = kHighestSpread - 1;
  const auto own = [&](const std::optional<double>& rms_um, std::uint64_t stream) {
    const double each_um = rms_um ? *rms_um / std::sqrt(orders) : 0.5 * hidden.rest_spread_um;
    return scattered(each_um, core::KeyedNoise(seed, {stream, feature, part}));
  };
  out.of_pin = own(hidden.pin_own_um, kPinOwnStream);
  out.of_main = own(hidden.main_own_um, kMainOwnStream);
  return out;
}

/// A part as control and gauge record it, in the senses and signs of the method.
struct Recorded {
  std::vector<double> alpha;
  std::vector<double> c_error_deg;  ///< Actual minus command.
  std::vector<double> x_error_um;
  std::vector<double> pin_um;  ///< At equal angles beta.
  std::vector<double> main_um;
};

void record_axes(const GroundWorld& world, std::uint64_t seed, std::uint64_t feature,
                 std::uint64_t part, Recorded& out) {
  const SimulatedContourPlan& hidden = world.hidden;
  const double step = core::kTwoPi * hidden.speed_rpm / 60.0 * hidden.sampling_ms * 1e-3;
  const auto count = static_cast<std::uint64_t>(std::ceil(hidden.turns * core::kTwoPi / step));
  for (std::uint64_t i = 0; i < count; ++i) {
    const double alpha = step * static_cast<double>(i);
    core::KeyedNoise noise(seed, {kAxesStream, feature, part, i});
    out.alpha.push_back(alpha);
    out.c_error_deg.push_back(world.c_error_deg(alpha) +
                              1e-3 * hidden.c_noise_mdeg * noise.normal());
    out.x_error_um.push_back(world.x_error_um(alpha) + hidden.x_noise_um * noise.normal());
  }
}

/// Samples of the controller, in the sense and sign that the plan states.
record::Series axes_of(const Recorded& part, const ContourTask& asked) {
  const double sign = asked.error == ContourTask::Error::kCommandMinusActual ? -1.0 : 1.0;
  const double sense = sense_of(asked);
  record::Series out;
  out.columns = {{"c_deg", "deg"}, {"c_error_deg", "deg"}, {"x_error_mm", "mm"}};
  for (std::size_t i = 0; i < part.alpha.size(); ++i) {
    out.values.push_back(sense * std::fmod(part.alpha[i] / kDegree, 360.0));
    out.values.push_back(sense * sign * part.c_error_deg[i]);
    out.values.push_back(sign * part.x_error_um[i] * kMicrometre);
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
    if (!world.table_mm.empty()) errors.x_mm.back() += fit::closed_at(world.table_mm, alpha);
  }
  TRY(const auto path, fit::wheel_path(geometry, errors));
  auto out = fit::envelope_radii_mm(path, geometry.wheel_radius_mm, points);
  for (double& r : out) r = (r - geometry.pin_radius_mm) / kMicrometre;
  return out;
}

/// A contour at equal angles beta as the gauge reads it.
std::vector<double> read_by_gauge(std::vector<double> deviation_um, double roughness_um,
                                  core::KeyedNoise noise) {
  for (double& v : deviation_um) v += roughness_um * noise.normal();
  return deviation_um;
}

double beta_of(std::size_t m, std::size_t count) {
  return core::kTwoPi * static_cast<double>(m) / static_cast<double>(count);
}

/// The same in the format of the gauge.
record::Series gauge_of(const std::vector<double>& read_um, double offset_deg, double sense) {
  record::Series out;
  out.columns = {{"angle_deg", "deg"}, {"deviation_um", "um"}};
  for (std::size_t m = 0; m < read_um.size(); ++m) {
    const double beta_deg = 360.0 * static_cast<double>(m) / static_cast<double>(read_um.size());
    out.values.push_back(offset_deg + sense * beta_deg);
    out.values.push_back(read_um[m]);
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

/// The parts of one feature.
struct Pins {
  const ContourTask& asked;
  SimulatedContourPlan hidden;
  fit::CrankGeometry geometry;
  std::uint64_t seed = 0;
  std::uint64_t feature = 0;

  Pins(const Plan& plan, std::size_t index, std::uint64_t key, bool errors)
      : asked(*plan.features[index].contour),
        hidden(*plan.simulation->contour),
        geometry{asked.crank_radius_mm, asked.wheel_radius_mm, asked.pin_radius_mm},
        seed(key),
        feature(index) {
    if (!errors) hidden.c_noise_mdeg = hidden.x_noise_um = hidden.roughness_um = 0.0;
    if (asked.wheel_radius_from) {
      geometry.wheel_radius_mm = named_wheel(plan, *asked.wheel_radius_from).true_mm;
    }
  }
  [[nodiscard]] bool traced() const {
    return asked.separation != ContourTask::Separation::kIndirect;
  }
};

/// One ground part, as it is and as it is read.
struct Part {
  std::vector<double> ground_um;
  std::vector<double> rest_um;
  std::vector<double> main_um;
  Recorded read;
};

core::Result<Part> ground_part(const Pins& pins, std::uint64_t number,
                               const std::vector<double>& table_mm) {
  GroundWorld world = world_of(pins.hidden, pins.seed, pins.feature, number);
  world.table_mm = table_mm;
  const auto points = static_cast<std::size_t>(pins.hidden.gauge_points);
  Part out;
  TRY(out.ground_um, ground_um(world, pins.geometry, points));
  std::vector<double> pin = out.ground_um;
  for (std::size_t m = 0; m < points; ++m) {
    const double beta = beta_of(m, points);
    out.rest_um.push_back(world.rest_um(beta));
    out.main_um.push_back(world.main_um(beta));
    pin[m] += out.rest_um[m];
  }
  record_axes(world, pins.seed, pins.feature, number, out.read);
  const auto noise = [&](std::uint64_t which) {
    return core::KeyedNoise(pins.seed, {kGaugeStream, pins.feature, number, which});
  };
  out.read.pin_um = read_by_gauge(std::move(pin), pins.hidden.roughness_um, noise(0));
  out.read.main_um = read_by_gauge(out.main_um, pins.hidden.roughness_um, noise(1));
  return out;
}

fit::GaugeRows rows_of(const std::vector<double>& read_um) {
  fit::GaugeRows out;
  for (std::size_t m = 0; m < read_um.size(); ++m) {
    out.angle_rad.push_back(beta_of(m, read_um.size()));
    out.deviation_mm.push_back(read_um[m] * kMicrometre);
  }
  return out;
}

/// The correction of X that pins give as they were read, over alpha.
core::Result<std::vector<double>> correction_of(const Pins& pins) {
  fit::ContourStudyOptions options;
  options.geometry = pins.geometry;
  options.samples = static_cast<std::size_t>(pins.asked.samples);
  options.error.filter.cutoff_upr = pins.asked.cutoff_upr;
  if (pins.asked.filter == ContourTask::Filter::kNone) {
    options.error.filter.filter = fit::ProfileFilter::kNone;
  }
  std::vector<fit::ContourPart> parts;
  for (int i = 0; i < pins.hidden.parts; ++i) {
    TRY(const auto part, ground_part(pins, static_cast<std::uint64_t>(i), {}));
    fit::ContourPart& one = parts.emplace_back();
    one.pin = rows_of(part.read.pin_um);
    one.main = rows_of(part.read.main_um);
    if (!pins.traced()) continue;
    auto& trace = one.trace.emplace();
    trace.c_rad = part.read.alpha;
    for (const double c : part.read.c_error_deg) trace.c_error_rad.push_back(c * kDegree);
    for (const double x : part.read.x_error_um) trace.x_error_mm.push_back(x * kMicrometre);
  }
  TRY(const auto study, fit::contour_study(parts, options));
  const auto table = pins.asked.correction.value_or(record::ContourCorrectionTask());
  return fit::x_table_mm(study, options.geometry,
                         {static_cast<std::size_t>(table.rows()), table.highest_order,
                          table.resolution_um * kMicrometre});
}

/// A correction as a control holds it.
record::Series table_of(const std::vector<double>& table_mm, double sense) {
  record::Series out;
  out.columns = {{"c_deg", "deg"}, {"x_um", "um"}};
  for (std::size_t i = 0; i < table_mm.size(); ++i) {
    const std::size_t row = sense < 0.0 ? (table_mm.size() - i) % table_mm.size() : i;
    out.values.push_back(360.0 * static_cast<double>(i) / static_cast<double>(table_mm.size()));
    out.values.push_back(table_mm[row] / kMicrometre);
  }
  return out;
}

}  // namespace

core::Result<AnalysisData> simulate_contour(const Plan& plan, std::size_t index, std::uint64_t seed,
                                            bool errors) {
  const Pins pins(plan, index, seed, errors);
  const ContourTask& asked = pins.asked;
  const double gauge_sense = asked.gauge == ContourTask::Gauge::kClockwise ? -1.0 : 1.0;
  const auto feature = static_cast<int>(index);
  AnalysisData out;
  std::vector<double> table_mm;
  if (asked.repeat) {
    const auto giver =
        std::ranges::find(plan.features, asked.repeat->with.feature, &FeaturePlan::id);
    const auto given = static_cast<std::size_t>(giver - plan.features.begin());
    // Also the truth is that of parts ground with the correction as it was found.
    TRY(table_mm, correction_of(Pins(plan, given, seed, true)));
    add(out, table_of(table_mm, sense_of(asked)), "table", feature);
  }
  for (int number = 1; number <= pins.hidden.parts; ++number) {
    TRY(const auto part, ground_part(pins, static_cast<std::uint64_t>(number - 1), table_mm));
    record::Series truth;
    truth.role = record::Series::Role::kTruth;
    truth.columns = {
        {"beta_deg", "deg"}, {"ground_um", "um"}, {"rest_um", "um"}, {"main_um", "um"}};
    for (std::size_t m = 0; m < part.rest_um.size(); ++m) {
      truth.values.insert(truth.values.end(),
                          {beta_of(m, part.rest_um.size()) / kDegree, part.ground_um[m],
                           part.rest_um[m], part.main_um[m]});
    }
    if (pins.traced()) add(out, axes_of(part.read, asked), fmt::format("axes {}", number), feature);
    add(out, gauge_of(part.read.pin_um, asked.phase_offset_deg, gauge_sense),
        fmt::format("pin {}", number), feature);
    // Of f by the main journal the truth is that of the axes: t less a journal that shows exactly
    // what the pin has beside it. What the two do not share is an error of the measurement.
    const bool alike = !errors && !pins.traced();
    add(out,
        gauge_of(alike ? part.rest_um : part.read.main_um, asked.main_phase_offset_deg,
                 gauge_sense),
        fmt::format("main {}", number), feature);
    add(out, std::move(truth), fmt::format("truth {}", number), feature);
    out.truths.push_back(
        {feature, fmt::format("rest_{}_peak_to_valley_um", number), range_of(part.rest_um)});
    out.truths.push_back({feature, fmt::format("main_{}_correlation", number),
                          fit::correlation_of(part.rest_um, part.main_um)});
  }
  return out;
}

}  // namespace rondure::plans
