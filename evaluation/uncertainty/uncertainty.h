#pragma once

#include <cstdint>
#include <optional>

#include "core/result.h"
#include "evaluation/uncertainty/cloud.h"
#include "evaluation/uncertainty/influences.h"
#include "evaluation/uncertainty/spectrum.h"
#include "evaluation/uncertainty/statement.h"

namespace rondure::evaluation {

class ErrorModel;  // internal/error_modes.h

/// Uncertainty of a form value by propagating distributions (Monte Carlo).
///
/// The deviations are form + declared errors: only declared errors are noise, the rest is form. A
/// model of the form (undulations times degrees in bands of a common size, rougher form, single
/// spots) is learnt from the one cloud, and forms compatible with the deviations are drawn from it
/// by Gibbs sampling. Their values are the distribution: (a) at the points, (b) of the same form on
/// the whole surface.
///
/// @param cloud       >= 4 (section) or 6 (cylinder) points that determine position and size;
///                    measured, or nominal with deviations from elsewhere.
/// @param spectrum    For (b); with no terms the spectrum that the cloud shows, which must then be
///                    dense; none: no statement about the whole surface.
/// @return  kTooFewPoints, kNotFinite (row), kRank, kBadOption; kSampling (too sparse for its own
///          spectrum); kMeaning (no noise known); kOutliers, kInconsistent (the data contradict the
///          model or the declaration: a void, with its reason). Same input, same bits, at any
///          number of threads on one kind of processor.
/// Sources: JCGM 101:2008 (propagation of distributions, 7.9 adaptive trials); ISO/TS 15530-4:2008
/// (declaration); E. I. George, R. E. McCulloch, JASA 88 (1993) 881 (variables that are there or
/// not). The method in words: docs/uncertainty.md.
[[nodiscard]] core::Result<UncertaintyResult> measurement_uncertainty(
    const FormCloud& cloud, const Influences& influences,
    const std::optional<FormSpectrum>& spectrum = std::nullopt,
    const UncertaintyOptions& options = {});

/// Deviations that one inspection of a part with a given form spectrum reads, about its axis [mm]:
/// for a prediction before the first touch.
///
/// @param nominal   Places; their deviations are ignored.
/// @param errors    Of these points.
/// @param spectrum  Its amplitudes are used as they are.
/// @param seed      Another seed gives another part and another inspection.
/// @return  One for each point; errors as for measurement_uncertainty().
[[nodiscard]] core::Result<Eigen::VectorXd> simulated_deviations(const FormCloud& nominal,
                                                                 const ErrorModel& errors,
                                                                 const FormSpectrum& spectrum,
                                                                 std::uint64_t seed);

}  // namespace rondure::evaluation
