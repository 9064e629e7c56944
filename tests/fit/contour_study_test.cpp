#include "core/statistics.h"
#include "fit/contour/study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/core/processor_time.h"
#include "tests/fit/contour_cases.h"

namespace rondure::fit {
namespace {

using core::kDegree;
using core::kMicrometre;

constexpr std::size_t kPoints = 1440;

std::vector<double> sum(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) out += std::pow(a[i] - b[i], 2);
  return std::sqrt(out / static_cast<double>(a.size()));
}

GaugeRows rows_of(const std::vector<double>& deviation_mm) {
  GaugeRows out;
  for (std::size_t m = 0; m < deviation_mm.size(); ++m) {
    out.angle_rad.push_back(test::turn_angle(m, deviation_mm.size()));
  }
  out.deviation_mm = deviation_mm;
  return out;
}

/// The four parts of section 10; their totals are filtered already.
std::vector<ContourPart> spec_parts() {
  std::vector<ContourPart> out;
  for (std::size_t i = 0; i < 4; ++i) {
    ContourPart part;
    part.trace = test::spec_trace(300, 1.0, 0.0, test::kSpecCScale[i]);
    const auto following = test::spec_following(test::kSpecCScale[i]).error_mm;
    part.pin = rows_of(sum(following, test::spec_rest(i)));
    out.push_back(part);
  }
  return out;
}

ContourStudyOptions spec_options() {
  ContourStudyOptions out;
  out.prefiltered = true;
  out.axes.samples = 300;   // the samples themselves
  out.refine_path = false;  // as the specification's prototype did
  return out;
}

TEST(ContourError, GivesFOfTheWorkedExample) {
  const auto f = test::spec_following();
  EXPECT_NEAR((f.base_radius_mm - 24.56) / kMicrometre, 0.397361, 5e-7);
  EXPECT_NEAR(f.base_center_mm.x() / kMicrometre, -0.091977, 5e-7);
  EXPECT_NEAR(f.base_center_mm.y() / kMicrometre, 0.642873, 5e-7);
  EXPECT_NEAR(f.peak_to_valley_mm / kMicrometre, 7.043050, 5e-7);
  EXPECT_NEAR(f.rms_mm / kMicrometre, 2.015809, 1e-6);  // printed cut off, not rounded
  EXPECT_NEAR(*std::max_element(f.error_mm.begin(), f.error_mm.end()) / kMicrometre, 3.401843,
              5e-7);
  EXPECT_NEAR(*std::min_element(f.error_mm.begin(), f.error_mm.end()) / kMicrometre, -3.641206,
              5e-7);
  EXPECT_NEAR(f.crest_rad() / kDegree, 223.5, 1e-9);
  EXPECT_NEAR(f.valley_rad() / kDegree, 284.5, 1e-9);
  const double at_30[] = {3.25383, 1.59038, -2.30610, -0.41619, -0.64758, -1.06981,
                          0.67191, 2.96206, 0.30113,  -3.19147, -1.87625, 0.28573};
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(f.error_mm[120 * i] / kMicrometre, at_30[i], 5e-6) << 30 * i;
  }
}

TEST(ContourError, GivesTheHarmonicsOfTheWorkedExample) {
  struct Row {
    int number;
    double amplitude_um, phase_deg;
  };
  const auto found = contour_harmonics(test::spec_following().error_mm, 50);
  for (const Row& row : {Row{2, 2.3373, 22.61}, Row{3, 1.3312, 310.31}, Row{4, 0.5200, 106.76},
                         Row{5, 0.5985, 79.91}, Row{6, 0.2249, 249.59}}) {
    SCOPED_TRACE(row.number);
    const Harmonic& h = found[static_cast<std::size_t>(row.number - 2)];
    ASSERT_EQ(h.number, row.number);
    EXPECT_NEAR(h.amplitude_mm / kMicrometre, row.amplitude_um, 5e-5);
    EXPECT_NEAR(std::remainder(h.phase_rad.value() / kDegree - row.phase_deg, 360.0), 0.0, 5e-3);
  }
}

