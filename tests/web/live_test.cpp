// The parts of the live page: guard, time left, frames, and its threads at once. Over HTTP with the
// whole program: tests/app/watch_test.cpp; in a browser: tests/browser/live.mjs.

#include <atomic>
#include <cmath>
#include <memory>
#include <set>
#include <span>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "evaluation/results/feature_values.h"
#include "tests/reports/synthetic.h"
#include "web/internal/frame.h"
#include "web/internal/sections.h"
#include "web/internal/server.h"
#include "web/page.h"
#include "web/time.h"
#include "web/view.h"

namespace rondure::web {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(LiveGuard, TokensAreRandomAndComparedAsAWhole) {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) seen.insert(random_token());
  EXPECT_EQ(seen.size(), 100U);
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_TRUE(same_secret(token, token));
  EXPECT_FALSE(same_secret(token, ""));
  EXPECT_FALSE(same_secret("", "")) << "no secret opens nothing";
  EXPECT_FALSE(same_secret(token, token.substr(0, 31)));
  EXPECT_FALSE(same_secret(token, token + "0"));
}

TEST(LiveGuard, OnlyTheOwnAddressIsAHost) {
  const LiveGate gate{8080, true, "secret"};
  EXPECT_FALSE(refuse_host(gate, "127.0.0.1:8080"));
  EXPECT_FALSE(refuse_host(gate, "localhost:8080"));
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:80801", "evil.example:8080", "localhost",
                           "localhost:8080.evil.example", "127.0.0.1:8080@evil", "[::1]:8080"}) {
    EXPECT_TRUE(refuse_host(gate, host)) << host;
  }
}

TEST(LiveGuard, AStopNeedsEverythingAtOnce) {
  const LiveGate gate{8080, true, "secret"};
  const LiveRequest right{"localhost:8080", "http://localhost:8080", "same-origin",
                          "application/json; charset=utf-8", "secret"};
  EXPECT_FALSE(refuse_stop(gate, right));
  EXPECT_TRUE(refuse_stop({8080, false, ""}, right)) << "read-only";
  EXPECT_TRUE(refuse_stop({8081, true, "secret"}, right));
  LiveRequest other = right;
  other.origin = "http://127.0.0.1:8080";  // of the same page under its other name
  EXPECT_TRUE(refuse_stop(gate, other));
}

TEST(LiveTime, LeftIsWhatTheModelPredictsAtThePaceOfTheRun) {
  const std::vector<PredictedStage> stages = {{10, 20.0}, {0, 30.0}, {50, 50.0}};
  EXPECT_EQ(predicted_touches(stages), 60);
  EXPECT_DOUBLE_EQ(predicted_time_s(stages, 5), 10.0);
  EXPECT_DOUBLE_EQ(predicted_time_s(stages, 60), 100.0);
  EXPECT_DOUBLE_EQ(predicted_time_s(stages, 35), 75.0);
  // Twice as slow as predicted: 75 s took 150 s, 25 s are left.
  EXPECT_DOUBLE_EQ(time_left_s(stages, 0, 35, 150.0).value_or(-1.0), 50.0);
  // Resumed behind touch 35: its own pace counts, 10 s of the model in 5 s.
  EXPECT_DOUBLE_EQ(time_left_s(stages, 35, 45, 5.0).value_or(-1.0), 7.5);
  EXPECT_FALSE(time_left_s(stages, 0, 2, 1.0)) << "no pace yet";
  EXPECT_FALSE(time_left_s(stages, 0, 60, 1.0)) << "beyond the prediction";
  EXPECT_FALSE(time_left_s({}, 0, 5, 1.0)) << "no model";
}

TEST(LiveTime, NeverGrowsWhileARunKeepsThePredictedPace) {
  const std::vector<PredictedStage> stages = {{13, 24.0}, {6, 21.0}, {140, 194.0}};
  double last = 1e9;
  for (int touches = 3; touches < 159; ++touches) {
    const auto left = time_left_s(stages, 0, touches, predicted_time_s(stages, touches));
    ASSERT_TRUE(left) << touches;
    EXPECT_LT(*left, last) << touches;
    EXPECT_NEAR(*left + predicted_time_s(stages, touches), 239.0, 1e-9);
    last = *left;
  }
}

