#include "record/private_folder.h"

#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

namespace rondure::record {

namespace fs = std::filesystem;

PrivateFolder::PrivateFolder(const char* name) {
  std::error_code problem;
  const fs::path place = fs::temp_directory_path(problem);
  std::string made = ((problem ? fs::path("/tmp") : place) / name).string() + "-XXXXXX";
  if (::mkdtemp(made.data()) != nullptr) path_ = made;
}

PrivateFolder::~PrivateFolder() {
  if (path_.empty()) return;
  std::error_code problem;
  // A process that was just killed may still write a file into a folder that is being emptied.
  for (int i = 0; i < 5; ++i) {
    fs::remove_all(path_, problem);
    if (!problem) return;
    ::usleep(20'000);
  }
}

}  // namespace rondure::record
