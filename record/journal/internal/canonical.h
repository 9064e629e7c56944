#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include <soci/soci.h>

// Private to the room: the bytes over which digests are computed (docs/developer/journal.md, "Bytes
// of a value"), and the rows of a table as such bytes. Functions that read throw soci::soci_error.

namespace rondure::record {

/// Appends one value as canonical bytes.
void append_integer(std::string& bytes, std::int64_t number);
void append_real(std::string& bytes, double number);
void append_text(std::string& bytes, std::string_view text);
void append_null(std::string& bytes);

/// Appends a value as the journal stores it: null for an empty optional.
template <class Value>
void append_given(std::string& bytes, const Value& value) {
  if constexpr (std::is_integral_v<Value>) {
    append_integer(bytes, value);
  } else if constexpr (std::is_floating_point_v<Value>) {
    append_real(bytes, value);
  } else {
    append_text(bytes, value);
  }
}
template <class Value>
void append_given(std::string& bytes, const std::optional<Value>& value) {
  if (value) {
    append_given(bytes, *value);
  } else {
    append_null(bytes);
  }
}

/// The canonical bytes of a row with these values, from left to right.
template <class... Values>
[[nodiscard]] std::string row_bytes(const Values&... values) {
  std::string bytes;
  (append_given(bytes, values), ...);
  return bytes;
}

/// Calls `take` for every row of a table, in the order of the first column, the id.
void for_each_row(soci::session& session, std::string_view table,
                  const std::function<void(std::int64_t id, const std::string& bytes)>& take);

/// Number of rows of a table and one SHA-256 over all their values.
struct Digest {
  std::int64_t rows = 0;
  std::string sha256;

  friend bool operator==(const Digest&, const Digest&) = default;
};

/// SHA-256 over the canonical bytes of all rows of a table.
[[nodiscard]] Digest digest_of(soci::session& session, std::string_view table);

}  // namespace rondure::record
