#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace rondure::record {

/// Finds the first of these programs in the folders of PATH, or of the default path of the system
/// when PATH is not set; empty when there is none. Relative folders are skipped: a program found
/// there would depend on the working directory.
[[nodiscard]] std::filesystem::path find_program(const std::vector<std::string>& names);

/// A program to be run, without a shell.
struct ProgramCall {
  std::filesystem::path program;
  std::vector<std::string> arguments;    ///< Without the name of the program.
  std::vector<std::string> environment;  ///< "NAME=value"; the program sees nothing else.
  std::filesystem::path said;  ///< File that receives its standard output and error; overwritten.
  std::chrono::milliseconds time_limit;  ///< The program is killed after this time; > 0.
};

/// Runs a program to its end as the leader of a process group, then kills the rest of the group.
/// @return  kFile unless its exit status is 0, with the cause and the last line of its output.
[[nodiscard]] core::Result<void> run_program(const ProgramCall& call);

}  // namespace rondure::record
