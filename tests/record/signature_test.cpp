#include "record/signature.h"

#include <cstdlib>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/files.h"
#include "record/sha256.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

using ::testing::HasSubstr;

// RFC 8032, 7.1, TEST 1: the secret key as `openssl genpkey` would have written it.
constexpr const char* kSecret1 =
    "-----BEGIN PRIVATE KEY-----\n"
    "MC4CAQAwBQYDK2VwBCIEIJ1hsZ3v/VpguoRK9JLsLMREScVpezJpGXA7rAMcrn9g\n-----END PRIVATE KEY-----\n";

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

/// Keys and signatures by the openssl command, in a folder of its own.
class Signature : public ::testing::Test {
 protected:
  void SetUp() override {
    openssl("genpkey -algorithm ed25519 -out key.pem");
    openssl("pkey -in key.pem -pubout -out public.pem");
  }
  void openssl(const std::string& arguments, int expected = 0) const {
    const std::string command = fmt::format("cd '{}' && openssl {} </dev/null >log 2>&1",
                                            scratch.path().string(), arguments);
    EXPECT_EQ(std::system(command.c_str()) == 0, expected == 0) << command;
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    return *read_file(scratch / name);
  }

  Scratch scratch;
};

TEST_F(Signature, IsTheOneOfRfc8032) {
  const auto signature = sign("", kSecret1);
  ASSERT_TRUE(signature) << signature.error().what;
  EXPECT_EQ(signature->bytes,
            from_hex("e5564300c360ac729086e2cc806e828a84877f1eb8e5d974d873e065224901555fb8821590a33"
                     "bacc61e39701cf9b46bd25bf5f0595bbe24655141438e7a100b"));
}

TEST_F(Signature, HoldsForTheSignedBytesOnly) {
  const std::string bytes = "sums\n";
  const auto signature = sign(bytes, text("key.pem"));
  ASSERT_TRUE(signature) << signature.error().what;
  EXPECT_TRUE(*signature_holds(bytes, signature->bytes, text("public.pem")));
  EXPECT_FALSE(*signature_holds("Sums\n", signature->bytes, text("public.pem")));
  for (std::size_t i = 0; i < signature->bytes.size(); ++i) {
    std::string changed = signature->bytes;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(*signature_holds(bytes, changed, text("public.pem"))) << i;
  }
  for (const std::string& wrong :
       {std::string(), signature->bytes.substr(1), signature->bytes + "x"}) {
    EXPECT_FALSE(*signature_holds(bytes, wrong, text("public.pem")));
  }
  openssl("genpkey -algorithm ed25519 -out other.pem");
  openssl("pkey -in other.pem -pubout -out other_public.pem");
  EXPECT_FALSE(*signature_holds(bytes, signature->bytes, text("other_public.pem")));
}

TEST_F(Signature, NamesItsKeyAsTheOpensslCommandDoes) {
  openssl("pkey -in key.pem -pubout -outform DER -out public.der");
  const std::string expected = sha256_hex(text("public.der"));
  EXPECT_EQ(sign("sums", text("key.pem"))->key_sha256, expected);
  EXPECT_EQ(key_sha256(text("public.pem")).value_or(""), expected);
  EXPECT_FALSE(key_sha256(text("key.pem"))) << "a private key is not for others to read";
}

TEST_F(Signature, IsReadAndWrittenByTheOpensslCommandToo) {
  ASSERT_TRUE(write_file(scratch / "sums", "some sums\n"));
  ASSERT_TRUE(write_file(scratch / "ours.sig", sign("some sums\n", text("key.pem"))->bytes));
  openssl("pkeyutl -verify -pubin -inkey public.pem -rawin -in sums -sigfile ours.sig");
  openssl("pkeyutl -sign -inkey key.pem -rawin -in sums -out theirs.sig");
  EXPECT_TRUE(*signature_holds("some sums\n", text("theirs.sig"), text("public.pem")));
}

TEST_F(Signature, WrongKeysAreNamedWithTheCommandThatMakesRightOnes) {
  openssl("genpkey -algorithm rsa -out rsa.pem");
  openssl("pkey -in rsa.pem -pubout -out rsa_public.pem");
  openssl("genpkey -algorithm x25519 -out x.pem");
  const auto refusal = [](const auto& result) {
    EXPECT_FALSE(result);
    EXPECT_EQ(result.error().code, core::Code::kBadOption);
    EXPECT_THAT(result.error().what, HasSubstr("openssl "));
    return result.error().what;
  };
  EXPECT_THAT(refusal(sign("", "")), HasSubstr("holds no such key"));
  EXPECT_THAT(refusal(sign("", text("public.pem"))), HasSubstr("holds a public key"));
  EXPECT_THAT(refusal(sign("", text("rsa.pem"))), HasSubstr("of the kind RSA"));
  EXPECT_THAT(refusal(sign("", text("x.pem"))), HasSubstr("of the kind X25519"));
  const std::string half = text("key.pem").substr(0, 60);
  EXPECT_THAT(refusal(sign("", half)), HasSubstr("holds no such key"));
  EXPECT_THAT(refusal(signature_holds("", "", text("key.pem"))), HasSubstr("a private key, which"));
  EXPECT_THAT(refusal(signature_holds("", "", text("rsa_public.pem"))), HasSubstr("kind RSA"));
  EXPECT_THAT(refusal(signature_holds("", "", "-----BEGIN")), HasSubstr("holds no such key"));
}

}  // namespace
}  // namespace rondure::record
