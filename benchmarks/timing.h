#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "benchmarks/allocations.h"
#include "benchmarks/judge.h"
#include "benchmarks/set_store.h"

namespace rondure::benchmarks {

/// Sets one benchmark takes in turn, so that branch history cannot learn one of them.
struct Rotation {
  Variant variant = Variant::kScanOrder;
  std::size_t points = 0;
  std::uint64_t first_seed = 0;
  std::uint64_t seeds = 20;

  [[nodiscard]] SetKey key(std::uint64_t turn) const {
    return {variant, points, first_seed + turn % seeds};
  }
  /// "scan/n:1000000/seed:3"; without a seed when there are several.
  [[nodiscard]] std::string name() const {
    const auto seed = seeds == 1 ? fmt::format("/seed:{}", first_seed) : std::string();
    return fmt::format("{}/n:{}{}", name_of(variant), points, seed);
  }
};

inline auto set_of(const SetKey& key, const CylinderSet*) { return cylinder_set(key); }
inline auto set_of(const SetKey& key, const CircleSet*) { return circle_set(key); }

/// The sets of a rotation, held while a benchmark runs.
template <class Set>
std::vector<std::shared_ptr<const Set>> sets_of(const Rotation& rotation) {
  std::vector<std::shared_ptr<const Set>> out;
  for (std::uint64_t i = 0; i < rotation.seeds; ++i) {
    out.push_back(set_of(rotation.key(i), static_cast<const Set*>(nullptr)));
  }
  return out;
}

/// Makes the compiler compute a value. Read only: benchmark::DoNotOptimize of a variable, as in
/// version 1.7 with g++ 12, may lose a double that was just stored in it (google/benchmark #903).
template <class T>
void keep(const T& value) {
  benchmark::DoNotOptimize(value);
}

/// Adds the statistic "max" to those of Google Benchmark: one bad repetition must show.
inline void with_largest(benchmark::internal::Benchmark* entry) {
  entry->ComputeStatistics(
      "max", [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); });
}

/// Times `call(set)` over a rotation. A single set is gone through once before: the benchmarks run
/// in random order, and the fewer calls fit into the time of one, the more the caches that the
/// others left would weigh.
template <class Set, class Call>
void register_call(const std::string& what, const Rotation& rotation, Call call) {
  auto turn = std::make_shared<std::size_t>(0);  // goes on through the repetitions
  with_largest(benchmark::RegisterBenchmark(fmt::format("{}/{}", what, rotation.name()).c_str(),
                                            [rotation, call, turn](benchmark::State& state) {
                                              const auto sets = sets_of<Set>(rotation);
                                              if (sets.size() == 1) keep(call(*sets.front()));
                                              for ([[maybe_unused]] auto _ : state) {
                                                const auto result =
                                                    call(*sets[(*turn)++ % sets.size()]);
                                                keep(result);
                                              }
                                            }));
}

/// Times a peer that gives the width of a zone [mm], and tells how far it is above the best known.
template <class Set, class Call>
void register_peer(const std::string& what, const Rotation& rotation, Call call) {
  auto turn = std::make_shared<std::size_t>(0);
  with_largest(benchmark::RegisterBenchmark(
      fmt::format("{}/{}", what, rotation.name()).c_str(),
      [rotation, call, turn](benchmark::State& state) {
        const auto sets = sets_of<Set>(rotation);
        std::vector<double> widths_mm(sets.size(), 0.0);
        std::vector<bool> timed(sets.size(), false);
        for ([[maybe_unused]] auto _ : state) {
          const std::size_t i = (*turn)++ % sets.size();
          widths_mm[i] = call(*sets[i]);
          keep(widths_mm[i]);
          timed[i] = true;
        }
        double excess = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < sets.size(); ++i) {
          if (!timed[i]) continue;  // its turn did not come
          excess = std::max(excess, excess_of(rotation.key(i), *sets[i], widths_mm[i]));
        }
        state.counters["excess"] = excess;
      }));
}

/// What is written beside the time of a zone.
struct ZoneCounters {
  double excess = 0.0;
  double width_um = 0.0;
  int faults = 0;  ///< Fits that failed or whose witness does not prove them.
  int passes = 0;  ///< Over all points.
  int pivots = 0;  ///< Of the linear programs.

  void write(benchmark::State& state) const {
    state.counters["excess"] = excess;
    state.counters["width_um"] = width_um;
    state.counters["faults"] = faults;
    state.counters["passes"] = passes;
    state.counters["pivots"] = pivots;
  }
};

/// Keeps judgements between repetitions: equal radii of a set need no second judgement.
class Judge {
 public:
  template <class Set, class Zone>
  void take(const SetKey& key, const Set& set, const Zone& zone) {
    const auto radii = std::pair(zone.inner_radius_mm, zone.outer_radius_mm);
    const auto seen = judged_.find(key);
    if (seen != judged_.end() && seen->second == radii) return;
    judged_[key] = radii;
    const Judgement judgement = judge(key, set, zone);
    counters_.excess = std::max(counters_.excess, judgement.excess);
    counters_.width_um = std::max(counters_.width_um, judgement.width_um);
    counters_.passes = std::max(counters_.passes, zone.passes);
    counters_.pivots = std::max(counters_.pivots, zone.pivots);
    if (!judgement.fault.empty()) fault(key, judgement.fault);
  }

  void fault(const SetKey& key, const std::string& why) {
    ++counters_.faults;
    fmt::print(stderr, "{} n {} seed {}: {}\n", name_of(key.variant), key.points, key.seed, why);
  }

  [[nodiscard]] const ZoneCounters& counters() const { return counters_; }

 private:
  std::map<SetKey, std::pair<double, double>> judged_;
  ZoneCounters counters_;  ///< The worst so far.
};

/// Heap allocations of a call that was made before with the same set.
template <class Set>
double allocations_of_zone(const Set& set) {
  const auto warm = own_zone(set);
  const std::uint64_t before = allocations();
  const auto again = own_zone(set);
  const auto count = static_cast<double>(allocations() - before);
  keep(warm);
  keep(again);
  return count;
}

/// Times own_zone() over a rotation and judges each result that was timed.
template <class Set>
void register_zone(const std::string& what, const Rotation& rotation) {
  auto turn = std::make_shared<std::size_t>(0);
  auto judge = std::make_shared<Judge>();
  with_largest(benchmark::RegisterBenchmark(
      fmt::format("{}/{}", what, rotation.name()).c_str(),
      [rotation, turn, judge](benchmark::State& state) {
        const auto sets = sets_of<Set>(rotation);
        std::vector<decltype(own_zone(*sets.front()))> zones(sets.size());
        std::vector<bool> timed(sets.size(), false);
        if (sets.size() == 1) keep(own_zone(*sets.front()));
        for ([[maybe_unused]] auto _ : state) {
          const std::size_t i = (*turn)++ % sets.size();
          zones[i] = own_zone(*sets[i]);
          keep(zones[i]);
          timed[i] = true;
        }
        for (std::size_t i = 0; i < sets.size(); ++i) {
          if (!timed[i]) continue;
          if (zones[i]) {
            judge->take(rotation.key(i), *sets[i], *zones[i]);
          } else {
            judge->fault(rotation.key(i), zones[i].error().what);
          }
        }
        judge->counters().write(state);
        state.counters["allocations"] = allocations_of_zone(*sets.front());
      }));
}

}  // namespace rondure::benchmarks
