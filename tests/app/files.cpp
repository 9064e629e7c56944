#include "tests/app/files.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace rondure::app::testing {

namespace fs = std::filesystem;

namespace {

void write_changed(const fs::path& file, nlohmann::ordered_json plan,
                   const std::vector<Change>& changes) {
  for (const Change& change : changes) {
    plan[nlohmann::ordered_json::json_pointer(change.pointer)] = change.value;
  }
  write(file, plan.dump(2));
}

}  // namespace

fs::path source_dir() { return RONDURE_SOURCE_DIR; }

fs::path example(const std::string& name) { return source_dir() / "plans" / "examples" / name; }

std::vector<fs::path> plans_in(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool needs_server(const fs::path& plan) {
  return nlohmann::json::parse(read(plan)).value("/machine/driver"_json_pointer, "") == "ippdme";
}

std::string read(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

void write(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent)) {
    out.push_back(entry.path().filename().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
  std::string bytes = read(file);
  const std::size_t at = bytes.find(from);
  if (at == std::string::npos) throw std::runtime_error(file.string() + " does not hold " + from);
  write(file, bytes.replace(at, from.size(), to));
}

void write_plan(const fs::path& file, const std::vector<Change>& changes) {
  auto plan = example_plan("01_spool_simulated");
  leave_out_intervals(plan);
  write_changed(file, std::move(plan), changes);
}

void write_plan_with_intervals(const fs::path& file, const std::vector<Change>& changes) {
  write_changed(file, example_plan("01_spool_simulated"), changes);
}

nlohmann::ordered_json example_plan(const std::string& name) {
  auto plan = nlohmann::ordered_json::parse(read(example(name + ".json")));
  plan.erase("$schema");
  const auto from_anywhere = [](nlohmann::ordered_json& file) {
    file = example(file.get<std::string>()).string();
  };
  for (auto& feature : plan["features"]) {
    if (feature.contains("source")) from_anywhere(feature["source"]["file"]);
  }
  const nlohmann::ordered_json::json_pointer calibration("/fixture/calibration/file");
  if (plan.contains(calibration)) from_anywhere(plan[calibration]);
  return plan;
}

nlohmann::ordered_json wheel_with_a_grain() {
  auto plan = example_plan("06_wheel");
  plan["simulation"]["wheel"].update({{"points", 16}, {"chipped_point", 5}, {"chip_um", 45.0}});
  return plan;
}

nlohmann::ordered_json two_crank_pins() {
  auto plan = example_plan("07_crank_pin");
  plan["simulation"]["contour"]["parts"] = 2;
  plan["simulation"]["contour"]["gauge_points"] = 360;
  return plan;
}

}  // namespace rondure::app::testing
