#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Core>

#include "core/noise.h"
#include "core/units.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/schema/internal/setting_list.h"
#include "plans/wheel_plan.h"

namespace rondure::plans {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;
using record::GroundSurfaceTask;
using record::WheelTask;

constexpr std::array kWheelForms = {record::Form::kRadius, record::Form::kRunOut,
                                    record::Form::kRoundness};
constexpr std::array<record::WantedColumn, 2> kEdgeColumns = {{{"x"}, {"z"}}};
constexpr std::uint64_t kEdgeStream = 0x3e1eeU;
constexpr int kBodyPoints = 3600;  ///< Points of the noise-free body for the stated truth.

/// Checks keys that belong together, and keys without effect.
struct Checker {
  const std::string& where;
  Findings& findings;

  void missing(std::string_view key, std::string_view why) const {
    findings.meaning(Code::kMissingKey, fmt::format("{}/{}", where, key),
                     fmt::format("this key is missing: {}", why));
  }
  void contradiction(std::string_view key, std::string what) const {
    findings.meaning(Code::kMeaning, fmt::format("{}/{}", where, key), std::move(what));
  }
  [[nodiscard]] bool given(std::string_view key) const {
    return findings.is_given(fmt::format("{}/{}", where, key));
  }
};

/// The axis as two numbers, or as a value of an earlier feature (check_references()).
void check_source_of_axis(const WheelTask& plan, const Checker& checker) {
  if (plan.axis_from) {
    for (const std::string_view key : {"axis_x_mm", "axis_z_mm"}) {
      if (!checker.given(key)) continue;
      checker.contradiction(key, "the axis is that of an earlier feature (axis_from); remove one");
    }
    if (plan.mode == WheelTask::Mode::kEnvelope) {
      checker.contradiction("axis_from",
                            "run-out cannot be stated in envelope mode; remove the axis, or "
                            "measure indexed");
    }
    return;
  }
  if (plan.axis_x_mm.has_value() != plan.axis_z_mm.has_value()) {
    checker.missing(plan.axis_x_mm ? "axis_z_mm" : "axis_x_mm", "the axis has x and z");
  }
  if (plan.mode == WheelTask::Mode::kEnvelope && plan.axis_x_mm) {
    checker.contradiction("axis_x_mm",
                          "run-out cannot be stated in envelope mode; remove the axis, or measure "
                          "indexed");
  }
}

void check_axis(const FeaturePlan& feature, const Checker& checker) {
  const WheelTask& plan = *feature.wheel;
  check_source_of_axis(plan, checker);
  const bool envelope = plan.mode == WheelTask::Mode::kEnvelope;
  for (const record::CharacteristicTask& c : feature.characteristics) {
    if (c.form == record::Form::kRunOut && envelope) {
      checker.contradiction("mode", "run-out is asked for, which a turning wheel does not show");
    } else if (c.form == record::Form::kRunOut && !plan.axis_x_mm && !plan.axis_from) {
      checker.missing("axis_x_mm", "run-out needs the spindle axis");
    }
    if (c.form == record::Form::kRadius && !plan.nominal_radius_mm) {
      checker.missing("nominal_radius_mm", "the radius is judged by its departure from nominal");
    }
  }
}

void check_tables(const GroundSurfaceTask& s, const Checker& checker) {
  if (s.table_x_mm.size() != s.table_z_mm.size()) {
    checker.contradiction(
        "surface/table_z_mm",
        fmt::format("the table has {} x and {} z", s.table_x_mm.size(), s.table_z_mm.size()));
  }
  if (s.removal_x_mm.size() != s.removal_depth_um.size()) {
    checker.contradiction("surface/removal_depth_um",
                          fmt::format("the removal has {} x and {} depths", s.removal_x_mm.size(),
                                      s.removal_depth_um.size()));
  }
}

void check_surface(const GroundSurfaceTask& s, const Checker& checker) {
  using Form = GroundSurfaceTask::Form;
  struct Needed {
    Form form;
    std::string_view key;
  };
  for (const Needed& needed :
       {Needed{Form::kPolynomial, "coefficients"}, Needed{Form::kTable, "table_x_mm"},
        Needed{Form::kTable, "table_z_mm"}}) {
    const std::string key = fmt::format("surface/{}", needed.key);
    if (s.form == needed.form && !checker.given(key)) {
      checker.missing(key, fmt::format("a {} is made of it", name_of(s.form)));
    } else if (s.form != needed.form && checker.given(key)) {
      checker.contradiction(
          key, fmt::format("has no effect: the form is {}; remove it", name_of(s.form)));
    }
  }
  for (const std::string_view key : {"vertex_radius_mm", "conic", "even_terms"}) {
    const std::string place = fmt::format("surface/{}", key);
    if (s.form != Form::kAsphere && checker.given(place)) {
      checker.contradiction(
          place, fmt::format("has no effect: the form is {}; remove it", name_of(s.form)));
    }
  }
  check_tables(s, checker);
  if (s.vertex_radius_mm == 0.0) {
    checker.contradiction("surface/vertex_radius_mm", "is 0; a plane has no vertex radius");
  }
  if (!(s.to_mm > s.from_mm)) {
    checker.contradiction("surface/to_mm",
                          fmt::format("is {} mm, not above from_mm, {} mm", s.to_mm, s.from_mm));
  }
}

void check_program(const WheelTask& plan, const Checker& checker) {
  if (!plan.surface) {
    checker.missing("surface", "a program grinds a surface");
    return;
  }
  const record::WheelProgramTask& program = *plan.program;
  const double from_mm = program.surface_from_mm.value_or(plan.surface->from_mm);
  const double to_mm = program.surface_to_mm.value_or(plan.surface->to_mm);
  if (from_mm > plan.surface->from_mm) {
    checker.contradiction("program/surface_from_mm",
                          fmt::format("is {} mm: the contacts begin before it, at {} mm", from_mm,
                                      plan.surface->from_mm));
  }
  if (to_mm < plan.surface->to_mm) {
    checker.contradiction(
        "program/surface_to_mm",
        fmt::format("is {} mm: the contacts end beyond it, at {} mm", to_mm, plan.surface->to_mm));
  }
}

void check_wheel(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const Checker checker{where, findings};
  check_axis(feature, checker);
  if (feature.wheel->surface) check_surface(*feature.wheel->surface, checker);
  if (feature.wheel->program) check_program(*feature.wheel, checker);
}

/// The simulated wheel.
struct SimulatedWheel {
  const SimulatedWheelPlan& hidden;

