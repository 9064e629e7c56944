#pragma once

#include <vector>

#include "reports/pdf_flow.h"

// Private to the room: tables of report.pdf.

namespace rondure::reports::pdf {

/// A brick a row, each with the head to repeat above it on a new page. Columns are as wide as their
/// longest words need and otherwise in proportion to their text, as browsers do it. A cell may span
/// columns, not rows. A row over which a cell spans all columns belongs to the one above.
[[nodiscard]] std::vector<Brick> set_table(Flow& flow, const pugi::xml_node& table,
                                           const Setting& setting);

}  // namespace rondure::reports::pdf
