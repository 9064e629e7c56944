#include "record/signature.h"

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include "record/sha256.h"

namespace rondure::record {
namespace {

using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Context = std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)>;

constexpr std::size_t kSignatureBytes = 64;
constexpr const char* kMakePublic = "openssl pkey -in KEY.pem -pubout -out PUBLIC.pem";

using Reader = EVP_PKEY* (*)(BIO*, EVP_PKEY**, pem_password_cb*, void*);

Key read_key(const std::string& pem, Reader reader) {
  const Bio text(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())), &BIO_free);
  return {reader(text.get(), nullptr, nullptr, nullptr), &EVP_PKEY_free};
}

/// The error for a text that is not the required key.
core::Error wrong_key(const std::string& pem, const Key& key, std::string_view kind,
                      std::string_view command) {
  ERR_clear_error();
  std::string found = "the file holds no such key";
  if (key) {
    found = fmt::format("the file holds a key of the kind {}", EVP_PKEY_get0_type_name(key.get()));
  } else if (pem.find("PRIVATE KEY") != std::string::npos && kind == "public") {
    found = "the file holds a private key, which stays with who signs";
  } else if (pem.find("PUBLIC KEY") != std::string::npos && kind == "private") {
    found = "the file holds a public key, which only checks";
  } else if (pem.find("ENCRYPTED") != std::string::npos) {
    return {core::Code::kBadOption,
            "the pass phrase of the key is not the right one; give it again",
            {}};
  }
  return {
      core::Code::kBadOption,
      fmt::format("a {} key of Ed25519 is needed, and {}; make one with: {}", kind, found, command),
      {}};
}

std::string sha256_of(const Key& key) {
  unsigned char* der = nullptr;
  const int length = i2d_PUBKEY(key.get(), &der);
  const std::string bytes(reinterpret_cast<const char*>(der), std::max(0, length));
  OPENSSL_free(der);
  return sha256_hex(bytes);
}

const unsigned char* octets(std::string_view bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

core::Result<Signature> sign(std::string_view bytes, const std::string& private_key_pem) {
  const Key key = read_key(private_key_pem, &PEM_read_bio_PrivateKey);
  if (!key || EVP_PKEY_is_a(key.get(), "ED25519") != 1) {
    return core::fail(wrong_key(private_key_pem, key, "private",
                                "openssl genpkey -algorithm ed25519 -out KEY.pem"));
  }
  const Context context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  std::array<unsigned char, kSignatureBytes> signature{};
  std::size_t length = signature.size();
  // Ed25519 hashes internally: no digest is set.
  if (EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key.get()) != 1 ||
      EVP_DigestSign(context.get(), signature.data(), &length, octets(bytes), bytes.size()) != 1) {
    ERR_clear_error();
    return core::fail(core::Code::kInternal, "OpenSSL refuses to sign with this key");
  }
  return Signature{{signature.begin(), signature.begin() + length}, sha256_of(key)};
}

core::Result<bool> signature_holds(std::string_view bytes, std::string_view signature,
                                   const std::string& public_key_pem) {
  const Key key = read_key(public_key_pem, &PEM_read_bio_PUBKEY);
  if (!key || EVP_PKEY_is_a(key.get(), "ED25519") != 1) {
    return core::fail(wrong_key(public_key_pem, key, "public", kMakePublic));
  }
  const Context context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  const bool holds =
      EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, key.get()) == 1 &&
      EVP_DigestVerify(context.get(), octets(signature), signature.size(), octets(bytes),
                       bytes.size()) == 1;
  ERR_clear_error();
  return holds;
}

core::Result<std::string> key_sha256(const std::string& public_key_pem) {
  const Key key = read_key(public_key_pem, &PEM_read_bio_PUBKEY);
  if (!key) return core::fail(wrong_key(public_key_pem, key, "public", kMakePublic));
  return sha256_of(key);
}

}  // namespace rondure::record
