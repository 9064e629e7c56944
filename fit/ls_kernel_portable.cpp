#include <cmath>

#include "fit/ls_kernel.h"

namespace rondure::fit::ls_kernel {
namespace {

/// One number at a time: any processor.
struct Portable {
  using Vector = double;

  template <class V>
  static V load(const double* p) {
    return *p;
  }
  static void store(double* p, double v) { *p = v; }
  static double root(double v) { return std::sqrt(v); }
  static void load3(const double* p, double& x, double& y, double& z) {
    x = p[0];
    y = p[1];
    z = p[2];
  }
  static void load2(const double* p, double& x, double& y) {
    x = p[0];
    y = p[1];
  }
};

}  // namespace

const Kernel kPortable = kernel_of<Portable>();

}  // namespace rondure::fit::ls_kernel