TEST(ContourError, TakesAwayWhatTheSpecificationSays) {
  const CrankGeometry geometry;
  const auto error_of = [&](double c_deg, double x_um, double crank_off_mm) {
    AxisErrors errors = {std::vector<double>(300, c_deg * kDegree),
                         std::vector<double>(300, x_um * kMicrometre)};
    CrankGeometry control = geometry;
    control.crank_radius_mm += crank_off_mm;
    for (std::size_t i = 0; i < 300; ++i) {
      const double alpha = test::turn_angle(i, 300);
      errors.x_mm[i] += wheel_position_mm(control, alpha) - wheel_position_mm(geometry, alpha);
    }
    auto r = ground_contour(geometry, errors).value().r_mm;
    for (double& v : r) v -= geometry.pin_radius_mm;
    return contour_error(r, geometry.pin_radius_mm).value();
  };
  const auto phase = error_of(1e-3, 0.0, 0.0);
  EXPECT_NEAR(phase.base_center_mm.y() / kMicrometre, 0.855, 5e-4);
  EXPECT_LT(phase.peak_to_valley_mm, 4e-5 * kMicrometre);
  const auto level = error_of(0.0, 10.0, 0.0);
  EXPECT_NEAR((level.base_radius_mm - 24.56) / kMicrometre, 9.943, 5e-4);
  EXPECT_NEAR(contour_harmonics(level.error_mm, 2)[0].amplitude_mm / kMicrometre, 0.056, 5e-4);
  EXPECT_NEAR(level.peak_to_valley_mm / kMicrometre, 0.122, 5e-4);
  const auto crank = error_of(0.0, 0.0, 0.01);
  EXPECT_NEAR(crank.base_center_mm.norm() / kMicrometre, 10.0, 1e-3);
  EXPECT_NEAR(crank.peak_to_valley_mm / kMicrometre, 0.002, 5e-4);
}

TEST(ContourError, AGeometricCircleLeavesNothingOfAnEccentricOne) {
  std::vector<double> deviation(kPoints);
  const Eigen::Vector2d center(0.5, -0.2);
  for (std::size_t m = 0; m < kPoints; ++m) {
    const double angle = test::turn_angle(m, kPoints);
    const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
    const double along = center.dot(ray);
    deviation[m] = along + std::sqrt(24.0 * 24.0 - center.squaredNorm() + along * along) - 24.56;
  }
  ContourErrorOptions options;
  options.base = BaseCircle::kGeometric;
  const auto out = contour_error(deviation, 24.56, options).value();
  EXPECT_LT(out.peak_to_valley_mm, 1e-10 * kMicrometre + 1e-12);
  EXPECT_NEAR(out.base_radius_mm, 24.0, 1e-12);
  EXPECT_NEAR((out.base_center_mm - center).norm(), 0.0, 1e-12);
}

TEST(ContourStudy, GivesTheStabilityTableOfTheWorkedExample) {
  const auto study = contour_study(spec_parts(), spec_options()).value();
  struct Row {
    const char* name;
    const Repeatability* found;
    double pv[4], rms[4], a, s, index, mean, least, variation;
  };
  for (const Row& row : {Row{"t",
                             &*study.total,
                             {8.9290, 8.5189, 6.4567, 6.2871},
                             {2.5994, 2.3500, 1.7655, 1.6208},
                             1.9372,
                             1.0019,
                             0.7772,
                             0.7910,
                             0.5649,
                             0.1815},
                         Row{"f",
                             &*study.following,
                             {7.0430, 7.1535, 6.9326, 7.0872},
                             {2.0158, 2.0397, 1.9920, 2.0254},
                             2.0182,
                             0.0233,
                             0.9999,
                             1.0000,
                             0.9999,
                             0.0132},
                         Row{"n",
                             &*study.rest,
                             {3.3301, 2.6908, 2.5161, 3.9805},
                             {0.8185, 0.7211, 0.7106, 1.2166},
                             0.2071,
                             1.0006,
                             -0.2613,
                             -0.2014,
                             -0.7969,
                             0.2130}}) {
    SCOPED_TRACE(row.name);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(row.found->peak_to_valley[i] / kMicrometre, row.pv[i], 6e-5);
      EXPECT_NEAR(row.found->rms[i] / kMicrometre, row.rms[i], 6e-5);
    }
    EXPECT_NEAR(row.found->mean_rms / kMicrometre, row.a, 6e-5);
    EXPECT_NEAR(row.found->spread / kMicrometre, row.s, 6e-5);
    EXPECT_NEAR(row.found->index.value(), row.index, 6e-5);
    EXPECT_NEAR(row.found->mean_correlation, row.mean, 6e-5);
    EXPECT_NEAR(row.found->least_correlation, row.least, 6e-5);
    EXPECT_NEAR(row.found->variation, row.variation, 6e-5);
  }
  EXPECT_NEAR(study.amplitude_ratio, 2.2654, 6e-5);
  EXPECT_EQ(study.total->word(), StabilityWord::kPartly);
  EXPECT_EQ(study.following->word(), StabilityWord::kStable);
  EXPECT_EQ(study.rest->word(), StabilityWord::kUnstable);
}

