// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay.hpp"

#include "stylet/coupling/insertion.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::serve {

namespace {

ContactSnapshot plain_contact(const ContactView& c) {
  return {plain(c.position), plain(c.force), c.s, c.sticking, c.tip};
}

}  // namespace

Replay::Replay(RunRecording recording, ScenePoints points)
    : recording_(std::move(recording)), steps_(recording_.steps), points_(std::move(points)) {}

double Replay::duration_s() const {
  double end = recording_.steps.empty() ? 0.0 : recording_.steps.back().time_s;
  if (!recording_.frames.empty()) end = std::max(end, recording_.frames.back().time_s);
  // While the needle of a recording that goes on is at rest, it gets no steps.
  if (recording_.implant && !recording_.implant->acts.empty())
    end = std::max(end, recording_.implant->acts.back().time_s);
  if (!recording_.probe_moves.empty()) end = std::max(end, recording_.probe_moves.back().time_s);
  return end;
}

void Replay::seek(double time_s) {
  const double to = std::clamp(time_s, 0.0, duration_s());
  changed_ = changed_ || to != time_s_;
  time_s_ = to;
}

void Replay::play(double rate) {
  rate_ = std::clamp(rate, 0.0, 20.0);
  if (rate_ > 0.0 && time_s_ >= duration_s()) seek(0.0);
}

void Replay::advance(double dt_s) {
  if (rate_ == 0.0) return;
  seek(time_s_ + rate_ * dt_s);
  if (time_s_ >= duration_s()) rate_ = 0.0;
}

/// The last step at or before the current moment; before the first step, the first, because the needle was at its place
/// then. Null if there are no steps.
const Step* Replay::step() const {
  const auto& steps = recording_.steps;
  if (steps.empty()) return nullptr;
  const auto after =
      std::upper_bound(steps.begin(), steps.end(), time_s_, [](double t, const Step& s) { return t < s.time_s; });
  return after == steps.begin() ? &steps.front() : &*(after - 1);
}

/// Before the first frame there is no recorded shape: shows a straight needle and undeformed tissue.
void Replay::put_needle(LiveFrame& out) const {
  set_displacement(out, Eigen::Matrix3Xf::Zero(3, points_.count()));
  if (recording_.steps.empty()) return;
  const Step& s = *step();
  if (!s.base.origin.allFinite()) return;
  for (const Vec3& point : {s.base.origin, s.tip_mm})
    for (const double value : point) out.centreline.push_back(static_cast<float>(value));
  out.step.tip_mm = s.tip_mm;
  out.left_out_N = Vec3(s.force_axial_N, s.force_sagittal_N, s.force_lateral_N).norm();
}

/// Empty before the first frame.
std::optional<Replay::Between> Replay::between() const {
  const auto& frames = recording_.frames;
  if (frames.empty() || time_s_ < frames.front().time_s) return std::nullopt;
  const auto after =
      std::upper_bound(frames.begin(), frames.end(), time_s_, [](double t, const Frame& f) { return t < f.time_s; });
  const Frame& a = after == frames.begin() ? frames.front() : *(after - 1);
  const Frame& b = after == frames.end() ? frames.back() : *after;
  const double span = b.time_s - a.time_s;
  return Between{a, b, span > 0.0 ? std::clamp((time_s_ - a.time_s) / span, 0.0, 1.0) : 0.0};
}

Vec3 Replay::displacement(Index node) const {
  const std::optional<Between> now = between();
  if (!now) return Vec3::Zero();
  const Eigen::Index at = 3 * Eigen::Index{node};
  return (1.0 - now->share) * now->before.displacement.segment<3>(at) +
         now->share * now->after.displacement.segment<3>(at);
}

/// Needle, contacts and displacement at the current moment.
void Replay::put_frame(LiveFrame& out) const {
  const std::optional<Between> now = between();
  if (!now) return put_needle(out);
  const auto& [a, b, share] = *now;
  for (std::size_t k = 0; k < a.needle.size(); ++k) {
    const Vec3& from = a.needle[k];
    const Vec3 point = k < b.needle.size() ? Vec3(from + share * (b.needle[k] - from)) : from;
    for (const double value : point) out.centreline.push_back(static_cast<float>(value));
  }
  if (!a.needle.empty()) out.step.tip_mm = a.needle.back();  // the first step has the exact value
  for (const ContactView& c : (share < 0.5 ? a : b).contacts) out.contacts.push_back(plain_contact(c));
  Eigen::Matrix3Xf u(3, points_.count());
  for (std::size_t k = 0; k < points_.nodes.size(); ++k) {
    const Eigen::Index at = 3 * Eigen::Index{points_.nodes[k]};
    u.col(static_cast<Eigen::Index>(k)) =
        ((1.0 - share) * a.displacement.segment<3>(at) + share * b.displacement.segment<3>(at)).cast<float>();
  }
  points_.carry_along(u);
  set_displacement(out, u);
}

std::vector<std::string> Replay::inside() const {
  std::vector<std::string> names;
  const Step* now = step();
  if (now == nullptr || now->tip_state == TipState::air) return names;
  for (const Event& e : recording_.events) {
    if (e.time_s > time_s_) break;
    if (e.kind == EventKind::withdrawn) names.clear();
    if (e.kind != EventKind::region_entered || e.depth_mm > now->base_depth_mm) continue;
    std::erase(names, e.region);
    names.insert(names.begin(), e.region);
  }
  return names;
}

std::shared_ptr<const LiveFrame> Replay::picture(bool whole_curve) {
  if (!changed_ && !whole_curve) return nullptr;
  changed_ = false;
  auto frame = std::make_shared<LiveFrame>();
  frame->time_s = time_s_;
  frame->bits = LiveFrame::replayed | LiveFrame::trusted | (rate_ == 0.0 ? LiveFrame::paused : 0U) |
                (whole_curve ? LiveFrame::whole_curve : 0U);
  put_frame(*frame);
  if (const Step* s = step()) {
    const Vec3 shown_tip = frame->step.tip_mm;
    const Pose shown_base = frame->step.base;
    frame->step = *s;
    if ((s->flags & Step::kDistrusted) != 0) frame->bits &= ~static_cast<std::uint32_t>(LiveFrame::trusted);
    frame->steps = static_cast<std::uint32_t>(steps_.last_at(time_s_)) + 1;
    if (time_s_ < s->time_s && !frame->centreline.empty()) frame->step.tip_mm = shown_tip;
    if (!s->base.origin.allFinite()) frame->step.base = shown_base;  // recordings of format 1 have none
  }
  if (whole_curve) {
    frame->curve = with_ends_of_rests(recording_.steps);
  }
  return frame;
}

}  // namespace stylet::serve
