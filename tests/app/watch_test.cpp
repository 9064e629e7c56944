// The live page of `rondure run --watch`: the real program on the first example without intervals,
// whose simulated machine is slowed down, asked over HTTP. What the page looks like:
// tests/browser/live.mjs.

#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cutting_proxy.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/app/watched_run.h"
#include "tests/record/sample_run.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Writes the plan into the folder of its run.
fs::path plan_in(const Scratch& folder) {
  write_plan(folder / "plan.json", {});
  return folder / "plan.json";
}

std::vector<std::string> run_words(const Scratch& folder, const std::string& speed,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"run",          plan_in(folder), "--out",
                                    folder / "run", "--watch",       "--archive",
                                    "none",         "--speed",       speed};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The journal of the same run without anybody watching.
const std::string& unwatched_bits() {
  static const std::string bits = [] {
    const Scratch folder;
    const Outcome outcome = rondure({"run", plan_in(folder), "--out", folder / "run", "--archive",
                                     "none", "--format", "json", "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return record::measured_bits(journal_of(folder / "run"));
  }();
  return bits;
}

/// Local addresses, in the hexadecimal of /proc, that listen at a port.
std::vector<std::string> listening_at(std::uint16_t port) {
  std::vector<std::string> out;
  const std::string wanted = fmt::format(":{:04X}", port);
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(table);
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string number, local, remote, state;
      words >> number >> local >> remote >> state;
      if (state == "0A" && local.ends_with(wanted))
        out.push_back(local.substr(0, local.size() - 5));
    }
  }
  return out;
}

TEST(Watch, ShowsTouchesPosesAndTimeThenTheVerdictAndChangesNoBit) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "150"));
  const json measuring = run.look_until("now", "Measuring");
  ASSERT_FALSE(measuring.is_null());
  EXPECT_THAT(measuring["head"], HasSubstr("SP-50-80"));
  const json drawn = run.look_until("drawing", "<svg");
  ASSERT_FALSE(drawn.is_null());
  EXPECT_THAT(std::string(drawn["drawing"]),
              AllOf(HasSubstr("class=\"polar\""), Not(HasSubstr(" style="))));
  EXPECT_THAT(std::string(drawn["now"]),
              AllOf(HasSubstr("f of this pose"), HasSubstr("Time left"), HasSubstr("of 159")));
  EXPECT_THAT(std::string(drawn["touches"]), HasSubstr("<td>measurement</td>"));
  EXPECT_THAT(std::string(drawn["decisions"]), HasSubstr("part located"));
  EXPECT_EQ(listening_at(run.port()), std::vector<std::string>{"0100007F"}) << "127.0.0.1 only";
  const json over = run.look_until("result", "Conforms");
  ASSERT_FALSE(over.is_null());
  EXPECT_TRUE(over["ended"]);
  EXPECT_THAT(std::string(over["now"]),
              AllOf(HasSubstr("Run finished"), HasSubstr(folder / "run")));
  const Outcome outcome = run.program().wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(record::measured_bits(journal_of(folder / "run")), unwatched_bits());
}

TEST(Watch, WithoutControlServesAPageThatLoadsNothingFromElsewhereAndStopsNothing) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "200"));
  const Answer page = run.ask("GET", "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.policy, AllOf(HasSubstr("default-src 'none'"), HasSubstr("script-src 'self'"),
                                 HasSubstr("frame-ancestors 'none'")));
  EXPECT_EQ(page.cache, "no-store");
  EXPECT_THAT(page.body, AllOf(Not(HasSubstr("http")), Not(HasSubstr("<button")),
                               HasSubstr("aria-live=\"polite\"")));
  for (const char* part : {"/live.css", "/live.js"}) {
    const Answer answer = run.ask("GET", part);
    EXPECT_EQ(answer.status, 200) << part;
    EXPECT_THAT(answer.body, Not(HasSubstr("http"))) << part;
  }
  EXPECT_EQ(run.ask("GET", "/journal.db").status, 404);
  EXPECT_EQ(run.ask("GET", "/../../etc/passwd").status, 404);
  EXPECT_EQ(run.token(), "");
  EXPECT_EQ(run.ask("POST", "/stop", run.right_heads(), "{}").status, 403);
  EXPECT_EQ(run.ask("GET", "/stop").status, 405);
  EXPECT_EQ(run.program().wait().status, 0);
}