/// A cylinder of 4 x 12 points as touched, noise-free: an exact answer is known. Ellipse of 6 um.
record::RunRecord touched(int points) {
  record::RunRecord out;
  out.header.version = "test";
  out.header.part_id = "part";
  out.header.temperature_min_degC = 10.0;
  out.header.temperature_max_degC = 30.0;
  record::Feature feature;
  feature.id = "bore";
  feature.layers = 4;
  feature.points_per_layer = 12;
  feature.nominal_diameter_mm = 50.0;
  out.features = {feature};
  out.poses = {{0, 0, {}, {}, false, 0.0}};
  for (int i = 0; i < points; ++i) {
    const int layer = i / 12 % 4;
    const int point = i % 12;
    const double angle = 2.0 * M_PI * point / 12.0;
    const double r = 25.0 + 0.003 * std::cos(2.0 * angle);
    record::Touch touch;
    touch.id = i;
    touch.layer = layer;
    touch.point = point;
    touch.pose = 0;
    touch.repeat = i / 48;
    touch.tip_mm = {r * std::cos(angle), r * std::sin(angle), 20.0 * layer};
    touch.approach = {-std::cos(angle), -std::sin(angle), 0.0};
    out.touches.push_back(touch);
  }
  return out;
}

TEST(LiveCloud, IsTheMinimumZoneOfTheTouchesSoFar) {
  for (const int points : {30, 48, 96}) {
    SCOPED_TRACE(points);
    const record::RunRecord record = touched(points);
    const auto cloud = evaluate_so_far(record, record.poses.front());
    ASSERT_TRUE(cloud) << cloud.error().what;
    EXPECT_EQ(cloud->every, 1U);
    const auto zone = zone_of(cloud->result);
    ASSERT_TRUE(zone);
    EXPECT_NEAR(zone->deviation_mm, 0.006, 1e-9);
    EXPECT_TRUE(cloud->result.characteristics.empty()) << "no verdict before the end";
  }
}

TEST(LiveCloud, SaysWhenTheTouchesDefineNothing) {
  for (const int points : {0, 1, 3, 5}) {
    const record::RunRecord record = touched(points);
    EXPECT_FALSE(evaluate_so_far(record, record.poses.front())) << points;
  }
}