TEST(ContourStudy, GivesTheEnergyBalanceOfTheWorkedExample) {
  const auto study = contour_study(spec_parts(), spec_options()).value();
  const double expected[4][5] = {{6.7571, 4.0635, 0.6700, 2.0236, 0.6132},
                                 {5.5223, 4.1605, 0.5200, 0.8418, 0.2862},
                                 {3.1169, 3.9680, 0.5050, -1.3561, -0.4790},
                                 {2.6269, 4.1021, 1.4800, -2.9552, -0.5997}};
  // The specification prints places of its search, 1/64 deg apart, before Newton.
  const double offsets_deg[4] = {-0.98, -3.78, 0.55, 0.67};
  constexpr double kPlace = 0.5 / 64.0 + 5e-3;
  for (std::size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    const ContourSeparation& found = study.parts[i].direct;
    EXPECT_NEAR(found.total_mm2 * 1e6, expected[i][0], 6e-5);
    EXPECT_NEAR(found.following_mm2 * 1e6, expected[i][1], 6e-5);
    EXPECT_NEAR(found.rest_mm2 * 1e6, expected[i][2], 6e-5);
    EXPECT_NEAR(found.cross_mm2 * 1e6, expected[i][3], 6e-5);
    EXPECT_NEAR(found.correlation, expected[i][4], 6e-5);
    EXPECT_EQ(found.enlarges(), i < 2);
    EXPECT_NEAR(study.parts[i].offset.angle_rad / kDegree, offsets_deg[i], kPlace);
  }
  EXPECT_NEAR(study.offset.angle_rad / kDegree, -1.02, kPlace);
}

TEST(ContourStudy, SeparatesPlantedPartsFromBareTraces) {
  // 4 ms samples at 50.3 r/min from anywhere, three turns; a gauge with an offset, turned round,
  // unfiltered, on a grid of its own.
  for (std::size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    const double start = 1.0 + 1.7 * static_cast<double>(i);
    ContourPart part;
    part.trace.emplace();
    for (std::size_t k = 0; k < 1000; ++k) {
      const double alpha = start + core::kTwoPi * static_cast<double>(k) * 0.004 * 50.3 / 60.0;
      part.trace->c_rad.push_back(std::fmod(alpha, core::kTwoPi));
      part.trace->c_error_rad.push_back(test::kSpecCScale[i] * test::spec_c_mdeg(alpha) * 1e-3 *
                                        kDegree);
      part.trace->x_error_mm.push_back(test::spec_x_um(alpha) * kMicrometre);
    }
    const double offset = 0.3 + static_cast<double>(i);
    const auto ground =
        ground_contour(CrankGeometry{}, test::spec_errors(4096, test::kSpecCScale[i]),
                       {.samples = 1000})
            .value();
    const auto rest = test::spec_rest(i, 1000);
    for (std::size_t m = 0; m < 1000; ++m) {
      part.pin.angle_rad.push_back(offset - test::turn_angle(m, 1000));
      part.pin.deviation_mm.push_back(ground.r_mm[m] + rest[m]);
    }
    ContourStudyOptions options;
    options.phase_offset_rad = offset;
    options.gauge_direction = -1;
    const auto out = contour_part(part, options).value();
    // What was planted, behind the filter of the method.
    const auto planted = contour_error(test::spec_rest(i), 24.56).value().error_mm;
    EXPECT_LT(rms_difference(out.direct.rest_mm, planted), 1e-3 * kMicrometre);
    EXPECT_LT(peak_to_valley(sum(out.direct.rest_mm,
                                 [&] {
                                   auto minus = planted;
                                   for (double& v : minus) v = -v;
                                   return minus;
                                 }())),
              0.02 * kMicrometre);
    EXPECT_LT(rms_difference(out.following.error_mm,
                             test::spec_following(test::kSpecCScale[i], 1440).error_mm),
              1e-3 * kMicrometre);
  }
}

