#include "plans/schema/near_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string>

namespace rondure::plans {
namespace {

/// A word of a plan, and those of drawings, standards and other programs, without marks.
struct Synonyms {
  std::string_view meant;
  std::string_view said;
};

constexpr std::array kSynonyms = {Synonyms{"roundness", " circularity ovality "},
                                  Synonyms{"run-out", " circularrunout radialrunout axialrunout "},
                                  Synonyms{"perpendicularity", " squareness "},
                                  Synonyms{"flatness", " planarity evenness "},
                                  Synonyms{"taper", " conicity "},
                                  Synonyms{"outside", " outer external shaft "},
                                  Synonyms{"inside", " inner internal bore hole "},
                                  Synonyms{"cylinder", " shaft bore hole journal "},
                                  Synonyms{"plane", " face "},
                                  Synonyms{"sphere", " ball "},
                                  Synonyms{"ls", " leastsquares gaussian "},
                                  Synonyms{"mz", " minimumzone chebyshev "},
                                  Synonyms{"mc", " minimumcircumscribed "},
                                  Synonyms{"mi", " maximuminscribed "},
                                  Synonyms{"scan", " scanning "},
                                  Synonyms{"touch", " singlepoint "},
                                  Synonyms{"simulated", " offline "},
                                  Synonyms{"ippdme", " ipp "},
                                  Synonyms{"rectangular", " uniform "}};

/// Small letters and digits alone: "Least squares" is "least-squares".
std::string without_marks(std::string_view word) {
  std::string out;
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) out += static_cast<char>(std::tolower(byte));
  }
  return out;
}

bool alike(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

// Optimal string alignment distance, ignoring case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = alike(a[i - 1], b[j - 1]) ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && alike(a[i - 1], b[j - 2]) && alike(a[i - 2], b[j - 1])) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& known) {
  // Longer words are not typing errors, and the cost is quadratic.
  constexpr std::size_t kLongest = 64;
  if (word.empty() || word.size() > kLongest) return {};
  const std::string bare = " " + without_marks(word) + " ";
  for (const auto& [meant, said] : kSynonyms) {
    if (said.find(bare) != said.npos && std::ranges::find(known, meant) != known.end())
      return meant;
  }
  std::string_view best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    // The distance is at least that.
    if (longer - std::min(word.size(), candidate.size()) >= least) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace rondure::plans
