#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/key_spec.h"
#include "record/run_record.h"
#include "record/tasks/axis_errors.h"

namespace rondure::record {

/// One lobe of the pre-travel, of unknown phase.
struct LobeInfluenceTask {
  int order = 3;
  double amplitude_um = 0.0;
};

struct ProbeInfluencesTask {
  std::optional<double> repeatability_um;  ///< None: from the repeats of the run.
  double degrees_of_freedom = 0.0;         ///< Those of the value above; 0: known exactly.
  double correlation_length_mm = 0.0;      ///< For a scan; 0: touches are independent.
  std::vector<LobeInfluenceTask> lobes;
  double form_limit_um = 0.0;
  std::optional<double> tip_radius_um;  ///< None: from the qualification of the run.
  /// None: 0. Optional, so that journals written before it are complete.
  std::optional<double> reference_sphere_um;
};

struct MachineInfluencesTask {
  std::vector<TranslationError> translations;
  std::vector<RotationError> rotations;
  double squareness_xy_urad = 0.0;
  double squareness_xz_urad = 0.0;
  double squareness_yz_urad = 0.0;
  double tip_offset_x_mm = 0.0;
  double tip_offset_y_mm = 0.0;
  double tip_offset_z_mm = 0.0;
  double length_limit_um = 0.0;
  double length_limit_um_m = 0.0;
};

struct ThermalInfluencesTask {
  double drift_K = 0.0;
  double machine_drift_x_um = 0.0;
  double machine_drift_y_um = 0.0;
  double machine_drift_z_um = 0.0;
};

struct FixtureInfluencesTask {
  double angle_deg = 0.0;
  double position_um = 0.0;
  double creep_deg = 0.0;
};

struct FormTermTask {
  int undulations = 2;
  int degree = 0;
  double amplitude_um = 0.0;
};

struct FormSpectrumTask {
  enum class Amplitudes { kRelative, kAbsolute };

