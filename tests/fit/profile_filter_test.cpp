#include "fit/profiles/profile_filter.h"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "core/units.h"
#include "fit/profiles/internal/dft.h"
#include "tests/fit/profile_cases.h"

namespace rondure::fit {
namespace {

using test::rough_profile;
using Profile = std::vector<double>;

constexpr ProfileFilter kAll[] = {ProfileFilter::kGaussian, ProfileFilter::kTwoRc,
                                  ProfileFilter::kRobustGaussian, ProfileFilter::kSpline};
constexpr ProfileFilter kLinear[] = {ProfileFilter::kGaussian, ProfileFilter::kTwoRc,
                                     ProfileFilter::kSpline};

Profile filtered(const Profile& r, const FilterOptions& options) {
  const auto out = filter_closed(r, options);
  EXPECT_TRUE(out.has_value()) << (out ? "" : out.error().what);
  return out ? out->r_mm : Profile{};
}

Profile low(const Profile& r, ProfileFilter filter, double cutoff) {
  return filtered(r, {filter, PassBand::kLow, cutoff});
}

void expect_same(const Profile& a, const Profile& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

/// The weight function of ISO 16610-21, sampled over several turns and scaled to sum 1.
Profile gaussian_weights(std::size_t n, double cutoff) {
  Profile s(n, 0.0);
  const double width = std::sqrt(std::numbers::ln2 / std::numbers::pi) / cutoff;  // in turns
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (int turn = -4; turn <= 4; ++turn) {
      const double x = (static_cast<double>(i) / static_cast<double>(n) + turn) / width;
      s[i] += std::exp(-std::numbers::pi * x * x);
    }
    sum += s[i];
  }
  for (double& value : s) value /= sum;
  return s;
}

Profile convolution(const Profile& s, const Profile& r) {
  const std::size_t n = r.size();
  Profile out(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) out[i] += s[(i + n - k) % n] * r[k];
  }
  return out;
}

TEST(ProfileFilter, GaussianIsTheConvolutionWithItsWeightFunction) {
  // 16 values per undulation: the sampled weight function then is the continuous one to round-off.
  constexpr std::size_t kCount = 1000;
  for (const double cutoff : {0.7, 15.0, 50.0, 62.5}) {
    SCOPED_TRACE(cutoff);
    const Profile r = rough_profile(3, kCount);
    expect_same(low(r, ProfileFilter::kGaussian, cutoff),
                convolution(gaussian_weights(kCount, cutoff), r), 1e-15);
  }
}

TEST(ProfileFilter, SplineSolvesTheEquationsOfTheStandard) {
  constexpr std::size_t kCount = 240;
  const double cutoff = 15.0;
  const double alpha = 1.0 / (2.0 * std::sin(std::numbers::pi * cutoff / kCount));
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(kCount, kCount);
  for (Eigen::Index i = 0; i < second.rows(); ++i) {
    second(i, i) = -2.0;
    second(i, (i + 1) % second.rows()) = second((i + 1) % second.rows(), i) = 1.0;
  }
  const Eigen::MatrixXd matrix =
      Eigen::MatrixXd::Identity(kCount, kCount) + std::pow(alpha, 4) * second.transpose() * second;
  const Profile r = rough_profile(5, kCount);
  const Eigen::VectorXd w =
      matrix.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(r.data(), kCount));
  expect_same(low(r, ProfileFilter::kSpline, cutoff), Profile(w.begin(), w.end()), 1e-14);
}

/// Re-weighted direct convolution, written from the definition; no transform, no shared code.
Profile robust_by_hand(const Profile& r, double cutoff) {
  const Profile s = gaussian_weights(r.size(), cutoff);
  Profile w = convolution(s, r);
  for (int turn = 0; turn < 400; ++turn) {
    Profile distance;
    for (std::size_t i = 0; i < r.size(); ++i) distance.push_back(std::abs(r[i] - w[i]));
    std::sort(distance.begin(), distance.end());
    const std::size_t half = r.size() / 2;
    const double median =
        r.size() % 2 == 1 ? distance[half] : 0.5 * (distance[half - 1] + distance[half]);
    Profile delta;
    Profile product;
    for (std::size_t i = 0; i < r.size(); ++i) {
      const double u = (r[i] - w[i]) / (4.4478 * median);
      delta.push_back(std::abs(u) <= 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0);
      product.push_back(delta.back() * r[i]);
    }
    const Profile above = convolution(s, product);
    const Profile below = convolution(s, delta);
    for (std::size_t i = 0; i < r.size(); ++i) w[i] = above[i] / below[i];
  }
  return w;
}

