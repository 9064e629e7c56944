#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/phrase.h"
#include "evaluation/results/analysis_value.h"
#include "evaluation/results/gate.h"
#include "evaluation/results/measured_radius.h"
#include "fit/profiles/roundness.h"
#include "fit/spindle/axis_motion.h"
#include "fit/spindle/first_harmonic.h"
#include "fit/spindle/three_probe.h"
#include "record/tasks/analysis_influences.h"
#include "record/tasks/spindle.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// All results for a spindle feature.
struct SpindleResult {
  fit::SwingArm arm;
  fit::ThreeProbeResult separation;
  fit::RoundnessEvaluation roundness;  ///< Roundness of the recovered profile.
  fit::AxisMotion x;                   ///< ISO 230-7, fixed directions.
  fit::AxisMotion y;
  std::optional<MeasuredRadius> wheel_radius = {};  ///< Where it is that of another feature.
  std::string feature_id = {};                      ///< Makes draws of noise its own.
  /// The influences that the plan declares; none: it declares none.
  std::optional<record::SpindleInfluencesTask> influences = {};
  /// By the declared errors of the probes; without gain and angle by usual ones, and then only its
  /// blindness counts.
  std::optional<fit::FirstHarmonic> first_harmonic = {};
  /// Greatest noise gain of a recovered harmonic where a declared influence moves the angles of the
  /// probes by up to two standard uncertainties, and its limit.
  double gain_within = 0.0;
  double greatest_gain = HUGE_VAL;
  std::optional<double> probe_range_mm = {};  ///< Whole range of a probe, where the plan states it.
  double greatest_reading_mm = 0.0;           ///< Largest distance of a reading from 0.
  /// Why the settings allow no interval: the printed formula.
  std::optional<core::Phrase> no_interval_because = {};
  std::optional<core::Phrase> void_because = {};  ///< The gate that voids every value.

  /// Whether gains and angles of the probes are declared.
  [[nodiscard]] bool declares_probes() const {
    return influences && influences->gain_1 && influences->angle_deg;
  }
};

/// What the declared non-linearity of the probes makes of the eccentricity: an oval that is not the
/// part's, c^2 q / 2 with q = 4 quadratic_1 / range [mm]. None: range or non-linearity not stated.
[[nodiscard]] std::optional<double> false_oval_mm(const SpindleResult& result);
/// The limit that the false oval must not exceed by a twentieth; none where no oval enters.
[[nodiscard]] std::optional<double> limit_of_oval_mm(const record::Characteristic& asked);
/// Share of a limit that the false oval may take.
constexpr double kOvalShare = 1.0 / 20.0;
/// Why a characteristic is void by the false oval; none where it is small enough.
[[nodiscard]] std::optional<core::Phrase> oval_reason(const SpindleResult& result,
                                                      const record::Characteristic& asked);

/// Turns from which asynchronous motion is judged: it grows with their number.
constexpr int kLeastAsynchronousTurns = 8;
/// Standard uncertainty of an amplitude up to which its limit is judged, in parts of the limit.
constexpr double kWeakShare = 0.25;

/// What the filter of the profile passes of the readings above the highest harmonic recovered, of
/// amplitudes that stand out of the noise: most of a peak to valley, or the rms [mm].
[[nodiscard]] double passed_beyond_mm(const SpindleResult& result, bool rms);
/// Why roundness misses harmonics that the filter of the profile passes, or nothing: the cut-off is
/// above the highest recovered, those above it hold more than a tenth of the tolerance, or the
/// readings were filtered before.
[[nodiscard]] std::optional<core::Phrase> beyond_the_band(const SpindleResult& result,
                                                          const record::Characteristic& asked);
/// Why a motion above its limit may be form of the part above the highest harmonic recovered; or
/// nothing.
[[nodiscard]] std::optional<core::Phrase> form_in_motion(const SpindleResult& result,
                                                         double value_mm,
                                                         const record::Characteristic& asked);
/// Why motion holds the drift of a probe: it is more than a tenth of the tolerance a turn, and not
/// declared; or nothing.
[[nodiscard]] std::optional<core::Phrase> drift_because(const SpindleResult& result,
                                                        const record::Characteristic& asked);
/// Why nothing vouches for the arm of tracking probes: no eccentricity shows it and it is not
/// declared; or nothing.
[[nodiscard]] std::optional<core::Phrase> blind_on_an_arm(const SpindleResult& result);
/// Why the readings do not show total motion, or nothing.
[[nodiscard]] std::optional<core::Phrase> one_turn_of_total(const SpindleResult& result);
/// All gates of a spindle, passed or not.
[[nodiscard]] std::vector<Gate> gates_of(const SpindleResult& result,
                                         const fit::ProbeReadings& readings,
                                         std::span<const record::Characteristic> characteristics);
/// Whether a gate of gates_of() that voids, voids every value, not those of some characteristics.
[[nodiscard]] bool voids_all(const Gate& gate);

/// Layout and settings of a separation as a plan or the command line spells them.
[[nodiscard]] core::Result<fit::ProbeLayout> probe_layout(const record::SpindleTask& task);
[[nodiscard]] fit::ThreeProbeOptions separation_options(const record::SpindleTask& task);

/// Evaluates feature `index` of a record.
/// @param earlier  Asked where another feature gives the wheel radius.
/// @param result  Holds the feature; receives the warnings and the gates.
/// @return  The result, or the reason why there is none.
[[nodiscard]] core::Result<SpindleResult> evaluate_spindle(const record::RunRecord& record,
                                                           int index, const RadiusOf& earlier,
                                                           FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const SpindleResult& result,
                                                   const record::Characteristic& characteristic);
/// The intervals of these values, in their order; or why there is none.
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const SpindleResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
[[nodiscard]] ValueOperator operator_of(const SpindleResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const SpindleResult& result);
[[nodiscard]] core::Phrase sampling_text(const SpindleResult& result);

/// Roundness of a recovered profile, with all references.
/// @param cutoff_upr  Gaussian low pass; 0: unfiltered.
[[nodiscard]] core::Result<SpindleResult> spindle_facts(const fit::ProbeReadings& readings,
                                                        const fit::SwingArm& arm,
                                                        const fit::ProbeLayout& layout,
                                                        const fit::ThreeProbeOptions& options,
                                                        double cutoff_upr, bool inside);

/// The readings of a series with the columns alpha_deg, H1_um, H2_um, H3_um[, beta_deg].
[[nodiscard]] fit::ProbeReadings probe_readings(const record::Series& series);

}  // namespace rondure::evaluation
