#pragma once

#include <string>
#include <vector>

namespace rondure::reports::testing {

/// Validates QIF documents with xmllint against the schemas of ../shared/qif, relative to the root
/// of the project. Without schemas or xmllint the test is skipped, with that reason.
void expect_valid_qif(const std::vector<std::string>& documents);

}  // namespace rondure::reports::testing
