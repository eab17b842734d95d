// SPDX-License-Identifier: GPL-3.0-or-later
#include "drop_log.hpp"

#include <algorithm>

namespace stylet::igtl {

void DropLog::add(const std::string& kind, std::string what, std::string cure, bool is_told_once) {
  const std::scoped_lock lock(mutex_);
  ++total_;
  const bool is_new = !kinds_.contains(kind);
  Entry& entry = kinds_[is_new && kinds_.size() >= kMostKinds ? "others" : kind];
  const std::int64_t count = entry.newest.count + 1;
  entry.newest = {std::move(what), std::move(cure), count};
  entry.is_told_once = is_told_once;
}

std::vector<Dropped> DropLog::news(Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  std::vector<Dropped> news;
  for (auto& [kind, entry] : kinds_) {
    const bool is_first = entry.told == 0;
    if (entry.told == entry.newest.count || (!is_first && (entry.is_told_once || now < entry.due))) continue;
    news.push_back(entry.newest);
    if (!is_first) entry.pause = std::min<Clock::duration>(2 * entry.pause, kLongestPause);
    entry.told = entry.newest.count;
    entry.due = now + entry.pause;
  }
  return news;
}

std::int64_t DropLog::total() const {
  const std::scoped_lock lock(mutex_);
  return total_;
}

}  // namespace stylet::igtl
