#include "record/growing_record.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace rondure::record {
namespace {

/// Copies the new rows. Rows are only ever appended.
template <class Row>
bool append_new(const std::vector<Row>& all, std::vector<Row>& seen) {
  if (seen.size() == all.size()) return false;
  seen.insert(seen.end(), all.begin() + static_cast<std::ptrdiff_t>(seen.size()), all.end());
  return true;
}

}  // namespace

void GrowingRecord::begin(RunRecord record) {
  const std::lock_guard lock(mutex_);
  record_ = std::move(record);
  begun_ = true;
}

void GrowingRecord::add(std::span<const Touch> touches) {
  const std::lock_guard lock(mutex_);
  for (const Touch& touch : touches) {
    const bool check = touch.purpose == Touch::Purpose::kCheck;
    (check ? record_.checks : record_.touches).push_back(touch);
  }
}

void GrowingRecord::add(const PoseVisit& pose) {
  const std::lock_guard lock(mutex_);
  record_.poses.push_back(pose);
}

void GrowingRecord::add(const Decision& decision) {
  const std::lock_guard lock(mutex_);
  take(decision, record_);
}

void GrowingRecord::mark_final(int pose_id) {
  const std::lock_guard lock(mutex_);
  for (PoseVisit& pose : record_.poses) {
    if (pose.id == pose_id) pose.final_cloud = true;
  }
}

void GrowingRecord::end(const std::string& ending, const core::Error* failure) {
  const std::lock_guard lock(mutex_);
  record_.ending = ending;
  if (failure != nullptr) record_.failure = *failure;
}

bool GrowingRecord::catch_up(RunRecord& mine) const {
  const std::lock_guard lock(mutex_);
  if (!begun_) return false;
  if (mine.header.version.empty()) {
    mine = record_;
    return true;
  }
  bool fresh = append_new(record_.touches, mine.touches);
  fresh |= append_new(record_.checks, mine.checks);
  fresh |= append_new(record_.decisions, mine.decisions);
  fresh |= append_new(record_.poses, mine.poses);
  for (std::size_t i = 0; i < mine.poses.size(); ++i) {
    fresh |= mine.poses[i].final_cloud != record_.poses[i].final_cloud;
    mine.poses[i].final_cloud = record_.poses[i].final_cloud;
  }
  fresh |= mine.ending != record_.ending;
  mine.ending = record_.ending;
  mine.failure = record_.failure;
  return fresh;
}

}  // namespace rondure::record