/// One header of the right ones with another value; an empty one is left out.
std::vector<Head> with(std::vector<Head> heads, const std::string& name, const std::string& value) {
  std::erase_if(heads, [&](const Head& head) { return head.name == name; });
  if (!value.empty()) heads.push_back({name, value});
  return heads;
}

void expect_all_refused(const WatchedRun& run) {
  const auto right = run.right_heads();
  const std::string other_port = fmt::format("127.0.0.1:{}", run.port() ^ 1);
  const std::vector<std::pair<int, std::vector<Head>>> wrong = {
      {403, with(right, "X-Rondure-Token", "")},
      {403, with(right, "X-Rondure-Token", std::string(32, '0'))},
      {403, with(right, "X-Rondure-Token", run.token().substr(1))},
      {403, with(right, "X-Rondure-Token", run.token() + "0")},
      {403, with(right, "Origin", "")},
      {403, with(right, "Origin", "null")},
      {403, with(right, "Origin", "http://evil.example")},
      {403, with(right, "Origin", "http://" + other_port)},
      {403, with(right, "Origin", "https://127.0.0.1:" + std::to_string(run.port()))},
      {403, with(right, "Host", "evil.example")},
      {403, with(right, "Host", fmt::format("evil.example:{}", run.port()))},
      {403, with(right, "Host", other_port)},
      {403, with(right, "Sec-Fetch-Site", "cross-site")},
      {415, with(right, "Content-Type", "text/plain")},
      {415, with(right, "Content-Type", "application/x-www-form-urlencoded")},
  };
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_EQ(run.ask("POST", "/stop", wrong[i].second, "{}").status, wrong[i].first) << i;
  }
  EXPECT_EQ(run.ask("GET", "/stop", right).status, 405);
  EXPECT_EQ(run.ask("PUT", "/stop", right, "{}").status, 404);
  EXPECT_EQ(run.ask("DELETE", "/stop", right).status, 404);
  EXPECT_EQ(run.ask("POST", "/", right, "{}").status, 404);
  EXPECT_EQ(run.ask("POST", "/stop", right, std::string(5000, ' ')).status, 413);
  EXPECT_EQ(run.ask("GET", "/", {{"Host", "evil.example"}}).status, 403) << "DNS rebinding";
}

TEST(Watch, StopsTheRunForItsOwnPageOnlyAndTheRunGoesOnToTheSameBits) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "60", {"--control"}));
  EXPECT_EQ(run.token().size(), 32U);
  EXPECT_THAT(run.ask("GET", "/").body,
              AllOf(HasSubstr("id=\"stop\""), Not(HasSubstr(run.token()))))
      << "only the address has it";
  expect_all_refused(run);
  const json measuring = run.look_until("now", "Measuring");
  ASSERT_FALSE(measuring.is_null()) << "refused requests stop nothing";
  EXPECT_EQ(run.ask("POST", "/stop", run.right_heads(), "{}").status, 200);
  const json over = run.look_until("now", "Run stopped");
  ASSERT_FALSE(over.is_null());
  EXPECT_THAT(std::string(over["result"]), HasSubstr("did not finish"));
  const Outcome stopped = run.program().wait();
  EXPECT_EQ(stopped.status, 3);
  EXPECT_THAT(stopped.err, AllOf(HasSubstr("stopped by the operator"), HasSubstr("--resume")));
  EXPECT_EQ(journal_of(folder / "run").ending, "stopped");
  const Outcome resumed = rondure({"run", folder / "run", "--resume", "--archive", "none"});
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(record::measured_bits(journal_of(folder / "run")), unwatched_bits());
}

