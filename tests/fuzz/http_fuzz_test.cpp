// Damaged requests to the live page, each over a connection of its own.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/fuzz/cases.h"
#include "tests/fuzz/mutation.h"
#include "web/internal/server.h"
#include "web/page.h"

namespace rondure::fuzz {
namespace {

/// What the page's server answers to these bytes; all of it, until it closes.
std::string answer_to(std::uint16_t port, const std::string& bytes) {
  const int line = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string out;
  if (::connect(line, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    ::close(line);
    return "no connection";
  }
  for (std::size_t sent = 0; sent < bytes.size();) {
    const auto now = ::send(line, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now <= 0) break;  // it may have answered before it read all
    sent += static_cast<std::size_t>(now);
  }
  ::shutdown(line, SHUT_WR);
  std::array<char, 4096> part{};
  for (ssize_t had = 0; (had = ::recv(line, part.data(), part.size(), 0)) > 0;) {
    out.append(part.data(), static_cast<std::size_t>(had));
  }
  ::close(line);
  return out;
}

class HttpFuzz : public ::testing::Test {
 protected:
  void SetUp() override {
    web::LiveGate gate;
    gate.control = true;
    gate.token = "0123456789abcdef0123456789abcdef";
    auto started = web::LiveServer::start(
        0, gate, web::live_page(true),
        {[](std::uint64_t since, const std::string& client) {
           return fmt::format("{{\"version\": {}, \"client\": {}}}", since, client.size());
         },
         [this] { ++stops; }});
    ASSERT_TRUE(started) << started.error().what;
    server = *std::move(started);
    const std::uint16_t port = server->gate().port;
    const std::string host = fmt::format("Host: 127.0.0.1:{}\r\n", port);
    // No seed knows the token: no damage of them may stop the run.
    const std::string post =
        "POST /stop HTTP/1.1\r\n" + host + fmt::format("Origin: http://127.0.0.1:{}\r\n", port) +
        "Content-Type: application/json\r\nX-Rondure-Token: 0123456789abcdef0123456789abcdee\r\n";
    requests = {
        "GET / HTTP/1.1\r\n" + host + "\r\n",
        "GET /live?since=3&client=abc HTTP/1.1\r\n" + host + "Accept-Encoding: gzip\r\n\r\n",
        "HEAD /live.js HTTP/1.0\r\n" + host + "Range: bytes=0-10,5-7\r\n\r\n",
        post + "Content-Length: 2\r\n\r\n{}",
        post + "Transfer-Encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n",
        post +
            "Content-Type: multipart/form-data; boundary=x\r\nContent-Length: 60\r\n\r\n--x\r\n"
            "Content-Disposition: form-data; name=\"a\"\r\n\r\n1\r\n--x--\r\n",
        "POST /stop HTTP/1.1\r\n" + host +
            "Content-Type: application/x-www-form-urlencoded\r\n"
            "Content-Encoding: gzip\r\nContent-Length: 7\r\n\r\na=1&b=2"};
  }

  /// "" or what is wrong with the answer to a request.
  [[nodiscard]] std::string wrong_with_request(const std::string& bytes) const {
    const std::string answer = answer_to(server->gate().port, bytes);
    if (!answer.empty() && !answer.starts_with("HTTP/1.")) return "answered " + answer;
    return stops == 0 ? "" : "it stopped the run";
  }
  void expect_still_answers() const {
    EXPECT_TRUE(answer_to(server->gate().port, requests.front()).starts_with("HTTP/1.1 200"));
  }

  std::atomic<int> stops = 0;
  std::unique_ptr<web::LiveServer> server;
  std::vector<std::string> requests;  ///< Good ones of every kind.
};

TEST_F(HttpFuzz, NoDamagedRequestUpsetsTheLivePage) {
  const std::vector<std::string> words = {"\r\n",
                                          "\n",
                                          "\r\n\r\n",
                                          "%00",
                                          "%",
                                          "%ff",
                                          "%u12",
                                          "../",
                                          "HTTP/1.1",
                                          "GET ",
                                          "OPTIONS ",
                                          "CONNECT ",
                                          "Content-Length: 99999999999999999999\r\n",
                                          "Content-Length: -1\r\n",
                                          "Transfer-Encoding: chunked\r\n",
                                          "ffffffffffffffff\r\n",
                                          "Expect: 100-continue\r\n",
                                          "Connection: keep-alive\r\n",
                                          "Range: bytes=-1\r\n",
                                          "Range: bytes=5-2,9-\r\n",
                                          ":",
                                          "Upgrade: h2c\r\n",
                                          std::string(9000, 'a'),
                                          std::string(1, '\0'),
                                          "\xff",
                                          "?",
                                          "&",
                                          "=",
                                          "#",
                                          "since=99999999999999999999999",
                                          "Host: evil\r\n",
                                          "\t",
                                          " ",
                                          "deflate",
                                          "br",
                                          "Content-Encoding: br\r\n",
                                          "boundary=\"\""};
  const Mutation mutation(requests, words);
  try_cases({600, 100'000},
            [&](unsigned seed) { return wrong_with_request(mutation.input(seed)); });
  expect_still_answers();
}

TEST_F(HttpFuzz, NoRequestThatEndsTooEarlyUpsetsTheLivePage) {
  for (const std::string& request : requests) {
    for (std::size_t size = 0; size < request.size(); ++size) {
      ASSERT_EQ(wrong_with_request(request.substr(0, size)), "") << request.substr(0, size);
    }
  }
  expect_still_answers();
}

}  // namespace
}  // namespace rondure::fuzz
