#include "tests/fuzz/cases.h"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/core/full.h"
#include "tests/core/scratch.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

namespace rondure::fuzz {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
constexpr rlim_t kMemory_bytes = 1'000'000'000;
constexpr int kProcessor_s = kSanitized ? 100 : 10;
constexpr int kClock_s = 60 * kProcessor_s;  // others may be at work

/// What a signal handler says: it may not make a text of its own.
std::array<char, 512> g_repeat = {};

void say_repeat(const char* what) {
  if (g_repeat.front() == '\0') return;  // not in a case
  for (const char* text : {"\n", what, ": ", static_cast<const char*>(g_repeat.data()), "\n"}) {
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
  }
}

extern "C" void on_hang(int /*signal*/) {
  say_repeat("this case took too long");
  ::_exit(1);
}

#ifdef __SANITIZE_ADDRESS__
void on_death() { say_repeat("the sanitizer ended this case"); }
void watch_crashes() { __sanitizer_set_death_callback(on_death); }
#else
extern "C" void on_crash(int signal) {
  say_repeat("this case crashed");
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void watch_crashes() {
  static std::array<char, 65536> stack;  // a stack that overflowed has no room for the handler
  stack_t own{};
  own.ss_sp = stack.data();
  own.ss_size = stack.size();
  ::sigaltstack(&own, nullptr);
  struct sigaction action = {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    ::sigaction(signal, &action, nullptr);
  }
}
#endif

/// For one case: both clocks.
void wind_clocks(int processor_s, int clock_s) {
  itimerval processor{};
  processor.it_value.tv_sec = processor_s;
  ::setitimer(ITIMER_PROF, &processor, nullptr);
  ::alarm(static_cast<unsigned>(clock_s));
}

/// Watches over the cases of one test; the process is as before at its end.
class Watch {
 public:
  Watch() {
    std::signal(SIGPROF, on_hang);
    std::signal(SIGALRM, on_hang);
    watch_crashes();
    if (kSanitized) return;  // the shadow of the sanitizer is larger
    ::getrlimit(RLIMIT_DATA, &before_);
    const rlimit memory{std::min(kMemory_bytes, before_.rlim_max), before_.rlim_max};
    ::setrlimit(RLIMIT_DATA, &memory);
  }
  ~Watch() {
    wind_clocks(0, 0);
    g_repeat.front() = '\0';
    if (!kSanitized) ::setrlimit(RLIMIT_DATA, &before_);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  rlimit before_{};
};

std::string repeat_command(unsigned seed) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto program = std::filesystem::proximate(std::filesystem::read_symlink("/proc/self/exe"),
                                                  app::testing::source_dir());
  return fmt::format("RONDURE_FUZZ_SEED={} {} --gtest_filter={}.{}", seed, program.string(),
                     test->test_suite_name(), test->name());
}

std::string result_of(unsigned seed, const std::function<std::string(unsigned)>& try_case) {
  try {
    return try_case(seed);
  } catch (const std::exception& thrown) {
    return fmt::format("an exception came out: {}", thrown.what());
  }
}

bool memory_is_well() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return kSanitized || static_cast<rlim_t>(usage.ru_maxrss) * 1024 <= kMemory_bytes;
}

}  // namespace

void try_cases(const Counts& counts, const std::function<std::string(unsigned seed)>& try_case) {
  unsigned first = 0;
  auto count = static_cast<unsigned>(test::cases(static_cast<int>(counts.quick),
                                                 static_cast<int>(counts.full / 4),
                                                 static_cast<int>(counts.full)));
  if (kSanitized) count = count / 10 + 1;
  if (const char* only = std::getenv("RONDURE_FUZZ_SEED"); only != nullptr) {
    first = static_cast<unsigned>(std::strtoul(only, nullptr, 10));
    count = 1;
  }
  const Watch watch;
  for (unsigned seed = first; seed < first + count; ++seed) {
    const std::string repeat = repeat_command(seed);
    std::snprintf(g_repeat.data(), g_repeat.size(), "%s", repeat.c_str());
    wind_clocks(kProcessor_s, kClock_s);
    const std::string problem = result_of(seed, try_case);
    ASSERT_EQ(problem, "") << repeat;
    ASSERT_TRUE(memory_is_well()) << "more than 1 GB: " << repeat;
  }
}

const std::filesystem::path& work_folder() {
  static const test::Scratch folder;
  static const int set = ::setenv("TMPDIR", folder.path().c_str(), 1);
  (void)set;
  return folder.path();
}

}  // namespace rondure::fuzz
