#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cmm/machine.h"

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

/// Values of the parameters of a tool after every tool change.
struct ParameterDefaults {
  Speeds speeds;  ///< Speeds of travel (GoToPar), of touches (PtMeasPar), of scans (ScanPar).
  double approach_mm = 3.0;
  double search_mm = 3.0;
  double retract_mm = -1.0;  ///< Negative: back to the start of the search.
};

/// The blocks GoToPar, PtMeasPar and ScanPar of the active tool: each parameter with the values
/// Act, Min, Max and Def. Accelerations are stored and have no effect.
class ToolParameters {
 public:
  /// @param least, greatest  Speeds the machine accepts.
  /// @param least_retract_mm  Negative: the tip can return to the start of the search.
  ToolParameters(const ParameterDefaults& defaults, const Speeds& least, const Speeds& greatest,
                 double least_retract_mm);

  /// Gets a value by its name after "Tool.": "PtMeasPar.Speed", "PtMeasPar.Speed.Max".
  [[nodiscard]] std::optional<double> get(std::string_view name) const;

  enum class Set { kDone, kClamped, kNoSuch };
  /// Sets Act; a value out of range is clamped.
  [[nodiscard]] Set set(std::string_view name, double value);
  /// Sets Act to Def for all parameters.
  void reset();

  [[nodiscard]] Speeds speeds() const;
  [[nodiscard]] double act(std::string_view name) const { return get(name).value_or(0.0); }
  /// All names, e.g. "PtMeasPar.Speed".
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  struct Parameter {
    std::string name;
    double def = 0.0;
    double min = 0.0;
    double max = 0.0;
    double act = 0.0;
  };
  std::vector<Parameter> parameters_;
};

}  // namespace rondure::cmm::ipp
