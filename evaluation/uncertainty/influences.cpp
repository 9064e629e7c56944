#include "evaluation/uncertainty/influences.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rondure::evaluation {
namespace {

using core::Code;

constexpr double kUm = 1e3;  // um in a mm

using Numbers = std::vector<std::pair<std::string, double>>;

core::Result<void> check_numbers(const Numbers& numbers, bool signs) {
  for (const auto& [name, value] : numbers) {
    if (std::isfinite(value) && (signs || value >= 0.0)) continue;
    return core::fail_with(Code::kBadOption, "{} {} is not a number{}", name, value,
                           signs ? "" : " >= 0");
  }
  return {};
}

core::Result<void> check_probe(const ProbeInfluences& probe) {
  Numbers numbers = {{"probe repeatability_mm", probe.repeatability_mm},
                     {"probe degrees_of_freedom", probe.degrees_of_freedom},
                     {"probe correlation_length_mm", probe.correlation_length_mm},
                     {"probing form_limit_mm", probe.form_limit_mm},
                     {"tip_radius_mm", probe.tip_radius_mm},
                     {"reference_sphere_mm", probe.reference_sphere_mm}};
  for (const cmm::PretravelLobe& lobe : probe.lobes) {
    numbers.emplace_back("lobe amplitude_mm", lobe.amplitude_mm);
    numbers.emplace_back("lobe order", lobe.order);
  }
  return check_numbers(numbers, false);
}

core::Result<void> check_machine(const MachineInfluences& machine) {
  const auto limits = check_numbers({{"length_limit_mm", machine.length_limit_mm},
                                     {"length_limit_slope", machine.length_limit_slope}},
                                    false);
  if (!limits) return limits;
  const cmm::GeometricErrors& terms = machine.terms;
  Numbers numbers = {{"squareness_xy_rad", terms.squareness_xy_rad},
                     {"squareness_xz_rad", terms.squareness_xz_rad},
                     {"squareness_yz_rad", terms.squareness_yz_rad},
                     {"tip_offset_mm", terms.tip_offset_mm.sum()}};
  for (const cmm::AxisErrors& axis : terms.axes) {
    for (const auto* curves : {&axis.translation, &axis.rotation}) {
      for (const cmm::ErrorCurve& curve : *curves) {
        numbers.emplace_back("linear coefficient", curve.linear_1_mm);
        numbers.emplace_back("quadratic coefficient", curve.quadratic_1_mm2);
        numbers.emplace_back("wave", curve.wave);
        if (curve.period_mm > 0.0) continue;
        return core::fail_with(Code::kBadOption, "wave period {} mm is not > 0", curve.period_mm);
      }
    }
  }
  // typical_errors() has signed values; a spread must not be negative
  return check_numbers(numbers, true);
}

core::Result<void> check_thermal(const ThermalInfluences& thermal) {
  const auto signs = check_numbers({{"from_reference_K", thermal.from_reference_K}}, true);
  if (!signs) return signs;
  return check_numbers({{"temperature_K", thermal.temperature_K},
                        {"expansion_1_K", thermal.expansion_1_K},
                        {"expansion_uncertainty_1_K", thermal.expansion_uncertainty_1_K},
                        {"drift_K", thermal.drift_K},
                        {"machine_drift_mm x", thermal.machine_drift_mm.x()},
                        {"machine_drift_mm y", thermal.machine_drift_mm.y()},
                        {"machine_drift_mm z", thermal.machine_drift_mm.z()}},
                       false);
}

core::Result<void> check_fixture(const FixtureInfluences& fixture) {
  if (fixture.pivot_mm && !fixture.pivot_mm->allFinite()) {
    return core::fail(Code::kBadOption, "pivot_mm of the fixture is not finite");
  }
  return check_numbers({{"fixture angle_rad", fixture.angle_rad},
                        {"fixture position_mm", fixture.position_mm},
                        {"fixture creep_rad", fixture.creep_rad}},
                       false);
}

constexpr double kContradicted = 1.5;

core::Phrase taken_as_zero() { return core::phrase("taken as zero"); }

/// Writes the declaration, one line per influence.
class Declaration {
 public:
  void group(bool declared) { declared_ = declared; }

