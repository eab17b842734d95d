// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/remark.hpp"

#include <mutex>
#include <set>
#include <utility>

namespace stylet {

namespace {

struct Remarks {
  std::mutex mutex;
  std::function<void(const std::string&)> receiver;
  std::set<std::string> made;
};

Remarks& remarks() {
  static Remarks all;
  return all;
}

}  // namespace

void receive_remarks(std::function<void(const std::string&)> receiver) {
  Remarks& all = remarks();
  const std::lock_guard lock(all.mutex);
  all.receiver = std::move(receiver);
}

void detail::remark(const std::string& sentence) {
  Remarks& all = remarks();
  const std::lock_guard lock(all.mutex);
  if (all.receiver && all.made.insert(sentence).second) all.receiver(sentence);
}

}  // namespace stylet
