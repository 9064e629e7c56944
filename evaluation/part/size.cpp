#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/units.h"
#include "evaluation/part/internal/asked_sections.h"
#include "evaluation/part/internal/associated.h"
#include "evaluation/part/internal/families.h"
#include "fit/profiles/harmonics.h"
#include "fit/sizes/sizes.h"

namespace rondure::evaluation {
namespace {

using Indication = record::Indication;
using Size = Indication::Size;
using Rank = Indication::Rank;

/// A size of one section, or the greatest and the least of its local sizes.
struct SectionSize {
  SurfaceSection of;
  double greatest_mm = 0.0;
  double least_mm = 0.0;
  std::vector<std::size_t> greatest_rows;  // points of the surface that carry it
  std::vector<std::size_t> least_rows;
};

/// Two-point sizes with the points of the surface that they were taken from, if any.
struct LocalSizeSet {
  std::vector<fit::LocalSize> sizes;  // first, second: points of the surface
  bool of_points = true;              // false: of the harmonic series between them
  std::size_t lost = 0;
  /// A section that lost more than half of its pairs, no window being the cause.
  std::optional<core::Phrase> too_few;
};

bool is_filtered(const Indication& indication) {
  return indication.filter.value_or(Indication::Filter::kNone) != Indication::Filter::kNone;
}

record::Reference reference_of_size(Size size) {
  switch (size) {
    case Size::kGN:
      return record::Reference::kMinimumCircumscribed;
    case Size::kGX:
      return record::Reference::kMaximumInscribed;
    case Size::kGC:
      return record::Reference::kMinimumZone;
    default:
      return record::Reference::kLeastSquares;
  }
}

/// The envelope size: exact for any tip (drawing, 2.2). The others are of the surface as it is
/// felt.
Size mating_size(const PreparedSurface& surface) {
  return surface.material.inside ? Size::kGX : Size::kGN;
}

core::Phrase size_words(const PreparedSurface& surface, Size size, const std::string& name) {
  const core::Phrase symbol = core::as_it_is(name);
  return size == mating_size(surface) ? symbol : core::phrase("{}, as felt by the tip", symbol);
}

std::string symbol_of_size(std::string_view size) { return "d " + std::string(size); }

/// The greatest against the upper limit, the least against the lower. A side without a limit is
/// left out if the other has one.
void judge_extremes(const record::Characteristic& asked, JudgedValue greatest, JudgedValue least,
                    Finding& out) {
  greatest.limits = {.lower_mm = {}, .upper_mm = asked.tolerance_mm};
  least.limits = {.lower_mm = asked.lower_mm, .upper_mm = {}};
  if (asked.tolerance_mm || !asked.lower_mm) out.judged.push_back(std::move(greatest));
  if (asked.lower_mm || !asked.tolerance_mm) out.judged.push_back(std::move(least));
}

/// How far a section is from conforming: above 0 where it does not. Without limits the greatest is
/// the worst.
double excess_mm(const record::Characteristic& asked, const SectionSize& section) {
  if (!asked.toleranced()) return section.greatest_mm;
  double excess = -HUGE_VAL;
  if (asked.tolerance_mm) excess = std::max(excess, section.greatest_mm - *asked.tolerance_mm);
  if (asked.lower_mm) excess = std::max(excess, *asked.lower_mm - section.least_mm);
  return excess;
}

/// Every section against both limits; all are listed.
void judge_sections(const PreparedSurface& surface, const record::Characteristic& asked,
                    const std::string& greatest_symbol, const std::string& least_symbol,
                    const std::vector<SectionSize>& sections, Finding& out) {
  const auto highest = std::ranges::max_element(sections, {}, &SectionSize::greatest_mm);
  const auto lowest = std::ranges::min_element(sections, {}, &SectionSize::least_mm);
  const auto worst = std::ranges::max_element(
      sections, {}, [&](const SectionSize& section) { return excess_mm(asked, section); });
  out.worst = static_cast<std::size_t>(worst - sections.begin());
  judge_extremes(asked, {greatest_symbol, highest->greatest_mm, {}},
                 {least_symbol, lowest->least_mm, {}}, out);
  for (const SectionSize& section : sections) {
    LocalValue value{.layer = section.of.layer,
                     .position = section.of.height_mm,
                     .value_mm = section.greatest_mm};
    if (greatest_symbol != least_symbol) value.least_mm = section.least_mm;
    out.local.push_back(std::move(value));
  }
  add_rows(surface, highest->greatest_rows, out);
  if (lowest->least_rows != highest->greatest_rows) add_rows(surface, lowest->least_rows, out);
}

bool fails_as_read(const Finding& finding) {
  return std::ranges::any_of(finding.judged, [](const JudgedValue& v) {
    return (v.limits.upper_mm && v.value_mm > *v.limits.upper_mm) ||
           (v.limits.lower_mm && v.value_mm < *v.limits.lower_mm);
  });
}

/// What no point and no window names of the turn: a size could be anything there. It can only add
/// to a size that fails as read.
/// @param only_worsens  More points move the judged sizes towards their limits.
void note_unseen(const std::optional<core::Phrase>& unseen, bool only_worsens, Finding& out) {
  if (!unseen || (only_worsens && fails_as_read(out))) return;
  out.no_verdict = unseen;
}

void note_uncertified(bool certified, std::string_view size, Finding& out) {
  if (!certified) out.no_verdict = core::phrase("no certificate stands behind the size {}", size);
}

bool is_circle(const PreparedSurface& surface) {
  return surface.of->feature.shape == record::Shape::kCircle;
}

core::Result<Associated> size_of_section(const PreparedSurface& surface,
                                         const SurfaceSection& section, Size size, Proof proof) {
  TRY(auto flat, projected(surface, std::span(&section, 1)));
  auto circle = associated_circle(flat.front().points_mm, reference_of_size(size), proof);
  if (!circle) return core::fail(in_layer(section, circle.error()));
  for (std::size_t& contact : circle->contacts) contact = section.points[contact];
  return circle;
}

/// GG, GX, GN, GC of the whole feature: of its cylinder or sphere, or of the circle of its one
/// section.
core::Result<Associated> whole_size(const PreparedSurface& surface, Size size, Proof proof) {
  if (surface.of->feature.shape == record::Shape::kSphere) {
    return associated_sphere(surface.points_mm, reference_of_size(size));
  }
  if (!is_circle(surface)) return associated_cylinder(surface, reference_of_size(size), proof);
  TRY(const auto sections, asked_sections(surface, {}));
  return size_of_section(surface, sections.front(), size, proof);
}

core::Result<Finding> find_global(const PreparedSurface& surface,
                                  const record::Characteristic& asked, Proof proof) {
  const Size size = asked.indication.size;
  const auto name = std::string(record::name_of(size));
  Finding out;
  out.reference = of_sections(size_words(surface, size, name), asked.indication);
  bool certified = true;
  std::optional<core::Phrase> unseen;
  if (asked.indication.section == Indication::Section::kAll) {
    TRY(const auto whole, whole_size(surface, size, proof));
    out.judged.push_back(
        {symbol_of_size(name), surface.material.diameter_mm(whole.radius_mm), limits_of(asked)});
    add_rows(surface, whole.contacts, out);
    certified = whole.certified;
    out.pivots = whole.pivots;
    unseen = unseen_part(surface);
  } else {
    TRY(const auto sections, asked_sections(surface, asked.indication));
    std::vector<SectionSize> sizes;
    for (const SurfaceSection& section : sections) {
      TRY(const auto circle, size_of_section(surface, section, size, proof));
      const double diameter_mm = surface.material.diameter_mm(circle.radius_mm);
      sizes.push_back({section, diameter_mm, diameter_mm, circle.contacts, circle.contacts});
      certified = certified && circle.certified;
    }
    judge_sections(surface, asked, symbol_of_size(name), symbol_of_size(name), sizes, out);
    unseen = unseen_part(surface, sections, surface.axis);
  }
  if (proof == Proof::kNone) return out;
  note_uncertified(certified, name, out);
  note_unseen(unseen, false, out);
  return out;
}

/// The sizes of a filtered profile: of opposite samples, or of its harmonic series where the
/// samples are not opposite or not uniform.
core::Result<std::vector<fit::LocalSize>> profile_sizes(const fit::ResampledProfile& profile,
                                                        const fit::Material& material) {
  constexpr std::size_t kSeries = 3600;
  if (!profile.interpolated && profile.profile.r_mm.size() % 2 == 0) {
    return fit::two_point_sizes(profile.profile, material);
  }
  const auto highest = static_cast<int>((profile.profile.r_mm.size() - 1) / 2);
  TRY(const auto table,
      fit::harmonics(profile.profile, {.highest = highest, .override_sampling = true}));
  return fit::two_point_sizes(fit::profile_of(table, kSeries), material);
}

core::Error no_pairs(const PreparedSurface& surface, const SurfaceSection& section) {
  const int layer = section.layer + 1;
  const bool window = !window_rows(surface, section).empty();
  const auto planned = static_cast<std::size_t>(surface.of->feature.points_per_layer);
  const std::size_t count = std::max(planned, section.points.size());
  if (window && count % 2 == 0) {
    return core::error_of(core::Code::kSampling,
                          core::phrase("the windows leave no opposite points in layer {}; turn "
                                       "sampling.start_deg, or plan more points",
                                       layer));
  }
  if (count % 2 == 1) {
    return core::error_of(core::Code::kSampling,
                          core::phrase("{} points a layer have no opposite ones; plan an even "
                                       "number, or a scan",
                                       count));
  }
  return core::error_of(core::Code::kSampling,
                        core::phrase("layer {} has no two points opposite each other to 0.5 deg; "
                                     "plan an even number of points at equal angles, or a scan",
                                     layer));
}

/// Adds the two-point sizes of a section, of each pass for itself.
core::Result<void> add_local_sizes(const PreparedSurface& surface, const SurfaceSection& section,
                                   bool filtered, LocalSizeSet& out) {
  const std::size_t before = out.sizes.size();
  const std::size_t in_windows = window_rows(surface, section).size();
  for (const SurfaceSection& pass : by_pass(surface, section)) {
    TRY(auto flat, projected(surface, std::span(&pass, 1)));
    if (filtered && section.dense && !section.gap) {
      const auto profile = section_profile(flat.front());
      if (!profile) return core::fail(in_layer(section, profile.error()));
      const auto sizes = profile_sizes(*profile, surface.material);
      if (!sizes) return core::fail(in_layer(section, sizes.error()));
      out.sizes.insert(out.sizes.end(), sizes->begin(), sizes->end());
      out.of_points = false;
      continue;
    }
    const auto sizes = fit::two_point_sizes(flat, surface.material);
    const std::size_t found = sizes ? sizes->size() : 0;
    if (!sizes && sizes.error().code != core::Code::kSampling) {
      return core::fail(in_layer(section, sizes.error()));
    }
    const auto planned = static_cast<std::size_t>(surface.of->feature.points_per_layer);
    const std::size_t possible = std::max(planned, pass.points.size()) / 2;
    const std::size_t lost = possible > found ? possible - found : 0;
    out.lost += lost;
    if (2 * lost > possible + 2 * in_windows) {
      out.too_few = core::phrase(
          "layer {} has {} of {} opposite pairs: the size is not known between them; plan an even "
          "number of points at equal angles, or a scan",
          section.layer + 1, found, possible);
    }
    for (std::size_t i = 0; i < found; ++i) {
      fit::LocalSize size = (*sizes)[i];
      size.first = pass.points[size.first];
      size.second = pass.points[size.second];
      out.sizes.push_back(size);
    }
  }
  if (out.sizes.size() > before) return {};
  return core::fail(no_pairs(surface, section));
}

/// @param filtered  The points are those of a filtered profile.
core::Result<LocalSizeSet> local_sizes(const PreparedSurface& surface,
                                       std::span<const SurfaceSection> sections, bool filtered) {
  LocalSizeSet out;
  for (const SurfaceSection& section : sections) {
    TRY_DO(add_local_sizes(surface, section, filtered, out));
  }
  return out;
}

/// The ranks by name, in the order of the words.
std::array<NamedNumber, 7> ranks_by_name(const fit::RankSizes& ranks) {
  return {{{"SX", ranks.sx_mm},
           {"SN", ranks.sn_mm},
           {"SA", ranks.sa_mm},
           {"SM", ranks.sm_mm},
           {"SD", ranks.sd_mm},
           {"SR", ranks.sr_mm},
           {"SQ", ranks.sq_mm}}};
}

double value_of_rank(const fit::RankSizes& ranks, Rank rank) {
  return ranks_by_name(ranks)[static_cast<std::size_t>(rank)].value;
}

/// The pairs that are there, those that are not; too few of them can only hide a size that fails.
void add_rank_numbers(const LocalSizeSet& set, bool only_worsens, Finding& out) {
  if (set.lost > 0) {
    out.warnings.push_back(core::error_of(
        core::Code::kSampling,
        core::phrase("{} pairs of opposite points, {} lost: a point of theirs is missing",
                     set.sizes.size(), set.lost)));
  }
  if (set.too_few && !(only_worsens && fails_as_read(out))) out.no_verdict = set.too_few;
  for (const NamedNumber& number : ranks_by_name(fit::rank_sizes(set.sizes)))
    out.numbers.push_back(number);
  out.numbers.push_back({"pairs", static_cast<double>(set.sizes.size()), false});
  out.numbers.push_back({"lost pairs", static_cast<double>(set.lost), false});
}

std::vector<std::size_t> pair_of(const LocalSizeSet& set, bool greatest) {
  if (!set.of_points) return {};
  const auto [least, most] = std::ranges::minmax_element(set.sizes, {}, &fit::LocalSize::size_mm);
  const fit::LocalSize& size = greatest ? *most : *least;
  return {size.first, size.second};
}

/// Rows of the pair that gives a rank; SX without one.
std::vector<std::size_t> rank_rows(const LocalSizeSet& set, std::optional<Rank> rank,
                                   bool greatest) {
  if (!rank) return pair_of(set, greatest);
  if (*rank == Rank::kSX || *rank == Rank::kSN) return pair_of(set, *rank == Rank::kSX);
  return {};
}

core::Result<Finding> find_local(const PreparedSurface& surface,
                                 const record::Characteristic& asked, Proof proof) {
  const Indication& indication = asked.indication;
  TRY(const auto sections, asked_sections(surface, indication));
  TRY(const auto whole, local_sizes(surface, sections, is_filtered(indication)));
  const auto symbol = [&](Rank rank) {
    return "LP " + std::string(record::name_of(indication.rank.value_or(rank)));
  };
  Finding out;
  const std::string name = indication.rank ? symbol(*indication.rank) : "LP";
  out.reference = of_sections(size_words(surface, Size::kLP, name), indication);
  const std::string greatest_symbol = symbol_of_size(symbol(Rank::kSX));
  const std::string least_symbol = symbol_of_size(symbol(Rank::kSN));
  if (indication.section == Indication::Section::kACS) {
    std::vector<SectionSize> sizes;
    for (const SurfaceSection& section : sections) {
      TRY(const auto own, local_sizes(surface, std::span(&section, 1), is_filtered(indication)));
      const fit::RankSizes ranks = fit::rank_sizes(own.sizes);
      sizes.push_back({section, value_of_rank(ranks, indication.rank.value_or(Rank::kSX)),
                       value_of_rank(ranks, indication.rank.value_or(Rank::kSN)),
                       rank_rows(own, indication.rank, true),
                       rank_rows(own, indication.rank, false)});
    }
    judge_sections(surface, asked, greatest_symbol, least_symbol, sizes, out);
  } else {
    const fit::RankSizes ranks = fit::rank_sizes(whole.sizes);
    if (indication.rank) {
      out.judged.push_back(
          {greatest_symbol, value_of_rank(ranks, *indication.rank), limits_of(asked)});
      add_rows(surface, rank_rows(whole, indication.rank, true), out);
    } else {
      judge_extremes(asked, {greatest_symbol, ranks.sx_mm, {}}, {least_symbol, ranks.sn_mm, {}},
                     out);
      if (asked.tolerance_mm || !asked.lower_mm) add_rows(surface, pair_of(whole, true), out);
      if (asked.lower_mm || !asked.tolerance_mm) add_rows(surface, pair_of(whole, false), out);
    }
  }
  const bool only_worsens = !indication.rank;
  add_rank_numbers(whole, only_worsens, out);
  if (proof == Proof::kFull) {
    note_unseen(unseen_part(surface, sections, surface.axis), only_worsens, out);
  }
  return out;
}

/// Two results, one verdict. A mating size that fails as read stands whatever the two-point sizes
/// are; where it holds and they are not known, the finding is their error.
core::Result<Finding> find_envelope(const PreparedSurface& surface,
                                    const record::Characteristic& asked, Proof proof) {
  const Size size = mating_size(surface);
  const bool inside = surface.material.inside;
  const auto name = std::string(record::name_of(size));
  TRY(const auto mating, whole_size(surface, size, proof));
  Finding out;
  out.reference = core::phrase("envelope: {} and two-point sizes as felt by the tip", name);
  const double mating_mm = surface.material.diameter_mm(mating.radius_mm);
  out.pivots = mating.pivots;
  const Limits upper{.lower_mm = {}, .upper_mm = asked.tolerance_mm};
  const Limits lower{.lower_mm = asked.lower_mm, .upper_mm = {}};
  out.judged.push_back({symbol_of_size(name), mating_mm, inside ? lower : upper});
  add_rows(surface, mating.contacts, out);
  const auto sections = asked_sections(surface, {});
  const auto local = sections ? local_sizes(surface, *sections, is_filtered(asked.indication))
                              : core::Result<LocalSizeSet>(core::fail(sections.error()));
  const std::optional<double>& limit = inside ? asked.lower_mm : asked.tolerance_mm;
  // Written so that a number that is none holds, and needs the other side.
  const bool fails = limit && (inside ? mating_mm < *limit : mating_mm > *limit);
  if (local) {
    const fit::RankSizes ranks = fit::rank_sizes(local->sizes);
    out.judged.push_back({symbol_of_size(inside ? "LP SX" : "LP SN"),
                          inside ? ranks.sx_mm : ranks.sn_mm, inside ? upper : lower});
    add_rows(surface, pair_of(*local, inside), out);
    add_rank_numbers(*local, true, out);
  } else if (!fails && proof == Proof::kFull) {
    return core::fail(local.error());
  }
  if (proof == Proof::kNone) return out;
  note_uncertified(mating.certified, name, out);
  note_unseen(unseen_part(surface), true, out);
  return out;
}

/// Whether every section carries a calculated size.
core::Result<void> check_calculated(const PreparedSurface& surface, const Sections& sections,
                                    const Indication& indication) {
  const auto name = record::name_of(indication.size);
  if (!is_filtered(indication)) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("size {} grows with every wave that is let in: give filter and "
                                   "cutoff_upr",
                                   name));
  }
  const double upr = indication.cutoff_upr.value_or(0.0);
  for (const SurfaceSection& section : sections) {
    const double open = unseen_in(surface, section);
    if (section.gap || open > 0.0) {
      TRY(const auto flat, projected(surface, std::span(&section, 1)));
      const double gap_rad =
          fit::largest_gap_rad(flat.front().points_mm, flat.front().circle.center_mm);
      return core::fail(
          core::Code::kSampling,
          core::phrase("size {} bridges no gap: layer {} has {:.1f} deg left out; ask for size GG",
                       name, section.layer + 1, core::degrees(gap_rad)));
    }
    if (!section.dense) {
      return core::fail(
          core::Code::kSampling,
          core::phrase("size {} needs a dense section: {} points a layer are there, {:.0f} are "
                       "needed for {:g} UPR; scan, or ask for size GG",
                       name, section.points.size(), std::ceil(7.0 * upr), upr));
    }
  }
  return {};
}

