#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "record/growing_record.h"
#include "record/run_record.h"
#include "reports/words/language.h"
#include "web/time.h"

namespace rondure::web {

/// One part of the page: the HTML of the element with this id.
struct LivePart {
  std::string id;
  std::string html;
  std::uint64_t version = 0;  ///< Version of the frame in which it last changed.
};

/// The page at one moment. Immutable after it is returned.
struct LiveFrame {
  std::uint64_t version = 0;
  bool ended = false;  ///< The run is over and this page is its last.
  std::string title;   ///< Title of the window, plain text.
  std::vector<LivePart> parts;
};

/// Answer to a page that has version `since` of this session: the parts changed since then, as JSON
/// {"session", "version", "ended", "title", "parts": {id: html}}.
[[nodiscard]] std::string answer_of(const LiveFrame& frame, std::string_view session,
                                    std::uint64_t since);

/// Creates the frames of one run, one after the other, with the drawings of the report. For use by
/// one thread. A frame costs the fits of one cloud; null when there is nothing new.
class LivePainter {
 public:
  LivePainter(std::shared_ptr<const record::GrowingRecord> source,
              std::vector<PredictedStage> stages, reports::Language language);

  /// @param elapsed_s  Time since this start of the program.
  [[nodiscard]] std::shared_ptr<const LiveFrame> paint(double elapsed_s);
  /// The last frame: the result as the report states it.
  /// @param report  Path of the report; may be empty.
  [[nodiscard]] std::shared_ptr<const LiveFrame> paint_result(
      const record::RunRecord& record, const evaluation::Evaluation& evaluation,
      std::string_view report);
  /// The last frame of a run that has no result.
  [[nodiscard]] std::shared_ptr<const LiveFrame> paint_failure(std::string_view why);

 private:
  void put(std::string_view id, std::string html);
  void paint_cloud(const record::PoseVisit& visit);
  /// Evaluates f of the poses of a feature: once for finished poses, each time for the current one.
  void look_at_poses(const record::PoseVisit& present);
  [[nodiscard]] std::shared_ptr<const LiveFrame> frame();

  std::shared_ptr<const record::GrowingRecord> source_;
  std::vector<PredictedStage> stages_;
  reports::Language language_;
  record::RunRecord record_;
  std::map<int, evaluation::PoseValue> poses_;  ///< By PoseVisit::id.
  int grew_ = -1;                               ///< The current pose at the last evaluation.
  std::optional<double> zone_mm_;               ///< Zone of the current cloud.
  std::optional<int> first_;  ///< Touches on record at the first touch of this program start.
  double first_s_ = 0.0;      ///< Time of that touch.
  LiveFrame frame_;
  bool changed_ = false;
};

}  // namespace rondure::web
