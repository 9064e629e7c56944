#pragma once

#include <cstddef>
#include <optional>
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

/// The part of the turn that no point and no window names, where it is too wide for a value (see
/// evaluation::unseen_rad()), or half a turn and more without a point, windows or not; else 0.
[[nodiscard]] double unseen_in(const PreparedSurface& surface, const SurfaceSection& section);

/// Why no verdict may rest on some sections: the first of fewer than three points, or that leaves a
/// part of its turn about an axis unseen as of unseen_in(). Nothing where all are seen.
[[nodiscard]] std::optional<core::Phrase> unseen_part(const PreparedSurface& surface,
                                                      std::span<const SurfaceSection> sections,
                                                      const fit::Axis& about);
/// The same of all points together, projected along the axis.
[[nodiscard]] std::optional<core::Phrase> unseen_turn(const PreparedSurface& surface,
                                                      const fit::Axis& about);
/// Of a whole surface about its own axis: of each layer or, without layers, of all points together;
/// of a ball the cap that they cover.
[[nodiscard]] std::optional<core::Phrase> unseen_part(const PreparedSurface& surface);
/// Of a face: of its layers that are circles, and of windows over one side of it.
[[nodiscard]] std::optional<core::Phrase> unseen_of_face(const PreparedSurface& surface);

/// " of any section", " of section 2": which sections a value is of; `what` is "GG".
[[nodiscard]] core::Phrase of_sections(const core::Phrase& what,
                                       const record::Indication& indication);

/// The error of one section, which names its layer.
[[nodiscard]] core::Error in_layer(const SurfaceSection& section, const core::Error& error);

}  // namespace rondure::evaluation
