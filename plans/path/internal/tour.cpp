#include "plans/path/internal/tour.h"

#include <algorithm>
#include <numeric>

#include "plans/path/scene.h"

namespace rondure::plans {
namespace {

using Order = std::vector<std::size_t>;

constexpr std::size_t kEnumerated = 7;  // stops up to which all orders are tried
constexpr std::size_t kImproved = 128;  // stops up to which a tour is improved
constexpr double kGain_mm = 1e-9;       // smaller gains are rounding

/// Table of the costs between all stops and the sky.
class CostTable {
 public:
  CostTable(std::size_t stops, const TourCost& cost) : side_(stops + 1) {
    table_.reserve(side_ * side_);
    for (std::size_t i = 0; i < side_; ++i) {
      for (std::size_t j = 0; j < side_; ++j) table_.push_back(i == j ? 0.0 : cost(i, j));
    }
  }
  double operator()(std::size_t i, std::size_t j) const { return table_[i * side_ + j]; }

 private:
  std::size_t side_;
  std::vector<double> table_;
};

/// Reverses pieces of the ring as long as that shortens it. `ring[0]` is the sky.
bool turn_round(Order& ring, const CostTable& cost) {
  bool better = false;
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i + 2 < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      const std::size_t after = ring[(j + 1) % n];
      const double gain = cost(ring[i], ring[i + 1]) + cost(ring[j], after) -
                          cost(ring[i], ring[j]) - cost(ring[i + 1], after);
      if (gain <= kGain_mm) continue;
      std::reverse(ring.begin() + static_cast<std::ptrdiff_t>(i + 1),
                   ring.begin() + static_cast<std::ptrdiff_t>(j + 1));
      better = true;
    }
  }
  return better;
}

/// Moves ring[from .. from + count) to after ring[to] if that shortens the ring.
bool move_piece(Order& ring, std::size_t from, std::size_t count, std::size_t to,
                const CostTable& cost) {
  const std::size_t n = ring.size();
  if (to + 1 >= from && to < from + count) return false;
  const std::size_t first = ring[from];
  const std::size_t last = ring[from + count - 1];
  const std::size_t before = ring[from - 1];
  const std::size_t behind = ring[(from + count) % n];
  const std::size_t left = ring[to];
  const std::size_t right = ring[(to + 1) % n];
  const double gain = cost(before, first) + cost(last, behind) - cost(before, behind) +
                      cost(left, right) - cost(left, first) - cost(last, right);
  if (gain <= kGain_mm) return false;
  const auto at = [&](std::size_t i) { return ring.begin() + static_cast<std::ptrdiff_t>(i); };
  if (to < from) {
    std::rotate(at(to + 1), at(from), at(from + count));
  } else {
    std::rotate(at(from), at(from + count), at(to + 1));
  }
  return true;
}

bool move_pieces(Order& ring, const CostTable& cost) {
  bool better = false;
  for (std::size_t count = 1; count <= 3; ++count) {
    for (std::size_t from = 1; from + count <= ring.size(); ++from) {
      for (std::size_t to = 0; to < ring.size(); ++to) {
        if (move_piece(ring, from, count, to, cost)) better = true;
      }
    }
  }
  return better;
}

Order improved(Order order, const TourCost& cost) {
  const std::size_t n = order.size();
  const CostTable table(n, cost);
  Order ring = {n};
  ring.insert(ring.end(), order.begin(), order.end());
  // Every change shortens the ring by more than kGain_mm, so this ends; the limit is a safeguard.
  for (int round = 0; round < 100; ++round) {
    const bool turned = turn_round(ring, table);
    if (!move_pieces(ring, table) && !turned) break;
  }
  return {ring.begin() + 1, ring.end()};
}

/// The shortest of all orders.
Order shortest(Order order, const TourCost& cost) {
  const CostTable table(order.size(), cost);
  Order best = order;
  double best_mm = tour_length_mm(best, table);
  while (std::next_permutation(order.begin(), order.end())) {
    const double mm = tour_length_mm(order, table);
    if (mm >= best_mm - kGain_mm) continue;
    best = order;
    best_mm = mm;
  }
  return best;
}

/// The indices sorted by keys; equal keys keep their order.
template <class Key>
Order sorted(std::size_t n, const Key& key) {
  Order out(n);
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::stable_sort(out.begin(), out.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return out;
}

}  // namespace

double tour_length_mm(std::span<const std::size_t> order, const TourCost& cost) {
  if (order.empty()) return 0.0;
  const std::size_t sky = order.size();
  double sum = cost(sky, order.front()) + cost(order.back(), sky);
  for (std::size_t k = 1; k < order.size(); ++k) sum += cost(order[k - 1], order[k]);
  return sum;
}

std::vector<std::size_t> short_tour(std::span<const Target> targets, const TourCost& cost) {
  const std::size_t n = targets.size();
  Order best = sorted(n, [](std::size_t i) { return i; });
  double best_mm = tour_length_mm(best, cost);
  if (n <= kEnumerated) return shortest(std::move(best), cost);
  const auto offer = [&](Order order) {
    if (n <= kImproved) order = improved(std::move(order), cost);
    const double mm = tour_length_mm(order, cost);
    if (mm >= best_mm - kGain_mm) return;
    best = std::move(order);
    best_mm = mm;
  };
  offer(best);
  offer(sorted(n, [&](std::size_t i) {  // layers, every other one backward
    const Target& t = targets[i];
    return std::pair(t.layer, t.layer % 2 == 0 ? t.point : -t.point);
  }));
  offer(sorted(n, [&](std::size_t i) {  // columns, every other one downward
    const Target& t = targets[i];
    return std::pair(t.point, t.point % 2 == 0 ? t.layer : -t.layer);
  }));
  return best;
}

TourCost bare_cost(std::span<const Target> targets, const PathGeometry& geometry) {
  return [targets, geometry](std::size_t from, std::size_t to) {
    const std::size_t sky = targets.size();
    if (from == sky) return length_mm(entry_path(geometry, targets[to]));
    if (to == sky) return length_mm(exit_path(geometry, targets[from]));
    // The same direction for both, so that they have the same rounding.
    const Target& a = targets[std::min(from, to)];
    const Target& b = targets[std::max(from, to)];
    const double around_mm = length_mm(path_between(geometry, a, b));
    if (geometry.inside) return around_mm;
    const Polyline out = exit_path(geometry, a);
    const Polyline in = entry_path(geometry, b);
    return std::min(around_mm, length_mm(out) + (in.front() - out.back()).norm() + length_mm(in));
  };
}

}  // namespace rondure::plans
