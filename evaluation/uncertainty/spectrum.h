#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/uncertainty/cloud.h"

namespace rondure::evaluation {

/// One kind of form: cos and sin of `undulations` times the angle, times the Legendre polynomial of
/// `degree` in the height. (0, 1) is taper, (0, 2) barrel, (1, 2) a bent axis, (2, 0) oval.
struct FormTerm {
  int undulations = 0;        ///< 0..200.
  int degree = 0;             ///< 0..20; 0 in a section. Not (0,0), (1,0), (1,1): size and place.
  double amplitude_mm = 0.0;  ///< Standard deviation of its coefficient(s), >= 0.
};

/// The stated form spectrum of a surface: which forms it may have, and how large. It describes the
/// surface between the points; without one there is no statement about the whole surface.
struct FormSpectrum {
  std::vector<FormTerm> terms;  ///< Empty: the form is learnt from the cloud.
  /// Whether the amplitudes are known; otherwise only their ratios are, and their common size is
  /// estimated from the deviations.
  bool absolute = false;
  double low_mm = 0.0;   ///< Lower end of the surface along the axis, in the heights of the cloud.
  double high_mm = 0.0;  ///< > low_mm; both 0 in a section.
  core::Phrase source;   ///< Where it comes from, for the report: "form_spectrum of the plan".
};

/// kBadOption for an invalid term, which it names; for more than 400 coefficients; or for
/// undulations and degrees that need a grid of more than 10 000 places.
[[nodiscard]] core::Result<void> check_spectrum(const FormSpectrum& spectrum, FormKind kind);

/// Values of the terms at points: one row per point, one or two columns per term (cos, sin), each
/// times its amplitude.
[[nodiscard]] Eigen::MatrixXd spectrum_columns(const FormSpectrum& spectrum,
                                               std::span<const FormPoint> points);

/// Number of places of a grid that is fine enough for a spectrum.
[[nodiscard]] std::size_t grid_places(const FormSpectrum& spectrum, FormKind kind);

}  // namespace rondure::evaluation
