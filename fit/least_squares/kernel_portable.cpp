#include <cmath>

#include "fit/least_squares/internal/kernel.h"

namespace rondure::fit::ls_kernel {
namespace {

/// One number at a time, for any processor.
struct Portable : Singles<Portable> {
  using Vector = double;

  template <class V>
  static V load(const double* p) {
    return *p;
  }
  static double root(double v) { return std::sqrt(v); }
};

}  // namespace

const Kernel kPortable = kernel_of<Portable>();

}  // namespace rondure::fit::ls_kernel
