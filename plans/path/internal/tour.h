#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "plans/path/sampling.h"
#include "plans/path/travel.h"

namespace rondure::plans {

/// Length of the way between two stops [mm]; symmetric. Stop `n` of n targets is the sky, where the
/// tour begins and ends.
using TourCost = std::function<double(std::size_t from, std::size_t to)>;

/// Sum over a tour from the sky through all stops in this order and back to it.
[[nodiscard]] double tour_length_mm(std::span<const std::size_t> order, const TourCost& cost);

/// A short order in which to touch targets, as indices into them: the shortest of all for up to 7;
/// the best of layer after layer, layers to and fro and columns up and down, each improved by
/// turning round (2-opt) and moving pieces of up to three stops, up to 128; beyond without
/// improvement. Never longer than the order given by the targets themselves, as `cost` says. Same
/// input, same order. O(n^2) a round up to 128 stops, O(n log n) beyond.
[[nodiscard]] std::vector<std::size_t> short_tour(std::span<const Target> targets,
                                                  const TourCost& cost);

/// The cost of a way around the bare feature: what path_between(), or over its end, measures.
[[nodiscard]] TourCost bare_cost(std::span<const Target> targets, const PathGeometry& geometry);

}  // namespace rondure::plans
