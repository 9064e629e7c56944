#include <charconv>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/sections.h"
#include "benchmarks/timing.h"
#include "record/points/points.h"

namespace rondure::benchmarks {
namespace {

std::string text_of(const CylinderSet& set) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "x,y,z\n");
  for (const Eigen::Vector3d& p : set.points_mm) {
    fmt::format_to(std::back_inserter(out), "{:.6f},{:.6f},{:.6f}\n", p.x(), p.y(), p.z());
  }
  return fmt::to_string(out);
}

/// The text's numbers and nothing else: no header, no errors, room for the numbers is there.
void bare_read(const std::string& text, std::vector<double>& numbers) {
  const char* at = text.data() + text.find('\n') + 1;
  const char* const end = text.data() + text.size();
  for (double& value : numbers) at = std::from_chars(at, end, value).ptr + 1;
}

}  // namespace

void register_text(const Extent& extent) {
  // Made at the first use, so that a filtered run does not wait for it.
  auto text = std::make_shared<std::string>();
  const auto fill = [extent, text] {
    if (text->empty()) *text = text_of(*cylinder_set({Variant::kScanOrder, extent.large(), 0}));
  };
  const auto name = [&](const char* what) { return fmt::format("{}/n:{}", what, extent.large()); };
  benchmark::RegisterBenchmark(name("text/ours").c_str(), [=](benchmark::State& state) {
    fill();
    for ([[maybe_unused]] auto _ : state) {
      const auto table = record::read_points(*text, "points.csv");
      keep(table);
    }
  });
  benchmark::RegisterBenchmark(name("text/from_chars").c_str(), [=](benchmark::State& state) {
    fill();
    std::vector<double> numbers(3 * std::size_t{extent.large()});
    for ([[maybe_unused]] auto _ : state) {
      bare_read(*text, numbers);
      keep(numbers.data());
      benchmark::ClobberMemory();
    }
  });
}

}  // namespace rondure::benchmarks
