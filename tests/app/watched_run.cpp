#include "tests/app/watched_run.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <httplib.h>

namespace rondure::app::testing {

using nlohmann::json;

WatchedRun::WatchedRun(const std::vector<std::string>& arguments, const Surroundings& surroundings)
    : program_(arguments, surroundings) {
  const std::string before = "http://127.0.0.1:";
  for (int i = 0; i < 60'000; ++i) {
    const std::string told = program_.told();
    const std::size_t at = told.find(before);
    if (at != std::string::npos && told.find('\n', at) != std::string::npos) {
      const std::string url = told.substr(at, told.find(' ', at) - at);
      port_ = static_cast<std::uint16_t>(std::stoi(url.substr(before.size())));
      const std::size_t mark = url.find("#token=");
      if (mark != std::string::npos) token_ = url.substr(mark + 7);
      return;
    }
    if (program_.ended()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ADD_FAILURE() << "no page: " << program_.told();
}

std::string WatchedRun::origin() const { return fmt::format("http://127.0.0.1:{}", port_); }

std::vector<Head> WatchedRun::right_heads() const {
  return {{"Origin", origin()},
          {"Content-Type", "application/json"},
          {"Sec-Fetch-Site", "same-origin"},
          {"X-Rondure-Token", token_}};
}

Answer WatchedRun::ask(const std::string& method, const std::string& path,
                       const std::vector<Head>& heads, const std::string& body) const {
  httplib::Client client("127.0.0.1", port_);
  client.set_connection_timeout(60);
  client.set_read_timeout(60);
  httplib::Request request;
  request.method = method;
  request.path = path;
  for (const Head& head : heads) request.headers.emplace(head.name, head.value);
  request.body = body;
  const auto result = client.send(request);
  if (!result) return {};
  return {result->status, result->get_header_value("Content-Type"),
          result->get_header_value("Content-Security-Policy"),
          result->get_header_value("Cache-Control"), result->body};
}

json WatchedRun::look(std::uint64_t since, const std::string& client) const {
  const Answer answer = ask("GET", fmt::format("/live?since={}&client={}", since, client));
  if (answer.status != 200) return nullptr;
  return json::parse(answer.body, nullptr, false);
}

json WatchedRun::look_until(const std::string& part, const std::string& text) const {
  json all = json::object();
  std::uint64_t since = 0;
  for (int i = 0; i < 15'000; ++i) {
    const json frame = look(since);
    if (frame.is_null()) return nullptr;
    since = frame["version"];
    all["ended"] = frame["ended"];
    for (const auto& [id, html] : frame["parts"].items()) all[id] = html;
    if (all.value(part, std::string()).find(text) != std::string::npos) return all;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return nullptr;
}

int connect_to(std::uint16_t port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  ::close(fd);
  return -1;
}

}  // namespace rondure::app::testing
