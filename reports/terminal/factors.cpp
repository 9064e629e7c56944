#include "reports/terminal/factors.h"

#include <iterator>

#include <fmt/format.h>

#include "core/numbers.h"
#include "reports/terminal/internal/columns.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::signed_um;
using core::um;

constexpr std::size_t kLabel = 34;
constexpr std::size_t kNumber = 9;  ///< Columns of a reference.
constexpr std::size_t kChange = 10;

using Combination = std::array<std::size_t, 4>;

/// A row: one combination of the last three factors, one column per reference.
struct CombinationRow {
  const evaluation::FactorStudy& study;
  Combination combination;  ///< Its reference is ignored.

  [[nodiscard]] const evaluation::FactorCell& cell(std::size_t reference) const {
    Combination c = combination;
    c[at(evaluation::Factor::kReference)] = reference;
    return study.cell(c);
  }
  [[nodiscard]] const evaluation::FactorCell& reported() const {
    return cell(study.reported[at(evaluation::Factor::kReference)]);
  }
  [[nodiscard]] std::size_t references() const {
    return study.levels[at(evaluation::Factor::kReference)].size();
  }
  [[nodiscard]] bool has_value() const {
    for (std::size_t r = 0; r < references(); ++r) {
      if (cell(r).value_mm) return true;
    }
    return false;
  }
};

/// The row, and below it the reason for a missing value.
std::string row_text(const CombinationRow& row, const std::string& label) {
  std::string out = fmt::format("{:<{}}", shortened(label, kLabel), kLabel);
  if (!row.has_value()) return wrapped(out, fmt::format("no value: {}", row.reported().why));
  std::string notes;
  for (std::size_t r = 0; r < row.references(); ++r) {
    const evaluation::FactorCell& cell = row.cell(r);
    fmt::format_to(std::back_inserter(out), "{:>{}}", cell.value_mm ? um(*cell.value_mm) : "-",
                   kNumber);
    if (cell.value_mm) continue;
    notes += wrapped(
        "    ",
        fmt::format("- {}: {}", row.study.levels[at(evaluation::Factor::kReference)][r], cell.why));
  }
  if (const auto& value = row.reported().value_mm)
    fmt::format_to(std::back_inserter(out), "{:>{}}", signed_um(*value - row.study.reported_mm),
                   kChange);
  return out + "\n" + notes;
}

std::string head_text(const evaluation::FactorStudy& study) {
  std::string out = fmt::format("{:<{}}", "um", kLabel);
  for (const std::string& reference : study.levels[at(evaluation::Factor::kReference)])
    fmt::format_to(std::back_inserter(out), "{:>{}}", reference, kNumber);
  return out + fmt::format("{:>{}}\n", "change", kChange);
}

/// "  3 sigma, 2 left out", "  points 1, 3, 5, ... (16)".
std::string label_of(const evaluation::FactorStudy& study, evaluation::Factor factor,
                     std::size_t level) {
  const evaluation::FactorCell& cell = study.changed(factor, level);
  const std::string& name = study.levels[at(factor)][level];
  if (factor == evaluation::Factor::kOutliers)
    return fmt::format("  {}, {} left out", name, cell.left_out);
  if (factor == evaluation::Factor::kSampling) return fmt::format("  {} ({})", name, cell.points);
  return fmt::format("  {}", name);
}

/// Changes by one factor at a time, for each reference.
std::string changes_text(const evaluation::FactorStudy& study) {
  std::string out = head_text(study);
  out += row_text({study, study.reported}, "as reported");
  for (const evaluation::Factor factor :
       {evaluation::Factor::kFilter, evaluation::Factor::kOutliers,
        evaluation::Factor::kSampling}) {
    out += fmt::format("{}\n", name_of(factor));
    for (std::size_t level = 0; level < study.levels[at(factor)].size(); ++level) {
      if (level == study.reported[at(factor)]) continue;
      Combination combination = study.reported;
      combination[at(factor)] = level;
      out += row_text({study, combination}, label_of(study, factor, level));
    }
  }
  return out;
}

