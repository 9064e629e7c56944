#include "plans/key_spec.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string>

namespace rondure::plans {
namespace {

struct Suffix {
  std::string_view text;
  std::string_view unit;
};

// Longest first, because "_um_m" ends in "_m". The units of hidden errors come first, then those of
// the plan; after "_um" follow units that no plan uses but that people write.
constexpr std::array kSuffixes = {
    Suffix{"_urad_m2", "urad/m^2"},
    Suffix{"_um_m2", "um/m^2"},
    Suffix{"_urad_m", "urad/m"},
    Suffix{"_um_m", "um/m"},
    Suffix{"_urad", "urad"},
    Suffix{"_per_K", "1/K"},
    Suffix{"_um_per_turn", "um/turn"},
    Suffix{"_ppm", "ppm"},
    Suffix{"_us", "us"},
    Suffix{"_percent", "%"},
    Suffix{"_GPa", "GPa"},
    Suffix{"_N", "N"},
    Suffix{"_per_deg_s2", "s^2/deg"},
    Suffix{"_per_deg_s", "s/deg"},
    Suffix{"_deg_s2", "deg/s^2"},
    Suffix{"_deg_s", "deg/s"},
    Suffix{"_mm_s", "mm/s"},
    Suffix{"_degC", "degC"},
    Suffix{"_deg", "deg"},
    Suffix{"_mm", "mm"},
    Suffix{"_um", "um"},
    Suffix{"_arcsec", "arcsec"},
    Suffix{"_arcmin", "arcmin"},
    Suffix{"_inches", "in"},
    Suffix{"_inch", "in"},
    Suffix{"_mm_min", "mm/min"},
    Suffix{"_m_s", "m/s"},
    Suffix{"_mrad", "mrad"},
    Suffix{"_degF", "degF"},
    Suffix{"_rad", "rad"},
    Suffix{"_mic", "um"},
    Suffix{"_nm", "nm"},
    Suffix{"_cm", "cm"},
    Suffix{"_in", "in"},
    Suffix{"_C", "degC"},
    Suffix{"_F", "degF"},
    Suffix{"_K", "K"},
    Suffix{"_m", "m"},
    Suffix{"_s", "s"},
};

}  // namespace

std::string_view unit_of(std::string_view key) {
  for (const Suffix& suffix : kSuffixes) {
    if (key.ends_with(suffix.text)) return suffix.unit;
  }
  return {};
}

std::string_view stem_of(std::string_view key) {
  for (const Suffix& suffix : kSuffixes) {
    if (key.ends_with(suffix.text)) return key.substr(0, key.size() - suffix.text.size());
  }
  return key;
}

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
