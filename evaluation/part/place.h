#pragma once

#include <optional>
#include <vector>

#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// Where a point lies as the shop finds it and windows are stated.
struct PlaceOnPart {
  double angle_rad = 0.0;           ///< From part x, counter-clockwise, in [0, 2 pi).
  std::optional<double> z_mm = {};  ///< Part z; of a plane the radius. None: it is not on record.
};
/// The places of the rows of a cloud, windows included; empty where its axis is not near part z.
[[nodiscard]] std::vector<PlaceOnPart> places_on_part(const FeatureResult& feature);

}  // namespace rondure::evaluation