/// The changes that a page gets when it asks once; discarded when there is no answer. Under the
/// thread sanitizer an answer may come too late: there it asks again for ten seconds.
json asked(std::uint16_t port, const std::string& client) {
  httplib::Client browser("127.0.0.1", port);
#ifdef __SANITIZE_THREAD__
  constexpr int kAttempts = 100;
#else
  constexpr int kAttempts = 1;
#endif
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (const auto answer = browser.Get("/live?since=0&client=" + client)) {
      return json::parse(answer->body, nullptr, false);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return json(json::value_t::discarded);
}

TEST(LiveView, IsPaintedAndServedWhileTheRunGrows) {
  const auto source = std::make_shared<record::GrowingRecord>();
  auto view = LiveView::start({}, source);
  ASSERT_TRUE(view) << view.error().what;
  const std::string url = (*view)->url();
  const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  std::atomic<int> drawn = 0;
  std::atomic<int> ended = 0;
  constexpr int kPages = 3;
  std::vector<std::thread> pages;
  for (int page = 0; page < kPages; ++page) {
    pages.emplace_back([&, name = std::string(1, static_cast<char>('a' + page))] {
      bool has_drawing = false;
      json answer = asked(port, name);
      for (; answer.is_object() && !answer["ended"]; answer = asked(port, name)) {
        const std::string drawing = answer["parts"].value("drawing", std::string());
        if (!has_drawing && drawing.find("<svg") != std::string::npos) ++drawn;
        has_drawing = has_drawing || drawing.find("<svg") != std::string::npos;
      }
      if (answer.is_object()) ++ended;
    });
  }
  const record::RunRecord whole = touched(48);
  record::RunRecord head = whole;
  head.touches.clear();
  source->begin(head);
  constexpr std::size_t kMostRounds = 12'000;  // a minute
  for (std::size_t i = 0; i < whole.touches.size() || (drawn < kPages && i < kMostRounds); ++i) {
    if (i < whole.touches.size()) source->add(std::span(&whole.touches[i], 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  (*view)->show_failure("the probe broke");
  for (std::thread& page : pages) page.join();
  EXPECT_EQ(drawn, kPages);
  EXPECT_EQ(ended, kPages);
}

TEST(LivePainter, SendsOnlyWhatChanged) {
  const auto source = std::make_shared<record::GrowingRecord>();
  LivePainter painter(source, {{60, 100.0}}, reports::Language::kEnglish);
  EXPECT_THAT(painter.paint(0.0)->parts.front().html, HasSubstr("Starting"));
  source->begin(touched(48));
  const auto first = painter.paint(1.0);
  const json all = json::parse(answer_of(*first, "s", 0));
  EXPECT_THAT(std::string(all["parts"]["drawing"]), HasSubstr("<svg"));
  EXPECT_THAT(std::string(all["parts"]["now"]), HasSubstr("<progress value=\"48\" max=\"60\""));
  EXPECT_FALSE(all["ended"]);
  const std::uint64_t version = all["version"];
  EXPECT_TRUE(json::parse(answer_of(*first, "s", version))["parts"].empty());
  const auto later = painter.paint(2.0);  // a second later, nothing touched
  const json few = json::parse(answer_of(*later, "s", version));
  EXPECT_EQ(few["parts"].size(), 1U) << few.dump();
  EXPECT_TRUE(few["parts"].contains("now"));
  EXPECT_EQ(json::parse(answer_of(*later, "s", 1'000'000))["parts"].size(), later->parts.size())
      << "a page of another run gets everything";
}

TEST(LivePainter, ChartsEveryPoseWithAllOfItsTouches) {
  const auto source = std::make_shared<record::GrowingRecord>();
  LivePainter painter(source, {}, reports::Language::kEnglish);
  source->begin(touched(3));  // three points have no zone: f is 0 as yet
  (void)painter.paint(0.0);
  record::RunRecord whole = touched(48);
  source->add(std::span(whole.touches).subspan(3));
  source->add(record::PoseVisit{1, 0, {0.01, 0.0}, {0.01, 0.0}, false, 1.0});
  for (record::Touch& touch : whole.touches) touch.pose = 1;
  source->add(std::span(whole.touches).first(20));
  const auto part = [](const LiveFrame& frame) {
    for (const LivePart& each : frame.parts) {
      if (each.id == "poses") return each.html;
    }
    return std::string("none");
  };
  EXPECT_EQ(part(*painter.paint(1.0)), "") << "one whole cloud is no search";
  source->add(std::span(whole.touches).subspan(20));
  EXPECT_THAT(part(*painter.paint(2.0)), HasSubstr("<svg"));
}

TEST(LivePainter, ShowsTheResultOfTheReportAndEscapesIt) {
  const std::string evil = "<script>\"'&\xff\x01";
  const reports::Case made = reports::hostile_case(evil);
  LivePainter painter(std::make_shared<record::GrowingRecord>(), {}, reports::Language::kEnglish);
  const auto frame = painter.paint_result(made.record, made.evaluation, evil);
  EXPECT_TRUE(frame->ended);
  const json answer = json::parse(answer_of(*frame, "s", 0));
  EXPECT_THAT(std::string(answer["parts"]["result"]), HasSubstr("class=\"verdict\""));
  for (const auto& [id, html] : answer["parts"].items()) {
    EXPECT_THAT(std::string(html), Not(HasSubstr("<script"))) << id;
  }
  const auto failed = painter.paint_failure(evil);
  EXPECT_THAT(answer_of(*failed, "s", 0),
              AllOf(HasSubstr("&lt;script&gt;"), Not(HasSubstr("<script"))));
}

TEST(LivePage, HasNoButtonWithoutControlAndItsWordsInBothLanguages) {
  EXPECT_THAT(live_page(false), AllOf(Not(HasSubstr("<button")), HasSubstr("lang=\"en\"")));
  EXPECT_THAT(live_page(true), HasSubstr("id=\"stop\""));
  const reports::LanguageScope scope(reports::Language::kChinese);
  EXPECT_THAT(live_page(true),
              AllOf(HasSubstr("lang=\"zh-Hans\""), HasSubstr("停止测量"), Not(HasSubstr("Stop"))));
}

}  // namespace
}  // namespace rondure::web
