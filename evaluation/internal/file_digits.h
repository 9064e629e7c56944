#pragma once

#include <string>

#include "record/run_record.h"

namespace rondure::evaluation {

/// The steps in which a points file writes its coordinates: 0.01 mm where all of them are whole
/// hundredths, 0.0254 mm where they are whole thousandths of an inch. 0: no such step from 0.1 um
/// to 0.05 mm, or one so wide that the points are constructed, not measured.
/// @param feature  Id of a feature of a points file. Cost: a few divisions a coordinate.
[[nodiscard]] double step_of_file_mm(const record::RunRecord& record, const std::string& feature);

}  // namespace rondure::evaluation
