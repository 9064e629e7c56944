// Damaged data files, through the readers and the analyses that go with them to the answer.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fuzz/cases.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/verb_entries.h"

namespace rondure::fuzz {
namespace {

/// Three of four cases are tables that can be read; the first byte is any.
void try_door(const Counts& counts, const std::vector<std::string>& tables,
              std::string (*entry)(std::string_view)) {
  const TableMutation rows(tables);
  const Mutation bytes(tables, table_words());
  try_cases(counts, [&](unsigned seed) {
    const auto choice = static_cast<char>(choice_of(seed));
    return entry(choice + (seed % 4 == 3 ? bytes.input(seed) : rows.input(seed)));
  });
}

TEST(VerbFuzz, NoDamagedPointsUpsetAFit) { try_door({40, 3'000}, point_tables(), try_fit); }

TEST(VerbFuzz, NoDamagedBallsUpsetTheRotaryAxes) {
  try_door({300, 30'000}, ball_tables(), try_rotary_axes);
}

TEST(VerbFuzz, NoDamagedProfileUpsetsRoundness) {
  try_door({300, 30'000}, roundness_tables(), try_roundness);
}

}  // namespace
}  // namespace rondure::fuzz
