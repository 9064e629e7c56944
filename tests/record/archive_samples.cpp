#include "tests/record/archive_samples.h"

#include <stdexcept>

#include <fmt/format.h>

#include "core/noise.h"
#include "record/sha256.h"

namespace rondure::record {

ArchiveRun archive_run(std::int64_t number, int results) {
  ArchiveRun run;
  ArchiveHead& h = run.head;
  h.journal_sha256 = sha256_hex(fmt::format("journal {}", number));
  h.run_id = fmt::format("run-{}", number);
  h.started_utc = fmt::format("2026-{:02}-{:02}T{:02}:{:02}:00Z", 1 + number / 40320 % 12,
                              1 + number / 1440 % 28, number / 60 % 24, number % 60);
  h.part_id = fmt::format("part-{}", number % 3);
  h.part_name = "shaft";
  h.serial = fmt::format("{:04}", number);
  h.operator_name = number % 2 == 0 ? "mk" : "o'neil \"x\"";
  h.machine = "simulated CMM";
  h.fixture = "simulated";
  h.simulated = number % 2 == 0;
  h.plan_name = "plan";
  h.plan_revision = "A";
  h.plan_sha256 = sha256_hex("plan");
  h.version = "0.1.0";
  std::uint64_t state = static_cast<std::uint64_t>(number) + 1;
  for (int i = 0; i < results; ++i) {
    ArchiveResult& r = run.results.emplace_back();
    r.feature = "journal";
    r.characteristic = fmt::format("c{}", i);
    r.symbol = "CYLt";
    r.reference = "MZCY";
    r.filter = "unfiltered";
    r.sampling = "4 x 7 points";
    // Any mantissa: a database that rounds shows.
    r.value = 1e-3 * (1.0 + static_cast<double>(core::splitmix64(state) >> 11) * 0x1.0p-53);
    if (i % 2 == 0) r.upper_limit = 0.01;
    r.verdict = i % 2 == 0 ? "conforms" : "not toleranced";
    r.certificate = "global";
  }
  return run;
}

std::string every_value(const ArchiveHead& h) {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", h.journal_sha256, h.run_id,
                     h.started_utc, h.part_id, h.part_name, h.serial, h.operator_name, h.machine,
                     h.fixture, h.simulated, h.plan_name, h.plan_revision, h.plan_sha256,
                     h.version);
}

std::string every_value(const ArchiveResult& r) {
  const auto number = [](const std::optional<double>& x) {
    return x ? fmt::format("{:a}", *x) : std::string("-");
  };
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", r.feature, r.characteristic, r.symbol,
                     r.reference, r.filter, r.sampling, number(r.value), number(r.upper_limit),
                     r.unit, r.verdict, r.certificate, number(r.lower_limit));
}

ArchivePlace place_of(const std::string& text) {
  auto place = parse_archive_place(text);
  if (!place) throw std::runtime_error(place.error().what);
  return *place;
}

Archive open_archive(const ArchivePlace& place) {
  auto archive = Archive::open(place, Archive::Access::kWrite);
  if (!archive) throw std::runtime_error(archive.error().what);
  return std::move(*archive);
}

std::vector<ArchivedResult> all_of(Archive& archive, const ArchiveFilter& filter) {
  auto results = archive.newest(filter, 1'000'000);
  if (!results) throw std::runtime_error(results.error().what);
  return std::move(*results);
}

void EitherArchive::SetUp() {
  if (GetParam() == ArchivePlace::Kind::kFile) {
    place_ = place_of(scratch_ / "archive.db");
    return;
  }
  server_.emplace();
  if (!server_->absent().empty()) GTEST_SKIP() << server_->absent();
  place_ = place_of(server_->url());
}

std::string kind_name(const ::testing::TestParamInfo<ArchivePlace::Kind>& info) {
  return info.param == ArchivePlace::Kind::kFile ? "file" : "server";
}

}  // namespace rondure::record
