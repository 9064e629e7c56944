#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// Name of the detached signature of SHA256SUMS in a run directory: the 64 bytes of Ed25519, in the
/// format of `openssl pkeyutl -sign -rawin`.
inline constexpr const char* kSignatureName = "SHA256SUMS.sig";

struct Signature {
  std::string bytes;       ///< 64.
  std::string key_sha256;  ///< As key_sha256() of the public key.
};

/// Signs bytes with Ed25519 (RFC 8032), through OpenSSL. The same key and bytes give the same
/// signature.
/// @param private_key_pem  Contents of a key file made by `openssl genpkey -algorithm ed25519`. If
///                         it has a pass phrase, OpenSSL asks for it on the terminal.
/// @return kBadOption when the text is not a private key of that kind.
[[nodiscard]] core::Result<Signature> sign(std::string_view bytes,
                                           const std::string& private_key_pem);

/// Whether `signature` is a signature of `bytes` made with the private key of this public key.
/// @param public_key_pem  Public key as written by `openssl pkey -in KEY.pem -pubout`.
/// @return kBadOption when the text is not an Ed25519 public key.
[[nodiscard]] core::Result<bool> signature_holds(std::string_view bytes, std::string_view signature,
                                                 const std::string& public_key_pem);

/// Which key this is: SHA-256 of a public key in DER, in hex, as `openssl pkey -in KEY.pem -pubout
/// -outform DER | sha256sum` gives it.
/// @return kBadOption when the text is not a public key.
[[nodiscard]] core::Result<std::string> key_sha256(const std::string& public_key_pem);

}  // namespace rondure::record