core::Result<fit::CalculatedSizes> calculated_of(const PreparedSurface& surface,
                                                 const SurfaceSection& section) {
  // Of the first pass: neighbouring points of two passes differ by their noise.
  const SurfaceSection pass = by_pass(surface, section).front();
  TRY(const auto flat, projected(surface, std::span(&pass, 1)));
  const auto profile = section_profile(flat.front());
  if (!profile) return core::fail(in_layer(section, profile.error()));
  const auto sizes = fit::calculated_sizes(profile->profile, surface.material);
  if (!sizes) return core::fail(in_layer(section, sizes.error()));
  return sizes;
}

/// CC, CA of the sections, each against both limits; CV of the volume between them.
core::Result<Finding> find_calculated(const PreparedSurface& surface,
                                      const record::Characteristic& asked) {
  const Indication& indication = asked.indication;
  const auto name = std::string(record::name_of(indication.size));
  const bool volume = indication.size == Size::kCV;
  if (volume && indication.section != Indication::Section::kAll) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("size CV is of the volume between the sections; ask for "
                                   "section \"all\", or for size CA"));
  }
  TRY(const auto sections, asked_sections(surface, indication));
  TRY_DO(check_calculated(surface, sections, indication));
  Finding out;
  out.reference = of_sections(size_words(surface, indication.size, name), indication);
  std::vector<SectionSize> sizes;
  std::vector<std::pair<double, double>> areas;  // height, area
  for (const SurfaceSection& section : sections) {
    TRY(const auto size, calculated_of(surface, section));
    const double diameter_mm = indication.size == Size::kCC ? size.cc_mm : size.ca_mm;
    sizes.push_back({section, diameter_mm, diameter_mm, {}, {}});
    areas.emplace_back(section.height_mm, size.area_mm2);
  }
  if (!volume) {
    judge_sections(surface, asked, symbol_of_size(name), symbol_of_size(name), sizes, out);
    return out;
  }
  if (areas.size() < 2) {
    return core::fail(core::Code::kRank,
                      core::phrase("{} section bounds no volume: plan at least 2 layers, or ask "
                                   "for size CA",
                                   areas.size()));
  }
  std::ranges::sort(areas);
  std::vector<double> heights_mm;
  std::vector<double> areas_mm2;
  for (const auto& [height_mm, area_mm2] : areas) {
    heights_mm.push_back(height_mm);
    areas_mm2.push_back(area_mm2);
  }
  TRY(const auto size, fit::volume_size_mm(heights_mm, areas_mm2));
  out.judged.push_back({symbol_of_size(name), size, limits_of(asked)});
  return out;
}

