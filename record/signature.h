#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// Name of the detached signature of SHA256SUMS in a run directory: the 64 bytes of Ed25519, as
/// `openssl pkeyutl -sign -rawin` writes them.
inline constexpr const char* kSignatureName = "SHA256SUMS.sig";

/// Signs bytes with Ed25519 (RFC 8032), through OpenSSL. Same key, same bytes, same signature.
/// @param private_key_pem  Text of a key file, as `openssl genpkey -algorithm ed25519` makes it.
/// When it has a pass phrase, OpenSSL asks for it on the terminal.
/// @return The 64 bytes; kBadOption when the text is no private key of that kind.
[[nodiscard]] core::Result<std::string> sign(std::string_view bytes,
                                             const std::string& private_key_pem);

/// Whether `signature` is that of `bytes` by the owner of a public key.
/// @param public_key_pem  As `openssl pkey -in KEY.pem -pubout` writes it.
/// @return kBadOption when the text is no public key of Ed25519.
[[nodiscard]] core::Result<bool> signature_holds(std::string_view bytes, std::string_view signature,
                                                 const std::string& public_key_pem);

}  // namespace rondure::record
