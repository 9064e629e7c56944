#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace rondure::record {

/// The first of these programs in the folders of PATH, or of the system's default where PATH is not
/// set; empty when there is none. Folders that are not named absolutely are left out: a program
/// there is whatever happens to lie beside the data.
[[nodiscard]] std::filesystem::path find_program(const std::vector<std::string>& names);

/// A program to be run, without a shell.
struct ProgramCall {
  std::filesystem::path program;
  std::vector<std::string> arguments;    ///< Without the name of the program.
  std::vector<std::string> environment;  ///< "NAME=value"; nothing else is handed on.
  std::filesystem::path said;            ///< File for its standard output and error, made anew.
  std::chrono::milliseconds time_limit;  ///< After it the program is killed; > 0.
};

/// Runs a program to its end, as the leader of a process group; what is left of the group is
/// killed.
/// @return  kFile unless its exit status is 0: what ended it and the last line that it wrote.
[[nodiscard]] core::Result<void> run_program(const ProgramCall& call);

}  // namespace rondure::record
