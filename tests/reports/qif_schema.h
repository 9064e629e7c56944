#pragma once

#include <string>
#include <vector>

namespace rondure::reports::testing {

/// Validates QIF documents with xmllint against the schemas of ../shared/qif, seen from the root of
/// the project. Where they or xmllint are not there the test is skipped, with that reason.
void expect_valid_qif(const std::vector<std::string>& documents);

}  // namespace rondure::reports::testing
