// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame_news.hpp"

#include <cmath>
#include <utility>

namespace stylet::serve {

namespace {

constexpr double kVisible_mm = 0.01;
constexpr double kForce_N = 0.005;
constexpr double kTorque_Nmm = 0.5;
constexpr double kAngle_deg = 0.05;

/// The members of a picture of which a viewer sees every change.
std::vector<std::uint32_t> words_of(const LiveFrame& f) {
  const bool paused = (f.bits & LiveFrame::paused) != 0;
  std::vector<std::uint32_t> words{f.bits & ~std::uint32_t{LiveFrame::whole_curve},
                                   f.step.flags,
                                   static_cast<std::uint32_t>(f.step.tip_state),
                                   static_cast<std::uint32_t>(f.step.sticking),
                                   f.tip_error ? 1U : 0U,
                                   paused ? f.steps : 0U};  // single steps
  for (const ContactSnapshot& c : f.contacts) words.push_back((c.sticking ? 1U : 0U) | (c.tip ? 2U : 0U));
  return words;
}

std::vector<float> numbers_of(const LiveFrame& f) {
  std::vector<float> numbers;
  const auto add = [&](double smallest, auto... values) {
    (numbers.push_back(static_cast<float>(static_cast<double>(values) / smallest)), ...);
  };
  const auto add_vector = [&](double smallest, const Vec3& v) { add(smallest, v.x(), v.y(), v.z()); };
  add(kVisible_mm, f.step.base_depth_mm);
  add(kForce_N, f.step.force_axial_N, f.step.force_sagittal_N, f.step.force_lateral_N, f.left_out_N);
  add_vector(kTorque_Nmm, f.step.torque_Nmm);
  add_vector(kVisible_mm, f.step.tip_mm);
  add_vector(kVisible_mm, f.step.base.origin);
  add(kAngle_deg, f.roll_deg, f.tilt_left_deg, f.tilt_anterior_deg);
  if (f.tip_error) {
    add_vector(kVisible_mm, f.tip_error->mm);
    add(kVisible_mm, f.tip_error->base_depth_mm);
  }
  for (const float x : f.centreline) add(kVisible_mm, x);
  for (const float x : f.resting) add(kVisible_mm, x);
  for (const ContactSnapshot& c : f.contacts) {
    add(kVisible_mm, c.position[0], c.position[1], c.position[2]);
    add(kForce_N, c.force[0], c.force[1], c.force[2]);
  }
  return numbers;
}

bool differ(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return true;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!(std::abs(a[k] - b[k]) < 1.0F)) return true;
  }
  return false;
}

}  // namespace

FrameNews::Verdict FrameNews::judge(const LiveFrame& frame, bool is_news, double now_s) {
  std::vector<std::uint32_t> words = words_of(frame);
  std::vector<float> numbers = numbers_of(frame);
  if (is_news || words != words_ || differ(numbers, numbers_)) {
    words_ = std::move(words);
    numbers_ = std::move(numbers);
    more_ = kMoreAfterNews;
  } else if (more_ > 0) {
    --more_;
  } else {
    if (now_s < passed_s_ + kSignEvery_s) return Verdict::nothing;
    is_owed_ = false;
    passed_s_ = now_s;
    return Verdict::sign_of_life;
  }
  is_owed_ = false;
  passed_s_ = now_s;
  return Verdict::news;
}

}  // namespace stylet::serve
