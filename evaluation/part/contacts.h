#pragma once

#include <cstddef>
#include <span>

#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Warns of the share of a value that single points far off the surface carry: the value minus the
/// value without each of them, and without all. Computes the characteristic anew for each of the
/// seven farthest.
/// @param found  Of the surfaces as measured; its warnings grow.
void warn_of_shares(std::span<const MeasuredSurface> part, std::size_t feature,
                    const record::Characteristic& asked, Finding& found);

/// The same of a form that find() did not compute, in the warnings of its feature: how far such
/// points lie off, and their shares.
void warn_of_shares(std::span<const MeasuredSurface> part, std::size_t index,
                    const record::Characteristic& asked, FeatureResult& feature);

}  // namespace rondure::evaluation
