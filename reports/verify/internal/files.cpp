#include "reports/verify/internal/files.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/sha256.h"
#include "record/signature.h"

namespace rondure::reports {

namespace fs = std::filesystem;

std::optional<ListedFiles::State> ListedFiles::state_of(const std::string& file) const {
  const auto found = files.find(file);
  return found == files.end() ? std::nullopt : std::optional(found->second);
}

bool stands_there(const fs::path& file) {
  std::error_code problem;
  return fs::symlink_status(file, problem).type() != fs::file_type::not_found;
}

core::Result<ListedFiles> check_listed_files(const fs::path& directory,
                                             std::vector<std::string>& differences) {
  ListedFiles out;
  out.list_found = stands_there(directory / record::kChecksumsName);
  if (!out.list_found) return out;
  const auto list = record::read_checksums(directory);
  if (!list && list.error().code != core::Code::kSyntax) return core::fail(list.error());
  if (!list) {
    differences.push_back(fmt::format("{}: {}", list.error().where, list.error().what));
    return out;
  }
  for (const record::Checksum& line : *list) {
    ListedFiles::State& state = out.files[line.file];
    if (!stands_there(directory / line.file)) {
      state = ListedFiles::State::kAbsent;
      continue;
    }
    TRY(const auto sha256, record::sha256_inside(directory, line.file));
    state = sha256 == line.sha256 ? ListedFiles::State::kAsWritten : ListedFiles::State::kChanged;
  }
  return out;
}

core::Result<void> check_signature(const fs::path& directory, const std::string& public_key_pem,
                                   const ListedFiles& listed, const std::vector<std::string>& files,
                                   std::vector<std::string>& differences) {
  if (!listed.list_found || !stands_there(directory / record::kSignatureName)) {
    differences.push_back(
        fmt::format("the run is not signed: there is no {}; rondure sign signs it",
                    listed.list_found ? record::kSignatureName : record::kChecksumsName));
    return {};
  }
  TRY(const auto sums, record::read_inside(directory, record::kChecksumsName));
  TRY(const auto signature, record::read_inside(directory, record::kSignatureName));
  TRY(const auto holds, record::signature_holds(sums, signature, public_key_pem));
  if (!holds) {
    differences.push_back(
        fmt::format("{}: the signature does not hold: {} or the signature was changed after it was "
                    "signed, or another key signed it",
                    record::kSignatureName, record::kChecksumsName));
  }
  for (const std::string& file : files) {
    const auto state = listed.state_of(file);
    const std::string absent =
        fmt::format("{}: it is not there, and {} names it", file, record::kChecksumsName);
    const bool told =
        std::find(differences.begin(), differences.end(), absent) != differences.end();
    if (state == ListedFiles::State::kAbsent && !told) differences.push_back(absent);
    if (state || !stands_there(directory / file)) continue;
    differences.push_back(
        fmt::format("{}: it is not signed: {} does not name it", file, record::kChecksumsName));
  }
  return {};
}

}  // namespace rondure::reports
