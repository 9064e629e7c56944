#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <cstddef>

namespace rondure::fuzz {

std::string Mutation::input(unsigned seed) const {
  std::mt19937 random(seed);
  const auto below = [&random](std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>(random()) % limit;
  };
  const auto pick = [&below](const std::vector<std::string>& from) -> const std::string& {
    return from[below(from.size())];
  };
  std::string text = pick(corpus_);
  for (std::size_t left = 1 + below(6); left > 0; --left) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(below(12), text.size() - at);
    switch (random() % 7) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random() % 256);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.insert(at, pick(words_));
        break;
      case 4:
        text.replace(at, length, pick(words_));
        break;
      case 5: {
        const std::string& other = pick(corpus_);
        text.insert(at, other.substr(below(other.size()), below(80)));
        break;
      }
      default:
        text.insert(at, 1 + below(40), static_cast<char>(32 + random() % 95));
        break;
    }
  }
  return text;
}

}  // namespace rondure::fuzz
