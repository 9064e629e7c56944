#pragma once

#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// Adds the warnings that a reader of the numbers needs: rows that are there twice, sparse
/// sampling, points that do not surround the axis, a deviation that is 0 by construction, a missing
/// certificate, a pose that is not level.
void warn(FeatureResult& result);

}  // namespace rondure::evaluation
