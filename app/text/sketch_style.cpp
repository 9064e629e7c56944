#include "app/text/sketch_style.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace rondure::app {
namespace {

/// The locale's name of its character set, as POSIX looks for it.
std::string locale_name() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(variable);
    if (value != nullptr && *value != '\0') return value;
  }
  return "C";
}

bool is_utf8(std::string name) {
  for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return name.find("UTF-8") != std::string::npos || name.find("UTF8") != std::string::npos;
}

}  // namespace

reports::SketchStyle sketch_style() {
  if (isatty(STDOUT_FILENO) != 1) return reports::SketchStyle::kNone;
  return is_utf8(locale_name()) ? reports::SketchStyle::kBraille : reports::SketchStyle::kAscii;
}

}  // namespace rondure::app
