#pragma once

#include <filesystem>
#include <string>

// Private to the room.

namespace rondure::record {

/// Describes for the operator what a damaged journal has lost: the number of bytes missing at its
/// end, and the tables that can no longer be read in full, with the number of readable rows. Empty
/// when no such loss is found. `copy` is a private copy; it is padded with zeros.
[[nodiscard]] std::string loss_in_words(const std::filesystem::path& copy);

}  // namespace rondure::record
