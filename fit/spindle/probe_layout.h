#pragma once

#include <array>
#include <complex>
#include <optional>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "fit/geometry/swing_arm.h"

namespace rondure::fit {

/// Arrangement of three displacement probes whose lines of action meet at the nominal pin centre.
/// Angles count from P1 against the rotation of the work: a point of the surface passes P2 first
/// and P1 an angle phi2 later. For an installation that counts with the rotation, enter negative
/// angles.
///
/// H_i(theta) = r(theta + Phi_i) + RY cos(Phi_i + beta) + RX sin(Phi_i + beta)
///
/// The weighted sum H_1 + k2 H_2 + k3 H_3 is free of the motion RX, RY for every beta. It contains
/// harmonic k of the profile with the factor G(k). Source: methods, roundness A.1, A.3, A.4.
class ProbeLayout {
 public:
  /// @param phi2_rad  Angle from P1 to P2.
  /// @param phi3_rad  Angle from P2 to P3 (not from P1).
  /// @return kRank if two probes are in line: |sin| of phi2, phi3 or phi2 + phi3 below 1e-3;
  ///         kNotFinite.
  [[nodiscard]] static core::Result<ProbeLayout> of(double phi2_rad, double phi3_rad);

  [[nodiscard]] double phi2_rad() const { return phi2_; }
  [[nodiscard]] double phi3_rad() const { return phi3_; }
  /// Phi_i, the angles from P1: 0, phi2, phi2 + phi3.
  [[nodiscard]] std::array<double, 3> angles_rad() const { return {0.0, phi2_, phi2_ + phi3_}; }
  /// 1, k2, k3.
  [[nodiscard]] const std::array<double, 3>& weights() const { return weights_; }
  /// sqrt(1 + k2^2 + k3^2).
  [[nodiscard]] double weight_norm() const;

  /// G(k) = 1 + k2 e^{j k phi2} + k3 e^{j k (phi2 + phi3)}. Zero at k = 1 by construction, but not
  /// at k = 0, where the unknown zeros of the probes appear.
  [[nodiscard]] std::complex<double> transfer(int order) const;
  /// Noise gain of harmonic k: weight_norm() / |G(k)|; infinite if G is 0.
  [[nodiscard]] double gain(int order) const;

 private:
  ProbeLayout(double phi2_rad, double phi3_rad);
  double phi2_;
  double phi3_;
  std::array<double, 3> weights_;
};

/// The layout as it stands about the pin when the swing arm is not as long as when the probes were
/// set. The arm swings about the wheel centre with P1 on it, on the side of the wheel: on a wheel
/// smaller by D every line misses the pin by D sin(Phi) sideways, which acts exactly as an angle,
/// Phi + D sin(Phi)/Rw. Source: methods, analyses_uncertainty 2.1, 2.2.
/// @param arm  With the wheel as it is; one that does not swing turns nothing.
/// @param set_on_mm  Radius of the wheel on which the probes were set.
/// @return As ProbeLayout::of(); kOutOfRange for a swinging arm without radius of the pin.
[[nodiscard]] core::Result<ProbeLayout> turned_by_arm(const ProbeLayout& layout,
                                                      const SwingArm& arm, double set_on_mm);

/// The two layouts of the source and the best one of methods A.5. The angles are whole samples of
/// 1024 per turn, of which the source prints rounded values: 90 and 181.0546875 deg; 60.8203125 and
/// 240.1171875 deg; 52.3828125 and 248.90625 deg.
[[nodiscard]] ProbeLayout published_layout_a();
[[nodiscard]] ProbeLayout published_layout_b();
[[nodiscard]] ProbeLayout reference_layout();

struct NamedLayout {
  std::string_view name;  ///< "published-a", "published-b", "reference".
  ProbeLayout layout;
};
[[nodiscard]] std::array<NamedLayout, 3> named_layouts();

/// The layout of a name; of any other name that of these angles between the probes [deg]. P3 is
/// placed from P2, or else from P1; what is not given counts 0, which no layout has.
/// @return As ProbeLayout::of().
[[nodiscard]] core::Result<ProbeLayout> stated_layout(std::string_view name,
                                                      std::optional<double> p1_to_p2_deg,
                                                      std::optional<double> p2_to_p3_deg,
                                                      std::optional<double> p1_to_p3_deg);

/// The greatest gain of the harmonics first..last, and its harmonic.
struct WorstGain {
  int order = 0;
  double gain = 0.0;
};
[[nodiscard]] WorstGain worst_gain(const ProbeLayout& layout, int first, int last);

/// Settings of design_layout(). All angles count from P1, as the probes are mounted.
struct LayoutSearch {
  int first = 2;  ///< Band of harmonics to be recovered; 2 <= first <= last.
  int last = 50;
  std::array<double, 2> p2_range_deg = {40.0, 140.0};  ///< Allowed positions of P2, then of P3.
  std::array<double, 2> p3_range_deg = {-140.0, -40.0};
  double least_apart_deg = 20.0;  ///< Least angle between two probes, to leave room for them.
  /// > 0: angles are multiples of one sample, with this many samples per turn. 0: any angle; a grid
  /// of 0.25 deg, whose best angles are refined to 0.001 deg.
  int samples = 0;
  int count = 5;  ///< Number of layouts to return, the best first; >= 1.
};

/// A layout found by the search, with its gains over the band.
struct DesignedLayout {
  ProbeLayout layout;
  WorstGain worst;
  double rms_gain = 0.0;  ///< sqrt(mean of g^2) over the band.
};

/// Searches for the angles of P2 and P3 with the smallest worst noise gain over a band of
/// harmonics. Layouts nearer than 2 deg to a better one are left out.
/// @return kBadOption for an invalid band, range or count. O(grid * band): some 0.1 s for 100 x
///         100 deg at 50 harmonics.
/// Source: methods, roundness A.5 (R*).
[[nodiscard]] core::Result<std::vector<DesignedLayout>> design_layout(const LayoutSearch& search);

}  // namespace rondure::fit
