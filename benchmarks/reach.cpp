#include <chrono>

#include "benchmarks/sections.h"
#include "benchmarks/timing.h"

namespace rondure::benchmarks {
namespace {

/// A zone this close to the best known, relative, is the best known.
constexpr double kReached = 1e-9;

/// Counts over many sets of one kind, each fitted once.
struct Reach {
  int sets = 0;
  int reached = 0;
  int flagged = 0;  ///< Not reached, and the result says that it may not be the global one.
  int faults = 0;   ///< No result, or a witness that proves nothing.
  double excess = 0.0;

  template <class Set, class Zone>
  void take(const SetKey& key, const Set& set, const core::Result<Zone>& zone, bool flag) {
    ++sets;
    std::string fault = zone ? "" : zone.error().what;
    if (zone) {
      const Judgement judgement = judge(key, set, *zone);
      excess = std::max(excess, judgement.excess);
      if (judgement.excess <= kReached) ++reached;
      if (judgement.excess > kReached && flag) ++flagged;
      fault = judgement.fault;
    }
    if (fault.empty()) return;
    ++faults;
    fmt::print(stderr, "{} arc {:.0f} deg n {} seed {}: {}\n", name_of(key.variant),
               key.arc_rad / core::kDegree, key.points, key.seed, fault);
  }

  void write(benchmark::State& state) const {
    state.counters["sets"] = sets;
    state.counters["reached"] = reached;
    state.counters["flagged"] = flagged;
    state.counters["faults"] = faults;
    state.counters["excess"] = excess;
  }
};

/// Registers something that runs once and is counted, not timed.
template <class Run>
void register_once(const std::string& name, Run run) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [run](benchmark::State& state) {
                                 for ([[maybe_unused]] auto _ : state) run(state);
                               })
      ->Iterations(1)
      ->Repetitions(1);
}

/// A1: every variant of a shape and size.
template <class Set>
void register_variants(const char* shape, std::size_t points, unsigned seeds) {
  for (const Variant variant : kVariants) {
    register_once(fmt::format("exact/{}/{}/n:{}", shape, name_of(variant), points),
                  [=](benchmark::State& state) {
                    Reach reach;
                    for (unsigned seed = 0; seed < seeds; ++seed) {
                      const SetKey key{variant, points, seed};
                      const auto set = set_of(key, static_cast<const Set*>(nullptr));
                      reach.take(key, *set, own_zone(*set), false);
                    }
                    reach.write(state);
                  });
  }
}

/// Runs a call and adds its time [s] to `total_s`.
template <class Call>
auto clocked(double& total_s, Call call) {
  const auto before = std::chrono::steady_clock::now();
  auto result = call();
  total_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  return result;
}

/// A2, A3: arcs with few points, where other minima lie near. `reach/` is the single call,
/// `reported/` the call behind a report, which marks what it cannot prove.
void register_arc(double arc_deg, std::size_t points, unsigned seeds) {
  const auto key_of = [=](unsigned seed) {
    return SetKey{Variant::kScanOrder, points, 1000 + seed, arc_deg * core::kDegree};
  };
  const auto name = fmt::format("cylinder/arc:{:g}/n:{}", arc_deg, points);
  register_once("reach/" + name, [=](benchmark::State& state) {
    Reach reach;
    for (unsigned seed = 0; seed < seeds; ++seed) {
      const CylinderSet set = make_cylinder(key_of(seed));
      reach.take(key_of(seed), set, own_zone(set), false);
    }
    reach.write(state);
  });
  if (arc_deg >= 180.0) return;
  register_once("reported/" + name, [=](benchmark::State& state) {
    Reach reach;
    double single_s = 0.0;
    double reported_s = 0.0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
      const CylinderSet set = make_cylinder(key_of(seed));
      const auto single = clocked(single_s, [&] { return own_zone(set); });
      const auto zone = clocked(reported_s, [&] { return reported_zone(set); });
      const bool proven = zone && zone->certificate.kind == fit::Certificate::Kind::kGlobal;
      if (single) static_cast<void>(judge(key_of(seed), set, *single));  // may be the best known
      reach.take(key_of(seed), set, zone, !proven);
    }
    reach.write(state);
    state.counters["time_ratio"] = reported_s / single_s;
  });
}

}  // namespace

void register_reach(const Extent& extent) {
  const unsigned part = extent.quick ? 20 : 1;
  for (const std::size_t points : {1'000, 100'000, 1'000'000}) {
    if (points > extent.large()) break;
    const unsigned seeds = points == 1'000 ? 40 / part : points == 100'000 ? 20 : 3;
    register_variants<CylinderSet>("cylinder", points, seeds);
    register_variants<CircleSet>("circle", points, seeds);
  }
  for (const double arc_deg : {360.0, 180.0}) {
    for (const std::size_t points : {9, 12, 24}) register_arc(arc_deg, points, 500 / part);
  }
  for (const std::size_t points : {9, 12}) register_arc(60.0, points, 300 / part);
}

}  // namespace rondure::benchmarks
