#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports {

/// Checks what the QIF schema does not: ids are unique and not above `idMax`; each reference
/// (elements ...Id, lists ...Ids, ranges of points) refers to an element of its kind; `n` counts
/// its items; point sets hold three numbers for each point and normal; directions have length 1
/// (within 1e-9); the two zone radii differ by the value (within 1e-9 mm).
///
/// @param document  A QIF 3.0 document as XML. Needs no schema and no file.
/// @return  One sentence for each fault; none for a valid document. Time and memory O(bytes).
[[nodiscard]] std::vector<std::string> check_qif(std::string_view document);

}  // namespace rondure::reports
