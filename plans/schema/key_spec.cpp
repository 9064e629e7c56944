#include "plans/schema/key_spec.h"

#include <array>

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

}  // namespace rondure::plans
