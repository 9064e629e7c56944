#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/measured_radius.h"
#include "evaluation/uncertainty/influences.h"
#include "fit/geometry/swing_arm.h"
#include "fit/spindle/first_harmonic.h"
#include "fit/spindle/probe_layout.h"
#include "record/tasks/analysis_influences.h"

namespace rondure::evaluation {

/// A declared influence on the errors of the probes.
struct ProbeSource {
  std::string name;                                   ///< "probe-2-gain"; "arm".
  std::string id;                                     ///< Of its draws: "probe.gain".
  std::uint64_t instance = 0;                         ///< Which of several with this id.
  fit::ProbeErrors per_u = fit::ProbeErrors::Zero();  ///< Errors for +1 standard uncertainty.
  bool rectangular = false;
  /// In place of an own draw: of an influence that another feature draws as well.
  std::function<double(std::uint64_t seed, int trial)> shared = {};

  [[nodiscard]] double draw(std::uint64_t seed, int trial) const;  ///< In standard uncertainties.
};

/// The declared influences of three probes, each by what it does to gains and angles. A line that
/// misses the centre, and an arm of another length, act exactly as angles.
/// Source: methods, analyses_uncertainty 2.1, 2.2.
/// @param radius  Of the wheel, where another feature gives it: its errors are one more source.
[[nodiscard]] std::vector<ProbeSource> probe_sources(
    const record::SpindleInfluencesTask& declared, const fit::SwingArm& arm,
    const fit::ProbeLayout& layout, const std::optional<MeasuredRadius>& radius = std::nullopt);

/// Covariance of the errors from independent sources.
[[nodiscard]] fit::ProbeErrorCovariance covariance_of(const std::vector<ProbeSource>& sources);

/// Usual errors of probes, to say whether a first harmonic could show any: gains 0.5 %, angles 0.1
/// deg.
[[nodiscard]] record::SpindleInfluencesTask usual_probes();

/// Which influences the interval covers.
/// @param noise_mm      Of a reading, as used.
/// @param states_range  Whether the plan states the range of the probes.
[[nodiscard]] std::vector<InfluenceStatement> probe_declaration(
    const record::SpindleInfluencesTask& declared, const fit::SwingArm& arm,
    const std::optional<MeasuredRadius>& radius, double noise_mm, bool states_range);

}  // namespace rondure::evaluation
