#pragma once

#include <functional>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The values of a record, without intervals.
using ValuesOf = std::function<Evaluation(const record::RunRecord&)>;

/// Writes beside the values of a simulated run what they are without errors of machine, probe,
/// fixture and temperature: the same evaluation of the same touches, where they truly met the part,
/// and of series as probes without errors record them. What a calibration leaves is that of the
/// calibration as found: for it the poses of both axes alone are read without errors.
///
/// A feature whose hidden truth is not on record gets none, nor does one with a datum of that kind.
/// A real run has none. Cost: that of the values once more, with a calibration twice.
void hold_against_truth(const record::RunRecord& measured, const ValuesOf& values_of,
                        Evaluation& out);

}  // namespace rondure::evaluation
