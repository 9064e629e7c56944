#include "record/checksums.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "record/files.h"
#include "record/sha256.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 64;

/// Whether a name is one in the directory or in a folder of it.
bool stays_inside(std::string_view name) {
  if (name.find('\0') != std::string_view::npos) return false;
  while (true) {
    const std::size_t end = name.find('/');
    const std::string_view step = name.substr(0, end);
    if (step.empty() || step == "." || step == "..") return false;
    if (end == std::string_view::npos) return true;
    name.remove_prefix(end + 1);
  }
}

/// "<64 digits>  <name>", or with an asterisk before the name (sha256sum --binary).
bool read_line(std::string_view line, Checksum& out) {
  if (line.size() <= kDigits + 2 || line[kDigits] != ' ') return false;
  if (line[kDigits + 1] != ' ' && line[kDigits + 1] != '*') return false;
  out.sha256 = line.substr(0, kDigits);
  out.file = line.substr(kDigits + 2);
  const bool hexadecimal = out.sha256.find_first_not_of("0123456789abcdef") == std::string::npos;
  return hexadecimal && stays_inside(out.file);
}

}  // namespace

core::Result<std::vector<Checksum>> read_checksums(const fs::path& directory) {
  TRY(const auto bytes, read_inside(directory, kChecksumsName));
  std::vector<Checksum> list;
  std::string_view rest = bytes;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    Checksum line;
    if (!read_line(rest.substr(0, end), line)) {
      return core::fail(core::Code::kSyntax,
                        "this is no line of sha256sum (64 digits 0-9a-f, two blanks, the name of "
                        "a file in this directory or below)",
                        fmt::format("{}:{}", kChecksumsName, number));
    }
    list.push_back(std::move(line));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  return list;
}

core::Result<void> update_checksums(const fs::path& directory, const std::vector<Checksum>& files,
                                    const std::vector<std::string>& gone) {
  std::vector<Checksum> list;
  std::error_code unknown;  // a list that cannot be examined cannot be written either
  if (fs::exists(directory / kChecksumsName, unknown)) {
    TRY(list, read_checksums(directory));
  }
  std::erase_if(list, [&](const Checksum& c) {
    return std::find(gone.begin(), gone.end(), c.file) != gone.end();
  });
  for (const Checksum& file : files) {
    const auto line = std::find_if(list.begin(), list.end(),
                                   [&](const Checksum& c) { return c.file == file.file; });
    if (line == list.end()) {
      list.push_back(file);
    } else {
      line->sha256 = file.sha256;
    }
  }
  std::string text;
  for (const Checksum& line : list) text += fmt::format("{}  {}\n", line.sha256, line.file);
  return write_file(directory / kChecksumsName, text);
}

}  // namespace rondure::record
