#include "cmm/ipp_server/service.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ideal_backend.h"
#include "tests/core/scratch.h"

namespace rondure::cmm::ipp {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A server on a free port of this computer, until the end of the test.
class Service {
 public:
  explicit Service(const std::filesystem::path& wire_log = {}, double speed = 1e6,
                   milliseconds silence_limit = milliseconds(60'000))
      : listener_(open()), server_(backend_, with_speed(speed)) {
    ServiceOptions options;
    options.stop_requested = [this] { return stop_.load(); };
    options.tell = [](std::string_view) {};
    options.wire_log = wire_log;
    options.silence_limit = silence_limit;
    thread_ = std::thread([this, options] { result_ = serve(listener_, server_, options); });
  }
  ~Service() { end(); }

  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] std::unique_ptr<wire::LineTransport> connect() {
    auto line = wire::connect_tcp("127.0.0.1", listener_.port());
    EXPECT_TRUE(line.has_value());
    return line ? std::move(*line) : nullptr;
  }
  [[nodiscard]] const core::Result<void>& result() const { return result_; }

 private:
  static wire::TcpListener open() {
    wire::TcpOptions limits;
    limits.max_line_bytes = 2 * kMaxLineLength;
    return std::move(*wire::TcpListener::open("127.0.0.1", 0, limits));
  }
  static ServerOptions with_speed(double speed) {
    ServerOptions options;
    options.speed = speed;
    return options;
  }

  IdealBackend backend_;
  wire::TcpListener listener_;
  Server server_;
  std::atomic<bool> stop_ = false;
  core::Result<void> result_;
  std::thread thread_;
};

/// The next line; "" when none came or the connection ended.
std::string next(wire::LineTransport& line) {
  const auto read = line.read_line(milliseconds(60'000));
  return read && *read ? (*read)->text : std::string();
}

/// Sends a command and reads to its end.
std::vector<std::string> ask(wire::LineTransport& line, const std::string& command) {
  std::vector<std::string> out;
  if (!line.write_line(command)) return out;
  do {
    out.push_back(next(line));
  } while (!out.back().empty() && !out.back().ends_with(" %"));
  return out;
}

TEST(IppService, AnswersOverTheSocket) {
  Service service;
  const auto client = service.connect();
  EXPECT_THAT(ask(*client, "00001 StartSession()"), ::testing::ElementsAre("00001 &", "00001 %"));
  EXPECT_THAT(ask(*client, "00002 GetDMEVersion()"),
              ::testing::ElementsAre("00002 &", "00002 # DMEVersion(\"1.4\")", "00002 %"));
}

TEST(IppService, SendsASecondClientAwayAndTakesTheNextOneLater) {
  Service service;
  auto first = service.connect();
  ask(*first, "00001 StartSession()");
  const auto second = service.connect();
  EXPECT_THAT(next(*second), AllOf(HasSubstr("this server has a client already, 127.0.0.1:"),
                                   HasSubstr("another one after 60 s of silence")));
  EXPECT_EQ(next(*second), "");
  EXPECT_FALSE(second->is_open());
  EXPECT_EQ(ask(*first, "00002 IsHomed()").size(), 3U);  // the first one is not disturbed
  first->close();
  const auto third = service.connect();
  EXPECT_THAT(ask(*third, "00001 IsHomed()").at(1), HasSubstr("0008"));  // no session of the first
  EXPECT_EQ(ask(*third, "00002 StartSession()").size(), 2U);
}

TEST(IppService, ASilentClientLosesItsPlaceToTheNextOneAndIsToldWhy) {
  Service service({}, 1e6, milliseconds(50));
  const auto first = service.connect();
  ask(*first, "00001 StartSession()");
  std::unique_ptr<wire::LineTransport> second;
  std::vector<std::string> answer;
  do {
    second = service.connect();
    answer = ask(*second, "00001 StartSession()");
  } while (answer.front().find("another one after 0.05 s of silence") != std::string::npos);
  EXPECT_THAT(answer, ::testing::ElementsAre("00001 &", "00001 %"));
  EXPECT_THAT(next(*first), HasSubstr("another client takes its place"));
  EXPECT_EQ(next(*first), "");
  EXPECT_FALSE(first->is_open());
}

TEST(IppService, AClientWhoseMotionLastsKeepsItsPlace) {
  Service service({}, 1.0, milliseconds(300));
  const auto first = service.connect();
  ask(*first, "00001 StartSession()");
  ask(*first, "00002 Home()");
  ASSERT_TRUE(first->write_line("00003 GoTo(X(15000))"));  // 150 s at 100 mm/s
  EXPECT_EQ(next(*first), "00003 &");
  std::this_thread::sleep_for(milliseconds(700));
  const auto second = service.connect();
  EXPECT_THAT(next(*second), HasSubstr("this server has a client already"));
  EXPECT_THAT(ask(*first, "E0001 AbortE()"), Contains(StartsWith("00003 ")));
}

TEST(IppService, SurvivesGarbageAndALineThatNeverEnds) {
  Service service;
  {
    const auto client = service.connect();
    ASSERT_TRUE(client->write_line("GET / HTTP/1.1"));
    EXPECT_THAT(next(*client), StartsWith("E0000 ! Error(2, 0001,"));
    ASSERT_TRUE(client->write_line(std::string(70'000, 'x')));
    EXPECT_THAT(next(*client), StartsWith("E0000 ! Error(3, 0008,"));
    const std::string block(1 << 20, 'x');
    for (int i = 0; i < 100 && client->write_line(block); ++i) continue;
    EXPECT_FALSE(client->is_open());
  }
  const auto client = service.connect();
  EXPECT_EQ(ask(*client, "00001 StartSession()").size(), 2U);
}

TEST(IppService, AMotionTakesItsTimeOnTheClock) {
  Service service({}, 2000.0);
  const auto client = service.connect();
  ask(*client, "00001 StartSession()");
  ask(*client, "00002 Home()");
  const auto before = std::chrono::steady_clock::now();
  ask(*client, "00003 GoTo(X(40000))");  // 400 s at 100 mm/s
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
  EXPECT_GE(took.count(), 0.2);
  EXPECT_LE(took.count(), 200.0);
}

TEST(IppService, TellsTheClientThatItEndsAndWritesEveryLineDown) {
  const test::Scratch folder;
  const std::filesystem::path log = folder / "wire";
  Service service(log);
  const auto client = service.connect();
  ask(*client, "00001 StartSession()");
  service.end();
  EXPECT_TRUE(service.result().has_value());
  EXPECT_THAT(next(*client), HasSubstr("0500"));
  EXPECT_EQ(next(*client), "");
  std::stringstream text;
  text << std::ifstream(log).rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("<- C: 00001 StartSession()"));
  EXPECT_THAT(text.str(), HasSubstr("-> S: 00001 %"));
  std::filesystem::remove(log);
}

}  // namespace
}  // namespace rondure::cmm::ipp