  /// @param zero  All its numbers are 0.
  void line(std::string name, const core::Phrase& text, bool zero = false) {
    lines.push_back({std::move(name), declared_,
                     !declared_ ? core::phrase("not declared")
                     : zero     ? taken_as_zero()
                                : text});
  }

  /// One of two ways to say the same: without a number it is not declared.
  void limit(std::string name, bool given, const core::Phrase& text,
             const core::Phrase& missing = core::phrase("not declared")) {
    const bool covered = declared_ && given;
    lines.push_back({std::move(name), covered, covered ? text : missing});
  }

  void never(std::string name, core::Phrase text) {
    lines.push_back({std::move(name), false, std::move(text)});
  }

  std::vector<InfluenceStatement> lines;

 private:
  bool declared_ = false;
};

/// How far the declared probing form may spread over some 25 touches of a sphere.
double declared_span_mm(const ProbeInfluences& probe) {
  double lobes_mm = 0.0;
  for (const cmm::PretravelLobe& lobe : probe.lobes) lobes_mm += lobe.amplitude_mm;
  return probe.form_limit_mm > 0.0 ? probe.form_limit_mm
                                   : 2.0 * lobes_mm + kRangeOf25Touches * probe.repeatability_mm;
}

void say_probe(const Influences& influences, Declaration& out) {
  const ProbeInfluences probe = influences.probe.value_or(ProbeInfluences{});
  out.group(influences.probe.has_value());
  const bool limited = probe.form_limit_mm > 0.0;
  const core::Phrase contained = core::phrase("contained in the probing form limit");
  const double sigma_um = kUm * probe.repeatability_mm;
  core::Phrase repeatability =
      core::phrase("standard deviation {:.4g} um of a touch, normal", sigma_um);
  if (probe.degrees_of_freedom > 0.0) {
    repeatability =
        core::phrase("{}; {:.4g} degrees of freedom", repeatability, probe.degrees_of_freedom);
  }
  repeatability = probe.correlation_length_mm > 0.0
                      ? core::phrase("{}; neighbours alike over {:.4g} mm", repeatability,
                                     probe.correlation_length_mm)
                      : core::phrase("{}; each touch anew", repeatability);
  out.limit("probe-repeatability", limited || probe.repeatability_known,
            limited ? contained : repeatability);
  core::Phrase lobes;
  for (const cmm::PretravelLobe& lobe : probe.lobes) {
    const core::Phrase one =
        core::phrase("{} lobes of amplitude {:.4g} um", lobe.order, kUm * lobe.amplitude_mm);
    lobes = lobes.empty() ? one : core::phrase("{}, {}", lobes, one);
  }
  const auto& span_mm = influences.probing_span_mm;
  // A form declared as much less than what the run saw of it is no declaration.
  const bool contradicted = span_mm && *span_mm > kContradicted * declared_span_mm(probe);
  const core::Phrase seen =
      !span_mm ? core::phrase("not declared")
      : contradicted && (limited || !lobes.empty())
          ? core::phrase(
                "declared are {:.3f} um, the qualification of this run shows a probing "
                "form of {:.3f} um",
                kUm * declared_span_mm(probe), kUm * *span_mm)
          : core::phrase(
                "not declared; the qualification of this run shows a probing form of "
                "{:.3f} um",
                kUm * *span_mm);
  out.limit("probe-lobing", (limited || !lobes.empty()) && !contradicted,
            limited ? contained : core::phrase("{}, phase unknown, uniform", lobes),
            contradicted ? seen : core::phrase("not declared"));
  // Repeatability and lobes state the same form in two parts.
  const bool in_parts = probe.repeatability_known && !probe.lobes.empty();
  out.limit("probing-form-limit", (limited || in_parts) && !contradicted,
            limited ? core::phrase("P_FTU {:.4g} um (ISO 10360-5): normal, standard deviation "
                                   "P / 3.93",
                                   kUm * probe.form_limit_mm)
                    : core::phrase("declared as repeatability and lobes"),
            seen);
  out.line("tip-qualification",
           core::phrase("radius {:.4g} um, normal; shifts radii, not the form",
                        kUm * probe.tip_radius_mm),
           probe.tip_radius_mm == 0.0);
  if (probe.reference_sphere_mm > 0.0) {
    out.line("reference-sphere",
             core::phrase("radius {:.4g} um, normal; shifts radii, not the form",
                          kUm * probe.reference_sphere_mm));
  }
}

/// Whether a curve has any value other than zero.
bool says(const cmm::ErrorCurve& curve) {
  return curve.linear_1_mm != 0.0 || curve.quadratic_1_mm2 != 0.0 || curve.wave != 0.0;
}

void say_machine(const std::optional<MachineInfluences>& declared, Declaration& out) {
  const MachineInfluences machine = declared.value_or(MachineInfluences{});
  const core::Phrase terms = core::phrase(
      "standard uncertainty of each coefficient, normal; waves with unknown phase, uniform");
  out.group(declared.has_value());
  bool position = false;
  bool straightness = false;
  bool rotation = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 3; ++i) {
      bool& translation = i == axis ? position : straightness;
      translation = translation || says(machine.terms.axes[axis].translation[i]);
      rotation = rotation || says(machine.terms.axes[axis].rotation[i]);
    }
  }
  const bool limited = machine.length_limit_mm + machine.length_limit_slope > 0.0;
  const core::Phrase contained = core::phrase("contained in the length limit");
  const auto said = [&](const core::Phrase& text) { return limited ? contained : text; };
  out.line("machine-position", said(core::phrase("{} ({})", terms, "EXX, EYY, EZZ")),
           !limited && !position);
  out.line("machine-straightness", said(core::phrase("{} ({})", terms, "EYX ... EYZ")),
           !limited && !straightness);
  out.line("machine-rotation", said(core::phrase("{} ({})", terms, "EAX ... ECZ")),
           !limited && !rotation);
  const auto& square = machine.terms;
  const bool is_square = square.squareness_xy_rad == 0.0 && square.squareness_xz_rad == 0.0 &&
                         square.squareness_yz_rad == 0.0;
  out.line("machine-squareness",
           said(core::phrase(
               "standard uncertainty {:.4g}, {:.4g}, {:.4g} urad (xy, xz, yz), normal",
               1e6 * std::abs(square.squareness_xy_rad), 1e6 * std::abs(square.squareness_xz_rad),
               1e6 * std::abs(square.squareness_yz_rad))),
           !limited && is_square);
  // Errors of the axes state the same lengths in parts.
  out.limit("machine-length-limit", limited || (position && !is_square),
            limited ? core::phrase("ISO 10360-2 {:.4g} um + {:.4g} um/m, rectangular",
                                   kUm * machine.length_limit_mm, 1e6 * machine.length_limit_slope)
                    : core::phrase("declared as errors of the axes"));
}

