#include "wire/internal/device_holders.h"

#include <algorithm>
#include <cctype>
#include <fstream>

#include <fmt/format.h>

namespace rondure::wire {
namespace {

namespace fs = std::filesystem;

bool has_open(const fs::path& process, const fs::path& device) {
  std::error_code none;
  for (fs::directory_iterator fd(process / "fd", none), end; !none && fd != end;
       fd.increment(none)) {
    std::error_code gone;
    if (fs::read_symlink(fd->path(), gone) == device) return true;
  }
  return false;
}

}  // namespace

std::string device_holders(const fs::path& device) {
  std::error_code none;
  const fs::path real = fs::canonical(device, none);
  std::string out;
  for (fs::directory_iterator entry("/proc", none), end; !none && entry != end;
       entry.increment(none)) {
    const std::string number = entry->path().filename().string();
    const bool process = std::all_of(number.begin(), number.end(),
                                     [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!process || !has_open(entry->path(), real.empty() ? device : real)) continue;
    std::string name;
    std::ifstream(entry->path() / "comm") >> name;
    out += fmt::format("{}{} (process {})", out.empty() ? "" : ", ", name, number);
  }
  return out;
}

}  // namespace rondure::wire
