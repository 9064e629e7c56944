#pragma once

namespace rondure::cmm::ipp {

/// Which point the coordinates in PtMeas and the start in ScanOnCircle name. The specification says
/// the surface (6.3.2.13: the approach includes the tool radius); some servers take them for the
/// centre of the tip. What is reported is the centre of the tip under either reading.
enum class NamedPoint { kSurface, kCenter };

}  // namespace rondure::cmm::ipp
