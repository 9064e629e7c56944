#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cmm/machine.h"

namespace rondure::cmm::ipp {

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
