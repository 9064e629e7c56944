#pragma once

namespace rondure::benchmarks {

/// How much is measured.
struct Extent {
  bool quick = false;  ///< Few and small sets: does everything still run?
  bool full = false;   ///< 1e7 points too.

  /// Seeds behind a "worst" clause.
  [[nodiscard]] unsigned seeds() const { return quick ? 2 : 20; }
  /// The size that stands for "large" in the gates.
  [[nodiscard]] unsigned large() const { return quick ? 10'000 : 1'000'000; }
};

// The parts of the program, each with its fits and their peers.
void register_passes(const Extent& extent);  ///< S1, read-and-sum
void register_cylinders(const Extent& extent);
void register_circles(const Extent& extent);
void register_text(const Extent& extent);   ///< reading points
void register_reach(const Extent& extent);  ///< gates A1 to A4: is the best zone found?

}  // namespace rondure::benchmarks
