#pragma once

#include <filesystem>
#include <string>

// Private to the room.

namespace rondure::record {

/// What is lost in a damaged journal, in words for who measured: how many bytes are missing at its
/// end, and which tables can no longer be read in full, with the number of rows that can. Empty
/// when nothing of that kind is found. `copy` is a private copy: it is filled up with zeros.
[[nodiscard]] std::string loss_in_words(const std::filesystem::path& copy);

}  // namespace rondure::record
