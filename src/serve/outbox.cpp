// SPDX-License-Identifier: GPL-3.0-or-later
#include "outbox.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace stylet::serve {

namespace {

constexpr std::size_t kMostWaiting = 2000;  ///< with this many waiting messages the connection is closed
constexpr std::size_t kMostSamples = 2000;  ///< most samples of the curve in a picture
constexpr std::size_t kFewSamples = 64;     ///< a curve of so few samples is sent as it is
constexpr double kSamplesPerSecond = 120.0;
constexpr double kSlow_s = 0.1;  ///< to a page that has pictures later than this, displacements are sent with 8 bits

/// Messages that come many times a second and are soon outdated.
bool is_fleeting(const Parcel& parcel) {
  using enum wire::Kind;
  return parcel.kind == seeds || parcel.kind == dose || parcel.kind == image;
}

/// Number of samples that a curve is worth when it has waited: as many as with pictures at their full rate.
std::size_t worth(const std::vector<Step>& curve) {
  if (curve.size() <= kFewSamples) return kFewSamples;
  const double seconds = curve.back().time_s - curve.front().time_s;
  return std::max(kFewSamples, static_cast<std::size_t>(std::max(0.0, kSamplesPerSecond * seconds)));
}

/// A picture without displacement, which replaces one that had some: pages keep the last displacement that they got.
std::shared_ptr<const LiveFrame> with_displacement_of(const LiveFrame& before,
                                                      const std::shared_ptr<const LiveFrame>& frame) {
  if (before.displacement.empty() || !frame->displacement.empty()) return frame;
  auto both = std::make_shared<LiveFrame>(*frame);
  both->displacement = before.displacement;
  both->unit_mm = before.unit_mm;
  return both;
}

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

void Outbox::put(const std::shared_ptr<const LiveFrame>& frame, double now_s) {
  if (frame_) ++skipped_;
  if ((frame->bits & LiveFrame::whole_curve) != 0) {
    curve_ = frame->curve;
    whole_curve_ = true;
  } else {
    curve_.insert(curve_.end(), frame->curve.begin(), frame->curve.end());
  }
  wire::thin(curve_, kMostSamples);
  frame_ = frame_ ? with_displacement_of(*frame_, frame) : frame;
  frame_since_s_ = now_s;
}

wire::Bytes Outbox::packed(const Parcel& parcel) {
  wire::Bytes bytes = *parcel.bytes;
  const std::uint32_t number = sent_++;
  std::memcpy(bytes.data() + sizeof number, &number, sizeof number);
  if (is_fleeting(parcel)) {
    unseen_.push_back({number, bytes.size()});
    unseen_bytes_ += bytes.size();
    frame_was_last_ = false;
  }
  return bytes;
}

wire::Bytes Outbox::packed_frame() {
  if (!whole_curve_) wire::thin(curve_, worth(curve_));
  wire::Bytes bytes = wire::encode(*frame_, curve_, whole_curve_, sent_, lag_s_.value_or(0.0) > kSlow_s);
  unseen_.push_back({sent_++, bytes.size(), frame_since_s_});
  unseen_bytes_ += bytes.size();
  frame_was_last_ = true;
  frame_.reset();
  curve_.clear();
  whole_curve_ = false;
  return bytes;
}

/// All messages but the status stay in their order. Pictures of the needle come after everything that has to be said,
/// and take turns with other fleeting messages, so that neither keeps the other from being sent.
std::optional<wire::Bytes> Outbox::next() {
  const bool has_room = unseen_bytes_ < kMostUnseen;
  const bool frame_may_go = frame_ && has_room && std::ranges::all_of(waiting_, is_fleeting);
  if (!waiting_.empty() && (has_room || !is_fleeting(waiting_.front())) && (!frame_may_go || frame_was_last_)) {
    const Parcel parcel = std::move(waiting_.front());
    waiting_.pop_front();
    return packed(parcel);
  }
  if (status_) return packed(*std::exchange(status_, std::nullopt));
  if (frame_may_go) return packed_frame();
  return std::nullopt;
}

void Outbox::seen(wire::Seen newest, double now_s) {
  if (newest.number >= sent_) return;  // it has not been sent
  while (!unseen_.empty() && unseen_.front().number <= newest.number) {
    if (unseen_.front().since_s) lag_s_ = now_s - *unseen_.front().since_s;
    unseen_bytes_ -= unseen_.front().bytes;
    unseen_.pop_front();
  }
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
