#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/run/arguments.h"
#include "app/run/resumption.h"
#include "evaluation/decision/decision.h"
#include "evaluation/results/evaluation.h"
#include "plans/plan.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"
#include "record/run_record.h"
#include "reports/words/language.h"

namespace rondure::app {

/// The formats that a run writes: from the command line, otherwise from the plan.
[[nodiscard]] const std::vector<std::string>& formats_of(const RunArguments& arguments,
                                                         const plans::Plan& plan);

/// Exit status of a finished run with this verdict.
[[nodiscard]] int exit_status(evaluation::Verdict verdict);

/// Reads and evaluates the journal on disk, not the rows in memory; seals a finished run; writes
/// the reports; archives a finished run.
/// @return  Exit status of the program.
[[nodiscard]] int conclude(const RunToFinish& ending, plans::Run& run);

/// Completes a sealed run, which may have died before its reports were written or its results
/// archived. Measures nothing.
/// @return  Exit status of the program.
[[nodiscard]] int finish_sealed(const RunToFinish& ending, record::HeldJournal held);

/// Prints the answer of a run, with all details and the names of all files where `verbose` asks for
/// them; then the features that have no corrections, with the reason (a technician who asked for a
/// table would miss it at the machine), where the report is, and what comes next.
void say_result(const std::filesystem::path& directory, const record::RunRecord& record,
                const evaluation::Evaluation& evaluation, reports::Language language, bool verbose,
                const std::vector<std::filesystem::path>& written);

/// The record of a run that can be evaluated; none, after a message for every fault, when its
/// journal cannot be read or is damaged.
[[nodiscard]] std::optional<record::RunRecord> read_sound_record(const std::string& directory);

}  // namespace rondure::app