TEST(Watch, BearsManyClientsAndThoseThatHangUpOrReadSlowly) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "100"));
  std::vector<int> silent;  // connect and say nothing, or ask and do not read
  for (int i = 0; i < 4; ++i) silent.push_back(connect_to(run.port()));
  const std::string request =
      fmt::format("GET /live.css HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", run.port());
  for (const int fd : {silent[2], silent[3]}) {
    EXPECT_EQ(::send(fd, request.data(), request.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(request.size()));
  }
  for (int i = 0; i < 50; ++i) {  // hang up at once
    const int fd = connect_to(run.port());
    if (fd >= 0) (void)::send(fd, request.data(), request.size() / 2, MSG_NOSIGNAL);
    if (fd >= 0) ::close(fd);
  }
  std::atomic<int> answered = 0;
  std::vector<std::thread> clients;
  for (int c = 0; c < 5; ++c) {
    clients.emplace_back([&run, &answered, c] {
      for (int i = 0; i < 200; ++i) {
        const json frame = run.look(0, "client" + std::to_string(c));
        if (frame.is_object() && frame["parts"].is_object()) ++answered;
      }
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(answered, 1000);
  EXPECT_FALSE(run.look_until("result", "Conforms").is_null());
  EXPECT_EQ(run.program().wait().status, 0);
  for (const int fd : silent) ::close(fd);
  EXPECT_EQ(record::measured_bits(journal_of(folder / "run")), unwatched_bits());
}

/// Programs started meanwhile may have so many files open.
class FewFiles {
 public:
  explicit FewFiles(rlim_t most) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit few{most, before_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  }
  ~FewFiles() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  FewFiles(const FewFiles&) = delete;
  FewFiles& operator=(const FewFiles&) = delete;

 private:
  rlimit before_{};
};

/// Of connections on which nothing was said, those that the other side has closed; so early, some
/// of them, that they never were (-1).
int closed_of(const std::vector<int>& connections) {
  int out = 0;
  for (const int fd : connections) {
    char byte = 0;
    const ssize_t got = ::recv(fd, &byte, 1, MSG_DONTWAIT);
    if (fd < 0 || got == 0 || (got < 0 && errno == ECONNRESET)) ++out;
  }
  return out;
}

TEST(Watch, EndsWellThoughSilentConnectionsOutnumberTheFilesItMayOpen) {
  const Scratch folder;
  auto run = [&] {
    const FewFiles few(128);
    return std::make_unique<WatchedRun>(run_words(folder, "100"));
  }();
  constexpr int kSilent = 400;
  constexpr int kKept = 8 + 64;  // by the threads, and waiting for them
  std::vector<int> silent;
  for (int i = 0; i < kSilent; ++i) silent.push_back(connect_to(run->port()));
  EXPECT_LT(std::count(silent.begin(), silent.end(), -1), kSilent / 4) << "they reach the program";
  int closed = 0;
  for (int i = 0; i < 4000 && closed < kSilent - kKept; ++i) {
    closed = closed_of(silent);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GE(closed, kSilent - kKept) << "at once, not eight every two seconds";
  const Outcome outcome = run->program().wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const int fd : silent) {
    if (fd >= 0) ::close(fd);
  }
  EXPECT_EQ(record::measured_bits(journal_of(folder / "run")), unwatched_bits());
}

/// What the program takes of an endless request: bytes until it hangs up, and its first words.
std::pair<std::size_t, std::string> taken_of(std::uint16_t port, const std::string& head,
                                             const std::string& more) {
  const int fd = connect_to(port);
  const timeval patience{5, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::size_t taken = 0;
  constexpr std::size_t kEnough = 200'000'000;
  ssize_t sent = ::send(fd, head.data(), head.size(), MSG_NOSIGNAL);
  while (sent > 0 && taken < kEnough) {
    sent = ::send(fd, more.data(), more.size(), MSG_NOSIGNAL);
    if (sent > 0) taken += static_cast<std::size_t>(sent);
  }
  std::array<char, 32> answer{};
  const ssize_t got = ::recv(fd, answer.data(), answer.size(), 0);
  ::close(fd);
  return {taken, std::string(answer.data(), got > 0 ? static_cast<std::size_t>(got) : 0)};
}

TEST(Watch, TakesNoBodyInChunksAndNoEndlessHead) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "30", {"--control"}));
  const std::string host = fmt::format("Host: 127.0.0.1:{}\r\n", run.port());
  auto chunked = run.right_heads();
  chunked.push_back({"Transfer-Encoding", "chunked"});
  EXPECT_EQ(run.ask("POST", "/stop", chunked, "2\r\n{}\r\n0\r\n\r\n").status, 411);
  constexpr std::size_t kBuffers = 20'000'000;  // what the system holds between the two
  const auto body =
      taken_of(run.port(), "POST /stop HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n",
               "100000\r\n" + std::string(0x100000, 'x') + "\r\n");
  EXPECT_LT(body.first, kBuffers);
  const auto head = taken_of(run.port(), "GET / HTTP/1.1\r\n" + host, "a: b\r\nc: d\r\n");
  EXPECT_LT(head.first, kBuffers);
  EXPECT_FALSE(run.look_until("now", "Measuring").is_null()) << "and goes on answering";
  EXPECT_EQ(run.ask("POST", "/stop", run.right_heads(), "{}").status, 200);
  EXPECT_EQ(run.program().wait().status, 3);
}

TEST(Watch, EndsSoonThoughABrowserWasKilledOrNeverReads) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "300"));
  EXPECT_FALSE(run.look_until("now", "Measuring").is_null());  // and never asks again
  const int silent = connect_to(run.port());
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run.program().wait().status, 0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  ::close(silent);
}

