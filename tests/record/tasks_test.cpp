#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/tasks/settings.h"
#include "record/tasks/spindle.h"
#include "record/tasks/wheel.h"

namespace rondure::record {
namespace {

using ::testing::HasSubstr;

/// A number of which every bit counts.
constexpr double kOdd = 0.1 + 0.2;

/// The settings, one line each, numbers by their bits.
std::vector<std::string> lines_of(const std::vector<Setting>& settings) {
  std::vector<std::string> out;
  for (const Setting& setting : settings) {
    out.push_back(setting.name + " " +
                  (setting.number ? std::to_string(std::bit_cast<std::uint64_t>(*setting.number))
                                  : "'" + setting.text + "'"));
  }
  return out;
}

/// Expects that a task goes to settings and back with the same bits.
template <class Task>
void comes_back(const Task& task) {
  const auto settings = settings_of_task(task, "of/");
  const auto read = task_of<Task>(settings, "of/");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(lines_of(settings_of_task(*read, "of/")), lines_of(settings));
}

/// Expects that no text of a task can be another word, and that each key keeps its kind.
template <class Task>
void refuses_other_words(const Task& task) {
  const auto settings = settings_of_task(task);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    SCOPED_TRACE(settings[i].name);
    auto other = settings;
    other[i].text = "nothing-of-that";
    if (!other[i].number) {
      const auto read = task_of<Task>(other);
      ASSERT_FALSE(read);
      EXPECT_EQ(read.error().code, core::Code::kMeaning);
      EXPECT_THAT(read.error().what, HasSubstr("\"" + settings[i].name + "\""));
      EXPECT_THAT(read.error().what, HasSubstr("\"nothing-of-that\""));
      other[i].number = 1.0;
    } else {
      other[i].number.reset();
    }
    EXPECT_FALSE(task_of<Task>(other)) << "a number where a text belongs, or the reverse";
  }
}

SpindleTask full_spindle() {
  SpindleTask out;
  out.layout = SpindleTask::Layout::kReference;
  out.p1_to_p2_deg = kOdd;
  out.p2_to_p3_deg = -kOdd;
  out.p1_to_p3_deg = -0.0;
  out.crank_radius_mm = std::numeric_limits<double>::denorm_min();
  out.samples = 720;
  out.recovery = SpindleTask::Recovery::kRegularised;
  out.probe_noise_um = kOdd / 3.0;
  out.resampling = Switch::kOff;
  out.second_order = SpindleTask::SecondOrder::kOff;
  out.motion = SpindleTask::Motion::kAsPublished;
  out.filter = SpindleTask::Filter::kNone;
  return out;
}

WheelTask full_wheel() {
  WheelTask out;
  out.mode = WheelTask::Mode::kEnvelope;
  out.nominal_radius_mm = kOdd;
  out.axis_x_mm = -kOdd;
  out.axis_z_mm = -0.0;
  out.center = WheelTask::Center::kWeighted;
  out.quadruples = WheelTask::Quadruples::kRandom;
  out.count = 5000;
  out.kappa_limit = kOdd / 7.0;
  out.robust = Switch::kOn;
  out.short_arc = WheelTask::ShortArc::kAllowed;
  GroundSurfaceTask& surface = out.surface.emplace();
  surface.form = GroundSurfaceTask::Form::kTable;
  surface.coefficients = {0.0, kOdd, -0.0};
  surface.vertex_radius_mm = 80.0 * kOdd;
  surface.table_x_mm = {1.0, kOdd};
  surface.cusp_um = kOdd;
  surface.radius = GroundSurfaceTask::Radius::kEffective;
  surface.touch_off_mm = 0.0;
  return out;
}

TEST(Tasks, ComeBackFromTheirSettingsWithTheSameBits) {
  comes_back(SpindleTask());
  comes_back(full_spindle());
  comes_back(WheelTask());
  comes_back(full_wheel());
}

TEST(Tasks, HaveTheirDefaultsWhereAJournalSaysNothing) {
  const auto spindle = task_of<SpindleTask>({});
  ASSERT_TRUE(spindle);
  EXPECT_EQ(lines_of(settings_of_task(*spindle)), lines_of(settings_of_task(SpindleTask())));
  const auto wheel = task_of<WheelTask>({});
  ASSERT_TRUE(wheel);
  EXPECT_EQ(lines_of(settings_of_task(*wheel)), lines_of(settings_of_task(WheelTask())));
}

TEST(Tasks, RefuseAnUnknownWordByTheNameOfItsSetting) {
  refuses_other_words(full_spindle());
  refuses_other_words(full_wheel());
}

TEST(Tasks, RefuseAWholeNumberThatIsNone) {
  for (const double samples : {720.5, 1e300, -1.0}) {
    SCOPED_TRACE(samples);
    const auto read = task_of<SpindleTask>(std::vector<Setting>{{"samples", samples, ""}});
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().what, HasSubstr("\"samples\""));
  }
}

}  // namespace
}  // namespace rondure::record
