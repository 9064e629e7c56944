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
/// How drawings name the places of a feature.
struct Drawn {
  bool part_z = false;                    ///< Heights of the cloud are part z, not about its mean.
  std::optional<std::size_t> worst = {};  ///< Row of the cloud that is marked.
};

/// A feature as it is drawn: without the points in its windows, with heights in part z.
struct DrawnFeature {
  evaluation::FeatureResult feature;
  std::optional<evaluation::Zone> zone;  ///< zone_to_draw().
  Drawn places;
};
/// @param worst  Row of the cloud of `all` to be marked.
[[nodiscard]] DrawnFeature drawn_of(const evaluation::FeatureResult& all,
                                    std::optional<std::size_t> worst = {});
/// The zone of a cylinder, circle, cone or sphere, as far as its drawings need it.
[[nodiscard]] std::optional<evaluation::Zone> zone_to_draw(
    const evaluation::FeatureResult& feature);

/// Polar plots of the layers, all at one magnification.
/// @param all  The feature with the points in windows, whose sectors are shaded; null: none is.
[[nodiscard]] std::string polar_plots(const evaluation::FeatureResult& feature,
                                      const evaluation::Zone& zone,
                                      const evaluation::FeatureResult* all = nullptr,
                                      const Drawn& drawn = {});
/// The section of the worst row, else the first, with words in its middle.
[[nodiscard]] std::string worst_section(const evaluation::FeatureResult& feature,
                                        const evaluation::Zone& zone,
                                        const evaluation::FeatureResult& all, const Drawn& drawn);
/// The unrolled lateral surface; for a single section its profile.
[[nodiscard]] std::string deviation_map(const evaluation::FeatureResult& feature,
                                        const evaluation::Zone& zone, const Drawn& drawn = {});
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
/// Of these the lines that a value was found on, generatrices or the median line; empty where it
/// lies on sections or on the whole surface.
[[nodiscard]] std::string line_plots(const evaluation::CharacteristicResult& result);
/// f over the visits, and the positions of the poses.
[[nodiscard]] std::string pose_plots(const evaluation::FeatureResult& feature,
                                     const std::optional<evaluation::Zone>& zone);

}  // namespace rondure::reports
