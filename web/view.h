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
  bool control = false;    ///< With a button that stops the run.
  /// Prediction of the plan for the time left; may be empty.
  std::vector<PredictedStage> stages;
  /// Action of the button, as Ctrl-C: sets a flag that the run polls. Called from another thread
  /// and more than once. Only with `control`.
  std::function<void()> stop;
  reports::Language language = reports::Language::kEnglish;  ///< Of the page.
};

/// A page at http://127.0.0.1 that shows a run while it is measured: touches, poses, f, time left,
/// the drawings of the report, then the verdict. It commands nothing.
///
/// The run writes into a GrowingRecord and waits for nobody: evaluation and drawing of a frame
/// happen in a thread of this object that yields the processor, at most five times a second, a
/// fifth of the time, and only while somebody looks. See docs/live.md for what guards the button.
class LiveView {
 public:
  /// @return  kFile when the port is in use.
  [[nodiscard]] static core::Result<std::unique_ptr<LiveView>> start(
      LiveOptions options, std::shared_ptr<const record::GrowingRecord> source);
  /// Serves the last frame until the pages that are open have it, 1.5 s at most; ends.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Where the page is. With control this holds the token, behind "#", which browsers do not send.
  [[nodiscard]] std::string url() const;

  /// The run is over: the pages show its result from now on.
  /// @param report  Where the report stands; may be empty.
  void show_result(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                   std::string_view report);
  /// The run is over and has no result.
  void show_failure(std::string_view why);

 private:
  class Impl;
  explicit LiveView(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rondure::web
