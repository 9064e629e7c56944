#pragma once

namespace rondure::cmm::ipp {

/// The point meant by the coordinates in PtMeas and the start in ScanOnCircle. The specification
/// means the surface (6.3.2.13: the approach includes the tool radius); some servers take the
/// centre of the tip. The reported point is the centre of the tip in both cases.
enum class NamedPoint { kSurface, kCenter };

}  // namespace rondure::cmm::ipp
