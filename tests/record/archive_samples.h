#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "record/archive/archive.h"
#include "tests/record/postgres_server.h"
#include "tests/record/sample_run.h"

namespace rondure::record {

/// A run whose every value follows from its number; started `number` minutes into 2026.
[[nodiscard]] ArchiveRun archive_run(std::int64_t number, int results = 2);

/// Every value as text: equal exactly when the runs are.
[[nodiscard]] std::string every_value(const ArchiveHead& head);
[[nodiscard]] std::string every_value(const ArchiveResult& result);

/// The place, or a failed test.
[[nodiscard]] ArchivePlace place_of(const std::string& text);
/// The archive, or a failed test.
[[nodiscard]] Archive open_archive(const ArchivePlace& place);
/// Everything in an archive that passes the filter, newest first.
[[nodiscard]] std::vector<ArchivedResult> all_of(Archive& archive,
                                                 const ArchiveFilter& filter = {});

/// An archive of either kind, empty. `server` skips the test where there is none.
class EitherArchive : public ::testing::TestWithParam<ArchivePlace::Kind> {
 protected:
  void SetUp() override;

  Scratch scratch_;
  std::optional<PostgresServer> server_;
  ArchivePlace place_;
};

/// "file" or "server", for the name of the test.
[[nodiscard]] std::string kind_name(const ::testing::TestParamInfo<ArchivePlace::Kind>& info);

}  // namespace rondure::record
