#include "wire/tcp_line.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <chrono>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/wire/raw_socket.h"

namespace rondure::wire {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr milliseconds kTcpPatience(60'000);

/// A transport of this program and a bare socket at its other end.
struct Pair {
  std::unique_ptr<LineTransport> line;
  std::unique_ptr<RawSocket> raw;
};

Pair connected_pair(const TcpOptions& options = {}) {
  auto listener = TcpListener::open("127.0.0.1", 0, options);
  Pair out;
  out.raw = std::make_unique<RawSocket>(listener->port());
  out.line = *listener->accept(kTcpPatience);
  return out;
}

/// A line that must be there.
Line read(LineTransport& line) {
  auto got = line.read_line(kTcpPatience);
  if (!got || !*got) {
    ADD_FAILURE() << (got ? "nothing came" : got.error().what);
    return {};
  }
  return **got;
}

TEST(TcpLine, CarriesLinesBothWays) {
  auto listener = TcpListener::open("127.0.0.1", 0);
  ASSERT_TRUE(listener) << listener.error().what;
  auto client = connect_tcp("localhost", listener->port());
  ASSERT_TRUE(client) << client.error().what;
  auto server = listener->accept(kTcpPatience);
  ASSERT_TRUE(server && *server);
  ASSERT_TRUE((*client)->write_line("00001 StartSession()"));
  EXPECT_EQ(read(**server).text, "00001 StartSession()");
  ASSERT_TRUE((*server)->write_line("00001 &"));
  ASSERT_TRUE((*server)->write_line("00001 %"));
  EXPECT_EQ(read(**client).text, "00001 &");
  const Line last = read(**client);
  EXPECT_EQ(last.text, "00001 %");
  EXPECT_TRUE(last.crlf);
  EXPECT_EQ((*client)->peer(), "127.0.0.1:" + std::to_string(listener->port()));
}

TEST(TcpLine, GivesTheSameLinesHoweverTheBytesArrive) {
  const std::string bytes = "first\r\n\r\nbare\nwith \r inside\r\n";
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    Pair pair = connected_pair();
    std::thread sender([&] {
      for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t count = 1 + random() % 5;
        pair.raw->send(std::string_view(bytes).substr(at, count));
        at += count;
      }
    });
    EXPECT_EQ(read(*pair.line).text, "first");
    EXPECT_EQ(read(*pair.line).text, "");
    const Line bare = read(*pair.line);
    EXPECT_EQ(bare.text, "bare");
    EXPECT_FALSE(bare.crlf);
    EXPECT_EQ(read(*pair.line).text, "with \r inside");
    sender.join();
  }
}

TEST(TcpLine, KeepsAHalfLineWhenTheTimeLimitPasses) {
  Pair pair = connected_pair();
  pair.raw->send("00001 ");
  const auto start = std::chrono::steady_clock::now();
  const auto nothing = pair.line->read_line(milliseconds(30));
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(*nothing);
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(30));
  pair.raw->send("%\r\n");
  EXPECT_EQ(read(*pair.line).text, "00001 %");
}

TEST(TcpLine, SaysThatTheOtherSideClosed) {
  Pair pair = connected_pair();
  pair.raw->send("00001 &\r\n");
  pair.raw->close();
  EXPECT_EQ(read(*pair.line).text, "00001 &");  // what came before is not lost
  const auto gone = pair.line->read_line(kTcpPatience);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, core::Code::kMachine);
  EXPECT_THAT(gone.error().what, HasSubstr("closed the connection"));
  EXPECT_FALSE(pair.line->is_open());
  EXPECT_EQ(pair.line->read_line(kTcpPatience).error(), gone.error());
  EXPECT_EQ(pair.line->write_line("00002 EndSession()").error(), gone.error());
}

TEST(TcpLine, SaysThatTheOtherSideClosedInTheMiddleOfALine) {
  Pair pair = connected_pair();
  pair.raw->send("00001");
  pair.raw->close();
  const auto gone = pair.line->read_line(kTcpPatience);
  ASSERT_FALSE(gone);
  EXPECT_THAT(gone.error().what, HasSubstr("in the middle of a line, after 5 bytes"));
  EXPECT_EQ(pair.line->unfinished(), "00001");
}

TEST(TcpLine, EndsTheConnectionAtALineOfAHundredMegabytes) {
  Pair pair = connected_pair();
  std::size_t sent = 0;
  std::thread sender([&] {
    const std::string block(1 << 16, 'x');
    while (sent < 100'000'000 && pair.raw->send(block)) sent += block.size();
  });
  const auto refused = pair.line->read_line(kTcpPatience);
  sender.join();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("a line of more than 1048576 bytes"));
  EXPECT_FALSE(pair.line->is_open());
  EXPECT_LT(sent, 100'000'000U);  // the sender noticed
}

