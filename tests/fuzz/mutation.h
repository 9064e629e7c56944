#pragma once

#include <random>
#include <string>
#include <vector>

namespace rondure::fuzz {

/// Makes damaged inputs out of good ones: bytes changed, taken out, doubled, words and lines of one
/// put into another. The same seed gives the same input.
class Mutation {
 public:
  /// @param words  Put in whole, e.g. names and numbers of the protocol.
  Mutation(std::vector<std::string> corpus, std::vector<std::string> words)
      : corpus_(std::move(corpus)), words_(std::move(words)) {}

  [[nodiscard]] std::string input(unsigned seed) const;

 private:
  std::vector<std::string> corpus_;
  std::vector<std::string> words_;
};

}  // namespace rondure::fuzz