TEST(ProfileFilter, RobustGaussianIsTheSettledReweightedConvolution) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    Profile r = rough_profile(seed, 301);
    for (std::size_t i = 100; i < 106; ++i) r[i] += 0.05;  // a burr of 50 um
    const auto line = filter_closed(r, {ProfileFilter::kRobustGaussian, PassBand::kLow, 15.0});
    ASSERT_TRUE(line.has_value());
    EXPECT_GT(line->iterations, 1);
    expect_same(line->r_mm, robust_by_hand(r, 15.0), 1e-10);
  }
}

TEST(ProfileFilter, RobustGaussianKeepsItsLineUnderABurr) {
  const Profile clean = rough_profile(7, 720);
  Profile burred = clean;
  for (std::size_t i = 200; i < 206; ++i) burred[i] += 0.1;
  const auto moved = [&](ProfileFilter filter) {
    const Profile a = low(clean, filter, 15.0);
    const Profile b = low(burred, filter, 15.0);
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  };
  EXPECT_GT(moved(ProfileFilter::kGaussian), 0.01);
  EXPECT_LT(moved(ProfileFilter::kRobustGaussian), 0.0004);
}

TEST(ProfileFilter, RobustGaussianTakesSmoothProfilesWithSpikes) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    core::KeyedNoise noise(seed, {31});
    const Profile theta = test::uniform_angles(1440);
    Profile clean;
    for (const double t : theta) {
      clean.push_back(1e-3 *
                      (3.0 * std::cos(2.0 * t) + std::cos(3.0 * t + static_cast<double>(seed)) +
                       0.3 * std::cos(7.0 * t - 1.0)));
    }
    Profile spiked = clean;
    for (int spike = 0; spike < 5; ++spike) {
      const auto at = static_cast<std::size_t>(1440.0 * noise.uniform());
      spiked[at] += (noise.uniform() < 0.5 ? -1e-3 : 1e-3) * (10.0 + 20.0 * noise.uniform());
    }
    for (const double cutoff : {15.0, 50.0, 150.0}) {
      SCOPED_TRACE(std::to_string(seed) + " at " + std::to_string(cutoff));
      const auto line =
          filter_closed(spiked, {ProfileFilter::kRobustGaussian, PassBand::kLow, cutoff});
      ASSERT_TRUE(line.has_value()) << line.error().what;
      const Profile truth = low(clean, ProfileFilter::kGaussian, cutoff);
      const Profile linear = low(spiked, ProfileFilter::kGaussian, cutoff);
      double off = 0.0;
      double pulled = 0.0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        off = std::max(off, std::abs(line->r_mm[i] - truth[i]));
        pulled = std::max(pulled, std::abs(linear[i] - truth[i]));
      }
      EXPECT_LT(off, 1e-4);  // 0.1 um
      EXPECT_GT(pulled, 3.0 * off);
    }
  }
}

/// Two first-order stages y' = a (x - y), stepped exactly for a piecewise linear input until
/// periodic.
Profile two_rc_by_hand(const Profile& r, double cutoff) {
  const double a = std::numbers::sqrt3 * cutoff;
  const double h = core::kTwoPi / static_cast<double>(r.size());
  const double decay = std::exp(-a * h);
  const auto stage = [&](const Profile& x) {
    Profile y(x.size(), 0.0);
    double state = 0.0;
    for (int turn = 0; turn < 4; ++turn) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double x0 = x[(i + x.size() - 1) % x.size()];
        const double slope = (x[i] - x0) / h;
        state = x[i] - slope / a + (state - x0 + slope / a) * decay;
        y[i] = state;
      }
    }
    return y;
  };
  return stage(stage(r));
}

TEST(ProfileFilter, TwoRcIsACascadeOfTwoLagsInSpace) {
  // The lags see straight lines between the values: an error of (150 h)^2 / 12 in the undulation of
  // 150 UPR that passes with 0.08 um, 2.4e-10 mm at this step h.
  constexpr std::size_t kCount = 1U << 18U;
  const Profile r = test::spec_profile(test::uniform_angles(kCount));
  expect_same(low(r, ProfileFilter::kTwoRc, 50.0), two_rc_by_hand(r, 50.0), 5e-10);
}