TEST(TcpLine, TakesALineAtItsLimitAndNoLongerOne) {
  TcpOptions options;
  options.max_line_bytes = 1000;
  Pair pair = connected_pair(options);
  pair.raw->send(std::string(999, 'a') + "\r\n");
  EXPECT_EQ(read(*pair.line).text.size(), 999U);
  pair.raw->send(std::string(1001, 'a') + "\r\n");
  EXPECT_FALSE(pair.line->read_line(kTcpPatience));
}

TEST(TcpLine, GivesUpWritingToWhoNeverReads) {
  TcpOptions options;
  options.write_limit = milliseconds(50);
  Pair pair = connected_pair(options);
  const std::string text(1 << 20, 'y');
  core::Result<void> written;
  for (int i = 0; i < 64 && written; ++i) written = pair.line->write_line(text);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().what, HasSubstr("takes no data for 0.05 s"));
}

TEST(ConnectTcp, SaysThatNobodyListens) {
  std::uint16_t port = 0;
  {
    auto listener = TcpListener::open("127.0.0.1", 0);
    port = listener->port();
  }
  const auto refused = connect_tcp("127.0.0.1", port);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kMachine);
  EXPECT_THAT(refused.error().what, HasSubstr("127.0.0.1:" + std::to_string(port)));
  EXPECT_THAT(refused.error().what, HasSubstr("check that the server runs"));
}

TEST(ConnectTcp, SaysThatTheComputerIsNotKnown) {
  const auto refused = connect_tcp("no such computer", 1294);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("no such computer is not known here"));
}

TEST(TcpListener, SaysWhyItCannotListen) {
  auto first = TcpListener::open("127.0.0.1", 0);
  ASSERT_TRUE(first);
  const auto second = TcpListener::open("127.0.0.1", first->port());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().what, HasSubstr("choose another port"));
  EXPECT_FALSE(TcpListener::open("not an address", 0));
}

TEST(TcpListener, ReportsNobodyWhenNobodyComes) {
  auto listener = TcpListener::open("127.0.0.1", 0);
  const auto nobody = listener->accept(milliseconds(20));
  ASSERT_TRUE(nobody);
  EXPECT_EQ(*nobody, nullptr);
  RawSocket late(listener->port());
  EXPECT_TRUE(late.connected());
  EXPECT_NE(*listener->accept(kTcpPatience), nullptr);
}

/// The socket of this program whose other end is that port; -1 when there is none.
int socket_to(std::uint16_t port) {
  for (int handle = 0; handle < 1024; ++handle) {
    sockaddr_in end = {};
    socklen_t size = sizeof(end);
    if (::getpeername(handle, reinterpret_cast<sockaddr*>(&end), &size) == 0 &&
        ntohs(end.sin_port) == port) {
      return handle;
    }
  }
  return -1;
}

int option_of(int handle, int level, int name) {
  int value = 0;
  socklen_t size = sizeof(value);
  EXPECT_EQ(::getsockopt(handle, level, name, &value, &size), 0);
  return value;
}

TEST(TcpLine, APeerThatDiesWithoutAWordIsNoticedWithinHalfAMinute) {
  auto listener = TcpListener::open("127.0.0.1", 0);
  const auto client = connect_tcp("127.0.0.1", listener->port());
  ASSERT_TRUE(client);
  const auto server = listener->accept(kTcpPatience);
  ASSERT_TRUE(server && *server);
  const std::string of_client = (*server)->peer();
  const auto client_port =
      static_cast<std::uint16_t>(std::stoi(of_client.substr(of_client.find(':') + 1)));
  for (const std::uint16_t port : {listener->port(), client_port}) {  // both sides
    const int handle = socket_to(port);
    ASSERT_GE(handle, 0);
    EXPECT_NE(option_of(handle, SOL_SOCKET, SO_KEEPALIVE), 0);
    const int noticed_s =
        option_of(handle, IPPROTO_TCP, TCP_KEEPIDLE) +
        option_of(handle, IPPROTO_TCP, TCP_KEEPCNT) * option_of(handle, IPPROTO_TCP, TCP_KEEPINTVL);
    EXPECT_LE(noticed_s, 30);
    EXPECT_GT(option_of(handle, IPPROTO_TCP, TCP_USER_TIMEOUT), 0);
    EXPECT_LE(option_of(handle, IPPROTO_TCP, TCP_USER_TIMEOUT), 30'000);
  }
}

}  // namespace
}  // namespace rondure::wire
