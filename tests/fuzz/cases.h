#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace rondure::fuzz {

/// Number of cases per input: `quick`, a quarter of `full` with RONDURE_FULL=1, `full` with
/// RONDURE_FULL=all; a tenth of each under the address sanitizer. RONDURE_FUZZ_SEED=N tries case N
/// alone.
struct Counts {
  unsigned quick = 0;
  unsigned full = 100'000;
};

/// Tries the cases 0, 1, 2, ... of an input in this process, and fails the test at the first faulty
/// case, with the command that repeats it. A case is faulty when it returns a text ("" is correct),
/// throws, crashes, takes more than 10 s of processor time or ten minutes of wall time, or brings
/// the process beyond 1 GB.
void try_cases(const Counts& counts, const std::function<std::string(unsigned seed)>& try_case);

/// A folder in memory, where the system has one, for the files of all cases; removed at the end of
/// the process. Temporary files of the program go there, too.
[[nodiscard]] const std::filesystem::path& work_folder();

}  // namespace rondure::fuzz
