// SPDX-License-Identifier: GPL-3.0-or-later
#include "complaints.hpp"

namespace stylet::serve {

namespace {

constexpr auto kSameComplaintEvery = std::chrono::seconds(10);

}  // namespace

bool Complaints::tell(const Error& why) {
  std::string text = why.message();
  {
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (text == last_ && now < again_) return false;
    last_ = text;
    again_ = now + kSameComplaintEvery;
  }
  if (say_) say_(text + '.');
  return true;
}

}  // namespace stylet::serve
