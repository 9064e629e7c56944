// What a touch costs on its way to the disk; prints the figures of docs/reliability.md.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "record/journal/journal.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int touches() { return std::getenv("RONDURE_FULL") != nullptr ? 2000 : 100; }

void print(const char* what, std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  std::printf("| %s | %zu | %.3f | %.3f | %.3f |\n", what, ms.size(), ms[ms.size() / 2],
              ms[ms.size() * 99 / 100], ms.back());
}

/// One page appended and flushed: what the disk itself takes.
std::vector<double> bare_flushes(const std::filesystem::path& file) {
  const std::string page(4096, 'x');
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  std::vector<double> ms;
  for (int i = 0; i < touches(); ++i) {
    const auto start = Clock::now();
    EXPECT_EQ(::write(fd, page.data(), page.size()), static_cast<ssize_t>(page.size()));
    EXPECT_EQ(::fsync(fd), 0);
    ms.push_back(ms_since(start));
  }
  ::close(fd);
  return ms;
}

TEST(JournalCost, OfATouchIsMostlyTheFlushOfTheDisk) {
  const Scratch scratch(Scratch::Where::kDisk);
  auto journal = Journal::create(scratch / "run", {}, {}, {});
  ASSERT_TRUE(journal);
  std::vector<double> single;
  for (int id = 0; id < touches(); ++id) {
    const auto start = Clock::now();
    ASSERT_TRUE(journal->add(touch_number(id)));
    single.push_back(ms_since(start));
  }
  constexpr int kLayer = 100;
  std::vector<double> batched;
  for (int first = touches(); first < 2 * touches(); first += kLayer) {
    std::vector<Touch> layer;
    for (int id = first; id < first + kLayer; ++id) layer.push_back(touch_number(id));
    const auto start = Clock::now();
    ASSERT_TRUE(journal->add(layer));
    batched.push_back(ms_since(start) / kLayer);
  }
  std::printf("| per touch | count | median ms | 99 %% ms | largest ms |\n");
  print("one commit a touch (the program)", single);
  print("one commit for 100 rows (points files)", batched);
  print("the disk alone: 4 kB appended and flushed", bare_flushes(scratch / "page"));
  EXPECT_EQ(read_journal(scratch / "run")->record.touches.size(),
            2 * static_cast<std::size_t>(touches()));
}

}  // namespace
}  // namespace rondure::record