TEST(ProfileFilter, PassesHalfAtTheCutOffAndThreeQuartersWithTwoRc) {
  const FilterOptions gaussian{ProfileFilter::kGaussian, PassBand::kLow, 50.0};
  EXPECT_DOUBLE_EQ(transmission(gaussian, 50.0, 1024).real(), 0.5);
  const FilterOptions spline{ProfileFilter::kSpline, PassBand::kHigh, 50.0};
  EXPECT_DOUBLE_EQ(transmission(spline, 50.0, 1024).real(), 0.5);
  for (const PassBand pass : {PassBand::kLow, PassBand::kHigh}) {
    const FilterOptions two_rc{ProfileFilter::kTwoRc, pass, 50.0};
    EXPECT_NEAR(std::abs(transmission(two_rc, 50.0, 1024)), 0.75, 1e-15);
    EXPECT_NEAR(std::abs(std::arg(transmission(two_rc, 50.0, 1024))), std::numbers::pi / 3.0,
                1e-15);
  }
}

TEST(ProfileFilter, TransmitsWhatTheSpecificationPrints) {
  const double ratio[] = {0.1, 0.2, 0.5, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0};
  const double printed[] = {0.993092, 0.972655, 0.840896, 0.641713, 0.5,
                            0.338564, 0.210224, 0.0625,   0.001953};
  for (std::size_t i = 0; i < std::size(ratio); ++i) {
    EXPECT_NEAR(gaussian_transmission(50.0 * ratio[i], 50.0), printed[i], 0.5e-6);
  }
}

TEST(ProfileFilter, ActsOnACosineAsItsTransmissionSays) {
  for (const ProfileFilter filter : kLinear) {
    for (const PassBand pass : {PassBand::kLow, PassBand::kHigh, PassBand::kBand}) {
      const FilterOptions options{filter, pass, 15.0, 90.0};
      for (const int n : {0, 1, 14, 40, 100}) {
        SCOPED_TRACE(std::string(name_of(filter)) + " " + std::to_string(n));
        Profile wave;
        Profile expected;
        const auto t = transmission(options, n, 777);
        for (const double theta : test::uniform_angles(777)) {
          wave.push_back(std::cos(n * theta));
          expected.push_back(std::abs(t) * std::cos(n * theta + std::arg(t)));
        }
        expect_same(filtered(wave, options), expected, 1e-13);
      }
    }
  }
}

TEST(ProfileFilter, LowAndHighPassAddUpToTheProfile) {
  for (const ProfileFilter filter :
       {ProfileFilter::kGaussian, ProfileFilter::kRobustGaussian, ProfileFilter::kSpline}) {
    SCOPED_TRACE(name_of(filter));
    const Profile r = rough_profile(11, 701);
    const Profile l = low(r, filter, 50.0);
    Profile sum = filtered(r, {filter, PassBand::kHigh, 50.0});
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += l[i];
    expect_same(sum, r, 1e-16);
  }
}

TEST(ProfileFilter, BandPassIsTheHighPassOfTheLowPass) {
  for (const ProfileFilter filter : kAll) {
    SCOPED_TRACE(name_of(filter));
    const Profile r = rough_profile(12, 721);  // odd: no bin at N/2, which cannot hold a phase
    const Profile upper = low(r, filter, 90.0);
    expect_same(filtered(r, {filter, PassBand::kBand, 15.0, 90.0}),
                filtered(upper, {filter, PassBand::kHigh, 15.0}), 1e-14);
  }
}

TEST(ProfileFilter, FollowsAShiftOfTheStartAngle) {
  for (const ProfileFilter filter : kAll) {
    SCOPED_TRACE(name_of(filter));
    const Profile r = rough_profile(13, 509);  // a prime: the transform takes its other way
    Profile turned = r;
    std::rotate(turned.begin(), turned.begin() + 123, turned.end());
    Profile line = low(r, filter, 50.0);
    std::rotate(line.begin(), line.begin() + 123, line.end());
    expect_same(low(turned, filter, 50.0), line, 1e-12);
  }
}

TEST(ProfileFilter, FollowsScaleAndConstant) {
  for (const ProfileFilter filter : kAll) {
    SCOPED_TRACE(name_of(filter));
    const Profile r = rough_profile(14, 512);
    Profile changed;
    for (const double value : r) changed.push_back(25.0 - 3.0 * value);
    Profile expected = low(r, filter, 50.0);
    for (double& value : expected) value = 25.0 - 3.0 * value;
    expect_same(low(changed, filter, 50.0), expected, 1e-11);
  }
}