/// "4 references x 1 filter x 3 outlier rules x 7 samplings".
std::string block_text(const evaluation::FactorShares& shares) {
  return fmt::format("{} x {} x {} x {}", count(shares.used[0].size(), "reference", "references"),
                     count(shares.used[1].size(), "filter", "filters"),
                     count(shares.used[2].size(), "outlier rule", "outlier rules"),
                     count(shares.used[3].size(), "sampling", "samplings"));
}

std::string effects_text(const evaluation::FactorStudy& study) {
  std::string out = fmt::format("{:<{}}{:>9}{:>9}{:>9}{:>19}\n", "alone, others as reported",
                                kLabel, "least", "greatest", "range", "share of variance");
  for (const evaluation::Factor factor : evaluation::kFactors) {
    const evaluation::FactorEffect& effect = study.effects[at(factor)];
    const std::string share =
        study.shares && effect.levels > 1
            ? fmt::format("{:.1f} %", 100.0 * study.shares->share_1[at(factor)])
            : "-";
    fmt::format_to(std::back_inserter(out), "{:<{}}{:>9}{:>9}{:>9}{:>19}\n",
                   fmt::format("  {}", name_of(factor)), kLabel,
                   effect.levels < 2 ? "-" : signed_um(effect.least_change_mm),
                   effect.levels < 2 ? "-" : signed_um(effect.greatest_change_mm),
                   effect.levels < 2 ? "-" : um(effect.range_mm()), share);
  }
  if (!study.shares) return out + "No combination gives another value.\n";
  fmt::format_to(std::back_inserter(out), "{:<{}}{:>46}\n", "  several together", kLabel,
                 fmt::format("{:.1f} %", 100.0 * study.shares->together_1));
  return out +
         wrapped("", fmt::format("Shares: variance over {}, {} in all.", block_text(*study.shares),
                                 count(study.shares->values, "value", "values")));
}

/// Whether an earlier study of the run contains the same values.
bool shown_before(const evaluation::RunComparison& comparison,
                  const evaluation::FactorStudy& study) {
  for (const evaluation::FactorStudy& other : comparison.studies) {
    if (&other == &study) return false;
    if (other.feature == study.feature && other.characteristic.form == study.characteristic.form)
      return true;
  }
  return false;
}

/// Every combination that has a value, by filter and outlier rule.
std::string all_text(const evaluation::FactorStudy& study) {
  std::string out;
  for (std::size_t f = 0; f < study.levels[at(evaluation::Factor::kFilter)].size(); ++f) {
    for (std::size_t o = 0; o < study.levels[at(evaluation::Factor::kOutliers)].size(); ++o) {
      std::string rows;
      for (std::size_t s = 0; s < study.levels[at(evaluation::Factor::kSampling)].size(); ++s) {
        const CombinationRow row{study, {0, f, o, s}};
        if (!row.has_value()) continue;
        const std::string label = fmt::format(
            "  {} ({})", study.levels[at(evaluation::Factor::kSampling)][s], row.reported().points);
        rows += row_text(row, label);
      }
      if (rows.empty()) continue;
      out +=
          fmt::format("\n{}, outliers: {}\n{}{}", study.levels[at(evaluation::Factor::kFilter)][f],
                      study.levels[at(evaluation::Factor::kOutliers)][o], head_text(study), rows);
    }
  }
  return out;
}

}  // namespace

std::string comparison_text(const std::string& run_id, const evaluation::RunComparison& comparison,
                            bool all) {
  std::string out = wrapped("", fmt::format("Why do they differ? Run {}", run_id));
  for (const evaluation::FactorStudy& study : comparison.studies) {
    out += "\n";
    out += wrapped("", fmt::format("{} / {}", study.feature, study.characteristic.id));
    out += wrapped("", answer_of(study));
    out += wrapped("reported: ", study.operator_words) + "\n";
    const bool known = shown_before(comparison, study);
    if (known) {
      out +=
          wrapped("", fmt::format("The values are those of the table of {} above.", study.symbol));
    } else {
      out += changes_text(study);
    }
    out += fmt::format("\n{}", effects_text(study));
    if (all && !known) out += all_text(study);
  }
  if (!comparison.without.empty()) out += "\n";
  for (const core::Error& error : comparison.without)
    out += wrapped("not compared: ", fmt::format("{}: {}", error.where, error.what));
  return out;
}

}  // namespace rondure::reports
