#include "fit/rotary/internal/published_axes.h"

#include <cmath>

namespace rondure::fit {
namespace {

Matrix36 c_rows(double l, double h, double c_rad) {
  const double s = std::sin(c_rad);
  const double c = std::cos(c_rad);
  Matrix36 out;
  out << 1.0, 0.0, 0.0, 0.0, -l, -h * c,  //
      0.0, 1.0, 0.0, l, 0.0, -h * s,      //
      0.0, 0.0, 1.0, h * c, h * s, 0.0;
  return out;
}

Matrix36 a_rows(double l, double h, double a_rad) {
  const double s = std::sin(a_rad);
  const double c = std::cos(a_rad);
  Matrix36 out;
  out << 1.0, 0.0, 0.0, 0.0, -l * c + h * s, -h * c - l * s,  //
      0.0, 1.0, 0.0, -h * s + l * c, 0.0, 0.0,                //
      0.0, 0.0, 1.0, h * c + l * s, 0.0, 0.0;
  return out;
}

}  // namespace

std::array<Eigen::Vector3d, 3> PublishedSetups::of_c() const {
  return {{{0.0, h1_mm, -l1_mm}, {0.0, h2_mm, -l1_mm}, {0.0, h1_mm, -l2_mm}}};
}

std::array<Eigen::Vector3d, 3> PublishedSetups::of_a() const {
  return {{{0.0, h1_mm, -l1_mm}, {0.0, h2_mm, -l1_mm}, {0.0, h2_mm, -l2_mm}}};
}

PublishedMatrix published_c_matrix(const PublishedSetups& setups, double c_rad) {
  PublishedMatrix out;
  out << c_rows(setups.l1_mm, setups.h1_mm, c_rad), c_rows(setups.l1_mm, setups.h2_mm, c_rad),
      c_rows(setups.l2_mm, setups.h1_mm, c_rad);
  return out;
}

PublishedMatrix published_a_matrix(const PublishedSetups& setups, double a_rad) {
  PublishedMatrix out;
  out << a_rows(setups.l1_mm, setups.h1_mm, a_rad), a_rows(setups.l1_mm, setups.h2_mm, a_rad),
      a_rows(setups.l2_mm, setups.h2_mm, a_rad);
  return out;
}

}  // namespace rondure::fit
