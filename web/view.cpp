#include "web/view.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "web/internal/frame.h"
#include "web/internal/server.h"
#include "web/page.h"

namespace rondure::web {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr auto kLeastPause = milliseconds(200);  ///< Five frames a second at most.
constexpr int kShare = 4;  ///< Ratio of a pause to the preceding drawing time.
/// A page counts as open for this time after a request.
constexpr auto kLooking = milliseconds(3000);
constexpr auto kLastWord = milliseconds(1500);  ///< Time for the pages to fetch the last frame.
constexpr std::size_t kMostClients = 64;

}  // namespace

/// Three kinds of threads use this object: the run (show_...), the painter, the server's.
class LiveView::Impl {
 public:
  Impl(LiveOptions options, std::shared_ptr<const record::GrowingRecord> source)
      : painter_(std::move(source), std::move(options.stages), options.language),
        language_(options.language),
        stop_(std::move(options.stop)),
        session_(random_token()) {}

  core::Result<void> start(std::uint16_t port, bool control) {
    LiveGate gate;
    gate.control = control;
    if (control) gate.token = random_token();
    if (session_.empty() || (control && gate.token.empty()))
      return core::fail(core::Code::kFile, "the system gives no random numbers for the live page");
    const reports::LanguageScope scope(language_);
    TRY(server_, LiveServer::start(port, std::move(gate), live_page(control),
                                   {[this](std::uint64_t since, const std::string& client) {
                                      return state(since, client);
                                    },
                                    [this] {
                                      if (stop_) stop_();
                                    }}));
    thread_ = std::thread([this] { paint(); });
    return {};
  }

  ~Impl() {
    end_painting();
    wait_for_readers();
  }

  [[nodiscard]] std::string url() const {
    const LiveGate& gate = server_->gate();
    const std::string page = fmt::format("http://127.0.0.1:{}/", gate.port);
    return gate.control ? page + "#token=" + gate.token : page;
  }

  /// Ends the painter's thread and paints the last frame in the thread of the caller.
  template <class Paint>
  void show_last(const Paint& paint_last) {
    end_painting();
    auto last = paint_last(painter_);
    const std::lock_guard lock(mutex_);
    frame_ = std::move(last);
  }

 private:
  void end_painting() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
      wake_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
  }

  /// Called from the server's threads.
  std::string state(std::uint64_t since, const std::string& client) {
    std::shared_ptr<const LiveFrame> frame;
    {
      const std::lock_guard lock(mutex_);
      looked_ = Clock::now();
      if (clients_.size() < kMostClients || clients_.count(client) == 1)
        clients_[client] = {looked_, frame_->ended};
      frame = frame_;
      wake_.notify_all();
    }
    return answer_of(*frame, session_, since);
  }

  /// Function of the painter's thread.
  void paint() {
    constexpr int kYield = 10;
    ::setpriority(PRIO_PROCESS, 0, kYield);  // for this thread
    std::unique_lock lock(mutex_);
    while (!ending_) {
      if (Clock::now() - looked_ > kLooking) {
        wake_.wait(lock);
        continue;
      }
      lock.unlock();
      const auto begin = Clock::now();
      auto frame = painter_.paint(std::chrono::duration<double>(begin - start_).count());
      const auto pause = std::max<Clock::duration>(kLeastPause, kShare * (Clock::now() - begin));
      lock.lock();
      frame_ = std::move(frame);
      wake_.wait_for(lock, pause, [this] { return ending_; });
    }
  }

  /// Waits until every open page has the last frame.
  void wait_for_readers() {
    const auto until = Clock::now() + kLastWord;
    const auto waits = [&] {
      return std::any_of(clients_.begin(), clients_.end(), [&](const auto& client) {
        return !client.second.has_last && until - client.second.asked < kLooking;
      });
    };
    std::unique_lock lock(mutex_);
    while (frame_->ended && waits() && Clock::now() < until) wake_.wait_until(lock, until);
  }

  struct Client {
    Clock::time_point asked;
    bool has_last = false;
  };

  LivePainter painter_;  ///< Used by its own thread; after that has ended, by the run's.
  reports::Language language_;
  std::function<void()> stop_;
  std::string session_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;  ///< Guards the members below, up to thread_.
  std::condition_variable wake_;
  std::shared_ptr<const LiveFrame> frame_ = std::make_shared<const LiveFrame>();
  Clock::time_point looked_ = start_ - 2 * kLooking;
  std::map<std::string, Client> clients_;
  bool ending_ = false;
  std::thread thread_;
  std::unique_ptr<LiveServer> server_;  ///< Last member: destroyed first, with its threads.
};

LiveView::LiveView(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LiveView::~LiveView() = default;

core::Result<std::unique_ptr<LiveView>> LiveView::start(
    LiveOptions options, std::shared_ptr<const record::GrowingRecord> source) {
  const std::uint16_t port = options.port;
  const bool control = options.control;
  auto impl = std::make_unique<Impl>(std::move(options), std::move(source));
  TRY_DO(impl->start(port, control));
  return std::unique_ptr<LiveView>(new LiveView(std::move(impl)));
}

std::string LiveView::url() const { return impl_->url(); }

void LiveView::show_result(const record::RunRecord& record,
                           const evaluation::Evaluation& evaluation, std::string_view report) {
  impl_->show_last(
      [&](LivePainter& painter) { return painter.paint_result(record, evaluation, report); });
}

void LiveView::show_failure(std::string_view why) {
  impl_->show_last([&](LivePainter& painter) { return painter.paint_failure(why); });
}

}  // namespace rondure::web