TEST(ContourStudy, AMisalignmentLeaksAsMuchAsTheSpecificationSays) {
  const auto f = test::spec_following().error_mm;
  for (const auto& [deg, um] :
       {std::pair{0.1, 0.011}, std::pair{1.0, 0.11}, std::pair{3.0, 0.32}}) {
    EXPECT_NEAR(rms_difference(turned_curve(f, deg * kDegree), f) / kMicrometre, um, 0.06 * um);
  }
}

TEST(ContourStudy, AShiftedTimeBaseCostsAsMuchAsTheSpecificationSays) {
  const auto f = test::spec_following().error_mm;
  const auto shifted = [&](bool x, bool c) {
    auto errors = test::spec_errors();
    if (x) std::rotate(errors.x_mm.begin(), errors.x_mm.begin() + 1, errors.x_mm.end());
    if (c) std::rotate(errors.c_rad.begin(), errors.c_rad.begin() + 1, errors.c_rad.end());
    auto r = ground_contour(CrankGeometry{}, errors).value().r_mm;
    for (double& v : r) v -= 24.56;
    return rms_difference(contour_error(r, 24.56).value().error_mm, f) / kMicrometre;
  };
  EXPECT_NEAR(shifted(true, false), 0.11, 5e-3);
  EXPECT_NEAR(shifted(false, true), 0.03, 5e-3);
}

TEST(ContourStudy, NegatedErrorsNegateTheFollowingPart) {
  auto errors = test::spec_errors();
  for (double& c : errors.c_rad) c = -c;
  for (double& x : errors.x_mm) x = -x;
  auto r = ground_contour(CrankGeometry{}, errors).value().r_mm;
  for (double& v : r) v -= 24.56;
  const auto both = sum(contour_error(r, 24.56).value().error_mm, test::spec_following().error_mm);
  double worst = 0.0;
  for (const double v : both) worst = std::max(worst, std::abs(v));
  EXPECT_NEAR(worst / kMicrometre, 0.015, 1.5e-3);
}

TEST(ContourStudy, WarnsOfASwappedSignWithItsEvidence) {
  auto options = spec_options();
  options.axes.error_sign = -1;
  const auto study = contour_study(spec_parts(), options).value();
  EXPECT_LT(study.sense.as_given, -0.8);
  EXPECT_EQ(study.sense.negated_better, 3U);  // n of part 4 opposes f
  EXPECT_EQ(study.sense.mirrored_better, 0U);
  EXPECT_GT(study.sense.rms_difference_mm, 3.0 * study.sense.rms_sum_mm);
  const auto found =
      std::find_if(study.warnings.begin(), study.warnings.end(),
                   [](const core::Error& w) { return w.code == core::Code::kSense; });
  ASSERT_NE(found, study.warnings.end());
  EXPECT_NE(found->what.find("error_sign 1 rather than -1"), std::string::npos) << found->what;
}

TEST(ContourStudy, WarnsOfAMirroredSenseWithItsEvidence) {
  auto parts = spec_parts();
  for (ContourPart& part : parts) {
    auto& rows = part.pin.deviation_mm;
    std::reverse(rows.begin() + 1, rows.end());
  }
  const auto study = contour_study(parts, spec_options()).value();
  EXPECT_TRUE(study.sense.sense_suspect());
  EXPECT_EQ(study.sense.mirrored_better, 4U);
  EXPECT_LT(study.sense.rms_mirrored_mm, study.sense.rms_difference_mm);
  EXPECT_FALSE(contour_study(spec_parts(), spec_options()).value().sense.sense_suspect());
  auto options = spec_options();
  options.gauge_direction = -1;
  EXPECT_FALSE(contour_study(parts, options).value().sense.sense_suspect());
}

