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

/// The parsed place; fails the test when the text is wrong.
[[nodiscard]] ArchivePlace place_of(const std::string& text);
/// The open archive; fails the test when it cannot be opened.
[[nodiscard]] Archive open_archive(const ArchivePlace& place);
/// All results in an archive that pass the filter, newest first.
[[nodiscard]] std::vector<ArchivedResult> all_of(Archive& archive,
                                                 const ArchiveFilter& filter = {});

/// An empty archive of either kind. For `server` the test is skipped where no server can run.
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