  Amplitudes amplitudes = Amplitudes::kRelative;
  std::vector<FormTermTask> terms;  ///< Empty: the part's own harmonics.
};

RONDURE_WORDS(FormSpectrumTask::Amplitudes, {kRelative, "relative"}, {kAbsolute, "absolute"});

/// The influences declared of a measurement, as plan and journal spell it. A member initialiser is
/// the default of its key.
struct UncertaintyTask {
  double coverage_percent = 95.0;
  int least_trials = 2000;
  int most_trials = 10'000;
  double tolerance_um = 0.0;
  int budget_trials = 1000;
  double expected_spots = 0.5;
  std::uint64_t seed = 1;
  std::optional<ProbeInfluencesTask> probe;
  std::optional<MachineInfluencesTask> machine;
  std::optional<ThermalInfluencesTask> thermal;
  std::optional<FixtureInfluencesTask> fixture;
  std::optional<FormSpectrumTask> form_spectrum;
};

template <class Visitor>
void describe(Visitor& v, LobeInfluenceTask& p) {
  v.whole("order", p.order, required(range(1, 50, "Lobes in a turn.")));
  v.number("amplitude_um", p.amplitude_um,
           required(range(0.0, 1000.0, "Half of peak to valley; its phase is taken as unknown.")));
}

template <class Visitor>
void describe(Visitor& v, ProbeInfluencesTask& p) {
  v.number("repeatability_um", p.repeatability_um,
           range(0.0, 1000.0,
                 "Standard deviation of one touch; normal. Left out: that of the repeated touches "
                 "of the run."));
  v.number("degrees_of_freedom", p.degrees_of_freedom,
           range(0.0, 1e6,
                 "Those of repeatability_um; 0: it is known exactly. Repeats of the run bring "
                 "their own."));
  v.number("correlation_length_mm", p.correlation_length_mm,
           range(0.0, 1000.0,
                 "Of a scan: distance along the surface over which the correlation of errors falls "
                 "to 1/e. 0: none."));
  v.list("lobes", p.lobes, {.meaning = "How the pre-travel changes with the direction."});
  v.number("form_limit_um", p.form_limit_um,
           range(0.0, 1000.0,
                 "Limit of the probing form error (ISO 10360-5), where repeatability and lobes are "
                 "unknown."));
  v.number("tip_radius_um", p.tip_radius_um,
           range(0.0, 1000.0,
                 "Of the qualified tip radius; normal. Left out: that of the qualification."));
  v.number("reference_sphere_um", p.reference_sphere_um,
           range(0.0, 1000.0,
                 "Of the certified radius of the reference sphere; normal. It moves all sizes of a "
                 "run alike. Left out: 0."));
}

template <class Visitor>
void describe(Visitor& v, MachineInfluencesTask& p) {
  v.list("translations", p.translations,
         {.meaning = "Standard uncertainty of each coefficient; a wave has this amplitude and an "
                     "unknown phase."});
  v.list("rotations", p.rotations, {.meaning = "The same of roll, pitch and yaw."});
  constexpr std::string_view kSquare = "Standard uncertainty of the angle between these axes.";
  v.number("squareness_xy_urad", p.squareness_xy_urad, range(0.0, 10'000.0, kSquare));
  v.number("squareness_xz_urad", p.squareness_xz_urad, range(0.0, 10'000.0, kSquare));
  v.number("squareness_yz_urad", p.squareness_yz_urad, range(0.0, 10'000.0, kSquare));
  constexpr std::string_view kOffset = "From where the ram turns to the tip.";
  v.number("tip_offset_x_mm", p.tip_offset_x_mm, within(2000.0, kOffset));
  v.number("tip_offset_y_mm", p.tip_offset_y_mm, within(2000.0, kOffset));
  v.number("tip_offset_z_mm", p.tip_offset_z_mm, within(2000.0, kOffset));
  v.number("length_limit_um", p.length_limit_um,
           range(0.0, 1000.0, "Limit of the length error (ISO 10360-2): constant part."));
  v.number("length_limit_um_m", p.length_limit_um_m,
           range(0.0, 1000.0, "The same: part that grows with the length."));
}

template <class Visitor>
void describe(Visitor& v, ThermalInfluencesTask& p) {
  v.number("drift_K", p.drift_K,
           range(0.0, 20.0, "Largest change of the part from the first to the last touch; even."));
  constexpr std::string_view kDrift =
      "Largest change of the reading of a fixed point in that time; rectangular.";
  v.number("machine_drift_x_um", p.machine_drift_x_um, range(0.0, 1000.0, kDrift));
  v.number("machine_drift_y_um", p.machine_drift_y_um, range(0.0, 1000.0, kDrift));
  v.number("machine_drift_z_um", p.machine_drift_z_um, range(0.0, 1000.0, kDrift));
}

template <class Visitor>
void describe(Visitor& v, FixtureInfluencesTask& p) {
  v.number("angle_deg", p.angle_deg,
           range(0.0, 10.0, "Standard uncertainty of the pose about each axis; normal."));
  v.number("position_um", p.position_um,
           range(0.0, 1000.0, "Standard uncertainty of the pivot in a pose; normal."));
  v.number("creep_deg", p.creep_deg,
           range(0.0, 10.0, "Largest turn of the part from the first to the last touch; even."));
}

template <class Visitor>
void describe(Visitor& v, FormTermTask& p) {
  v.whole("undulations", p.undulations, required(range(0, 200, "In a turn.")));
  v.whole("degree", p.degree, range(0, 20, "Of the Legendre polynomial along the part."));
  v.number("amplitude_um", p.amplitude_um,
           required(range(0.0, 1000.0, "Standard deviation of its coefficients.")));
}

template <class Visitor>
void describe(Visitor& v, FormSpectrumTask& p) {
  v.text("amplitudes", p.amplitudes,
         {.meaning = "relative: only their ratios are known; their common size is estimated from "
                     "the points."});
  v.list("terms", p.terms,
         {.meaning = "Forms the surface may have; left out: the part's own harmonics, from dense "
                     "layers (14 points and more)."});
}

/// The groups of influences; one that is left out is not covered by the interval.
template <class Visitor>
void describe_groups(Visitor& v, UncertaintyTask& p) {
  v.object("probe", p.probe, {.meaning = "Declared influences of the probe."});
  v.object("machine", p.machine, {.meaning = "Of the geometry of the machine."});
  v.object("thermal", p.thermal,
           {.meaning = "Of temperature, besides part.expansion_uncertainty_per_K and "
                       "environment.temperature_uncertainty_K."});
  v.object("fixture", p.fixture, {.meaning = "Of the fixture."});
  v.object(
      "form_spectrum", p.form_spectrum,
      {.meaning =
           "Possible form between the points; without it nothing is said of the whole surface."});
}

template <class Visitor>
void describe(Visitor& v, UncertaintyTask& p) {
  v.number("coverage_percent", p.coverage_percent,
           range(50.0, 99.9, "Probability of the coverage interval."));
  v.whole("least_trials", p.least_trials, range(2000, 1'000'000, "Trials at least."));
  v.whole("most_trials", p.most_trials, range(2000, 1'000'000, "Trials at most."));
  v.number("tolerance_um", p.tolerance_um,
           range(0.0, 100.0,
                 "Numerical tolerance (JCGM 101, 7.9): trials end when the printed numbers are "
                 "known this well; 0: all are done."));
  v.whole("budget_trials", p.budget_trials,
          range(0, 1'000'000, "Trials of each influence alone; 0: no budget."));
  v.number("expected_spots", p.expected_spots,
           range(0.01, 10.0,
                 "Isolated points (burrs, dirt, scratches) expected on a part: they are form and "
                 "are never smoothed away."));
  v.whole("seed", p.seed, range(0, 9007199254740991.0, "Same seed, same numbers."));
  describe_groups(v, p);
}

/// Settings of `uncertainty` in the journal of a run, beside the keys of the plan.
struct DeclaredUncertainty {
  std::optional<double>
      expansion_per_K;  ///< Expansion of the part, for points that bring no temperatures.
  std::vector<std::string> groups;  ///< Those declared, as describe_groups() names them.
};

/// Visitor of describe_groups(): the names of all groups, or of those that a task declares.
struct GroupNames {
  bool all = false;
  std::vector<std::string_view> names = {};

  template <class T>
  void object(std::string_view key, const std::optional<T>& group, const GroupSpec&) {
    if (all || group) names.push_back(key);
  }
};

template <class Visitor>
void describe(Visitor& v, DeclaredUncertainty& p) {
  v.number("thermal/expansion_per_K", p.expansion_per_K, within(1.0, "Of the part."));
  GroupNames known{.all = true};
  UncertaintyTask task;
  describe_groups(known, task);
  v.texts("declared", p.groups, {.one_of = known.names, .meaning = "Groups that are declared."});
}

/// The settings of a run that declares its uncertainty.
/// @param expansion_per_K  Of the part, where the plan states it.
[[nodiscard]] std::vector<Setting> settings_of_uncertainty(
    const UncertaintyTask& task, const std::optional<double>& expansion_per_K);

/// The uncertainty that a run declares.
struct RecordedUncertainty {
  UncertaintyTask task;
  std::optional<double> expansion_per_K;
};

/// The reverse of settings_of_uncertainty(). A group counts where it is declared, and only there.
/// @return  Nothing when the run declares no uncertainty; the errors of task_of().
[[nodiscard]] core::Result<std::optional<RecordedUncertainty>> recorded_uncertainty(
    std::span<const Setting> settings);

}  // namespace rondure::record
