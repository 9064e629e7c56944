#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "core/result.h"

namespace rondure::fit {

/// Where three displacement probes look: their lines of action meet at the nominal pin centre.
/// Angles count from P1 against the rotation of the work: a point of the surface passes P2 first
/// and P1 an angle phi2 later. An installation that counts with the rotation enters negative
/// angles.
///
/// H_i(theta) = r(theta + Phi_i) + RY cos(Phi_i + beta) + RX sin(Phi_i + beta)
///
/// The weighted sum H_1 + k2 H_2 + k3 H_3 is free of the motion RX, RY for every beta; of the
/// profile it passes harmonic k with the factor G(k). Source: methods, roundness A.1, A.3, A.4.
class ProbeLayout {
 public:
  /// @param phi2_rad  From P1 to P2.
  /// @param phi3_rad  From P2 to P3 (not from P1).
  /// @return kRank when two probes are in line: |sin| of phi2, phi3 or phi2 + phi3 below 1e-3;
  ///         kNotFinite.
  [[nodiscard]] static core::Result<ProbeLayout> of(double phi2_rad, double phi3_rad);

  [[nodiscard]] double phi2_rad() const { return phi2_; }
  [[nodiscard]] double phi3_rad() const { return phi3_; }
  /// Phi_i, from P1: 0, phi2, phi2 + phi3.
  [[nodiscard]] std::array<double, 3> angles_rad() const { return {0.0, phi2_, phi2_ + phi3_}; }
  /// 1, k2, k3.
  [[nodiscard]] const std::array<double, 3>& weights() const { return weights_; }
  /// sqrt(1 + k2^2 + k3^2).
  [[nodiscard]] double weight_norm() const;

  /// G(k) = 1 + k2 e^{j k phi2} + k3 e^{j k (phi2 + phi3)}. Zero at k = 1 by construction; not zero
  /// at k = 0, where the unknown zeros of the probes are.
  [[nodiscard]] std::complex<double> transfer(int order) const;
  /// Noise gain of harmonic k: weight_norm() / |G(k)|; infinite where G is 0.
  [[nodiscard]] double gain(int order) const;

 private:
  ProbeLayout(double phi2_rad, double phi3_rad);
  double phi2_;
  double phi3_;
  std::array<double, 3> weights_;
};

/// The two layouts of the source and the best of methods A.5, each with the exact angles of 1024
/// samples a turn behind the printed ones: 90 and 181.0546875 deg; 60.8203125 and 240.1171875 deg;
/// 52.3828125 and 248.90625 deg.
[[nodiscard]] ProbeLayout published_layout_a();
[[nodiscard]] ProbeLayout published_layout_b();
[[nodiscard]] ProbeLayout reference_layout();

/// The greatest gain of the harmonics first..last, and where it is.
struct WorstGain {
  int order = 0;
  double gain = 0.0;
};
[[nodiscard]] WorstGain worst_gain(const ProbeLayout& layout, int first, int last);

/// Settings of design_layout(). Angles from P1, as a maker would mount the probes.
struct LayoutSearch {
  int first = 2;  ///< Band of harmonics to serve; 2 <= first <= last.
  int last = 50;
  std::array<double, 2> p2_range_deg = {40.0, 140.0};  ///< Where P2 may stand.
  std::array<double, 2> p3_range_deg = {-140.0, -40.0};
  double least_apart_deg = 20.0;  ///< Between any two probes, for their bodies.
  /// > 0: angles that are whole samples of so many a turn. 0: any angle; a grid of 0.25 deg, then
  /// the best are refined to 0.001 deg.
  int samples = 0;
  int count = 5;  ///< Layouts to give, the best first; >= 1.
};

/// A layout that was found, and what it does to the band.
struct DesignedLayout {
  ProbeLayout layout;
  WorstGain worst;
  double rms_gain = 0.0;  ///< sqrt(mean of g^2) over the band.
};

/// Searches the angles of P2 and P3 for the least worst noise gain over a band of harmonics.
/// Layouts nearer than 2 deg to a better one are left out.
/// @return kBadOption for a band, range or count that is none. O(grid * band): some 0.1 s for 100 x
///         100 deg at 50 harmonics.
/// Source: methods, roundness A.5 (R*).
[[nodiscard]] core::Result<std::vector<DesignedLayout>> design_layout(const LayoutSearch& search);

}  // namespace rondure::fit
