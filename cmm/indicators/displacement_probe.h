#pragma once

#include <string>

#include "core/result.h"

namespace rondure::cmm {

/// What an indicator can do.
struct IndicatorTraits {
  double resolution_mm = 0.001;  ///< Of its last digit.
  double reading_time_s = 0.05;  ///< From the question to the reading, usually.
};

/// An indicator that says, when it is asked, how far its tip stands: a dial gauge, an inductive
/// probe with a display. One question, one reading; indicators side by side are read one after the
/// other. That serves setting up, and work at stopped angles.
class DisplacementProbe {
 public:
  virtual ~DisplacementProbe() = default;
  DisplacementProbe() = default;
  DisplacementProbe(const DisplacementProbe&) = delete;
  DisplacementProbe& operator=(const DisplacementProbe&) = delete;

  /// One line for the record.
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] virtual IndicatorTraits traits() const = 0;
  /// Asks for a reading [mm]; it is never older than the question. kMachine, with what the
  /// indicator said, when none comes.
  [[nodiscard]] virtual core::Result<double> read_mm() = 0;
};

/// Whether indicators that are asked one after the other can follow a part that turns: they cannot,
/// and kBadOption says why in numbers.
/// @param rate_Hz     Readings a second that are wanted of each indicator, > 0.
/// @param indicators  How many are read, >= 1.
[[nodiscard]] core::Error refuse_tracking(const IndicatorTraits& traits, double rate_Hz,
                                          int indicators);

}  // namespace rondure::cmm