void say_thermal(const std::optional<ThermalInfluences>& declared, Declaration& out) {
  const ThermalInfluences thermal = declared.value_or(ThermalInfluences{});
  out.group(declared.has_value());
  if (declared && thermal.expansion_1_K == 0.0) {
    out.never("temperature", core::phrase("no expansion of the part is stated; shifts "
                                          "radii, not the form"));
  } else {
    out.line(
        "temperature",
        core::phrase("mean part temperature {:.4g} K, expansion {:.4g} /K, normal; shifts radii, "
                     "not the form",
                     thermal.temperature_K, thermal.expansion_uncertainty_1_K),
        thermal.temperature_K == 0.0 && thermal.expansion_uncertainty_1_K == 0.0);
  }
  out.group(declared && thermal.drifts_declared);
  if (thermal.drift_K > 0.0 && thermal.expansion_1_K == 0.0) {
    out.never("temperature-drift",
              core::phrase("{:.4g} K declared, but no expansion of the part (part.expansion_per_K)",
                           thermal.drift_K));
  } else {
    out.line("temperature-drift",
             core::phrase("at most {:.4g} K from the first to the last touch, rectangular",
                          thermal.drift_K),
             thermal.drift_K == 0.0);
  }
  out.line("machine-drift",
           core::phrase("at most {:.4g}, {:.4g}, {:.4g} um from the first to the last touch, "
                        "rectangular",
                        kUm * thermal.machine_drift_mm.x(), kUm * thermal.machine_drift_mm.y(),
                        kUm * thermal.machine_drift_mm.z()),
           thermal.machine_drift_mm.isZero(0.0));
}

