#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rondure::cmm::ipp {

/// How a server differs from the specification: the names it lacks and the form of its answers.
struct Profile {
  /// Error `told` is reported in place of `number`.
  struct ErrorNumber {
    int number = 0;
    int told = 0;
    std::string_view method = {};  ///< For this method alone; empty: for every method.
  };

  std::string_view name = "as-specified";
  /// Unknown methods, properties and values of reports; "Part" stands for "Part.Temperature" too.
  std::vector<std::string_view> lacks;
  std::vector<ErrorNumber> errors;
  double least_retract_mm = -1.0;       ///< 0: a negative PtMeasPar.Retract is clamped.
  std::size_t numbers_in_a_line = 400;  ///< Of a scan: some 8000 characters.
  bool writes_five_decimals = false;    ///< In place of ControllerOptions::numbers.
  bool sorts_values = false;            ///< Reports have alphabetical order: ER, IJK, Q, X, Y, Z.
  bool adds_origin = false;             ///< x_csy = R x_machine + x0, see machine_to_csy().
  bool quotes_machine_class = false;    ///< GetMachineClass("CartCMM").
  bool brackets_vectors = false;        ///< AlignPart answers (0,0,1), not bare numbers.
  bool tells_tool_axis = false;         ///< IJK of a touch is always (0,0,1).
  bool abort_is_silent = false;         ///< AbortE drops waiting commands, and daemons.

  [[nodiscard]] bool knows(std::string_view asked) const;
  /// The number to report for an error of a method.
  [[nodiscard]] int told(int number, std::string_view method) const;
  /// The values of a report as they are answered.
  [[nodiscard]] std::vector<std::string> in_order(std::vector<std::string> names) const;
};

/// "as-recorded": the independent server of tests/data/ipp_dme_dialogue.
[[nodiscard]] Profile as_recorded();
/// "touches-only": the same without scans, GetDMEVersion and negative retract.
[[nodiscard]] Profile touches_only();
/// The profiles to choose from, "as-specified" first.
[[nodiscard]] const std::vector<Profile>& profiles();

}  // namespace rondure::cmm::ipp
