#pragma once

#include <string>

#include "core/result.h"

namespace rondure::cmm {

/// Properties of an indicator.
struct IndicatorTraits {
  double resolution_mm = 0.001;  ///< Value of its last digit.
  double reading_time_s = 0.05;  ///< Typical time from the request to the reading.
};

/// An indicator that returns the position of its tip on request: a dial gauge, an inductive probe
/// with a display. Each request gives one reading, and several indicators are read one after the
/// other. This suits setting up, and measurements at stopped angles.
class DisplacementProbe {
 public:
  virtual ~DisplacementProbe() = default;
  DisplacementProbe() = default;
  DisplacementProbe(const DisplacementProbe&) = delete;
  DisplacementProbe& operator=(const DisplacementProbe&) = delete;

  /// One line for the record.
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] virtual IndicatorTraits traits() const = 0;
  /// Requests a reading [mm]; it is never older than the request. kMachine, with the message of the
  /// indicator, when none arrives.
  [[nodiscard]] virtual core::Result<double> read_mm() = 0;
};

/// The error kBadOption for indicators that are to follow a rotating part: read one after the
/// other, they cannot, and the message gives the reason in numbers.
/// @param rate_Hz     Readings per second wanted of each indicator, > 0.
/// @param indicators  Number of indicators, >= 1.
[[nodiscard]] core::Error refuse_tracking(const IndicatorTraits& traits, double rate_Hz,
                                          int indicators);

}  // namespace rondure::cmm
