#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "plans/plan.h"
#include "plans/schema/findings.h"

namespace rondure::plans {

/// Checks the bodies of the fixture (`fixture.bodies`) and reads the files of those that have one.
void read_bodies(Plan& plan, Findings& findings);

/// The files of the bodies, each in a line with its SHA-256: what a run takes of them. Empty for
/// none.
[[nodiscard]] std::string body_files(const Plan& plan);

/// The bodies whose files are not those on record, each with the pointer of its file.
/// @param on_record  What body_files() gave when the run began.
[[nodiscard]] std::vector<core::Error> bodies_changed(const Plan& plan, std::string_view on_record);

}  // namespace rondure::plans
