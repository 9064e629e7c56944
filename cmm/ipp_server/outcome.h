#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "cmm/ipp/grammar.h"

namespace rondure::cmm::ipp {

/// Why a command failed: a number of the error list, and the text for GetXtdErrStatus().
struct Failure {
  int number = 0;
  std::string what;
};

/// Result of a command.
struct Reply {
  std::vector<std::vector<Item>> lines;  ///< Data.
  int report = 0;                        ///< Number of an error to report after the data; 0: none.
};

using Outcome = tl::expected<Reply, Failure>;

}  // namespace rondure::cmm::ipp
