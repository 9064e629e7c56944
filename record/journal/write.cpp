#include "record/journal/journal.h"

#include <stdexcept>
#include <utility>

#include "record/growing_record.h"
#include "record/journal/internal/impl.h"
#include "record/journal/internal/series.h"

namespace rondure::record {

using soci::use;

Journal::Journal(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

void Journal::follow(std::shared_ptr<GrowingRecord> copy) { impl_->follower = std::move(copy); }

core::Result<void> Journal::add(const Touch& touch) {
  const bool check = touch.purpose == Touch::Purpose::kCheck;
  const std::string subject =
      check ? std::string("a repeated touch") : fmt::format("touch {}", touch.id);
  auto written = impl_->write(subject, [&] { impl_->insert(touch); });
  if (written) impl_->keep(touch);
  if (written && impl_->follower) impl_->follower->add(std::span(&touch, 1));
  return written;
}

core::Result<void> Journal::add(std::span<const Touch> touches) {
  if (touches.empty()) return {};
  const std::string subject =
      fmt::format("touches {} to {}", touches.front().id, touches.back().id);
  auto written = impl_->write(subject, [&] {
    for (const Touch& touch : touches) impl_->insert(touch);
  });
  if (written) {
    for (const Touch& touch : touches) impl_->keep(touch);
    if (impl_->follower) impl_->follower->add(touches);
  }
  return written;
}

core::Result<void> Journal::add(const PoseVisit& pose) {
  auto written = impl_->write(fmt::format("pose {}", pose.id), [&] {
    impl_->statements->pose = pose;
    impl_->statements->final_cloud = pose.final_cloud ? 1 : 0;
    impl_->statements->insert_pose.execute(true);
    impl_->link(pose);
  });
  if (written) impl_->poses.insert_or_assign(pose.id, pose);
  if (written && impl_->follower) impl_->follower->add(pose);
  return written;
}

core::Result<void> Journal::add(const Decision& decision) {
  auto written = impl_->write("a decision", [&] { impl_->insert(decision); });
  if (written && impl_->follower) impl_->follower->add(decision);
  return written;
}

core::Result<void> Journal::add(const SimulationTruth& truth) {
  return impl_->write("the truth of the simulation", [&] {
    impl_->statements->truth = truth;
    impl_->statements->insert_truth.execute(true);
    impl_->chain->append_inserted("truth", truth.feature, truth.cylt_mm);
  });
}

core::Result<void> Journal::add(std::span<const Series> series,
                                std::span<const TruthValue> truths) {
  if (series.empty() && truths.empty()) return {};
  const std::string subject = series.empty()
                                  ? std::string("the truth of the simulation")
                                  : fmt::format("the series of feature {}", series.front().feature);
  return impl_->write(subject, [&] { insert_series(impl_->sql, *impl_->chain, series, truths); });
}

core::Result<void> Journal::mark_final(int pose_id) {
  auto written = impl_->write(fmt::format("the mark of the final pose {}", pose_id), [&] {
    const auto pose = impl_->poses.find(pose_id);
    if (pose == impl_->poses.end()) throw std::runtime_error("there is no such pose");
    impl_->statements->marked_pose = pose_id;
    impl_->statements->update_final.execute(true);
    PoseVisit marked = pose->second;
    marked.final_cloud = true;
    impl_->link(marked);
  });
  if (written) impl_->poses.at(pose_id).final_cloud = true;
  if (written && impl_->follower) impl_->follower->mark_final(pose_id);
  return written;
}

core::Result<void> Journal::end(const std::string& ending, const core::Error* failure) {
  auto written = impl_->write("the ending of the run", [&] {
    if (impl_->ended) throw std::runtime_error("it stands there already");
    const std::string code = failure == nullptr ? "" : std::string(core::code_name(failure->code));
    const std::string what = failure == nullptr ? "" : failure->what;
    const std::string where = failure == nullptr ? "" : failure->where;
    soci::indicator given = failure == nullptr ? soci::i_null : soci::i_ok;
    impl_->sql << "update header set ending = :ending, failure_code = :code, failure_what = :what, "
                  "failure_where = :place",
        use(ending), use(code, given), use(what, given), use(where, given);
    impl_->link_header(ending, failure);
  });
  impl_->ended = impl_->ended || written.has_value();
  if (written && impl_->follower) impl_->follower->end(ending, failure);
  return written;
}

}  // namespace rondure::record
