#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/growing_record.h"
#include "record/run_record.h"
#include "reports/words/language.h"
#include "web/time.h"

namespace rondure::web {

/// Settings of a live page.
struct LiveOptions {
  std::uint16_t port = 0;  ///< 0: any free one.
  bool control = false;    ///< Shows a button that stops the run.
  /// Prediction of the plan, for the time left; may be empty.
  std::vector<PredictedStage> stages;
  /// Action of the button, as for Ctrl-C: sets a flag that the run polls. Called from another
  /// thread, possibly more than once. Only with `control`.
  std::function<void()> stop;
  reports::Language language = reports::Language::kEnglish;  ///< Language of the page.
};

/// A page at http://127.0.0.1 that shows a run during the measurement: touches, poses, f, time
/// left, the drawings of the report, then the verdict. It gives no commands.
///
/// The run writes into a GrowingRecord and never waits: a thread of this object evaluates and draws
/// the frames. It yields the processor, runs at most five times a second and a fifth of the time,
/// and only while a page is open. docs/live.md explains the protection of the button.
class LiveView {
 public:
  /// @return  kFile when the port is in use.
  [[nodiscard]] static core::Result<std::unique_ptr<LiveView>> start(
      LiveOptions options, std::shared_ptr<const record::GrowingRecord> source);
  /// Serves the last frame until all open pages have it, for at most 1.5 s.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// URL of the page. With control it contains the token, after "#", which browsers do not send.
  [[nodiscard]] std::string url() const;

  /// Ends the live view: the pages show the result of the run from now on.
  /// @param report  Path of the report; may be empty.
  void show_result(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                   std::string_view report);
  /// Ends the live view of a run without a result.
  void show_failure(std::string_view why);

 private:
  class Impl;
  explicit LiveView(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rondure::web