void say_fixture(const std::optional<FixtureInfluences>& declared, Declaration& out) {
  const FixtureInfluences fixture = declared.value_or(FixtureInfluences{});
  out.group(declared.has_value());
  out.line(
      "fixture-calibration",
      core::phrase("pose {:.4g} urad, {:.4g} um, normal, each pose anew; one pose moves no form",
                   1e6 * fixture.angle_rad, kUm * fixture.position_mm),
      fixture.angle_rad == 0.0 && fixture.position_mm == 0.0);
  out.line("fixture-creep",
           core::phrase("at most {:.4g} urad from the first to the last touch, rectangular",
                        1e6 * fixture.creep_rad),
           fixture.creep_rad == 0.0);
}

void say_calibration(const std::optional<CalibrationInfluences>& used, Declaration& out) {
  if (!used) return;
  out.group(true);
  if (used->poses == 1) {
    out.line(
        "calibration-stations",
        core::phrase("calibration {}: errors at its stations; one pose moves no form", used->id));
    return;
  }
  out.line("calibration-stations",
           core::phrase("calibration {}: errors at its stations with their covariance and what "
                        "they share, normal, one draw for all {} poses",
                        used->id, used->poses));
  if (used->growth) {
    out.line("calibration-temperature",
             core::phrase("growth of the fixture by {:.2f} K since its calibration, rectangular",
                          used->change_K));
  } else {
    out.never("calibration-temperature",
              core::phrase("growth of the fixture since its calibration: its expansion or a "
                           "temperature is not known"));
  }
  out.never("calibration-age",
            used->age_days
                ? core::phrase("wear and settling of the fixture in the {:.1f} days "
                               "since its calibration",
                               *used->age_days)
                : core::phrase("wear and settling of the fixture since its calibration"));
}

core::Result<void> check_calibration_draws(const CalibrationInfluences& used) {
  const auto fits = [&](const Eigen::MatrixXd& draws) {
    return draws.rows() == 6 * used.poses && draws.allFinite();
  };
  if (used.poses >= 1 && fits(used.draws) && (!used.growth || fits(*used.growth))) return {};
  return core::fail_with(Code::kBadOption,
                         "the draws of the calibration are not 6 finite rows for each of {} poses",
                         used.poses);
}

}  // namespace

core::Result<void> check_influences(const Influences& influences) {
  if (influences.probe) {
    if (const auto good = check_probe(*influences.probe); !good) return good;
  }
  if (influences.machine) {
    if (const auto good = check_machine(*influences.machine); !good) return good;
  }
  if (influences.thermal) {
    if (const auto good = check_thermal(*influences.thermal); !good) return good;
  }
  if (influences.fixture) {
    if (const auto good = check_fixture(*influences.fixture); !good) return good;
  }
  if (influences.calibration) {
    if (const auto good = check_calibration_draws(*influences.calibration); !good) return good;
  }
  return {};
}

std::vector<InfluenceStatement> influence_statements(const Influences& influences) {
  Declaration out;
  say_probe(influences, out);
  say_machine(influences.machine, out);
  say_thermal(influences.thermal, out);
  if (!influences.no_fixture) say_fixture(influences.fixture, out);
  say_calibration(influences.calibration, out);
  out.never(
      "clamping",
      core::phrase("the part as clamped is what is measured; how clamping bends it is unknown"));
  out.never("contact",
            core::phrase("dirt, oil and roughness between tip and part; wear of the tip"));
  out.never("probing-strategy",
            core::phrase("speed, force and approach other than those of the qualification"));
  out.never("software",
            core::phrase("round-off; held by the certificates of the fits, not by this interval"));
  return std::move(out.lines);
}

bool is_taken_as_zero(const InfluenceStatement& line) { return line.text == taken_as_zero(); }

bool covers_probing_form(const std::vector<InfluenceStatement>& declaration) {
  return std::ranges::any_of(declaration, [](const InfluenceStatement& line) {
    return line.covered && (line.name == "probe-lobing" || line.name == "probing-form-limit");
  });
}

}  // namespace rondure::evaluation
