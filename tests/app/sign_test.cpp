// Signed runs: the signature finds what digests alone cannot.

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/signature.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SignedRun : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_without_intervals("09_axle_points_file",
                                    {"--out", run_, "--quiet", "--format", "json,csv"})
                  .status,
              0);
    make_keys("mine");
    make_keys("another");
    const Outcome outcome = sign();
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out,
                ::testing::StartsWith((run_ / "SHA256SUMS.sig").string() + "\nsigned with the "));
  }
  void make_keys(const std::string& name) const {
    const std::string place = "cd '" + folder_.path().string() + "' && openssl ";
    ASSERT_EQ(std::system((place + "genpkey -algorithm ed25519 -out " + name + ".pem").c_str()), 0);
    ASSERT_EQ(
        std::system(
            (place + "pkey -in " + name + ".pem -pubout -out " + name + "_public.pem").c_str()),
        0);
  }
  [[nodiscard]] Outcome sign() const {
    return rondure({"sign", run_, "--key", folder_ / "mine.pem"});
  }
  [[nodiscard]] Outcome verify(const std::string& key = "mine_public.pem") const {
    return rondure({"verify", run_, "--key", folder_ / key});
  }

  Scratch folder_;
  fs::path run_ = folder_ / "run";
};

TEST_F(SignedRun, VerifiesWithTheKeyOfItsSignerOnly) {
  const Outcome outcome = verify();
  EXPECT_EQ(outcome.status, 0);
  const std::string key = record::key_sha256(read(folder_ / "mine_public.pem")).value();
  EXPECT_THAT(outcome.out, HasSubstr("; the signature holds for this key, " + key));
  EXPECT_THAT(sign().out, HasSubstr("signed with the key " + key));
  const Outcome other = verify("another_public.pem");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.out, HasSubstr("SHA256SUMS.sig: the signature does not hold"));
  const Outcome without = rondure({"verify", run_});
  EXPECT_EQ(without.status, 0);
  EXPECT_THAT(without.out, HasSubstr("signed, the signature was not checked (--key PUBLIC.pem"));
}

TEST_F(SignedRun, AnotherSignatureAndAKeyThatOthersCanReadAreNoted) {
  EXPECT_EQ(sign().err, "");
  EXPECT_THAT(rondure({"sign", run_, "--key", folder_ / "another.pem"}).err,
              HasSubstr("this replaces a signature, of another key or of other files"));
  EXPECT_THAT(sign().err, HasSubstr("this replaces a signature"));
  for (const fs::perms readers : {fs::perms::group_read, fs::perms::others_read}) {
    fs::permissions(folder_ / "mine.pem", fs::perms::owner_read | readers);
    const Outcome outcome = sign();
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.err, HasSubstr("note: other users of this computer can read the private "
                                       "key"));
  }
}

TEST_F(SignedRun, IsCheckedByTheOpensslCommandToo) {
  const std::string command =
      "cd '" + run_.string() +
      "' && sha256sum --status -c SHA256SUMS && openssl pkeyutl -verify -pubin -inkey "
      "../mine_public.pem -rawin -in SHA256SUMS -sigfile SHA256SUMS.sig >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(SignedRun, AForgerWhoMakesTheWholeRunAgainIsFound) {
  const std::string signature = read(run_ / "SHA256SUMS.sig");
  fs::remove_all(run_);
  ASSERT_EQ(run_without_intervals("09_axle_points_file", {"--out", run_, "--quiet", "--serial",
                                                          "another part", "--format", "json,csv"})
                .status,
            0);
  write(run_ / "SHA256SUMS.sig", signature);
  EXPECT_EQ(rondure({"verify", run_}).status, 0);  // digests alone say nothing of who made them
  EXPECT_EQ(verify().status, 1);
}

TEST_F(SignedRun, WhatWasAddedLaterIsNotSigned) {
  EXPECT_EQ(rondure({"report", run_, "--format", "json"}).err, "");  // the same bytes again
  EXPECT_EQ(verify().status, 0);
  const Outcome added = rondure({"report", run_, "--format", "html"});
  EXPECT_THAT(added.err, HasSubstr("the reports differ from those that were signed; sign the run"));
  EXPECT_THAT(verify().out, HasSubstr("the signature does not hold"));
  ASSERT_EQ(sign().status, 0);
  EXPECT_EQ(verify().status, 0);
  // A list that was signed before the page was there.
  std::string list = read(run_ / "SHA256SUMS");
  const std::size_t line = list.find("  report.html") - 64;
  list.erase(line, list.find('\n', line) + 1 - line);
  write(run_ / "SHA256SUMS", list);
  ASSERT_EQ(sign().status, 0);
  const Outcome unlisted = verify();
  EXPECT_EQ(unlisted.status, 1);
  EXPECT_THAT(unlisted.out,
              HasSubstr("report.html: it is not signed: SHA256SUMS does not name it"));
}

TEST_F(SignedRun, WithoutSignatureOrListIsNotEqualWhenAKeyIsGiven) {
  fs::remove(run_ / "SHA256SUMS.sig");
  EXPECT_EQ(verify().status, 1);
  EXPECT_THAT(verify().out, HasSubstr("the run is not signed: there is no SHA256SUMS.sig"));
  ASSERT_EQ(sign().status, 0);
  fs::remove(run_ / "SHA256SUMS");
  EXPECT_EQ(verify().status, 1);
  EXPECT_THAT(verify().out, HasSubstr("the run is not signed: there is no SHA256SUMS;"));
}

TEST_F(SignedRun, WrongKeyFilesAreNamed) {
  const Outcome private_key = verify("mine.pem");
  EXPECT_EQ(private_key.status, 2);
  EXPECT_THAT(private_key.err, HasSubstr("mine.pem: a public key of Ed25519 is needed"));
  EXPECT_EQ(verify("absent.pem").status, 2);
  const Outcome public_key = rondure({"sign", run_, "--key", folder_ / "mine_public.pem"});
  EXPECT_EQ(public_key.status, 2);
  EXPECT_THAT(public_key.err, HasSubstr("mine_public.pem: a private key of Ed25519 is needed"));
}

TEST_F(SignedRun, OnlyARunThatVerifiesIsSigned) {
  fs::remove(run_ / "SHA256SUMS.sig");
  replace_in(run_ / "touches.csv", ",measure,", ",locate,");
  const Outcome outcome = sign();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("not signed, because not equal: touches.csv: line"));
  EXPECT_FALSE(fs::exists(run_ / "SHA256SUMS.sig"));
  EXPECT_EQ(rondure({"sign", folder_.path(), "--key", folder_ / "mine.pem"}).status, 2);
}

}  // namespace
}  // namespace rondure::app::testing
