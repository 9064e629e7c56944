#include <filesystem>

#include <fmt/format.h>

#include "app/run/kept_trials.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/signature.h"
#include "reports/verify/verify.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

/// Whether the run verifies: no other run should be signed.
bool verifies(const fs::path& directory) {
  const auto outcome = reports::verify_run(directory, verify_options(directory));
  if (!outcome) {
    print_error(outcome.error());
    return false;
  }
  for (const std::string& difference : outcome->differences) {
    tell(fmt::format("rondure: not signed, because not equal: {}\n", difference));
  }
  return outcome->differences.empty();
}

/// Says when other users of the computer could sign in the signer's name.
void tell_readable_key(const fs::path& key) {
  std::error_code unknown;
  const fs::perms others =
      fs::status(key, unknown).permissions() & (fs::perms::group_read | fs::perms::others_read);
  if (unknown || others == fs::perms::none) return;
  tell(
      fmt::format("rondure: note: other users of this computer can read the private key {}; "
                  "chmod 600 keeps it to yourself\n",
                  key.string()));
}

core::Result<fs::path> write_signature(const SignArguments& arguments) {
  const fs::path directory = arguments.directory;
  TRY(const auto key, record::read_file(arguments.key));
  TRY(const auto sums, record::read_inside(directory, record::kChecksumsName));
  const auto signature = record::sign(sums, key);
  if (!signature) return core::fail(signature.error().at(arguments.key));
  const fs::path file = directory / record::kSignatureName;
  TRY_DO(record::write_file(file, *signature));
  return file;
}

}  // namespace

int sign(const SignArguments& arguments) {
  if (!verifies(arguments.directory)) return kBadInput;
  const auto file = write_signature(arguments);
  if (!file) return refuse(file.error());
  tell_readable_key(arguments.key);
  say_line(file->string());
  return kAllWell;
}

}  // namespace rondure::app
