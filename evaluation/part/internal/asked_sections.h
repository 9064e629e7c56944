#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/phrase.h"
#include "core/result.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "fit/least_squares/sections.h"
#include "fit/profiles/closed_profile.h"
#include "record/indication.h"

// Private to the room: the sections of a prepared surface that a characteristic is about.

namespace rondure::evaluation {

using Sections = std::vector<SurfaceSection>;

/// All sections, or those that section SCS names.
/// @return kSampling for points that are in no sections; kRank for a section that is not there.
[[nodiscard]] core::Result<Sections> asked_sections(const PreparedSurface& surface,
                                                    const record::Indication& indication);

/// The points of each pass of a scan as a section of its own: neighbours of two passes differ by
/// their noise.
[[nodiscard]] Sections by_pass(const PreparedSurface& surface, const SurfaceSection& section);

/// Sections projected along the axis of the surface, in their order.
/// @return as fit::sections_across().
[[nodiscard]] core::Result<std::vector<fit::Section>> projected(const PreparedSurface& surface,
                                                                std::span<const SurfaceSection> of);

/// Profile of a dense section about its circle [mm], at uniform angles: its points where they stand
/// at equal steps to a thousandth, else interpolated.
[[nodiscard]] core::Result<fit::ResampledProfile> section_profile(const fit::Section& section);

/// Adds the rows of some points to those that carry a value.
void add_rows(const PreparedSurface& surface, std::span<const std::size_t> points, Finding& out);

/// Rows that a window takes out of a section.
[[nodiscard]] std::vector<std::size_t> window_rows(const PreparedSurface& surface,
                                                   const SurfaceSection& section);
/// Angle of a place about the axis of the surface, in the frame of across() [rad].
[[nodiscard]] double angle_rad(const PreparedSurface& surface, const Eigen::Vector3d& place_mm);

/// The part of the turn that no point and no window names, where it is too wide for a value; else 0
/// (see evaluation::unseen_rad()).
[[nodiscard]] double unseen_in(const PreparedSurface& surface, const SurfaceSection& section);
/// The same for all points together, projected along the axis.
[[nodiscard]] double unseen_in(const PreparedSurface& surface);

/// " of any section", " of section 2": which sections a value is of; `what` is "GG".
[[nodiscard]] core::Phrase of_sections(const core::Phrase& what,
                                       const record::Indication& indication);

/// The error of one section, which names its layer.
[[nodiscard]] core::Error in_layer(const SurfaceSection& section, const core::Error& error);

}  // namespace rondure::evaluation
