#pragma once

#include <optional>
#include <span>
#include <vector>

#include "evaluation/results/gate.h"
#include "evaluation/rotary/result.h"

namespace rondure::evaluation {

/// What the visits of a calibration say of the drive and of the placing of the body.
struct PlacingFacts {
  double off_rad = 0.0;  ///< Largest reading of the other axis while a station is measured.
  double off_limit_rad = 0.0;
  double missed_rad = 0.0;  ///< Largest distance of a reading from its command.
  /// None: the journal does not say how fine the drive is.
  std::optional<double> missed_limit_rad;
  int references = 0;
  /// Largest difference of a ball between two zero poses, in its standard uncertainty.
  double reference_sigmas = 0.0;
};

/// Condition, redundancy, and chi2 of the stations of some axes.
[[nodiscard]] std::vector<Gate> station_gates(std::span<const AxisFacts> axes, double condition);

/// Whether what is left at combined poses is explained (rms).
[[nodiscard]] Gate residual_gate(double rms_mm, double expected_mm);

/// The gates of a calibration, in the order of the pages; all of them, passed or not. The scales of
/// `facts` are known.
[[nodiscard]] std::vector<Gate> rotary_gates(const RotaryResult& facts,
                                             const PlacingFacts& placing);

/// Why the combined poses do not show what is left between the stations: those that lie off the
/// stations of both axes by a third of the step cover less than half of their range.
[[nodiscard]] std::optional<core::Phrase> residual_not_shown(const RotaryResult& facts);

/// The reason of the first gate that voids; none when there is no such gate.
[[nodiscard]] std::optional<core::Phrase> voided_by(const std::vector<Gate>& gates);

}  // namespace rondure::evaluation
