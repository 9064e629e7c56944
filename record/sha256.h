#pragma once

#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // OpenSSL's own header stays in the .cpp file

namespace rondure::record {

/// SHA-256 (FIPS 180-4) of bytes that are added in pieces.
class Sha256 {
 public:
  Sha256();

  void add(std::string_view bytes);
  /// The digest of all pieces, as 64 lower-case hexadecimal digits. Call once, at the end.
  [[nodiscard]] std::string hex();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

/// SHA-256 (FIPS 180-4) of the bytes, as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace rondure::record
