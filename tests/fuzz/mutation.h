#pragma once

#include <random>
#include <string>
#include <vector>

namespace rondure::fuzz {

/// Makes damaged inputs out of good ones: bytes changed, removed, doubled, words and lines of one
/// input put into another. The same seed gives the same input.
class Mutation {
 public:
  /// @param words  Inserted as a whole, e.g. names and numbers of the protocol.
  Mutation(std::vector<std::string> corpus, std::vector<std::string> words)
      : corpus_(std::move(corpus)), words_(std::move(words)) {}

  [[nodiscard]] std::string input(unsigned seed) const;

 private:
  std::vector<std::string> corpus_;
  std::vector<std::string> words_;
};

/// Makes damaged but readable tables out of good ones: rows removed, doubled and sorted, columns
/// made equal, scaled and moved, single numbers of any size. The same seed gives the same table.
class TableMutation {
 public:
  /// @param tables  CSV: a header line, then rows of numbers and words.
  explicit TableMutation(std::vector<std::string> tables) : tables_(std::move(tables)) {}

  [[nodiscard]] std::string input(unsigned seed) const;

 private:
  std::vector<std::string> tables_;
};

/// A byte that follows from the seed.
[[nodiscard]] inline unsigned choice_of(unsigned seed) { return std::mt19937(~seed)() % 256; }

}  // namespace rondure::fuzz
