#include "cmm/ipp/internal/errors.h"

#include <algorithm>
#include <array>

namespace rondure::cmm::ipp {
namespace {

constexpr std::array kErrors = {
    ErrorEntry{0, 0, "Buffer full"},
    ErrorEntry{1, 2, "Illegal tag"},
    ErrorEntry{2, 2, "No space at pos. 6"},
    ErrorEntry{6, 2, "Transaction aborted (Use ClearAllErrors To Continue)"},
    ErrorEntry{7, 3, "Illegal character"},
    ErrorEntry{8, 3, "Protocol error"},
    ErrorEntry{500, 3, "Emergency stop"},
    ErrorEntry{501, 3, "Unsupported command"},
    ErrorEntry{502, 3, "Incorrect arguments"},
    ErrorEntry{503, 9, "Controller communications failure"},
    ErrorEntry{504, 1, "Argument out of range"},
    ErrorEntry{505, 3, "Argument not recognized"},
    ErrorEntry{506, 3, "Argument not supported"},
    ErrorEntry{507, 3, "Illegal command"},
    ErrorEntry{508, 3, "Bad context"},
    ErrorEntry{509, 3, "Bad argument"},
    ErrorEntry{510, 3, "Bad property"},
    ErrorEntry{511, 3, "Error processing method"},
    ErrorEntry{512, 1, "No daemons are active"},
    ErrorEntry{513, 2, "Daemon does not exist"},
    ErrorEntry{514, 2, "Use ClearAllErrors to continue"},
    ErrorEntry{515, 2, "Daemon already exists"},
    ErrorEntry{1000, 3, "Machine in error state"},
    ErrorEntry{1001, 2, "Illegal touch"},
    ErrorEntry{1002, 9, "Axis does not exist"},
    ErrorEntry{1003, 2, "No touch"},
    ErrorEntry{1004, 9, "Number of angles not supported on current device"},
    ErrorEntry{1005, 3, "Error during home"},
    ErrorEntry{1006, 2, "Surface not found"},
    ErrorEntry{1007, 3, "Theta out of range"},
    ErrorEntry{1008, 3, "Target position out of machine volume"},
    ErrorEntry{1009, 3, "Air pressure out of range"},
    ErrorEntry{1010, 2, "Vector has no norm"},
    ErrorEntry{1011, 2, "Unable to move"},
    ErrorEntry{1012, 2, "Bad lock combinations"},
    ErrorEntry{1013, 3, "Coordinate system not found"},
    ErrorEntry{1014, 2, "Failed to set value due to active internal correction"},
    ErrorEntry{1500, 3, "Failed to re-seat head"},
    ErrorEntry{1501, 3, "Probe not armed"},
    ErrorEntry{1502, 3, "Tool not found"},
    ErrorEntry{1503, 3, "Tool not defined"},
    ErrorEntry{1504, 3, "Collection not found"},
    ErrorEntry{1505, 2, "Tool not alignable"},
    ErrorEntry{1506, 1, "Tool property not applicable"},
    ErrorEntry{1507, 3, "Tool not alignable to given orientation"},
    ErrorEntry{2000, 3, "Tool not calibrated"},
    ErrorEntry{2001, 2, "Head error excessive force"},
    ErrorEntry{2002, 3, "Type of probe does not allow this operation"},
    ErrorEntry{2500, 3, "Machine limit encountered [Move Out Of Limits]"},
    ErrorEntry{2501, 3, "Axis not active"},
    ErrorEntry{2502, 3, "Axis position error"},
    ErrorEntry{2503, 9, "Scale read head failure"},
    ErrorEntry{2504, 3, "Collision"},
    ErrorEntry{2505, 2, "Specified angle out of range"},
    ErrorEntry{2506, 2, "Part not aligned"},
};

}  // namespace

const ErrorEntry* find_error(int number) {
  const auto found =
      std::lower_bound(kErrors.begin(), kErrors.end(), number,
                       [](const ErrorEntry& entry, int wanted) { return entry.number < wanted; });
  return found != kErrors.end() && found->number == number ? &*found : nullptr;
}

}  // namespace rondure::cmm::ipp
