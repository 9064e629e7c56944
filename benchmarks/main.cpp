// rondure_benchmarks [--quick | --full] [flags of Google Benchmark]
//   --quick  few and small sets: a check that everything runs, no figures
//   --full   1e7 points too

#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include "benchmarks/sections.h"

int main(int argc, char** argv) {
  using namespace rondure::benchmarks;
  Extent extent;
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--quick") {
      extent.quick = true;
    } else if (argument == "--full") {
      extent.full = true;
    } else {
      rest.push_back(argv[i]);
    }
  }
  int count = static_cast<int>(rest.size());
  benchmark::Initialize(&count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 2;
  benchmark::AddCustomContext("extent", extent.quick ? "quick" : extent.full ? "full" : "usual");
  register_passes(extent);
  register_cylinders(extent);
  register_circles(extent);
  register_text(extent);
  register_reach(extent);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
