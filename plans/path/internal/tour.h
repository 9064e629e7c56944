#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "plans/path/sampling.h"
#include "plans/path/travel.h"

namespace rondure::plans {

/// Length of the path between two stops [mm]; symmetric. Stop `n` of n targets is the sky, where
/// the tour starts and ends.
using TourCost = std::function<double(std::size_t from, std::size_t to)>;

/// Length of a tour from the sky through all stops in this order and back to it.
[[nodiscard]] double tour_length_mm(std::span<const std::size_t> order, const TourCost& cost);

/// A short order of touching, as indices into the targets. Up to 7 targets: the shortest order. Up
/// to 128: the best of layer after layer, layers in alternating sense, and columns up and down,
/// each improved by reversing (2-opt) and moving pieces of up to three stops. Beyond: without
/// improvement. Never longer by `cost` than the order of the targets themselves. The same input
/// gives the same order. O(n^2) per round up to 128 stops, O(n log n) beyond.
[[nodiscard]] std::vector<std::size_t> short_tour(std::span<const Target> targets,
                                                  const TourCost& cost);

/// The cost of a path around the bare feature, by path_between() or over its end.
[[nodiscard]] TourCost bare_cost(std::span<const Target> targets, const PathGeometry& geometry);

}  // namespace rondure::plans