  [[nodiscard]] Eigen::Vector2d axis() const { return {hidden.axis_x_mm, hidden.axis_z_mm}; }
  [[nodiscard]] Eigen::Vector2d center() const {
    return axis() + hidden.eccentricity_um * kMicrometre * direction(hidden.eccentricity_deg);
  }
  /// Angle of a point of the list, from 0.
  [[nodiscard]] double point_deg(int i) const {
    const double arc = hidden.arc_to_deg - hidden.arc_from_deg;
    const bool whole = std::abs(arc) >= 360.0 - 1e-9;
    return hidden.arc_from_deg + arc * i / std::max(1, whole ? hidden.points : hidden.points - 1);
  }
  /// A chip, or a proud grain, belongs to the body: it is run-out, whether a point meets it or not.
  [[nodiscard]] bool is_chipped(double deg) const {
    if (hidden.chipped_point == 0) return false;
    const double from = std::remainder(deg - point_deg(hidden.chipped_point - 1), 360.0);
    return std::abs(from) <= 0.5 * hidden.chip_width_deg;
  }
  static Eigen::Vector2d direction(double deg) {
    return {std::cos(deg * kDegree), std::sin(deg * kDegree)};
  }
  /// A point of the edge relative to its centre; `noise_um` acts along the radius.
  [[nodiscard]] Eigen::Vector2d edge(double deg, double noise_um) const {
    double r = hidden.radius_mm + noise_um * kMicrometre;
    if (is_chipped(deg)) r += hidden.chip_um * kMicrometre;
    for (const WheelLobePlan& lobe : hidden.lobes) {
      r +=
          lobe.amplitude_um * kMicrometre * std::cos((lobe.order * deg - lobe.phase_deg) * kDegree);
    }
    return center() + r * direction(deg);
  }
};

/// Distances of the noise-free body from its axis.
struct Reach {
  double least_mm = HUGE_VAL;
  double greatest_mm = 0.0;
};

Reach reach_of(const SimulatedWheel& body) {
  Reach out;
  const auto take = [&](double deg) {
    const double distance = (body.edge(deg, 0.0) - body.axis()).norm();
    out.least_mm = std::min(out.least_mm, distance);
    out.greatest_mm = std::max(out.greatest_mm, distance);
  };
  for (int k = 0; k < kBodyPoints; ++k) take(360.0 * k / kBodyPoints);
  // A chip may be narrower than the step between these.
  if (body.hidden.chipped_point > 0) take(body.point_deg(body.hidden.chipped_point - 1));
  return out;
}

record::Series edge_points(const SimulatedWheel& body, const Reach& reach, bool envelope,
                           int feature, std::uint64_t seed) {
  const SimulatedWheelPlan& hidden = body.hidden;
  record::Series out;
  out.feature = feature;
  out.columns = {{"x", "mm"}, {"z", "mm"}};
  for (int i = 0; i < hidden.points; ++i) {
    core::KeyedNoise noise(
        seed, {kEdgeStream, static_cast<std::uint64_t>(feature), static_cast<std::uint64_t>(i)});
    const double deg = body.point_deg(i);
    const double error_um = hidden.noise_um * noise.normal();
    const Eigen::Vector2d p =
        envelope ? Eigen::Vector2d(body.axis() + (reach.greatest_mm + error_um * kMicrometre) *
                                                     SimulatedWheel::direction(deg))
                 : body.edge(deg, error_um);
    out.values.insert(out.values.end(), {p.x(), p.y()});
  }
  return out;
}

core::Result<AnalysisData> simulate_wheel(const Plan& plan, std::size_t index, std::uint64_t seed,
                                          bool errors) {
  SimulatedWheelPlan hidden = *plan.simulation->wheel;
  if (!errors) hidden.noise_um = 0.0;
  const SimulatedWheel body{hidden};
  const Reach reach = reach_of(body);
  const auto feature = static_cast<int>(index);
  const bool envelope = plan.features[index].wheel->mode == WheelTask::Mode::kEnvelope;
  AnalysisData out;
  out.series.push_back(edge_points(body, reach, envelope, feature, seed));
  out.truths = {{feature, "radius_mm", body.hidden.radius_mm},
                {feature, "center_x_mm", body.center().x()},
                {feature, "center_z_mm", body.center().y()},
                {feature, "runout_um", (reach.greatest_mm - reach.least_mm) / kMicrometre},
                {feature, "effective_radius_mm", reach.greatest_mm}};
  return out;
}

}  // namespace

NamedWheel named_wheel(const Plan& plan, const record::FeatureReference& from) {
  const auto found = std::ranges::find(plan.features, from.feature, &FeaturePlan::id);
  if (found == plan.features.end() || !found->wheel) return {};
  const double nominal_mm = found->wheel->nominal_radius_mm.value_or(0.0);
  NamedWheel out{nominal_mm, nominal_mm};
  if (!found->source && plan.simulation && plan.simulation->wheel) {
    out.true_mm = reach_of(SimulatedWheel{*plan.simulation->wheel}).greatest_mm;
  }
  return out;
}

const AnalysisKind& wheel_kind() {
  static constexpr AnalysisKind kKind = {
      .type = "wheel",
      .shape = record::Shape::kWheel,
      .forms = kWheelForms,
      .is_simulated = simulates<&SimulationPlan::wheel>,
      .settings = settings_of_section<&FeaturePlan::wheel>,
      .files = [](const FeaturePlan& feature) { return source_file(feature, kEdgeColumns); },
      .check = check_wheel,
      .simulate = simulate_wheel};
  return kKind;
}

}  // namespace rondure::plans
