#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// The text of a file as UTF-8, without a byte order mark.
struct DecodedText {
  std::string converted;      ///< Owner of the text; empty where the bytes are UTF-8.
  std::string_view encoding;  ///< "UTF-16 LE"; empty for UTF-8.

  /// @param bytes  Those that were decoded.
  [[nodiscard]] std::string_view text(std::string_view bytes) const;
};

/// Decodes UTF-8, UTF-16 (by its byte order mark, or by the zero bytes of its digits) and, where
/// the bytes are neither, Windows-1252: a wrong guess can only hurt names.
/// @return  kSyntax for UTF-32 and for zero bytes elsewhere, with `where` "name:line".
[[nodiscard]] core::Result<DecodedText> decode_text(std::string_view bytes, std::string_view name);

}  // namespace rondure::record
