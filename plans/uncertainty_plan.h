#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plans/machine_errors_plan.h"

namespace rondure::plans {

// decision_rule and uncertainty, named as in the JSON. See plan.h.

/// Knowledge about parts of this kind before the measurement.
struct PriorPlan {
  std::string distribution = "gamma";  ///< Or "normal", truncated at 0.
  double mean_um = 0.0;
  double standard_deviation_um = 0.0;
};

struct DecisionRulePlan {
  std::string rule = "simple-acceptance";
  std::string measurand = "sampled-points";  ///< Or "whole-surface".
  std::string judge = "as-read";             ///< Or "corrected".
  double guard_factor = 1.0;                 ///< For "iso-14253-1".
  double consumer_risk_percent = 5.0;        ///< For "jcgm-106".
  double producer_risk_percent = 5.0;        ///< For "jcgm-106".
  std::optional<PriorPlan> prior;
  double ratio = 4.0;                       ///< N of "n-to-1".
  double acceptance_guard_percent = 100.0;  ///< For "guard-band".
  double rejection_guard_percent = 100.0;   ///< For "guard-band".
  // The statements of ASME B89.7.3.1; required by "n-to-1" and "guard-band".
  std::string zones;
  std::string outcomes;
  std::string repeats;
  std::string outliers;
};

/// One lobe of the pre-travel, of unknown phase.
struct LobeInfluencePlan {
  int order = 3;
  double amplitude_um = 0.0;
};

struct ProbeInfluencesPlan {
  std::optional<double> repeatability_um;  ///< None: determined from the repeats of the run.
  double degrees_of_freedom = 0.0;         ///< For `repeatability_um`; 0: known exactly.
  double correlation_length_mm = 0.0;      ///< For a scan; 0: touches are independent.
  std::vector<LobeInfluencePlan> lobes;
  double form_limit_um = 0.0;
  std::optional<double> tip_radius_um;  ///< None: determined by the qualification of the run.
};

struct MachineInfluencesPlan {
  std::vector<TranslationErrorPlan> translations;
  std::vector<RotationErrorPlan> rotations;
  double squareness_xy_urad = 0.0;
  double squareness_xz_urad = 0.0;
  double squareness_yz_urad = 0.0;
  double tip_offset_x_mm = 0.0;
  double tip_offset_y_mm = 0.0;
  double tip_offset_z_mm = 0.0;
  double length_limit_um = 0.0;
  double length_limit_um_m = 0.0;
};

struct ThermalInfluencesPlan {
  double drift_K = 0.0;
  double machine_drift_x_um = 0.0;
  double machine_drift_y_um = 0.0;
  double machine_drift_z_um = 0.0;
};

struct FixtureInfluencesPlan {
  double angle_deg = 0.0;
  double position_um = 0.0;
  double creep_deg = 0.0;
};

struct FormTermPlan {
  int undulations = 2;
  int degree = 0;
  double amplitude_um = 0.0;
};

struct FormSpectrumPlan {
  std::string amplitudes = "relative";  ///< Or "absolute".
  std::vector<FormTermPlan> terms;      ///< Empty: the part's own harmonics.
};

struct UncertaintyPlan {
  double coverage_percent = 95.0;
  int least_trials = 2000;
  int most_trials = 10'000;
  double tolerance_um = 0.0;
  int budget_trials = 1000;
  double expected_spots = 0.5;
  std::uint64_t seed = 1;
  std::optional<ProbeInfluencesPlan> probe;
  std::optional<MachineInfluencesPlan> machine;
  std::optional<ThermalInfluencesPlan> thermal;
  std::optional<FixtureInfluencesPlan> fixture;
  std::optional<FormSpectrumPlan> form_spectrum;
};

}  // namespace rondure::plans
