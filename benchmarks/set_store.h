#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <utility>

#include "benchmarks/sample_sets.h"

namespace rondure::benchmarks {

/// Keeps sets between the repetitions of a benchmark: the least recently used are dropped when all
/// together exceed `kLargest_bytes`, and made again when they are asked for.
template <class Set>
class SetStore {
 public:
  using Maker = Set (*)(const SetKey&);

  explicit SetStore(Maker maker) : maker_(maker) {}

  [[nodiscard]] std::shared_ptr<const Set> get(const SetKey& key) {
    for (auto it = kept_.begin(); it != kept_.end(); ++it) {
      if (it->first != key) continue;
      kept_.splice(kept_.begin(), kept_, it);
      return kept_.front().second;
    }
    kept_.emplace_front(key, std::make_shared<const Set>(maker_(key)));
    while (kept_.size() > 1 && bytes() > kLargest_bytes) kept_.pop_back();
    return kept_.front().second;
  }

 private:
  static constexpr std::size_t kLargest_bytes = std::size_t{1} << 30;

  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& [key, set] : kept_) {
      sum += set->points_mm.size() * sizeof(set->points_mm.front());
    }
    return sum;
  }

  Maker maker_;
  std::list<std::pair<SetKey, std::shared_ptr<const Set>>> kept_;
};

/// The program's stores.
[[nodiscard]] inline std::shared_ptr<const CylinderSet> cylinder_set(const SetKey& key) {
  static SetStore<CylinderSet> store(make_cylinder);
  return store.get(key);
}
[[nodiscard]] inline std::shared_ptr<const CircleSet> circle_set(const SetKey& key) {
  static SetStore<CircleSet> store(make_circle);
  return store.get(key);
}

}  // namespace rondure::benchmarks