TEST(ProfileFilter, LinearFiltersCommute) {
  const Profile r = rough_profile(15, 720);
  for (const ProfileFilter a : kLinear) {
    for (const ProfileFilter b : kLinear) {
      expect_same(low(low(r, a, 15.0), b, 50.0), low(low(r, b, 50.0), a, 15.0), 1e-16);
    }
  }
}

TEST(ProfileFilter, RefusesFewerThanSevenPointsPerUndulationUnlessOverridden) {
  const Profile r = rough_profile(16, 349);
  FilterOptions options{ProfileFilter::kGaussian, PassBand::kLow, 50.0};
  const auto refused = filter_closed(r, options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, core::Code::kSampling);
  EXPECT_NE(refused.error().what.find("350 points"), std::string::npos) << refused.error().what;
  options.override_sampling = true;
  const auto taken = filter_closed(r, options);
  ASSERT_TRUE(taken.has_value());
  EXPECT_TRUE(taken->sampling.overridden);
  EXPECT_NEAR(taken->sampling.points_per_undulation, 6.98, 1e-12);
  EXPECT_FALSE(filter_closed(rough_profile(16, 350), options)->sampling.overridden);
}

TEST(ProfileFilter, RefusesCutOffsThatMeanNothing) {
  const Profile r = rough_profile(17, 100);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double cutoff : {0.0, -15.0, nan, 50.0, 1e9}) {
    FilterOptions options{ProfileFilter::kGaussian, PassBand::kLow, cutoff};
    options.override_sampling = true;
    const auto out = filter_closed(r, options);
    ASSERT_FALSE(out.has_value()) << cutoff;
    EXPECT_EQ(out.error().code, core::Code::kBadOption);
  }
  const auto empty = filter_closed(r, {ProfileFilter::kGaussian, PassBand::kBand, 14.0, 5.0});
  ASSERT_FALSE(empty.has_value());
  EXPECT_EQ(empty.error().code, core::Code::kBadOption);
}

TEST(ProfileFilter, RefusesAHighPassWithoutAFilter) {
  const Profile r = rough_profile(17, 100);
  EXPECT_TRUE(filter_closed(r, {ProfileFilter::kNone, PassBand::kLow}));
  for (const PassBand pass : {PassBand::kHigh, PassBand::kBand}) {
    const auto out = filter_closed(r, {ProfileFilter::kNone, pass});
    ASSERT_FALSE(out.has_value());
    EXPECT_EQ(out.error().code, core::Code::kBadOption);
  }
}

TEST(ProfileFilter, NamesTheRowThatIsNotANumber) {
  Profile r = rough_profile(18, 400);
  r[17] = std::numeric_limits<double>::quiet_NaN();
  const auto out = filter_closed(r, {});
  ASSERT_FALSE(out.has_value());
  EXPECT_EQ(out.error().code, core::Code::kNotFinite);
  EXPECT_NE(out.error().what.find("row 17"), std::string::npos);
}

/// Harmonic of a series by direct summation, not by the transform that the filter uses.
std::complex<double> harmonic_of(const Profile& r, std::size_t n) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const auto place = static_cast<double>(i * n % r.size()) / static_cast<double>(r.size());
    sum += r[i] * std::polar(1.0, -core::kTwoPi * place);  // polar() takes no negative modulus
  }
  return sum;
}

// An impulse holds every harmonic with the same amplitude.
TEST(ProfileFilter, TransmitsEveryHarmonicOfAnImpulseAsTheDefinitionSays) {
  for (const double cutoff : {1.0, 15.0, 50.0, 62.5, 150.0, 500.0, 1500.0}) {
    SCOPED_TRACE(cutoff);
    Profile impulse(7 * static_cast<std::size_t>(std::ceil(3.0 * cutoff)), 0.0);
    impulse[0] = 1.0;
    const auto response =
        filter_closed(impulse, {ProfileFilter::kGaussian, PassBand::kLow, cutoff});
    ASSERT_TRUE(response.has_value());
    double greatest = 0.0;
    // Above 500 UPR every 13th: the direct sum takes harmonics times samples.
    const std::size_t step = cutoff > 500.0 ? 13 : 1;
    for (std::size_t n = 1; static_cast<double>(n) <= 3.0 * cutoff; n += step) {
      const double expected = std::pow(2.0, -std::pow(static_cast<double>(n) / cutoff, 2));
      greatest = std::max(greatest, std::abs(harmonic_of(response->r_mm, n) - expected));
    }
    EXPECT_LT(greatest, 1e-13);
  }
}

}  // namespace
}  // namespace rondure::fit
