#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace rondure::fuzz {

/// How many cases of a door are tried: `quick` of them, `full` with RONDURE_FULL=1, a tenth of
/// either under the address sanitizer. RONDURE_FUZZ_SEED=N tries case N alone.
struct Counts {
  unsigned quick = 0;
  unsigned full = 100'000;
};

/// Tries the cases 0, 1, 2, ... of a door in this process, and fails the test at the first that
/// goes wrong, with the command that repeats it: a case that says what is wrong ("" is well),
/// throws, crashes, takes more than 10 s of the processor or ten minutes of the clock, or brings the
/// process beyond 1 GB.
void try_cases(const Counts& counts, const std::function<std::string(unsigned seed)>& try_case);

/// A folder in memory, where the system has one, for the files of all cases; removed at the end of
/// the process. Temporary files of the program go there, too.
[[nodiscard]] const std::filesystem::path& work_folder();

}  // namespace rondure::fuzz