TEST(Watch, ShowsAFaultAndEndsAsTheRunDoes) {
  const Scratch folder;
  write_plan(folder / "plan.json", {{"/simulation/faults", {{"connection_lost_at_touch", 60}}}});
  WatchedRun run(
      {"run", folder / "plan.json", "--out", folder / "run", "--watch", "--speed", "150"});
  const json over = run.look_until("now", "ended by a fault");
  ASSERT_FALSE(over.is_null());
  EXPECT_THAT(std::string(over["result"]), HasSubstr("did not finish"));
  EXPECT_EQ(run.program().wait().status, 3);
  EXPECT_EQ(journal_of(folder / "run").touches.size(), 59U);
}

TEST(Watch, ShowsThatTheReportsCouldNotBeWritten) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "150"));
  ASSERT_FALSE(run.look_until("now", "Measuring").is_null());
  std::filesystem::create_directories(folder / "run" / "report.html" / "in the way");
  const json over = run.look_until("now", "report.html");
  ASSERT_FALSE(over.is_null());
  EXPECT_TRUE(over["ended"]);
  const Outcome outcome = run.program().wait();
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("the measurement is kept"));
}

TEST(Watch, KeepsHostileTextsText) {
  const Scratch folder;
  const std::string evil = "<script>alert(1)</script><img src=x onerror=alert(2)>\"'&";
  write_plan(folder / "plan.json",
             {{"/part/id", evil}, {"/plan/name", evil}, {"/features/0/id", evil}});
  WatchedRun run({"run", folder / "plan.json", "--out", folder / "run", "--watch", "--speed", "500",
                  "--serial", evil, "--operator", evil});
  const json over = run.look_until("result", "onforms");
  ASSERT_FALSE(over.is_null());
  EXPECT_THAT(over.dump(), AllOf(HasSubstr("&lt;script&gt;"), Not(HasSubstr("<script")),
                                 Not(HasSubstr("<img"))));
  EXPECT_EQ(run.program().wait().status, 0);
}

TEST(Watch, SaysWhatToDoAboutAPortInUseBeforeAnythingMoves) {
  const Scratch folder;
  WatchedRun run(run_words(folder, "100"));
  const Outcome second = rondure({"run", folder / "plan.json", "--out", folder / "second",
                                  "--watch=" + std::to_string(run.port())});
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.err, AllOf(HasSubstr(std::to_string(run.port())), HasSubstr("in use"),
                                HasSubstr("--watch=PORT")));
  EXPECT_FALSE(std::filesystem::exists(folder / "second"));
  EXPECT_EQ(run.program().wait().status, 0);
}

TEST(Watch, ServesAtThePortThatWasAskedForAlsoWithPipedOutput) {
  const Scratch folder;
  const std::uint16_t port = free_port();
  WatchedRun run({"run", plan_in(folder), "--out", folder / "run", "--archive", "none", "--quiet",
                  "--watch=" + std::to_string(port), "--speed", "1000"});
  EXPECT_EQ(run.port(), port);
  const Outcome outcome = run.program().wait();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "") << "the page is told on standard error";
}

TEST(Watch, RefusesArgumentsThatMeanNothing) {
  const std::string plan = example("01_spool_simulated.json");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", plan, "--control"},
        {"run", plan, "--watch=0"},
        {"run", plan, "--watch=65536"},
        {"run", plan, "--watch=x"},
        {"run", plan, "--speed", "0"},
        {"run", example("02_spool_over_ippdme.json"), "--speed", "2"}}) {
    EXPECT_EQ(rondure(words).status, 2) << words.back();
  }
}

}  // namespace
}  // namespace rondure::app::testing