core::Result<void> check_asked_size(const PreparedSurface& surface, const Indication& indication) {
  const bool envelope = indication.requirement == Indication::Requirement::kEnvelope;
  if (!surface.tip_known) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("the tip radius is not known: give source.tip_diameter_mm; a "
                                   "size needs it"));
  }
  if (indication.size == Size::kLS) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("spherical size needs an areal cloud, points all round each "
                                   "centre; ask for size LP or GX"));
  }
  if (indication.rank && (indication.size != Size::kLP || envelope)) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("rank {} is of two-point sizes; leave rank out, or ask for size "
                                   "LP without a requirement",
                                   record::name_of(*indication.rank)));
  }
  if (envelope &&
      (indication.size != Size::kLP || indication.section != Indication::Section::kAll)) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("the envelope requirement is of the whole feature, and has its "
                                   "own sizes; leave size and section out"));
  }
  return fit::check_material(surface.material);
}

}  // namespace

core::Result<Finding> find_size(const PreparedSurface& surface, const record::Characteristic& asked,
                                Proof proof) {
  TRY_DO(check_asked_size(surface, asked.indication));
  if (asked.indication.requirement == Indication::Requirement::kEnvelope) {
    return find_envelope(surface, asked, proof);
  }
  switch (asked.indication.size) {
    case Size::kLP:
      return find_local(surface, asked, proof);
    case Size::kCC:
    case Size::kCA:
    case Size::kCV:
      return find_calculated(surface, asked);
    default:
      return find_global(surface, asked, proof);
  }
}

}  // namespace rondure::evaluation
