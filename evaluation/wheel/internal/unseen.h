#pragma once

#include <optional>

#include "core/phrase.h"
#include "evaluation/wheel/result.h"
#include "fit/wheel/wheel.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Lobes of a ground wheel that matter: up to this order the points must hold them.
constexpr int kOrdersOfLobes = 7;

/// What may lie between the points of a wheel.
struct BetweenPoints {
  double gap_rad = 0.0;  ///< Largest between neighbouring points, dropped ones included.
  int held = 0;          ///< Highest order of lobes whose amplitudes the places of the points hold.
  /// Most that a peak to valley lost there; none on an arc, and none where fewer orders are held
  /// than kOrdersOfLobes: lobes that the points do not hold have no bound.
  std::optional<double> loss_mm;
};

/// Of run-out about the axis, with the eccentricity, or of roundness.
[[nodiscard]] BetweenPoints between_points(const WheelResult& facts, record::Form form);

/// Why run-out or roundness is only a lower bound: a gap above fit::kWidestGap, points that
/// do not hold the lobes that matter, or a loss between the points above a tenth of the tolerance.
/// @param found  As of between_points().
[[nodiscard]] std::optional<core::Phrase> unseen_because(
    const WheelResult& facts, const BetweenPoints& found,
    const record::Characteristic& characteristic);

/// Whether R - R_nom is judged with its sign, between two limits, instead of its amount.
[[nodiscard]] bool has_signed_limits(const record::Characteristic& characteristic);
/// What the departure of a radius may be to each side: of two limits half their distance.
[[nodiscard]] std::optional<double> radius_tolerance_mm(
    const record::Characteristic& characteristic);

/// Why form makes the radius of an arc void: it may move it by more than a quarter of the
/// tolerance.
[[nodiscard]] std::optional<core::Phrase> form_moves_radius(
    const fit::WheelMeasurement& wheel, const std::optional<double>& tolerance_mm);

/// Why a radius is void by its temperature: the plan states no expansion and it may differ from
/// that at 20 degC by more than a quarter of its tolerance, or an expansion and no temperature.
[[nodiscard]] std::optional<core::Phrase> not_at_20_degC(const WheelResult& facts,
                                                         const record::Characteristic& asked);

}  // namespace rondure::evaluation