TEST(ContourStudy, ASlopeOfTOverFIsAGainOnlyWhereTheRestCannotMakeIt) {
  for (std::size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    const auto f = test::spec_following(test::kSpecCScale[i]).error_mm;
    const auto t = sum(f, test::spec_rest(i));
    const double slope[] = {1.249, 1.101, 0.829, 0.640};
    const auto found = gain_evidence({t, f}).value();
    EXPECT_NEAR(found.slope, slope[i], 1e-3);
    EXPECT_LT(std::abs(found.slope - 1.0), 3.0 * found.u);
    auto gained = f;
    for (double& v : gained) v *= 1.02;
    EXPECT_NEAR(gain_evidence({gained, f}).value().slope, 1.02, 1e-12);
    EXPECT_LT(gain_evidence({gained, f}).value().u, 1e-9);
  }
  const std::vector<double> zero(kPoints, 0.0);
  EXPECT_FALSE(gain_evidence({zero, zero}));
}

TEST(ContourStudy, AWrongCrankChangesFAsMuchAsTheSpecificationSays) {
  const auto f = test::spec_following();
  struct Row {
    double crank_mm, pv_um, rms_um;
  };
  for (const Row& row :
       {Row{45.0, 6.862, 0.061}, Row{40.0, 6.710, 0.136}, Row{56.0, 7.369, 0.109}}) {
    SCOPED_TRACE(row.crank_mm);
    auto r = ground_contour({row.crank_mm, 299.88, 24.56}, test::spec_errors()).value().r_mm;
    for (double& v : r) v -= 24.56;
    const auto wrong = contour_error(r, 24.56).value();
    EXPECT_NEAR(wrong.peak_to_valley_mm / kMicrometre, row.pv_um, 1e-3);
    EXPECT_NEAR(rms_difference(wrong.error_mm, f.error_mm) / kMicrometre, row.rms_um, 1e-3);
  }
}

/// Positions of X as an axis records them that grinds another crank, with another zero.
void add_positions(AxisTrace& trace, const CrankGeometry& geometry, double zero_rad) {
  for (const double c : trace.c_rad) {
    trace.x_mm.push_back(wheel_position_mm(geometry, c - zero_rad) + 12.0);
  }
}

TEST(ContourStudy, RefusesPositionsThatContradictCrankWheelOrZero) {
  struct Case {
    CrankGeometry geometry;
    double zero_deg;
    std::string named;
  };
  for (const Case& wrong : {Case{{45.0, 299.88, 24.56}, 0.0, "crank radius of 45.000 mm"},
                            Case{{49.0, 200.0, 24.56}, 0.0, "pin radii of 22"},
                            Case{{49.0, 299.88, 24.56}, 0.1, "C turned by 0.10 deg"}}) {
    SCOPED_TRACE(wrong.named);
    auto parts = spec_parts();
    for (ContourPart& part : parts) {
      add_positions(*part.trace, wrong.geometry, wrong.zero_deg * kDegree);
    }
    const auto refused = contour_study(parts, spec_options());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kInconsistent);
    EXPECT_EQ(refused.error().where, "parts/0/axes");
    EXPECT_NE(refused.error().what.find(wrong.named), std::string::npos) << refused.error().what;
  }
  auto parts = spec_parts();
  for (ContourPart& part : parts) add_positions(*part.trace, CrankGeometry{}, 0.0);
  EXPECT_TRUE(contour_study(parts, spec_options()));
}

