// SPDX-License-Identifier: GPL-3.0-or-later
#include "outbox.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace stylet::serve {

namespace {

constexpr std::size_t kMostWaiting = 2000;  ///< with this many waiting messages the connection is closed
constexpr std::size_t kMostSamples = 2000;  ///< most samples of the curve in a picture

}  // namespace

bool Outbox::put(const Parcel& parcel) {
  using enum wire::Kind;
  if (parcel.kind == status) {
    status_ = parcel;
    return true;
  }
  if (parcel.kind == scene) {
    frame_.reset();  // it belongs to the previous scene
    curve_.clear();
  } else if (parcel.kind != event && parcel.kind != notice) {
    std::erase_if(waiting_, [&](const Parcel& other) { return other.kind == parcel.kind; });
  }
  if (waiting_.size() >= kMostWaiting) return false;
  waiting_.push_back(parcel);
  return true;
}

void Outbox::put(const std::shared_ptr<const LiveFrame>& frame) {
  if (frame_) ++skipped_;
  if ((frame->bits & LiveFrame::whole_curve) != 0) {
    curve_ = frame->curve;
    whole_curve_ = true;
  } else {
    curve_.insert(curve_.end(), frame->curve.begin(), frame->curve.end());
  }
  wire::thin(curve_, kMostSamples);
  frame_ = frame;
}

std::optional<wire::Bytes> Outbox::next() {
  if (!waiting_.empty() || status_) {
    Parcel parcel;
    if (waiting_.empty()) {
      parcel = *std::exchange(status_, std::nullopt);
    } else {
      parcel = std::move(waiting_.front());
      waiting_.pop_front();
    }
    wire::Bytes bytes = *parcel.bytes;
    const std::uint32_t number = sent_++;
    std::memcpy(bytes.data() + sizeof number, &number, sizeof number);
    return bytes;
  }
  if (!frame_) return std::nullopt;
  wire::Bytes bytes = wire::encode(*frame_, curve_, whole_curve_, sent_++);
  frame_.reset();
  curve_.clear();
  whole_curve_ = false;
  return bytes;
}

bool Allowance::take() {
  const auto now = std::chrono::steady_clock::now();
  left_ = std::min(kPerSecond, left_ + kPerSecond * std::chrono::duration<double>(now - last_).count());
  last_ = now;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

}  // namespace stylet::serve
