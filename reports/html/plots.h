#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"

namespace rondure::reports {

/// The drawings of the page, as HTML (inline SVG with captions). An empty string means that there
/// is nothing to draw.

/// Symbol of a verdict: a filled disc with a tick, a filled octagon with a cross, ... Shape and
/// colour both differ.
[[nodiscard]] std::string verdict_mark(evaluation::Verdict verdict, int size_px);
/// ISO 1101 symbol of a geometrical tolerance; empty of a characteristic that has none.
[[nodiscard]] std::string form_symbol(record::Form form);
/// The value with its interval, relative to limit and guard bands. The characteristic must have a
/// value.
[[nodiscard]] std::string tolerance_bar(const evaluation::CharacteristicResult& result,
                                        double tolerance_mm);
/// Judged values, at least one, between a lower and an upper limit with their guard bands. The
/// characteristic must have a value.
[[nodiscard]] std::string limits_bar(const evaluation::CharacteristicResult& result,
                                     const std::vector<evaluation::JudgedValue>& judged);
/// Ranked bars of an uncertainty budget.
[[nodiscard]] std::string budget_bars(const std::vector<evaluation::BudgetLine>& budget,
                                      core::ValueUnit unit);

/// Polar plots of the layers, all at one magnification.
/// @param all  The feature with the points in windows, whose sectors are shaded; null: none is.
[[nodiscard]] std::string polar_plots(const evaluation::FeatureResult& feature,
                                      const evaluation::Zone& zone,
                                      const evaluation::FeatureResult* all = nullptr);
/// The unrolled lateral surface; for a single section its profile.
[[nodiscard]] std::string deviation_map(const evaluation::FeatureResult& feature,
                                        const evaluation::Zone& zone);
/// The cylinder with its zone and its points in three dimensions: complete without the script of
/// the page (html/internal/script.h), which turns it. Empty for a single section.
[[nodiscard]] std::string solid_view(const evaluation::FeatureResult& feature,
                                     const evaluation::Zone& zone);
/// The points of a plane over its disc, coloured by their height over the middle of the zone.
[[nodiscard]] std::string face_map(const evaluation::FeatureResult& feature);
/// How the value of a characteristic lies on its feature: local values with their limit,
/// generatrices, the median line about its datum.
[[nodiscard]] std::string finding_plots(const evaluation::CharacteristicResult& result,
                                        double nominal_mm);
/// f over the visits, and the positions of the poses.
[[nodiscard]] std::string pose_plots(const evaluation::FeatureResult& feature,
                                     const std::optional<evaluation::Zone>& zone);

}  // namespace rondure::reports