TEST(ContourStudy, WithoutTracesTakesTheMainJournalForTheRest) {
  auto parts = spec_parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].trace.reset();
    parts[i].main = rows_of(test::spec_rest(i));
  }
  ContourStudyOptions options;
  options.prefiltered = true;
  const auto study = contour_study(parts, options).value();
  EXPECT_FALSE(study.traced());
  EXPECT_FALSE(study.c_error);
  ASSERT_TRUE(study.following);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto f = test::spec_following(test::kSpecCScale[i]).error_mm;
    for (std::size_t m = 0; m < f.size(); ++m) {
      ASSERT_NEAR(study.parts[i].following.error_mm[m], f[m], 1e-9) << i << " " << m;
      ASSERT_NEAR(study.parts[i].direct.rest_mm[m], test::spec_rest(i)[m], 1e-9) << i;
    }
  }
  options.method = ContourMethod::kAsPublished;
  EXPECT_EQ(contour_study(parts, options).error().code, core::Code::kBadOption);
  options.method = ContourMethod::kCorrected;
  parts[2].main.reset();
  EXPECT_EQ(contour_study(parts, options).error().code, core::Code::kNoPoints);
  EXPECT_EQ(contour_study(parts, options).error().where, "parts/2/main");
  parts = spec_parts();
  parts[3].trace.reset();
  EXPECT_EQ(contour_study(parts, options).error().code, core::Code::kNoPoints);
}

/// One pin whose axis errors and rest are random; the gauge stands `turned_rad` beside its zero.
ContourStudy random_pin(std::uint64_t seed, double rest_share, double turned_rad) {
  ContourPart part;
  part.trace.emplace();
  const auto errors = test::random_errors(seed, 1440);
  for (std::size_t i = 0; i < 1440; ++i) part.trace->c_rad.push_back(test::turn_angle(i, 1440));
  part.trace->c_error_rad = errors.c_rad;
  part.trace->x_error_mm = errors.x_mm;
  auto r = ground_contour(CrankGeometry{}, errors).value().r_mm;
  for (double& v : r) v -= 24.56;
  const auto following = contour_error(r, 24.56).value();
  core::KeyedNoise noise(seed, {48});
  std::vector<double> rest(kPoints);
  for (int k = 2; k < 8; ++k) {
    const double amplitude = noise.normal();
    const double phase = core::kTwoPi * noise.uniform();
    for (std::size_t m = 0; m < kPoints; ++m) {
      rest[m] += amplitude * std::cos(k * test::turn_angle(m, kPoints) - phase);
    }
  }
  const double scale = rest_share * following.rms_mm / core::root_mean_square(rest);
  for (double& v : rest) v *= scale;
  part.pin = rows_of(turned_curve(sum(following.error_mm, rest), turned_rad));
  ContourStudyOptions options;
  options.prefiltered = true;
  return contour_study({{part}}, options).value();
}

TEST(ContourStudy, DoubtsTheAlignmentOnlyBeyondWhatTheRestExplains) {
  int turned_far = 0;
  int aligned_doubted = 0;
  int turned_doubted = 0;
  for (std::uint64_t seed = 1; seed <= 33; ++seed) {
    const auto doubted = [](const ContourStudy& study) {
      return std::any_of(study.warnings.begin(), study.warnings.end(),
                         [](const auto& w) { return w.code == core::Code::kAlignment; });
    };
    const auto aligned = random_pin(seed, 1.5, 0.0);
    turned_far += std::abs(aligned.offset.angle_rad) > 2.0 * kDegree ? 1 : 0;
    aligned_doubted += doubted(aligned) ? 1 : 0;
    turned_doubted += doubted(random_pin(seed, 0.1, 5.0 * kDegree)) ? 1 : 0;
  }
  std::printf("33 aligned pins: correlation beyond 2 deg %d, doubted %d; turned by 5 deg: %d\n",
              turned_far, aligned_doubted, turned_doubted);
  EXPECT_GT(turned_far, 10);
  EXPECT_LE(aligned_doubted, 1);
  EXPECT_GE(turned_doubted, 30);
}

