#include "app/run/processor.h"

#include <ctime>

#include <array>
#include <fstream>
#include <sstream>

namespace rondure::app {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string model = "unknown processor";
  std::string units;
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    if (line.rfind("model name", 0) == 0 && colon + 2 <= line.size())
      model = line.substr(colon + 2);
    if (line.rfind("flags", 0) != 0) continue;
    std::istringstream flags(line.substr(colon + 1));
    for (std::string flag; flags >> flag;) {
      if (flag == "fma" || flag == "avx2" || flag == "avx512f") units += " " + flag;
    }
    break;  // the other cores are identical
  }
  return model + " (" + (units.empty() ? "no fma" : units.substr(1)) + ")";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  const auto length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

}  // namespace rondure::app