TEST(ContourStudy, CDirectionMirrorsTheFollowingPart) {
  auto options = spec_options();
  options.axes.c_direction = -1;
  auto parts = spec_parts();
  for (ContourPart& part :
       parts) {  // the same motion, recorded by an axis that counts the other way
    for (double& c : part.trace->c_rad) c = -c;
    for (double& c : part.trace->c_error_rad) c = -c;
  }
  const auto a = contour_study(parts, options).value();
  const auto b = contour_study(spec_parts(), spec_options()).value();
  EXPECT_LT(rms_difference(a.parts[1].following.error_mm, b.parts[1].following.error_mm), 1e-9);
}

TEST(ContourStudy, AMainJournalStandsForTheRest) {
  auto parts = spec_parts();
  for (std::size_t i = 0; i < 4; ++i) parts[i].main = rows_of(test::spec_rest(i));
  const auto study = contour_study(parts, spec_options()).value();
  ASSERT_TRUE(study.main);
  for (const ContourPartResult& part : study.parts) {
    ASSERT_TRUE(part.indirect);
    EXPECT_GT(part.indirect->correlation, 0.999999);
    EXPECT_LT(part.indirect->rms_difference_mm, 1e-3 * kMicrometre);
  }
}

TEST(ContourStudy, AsPublishedTurnsTheFollowingPartAndExplainsTheRestAway) {
  auto options = spec_options();
  options.method = ContourMethod::kAsPublished;
  const auto published = contour_study(spec_parts(), options).value();
  const auto corrected = contour_study(spec_parts(), spec_options()).value();
  for (std::size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    EXPECT_LT(published.parts[i].direct.rest_mm2, corrected.parts[i].direct.rest_mm2);
    EXPECT_GT(rms_difference(published.parts[i].direct.rest_mm, test::spec_rest(i)),
              20.0 * rms_difference(corrected.parts[i].direct.rest_mm, test::spec_rest(i)));
  }
}

TEST(ContourStudy, SaysNoWordBelowFourParts) {
  auto parts = spec_parts();
  parts.resize(3);
  const auto three = contour_study(parts, spec_options()).value();
  EXPECT_TRUE(three.following->index);
  EXPECT_FALSE(three.following->word());
  parts.resize(1);
  EXPECT_FALSE(contour_study(parts, spec_options()).value().total);
}

TEST(ContourStudy, NamesThePartAndTheRowOfBadInput) {
  auto parts = spec_parts();
  parts[2].pin.deviation_mm[11] = std::numeric_limits<double>::quiet_NaN();
  const auto pin = contour_study(parts, spec_options());
  EXPECT_EQ(pin.error().code, core::Code::kNotFinite);
  EXPECT_EQ(pin.error().where, "parts/2/pin");
  EXPECT_NE(pin.error().what.find("row 11 "), std::string::npos);
  parts = spec_parts();
  parts[1].trace->x_error_mm.pop_back();
  const auto axes = contour_study(parts, spec_options());
  EXPECT_EQ(axes.error().code, core::Code::kMeaning);
  EXPECT_EQ(axes.error().where, "parts/1/axes");
  EXPECT_EQ(contour_study({}, spec_options()).error().code, core::Code::kNoPoints);
}

TEST(ContourStudy, HoldsTheSamplingOfTheControlAgainstTheCutOff) {
  auto parts = spec_parts();
  auto options = spec_options();
  options.error.filter.cutoff_upr = 100.0;
  const auto warned = contour_study(parts, options).value();
  EXPECT_TRUE(std::any_of(warned.warnings.begin(), warned.warnings.end(),
                          [](const auto& w) { return w.code == core::Code::kUndersampled; }));
  options.error.filter.cutoff_upr = 150.0;
  EXPECT_EQ(contour_study(parts, options).error().code, core::Code::kSampling);
}

TEST(ContourStudy, SeparatesOnePartInLessThanFiveMilliseconds) {
  ContourPart part = spec_parts()[0];
  ContourStudyOptions options;
  double best = 1.0;
  for (int i = 0; i < 10; ++i) {
    const double start_s = test::processor_seconds();
    ASSERT_TRUE(contour_part(part, options));
    best = std::min(best, test::processor_seconds() - start_s);
  }
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
  EXPECT_LT(best, 5e-3);
#endif
  RecordProperty("milliseconds", std::to_string(1e3 * best));
}

}  // namespace
}  // namespace rondure::fit
