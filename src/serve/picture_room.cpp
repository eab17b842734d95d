// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_room.hpp"

namespace stylet::serve {

Reply PictureRoom::ask(const Request& request) {
  const auto& [what, text, number] = request.command;
  if (what == Command::Do::set) {
    const auto done = desk_.set(text, number);
    return done ? Reply{} : Reply::refusal(request, done.error());
  }
  const auto shown = shown_image(text);
  if (!shown) {
    return Reply::refusal(request, input_error("picture", "there is no picture \"" + text + "\"",
                                               "Choose none, transverse, sagittal or xray"));
  }
  desk_.show(*shown);
  wants_moment_ = true;
  return {};
}

void PictureRoom::open(const ImageSubject& patient) {
  std::pair now{patient.mesh, patient.field};
  if (now == patient_) return;
  patient_ = std::move(now);
  desk_.open(patient);
  wants_moment_ = true;
}

void PictureRoom::serve_companion(bool is_live) {
  if (!settings_.companion) return;
  const bool was_busy = desk_.is_busy();
  desk_.serve(is_live && settings_.companion->wants_images());
  desk_.track(is_live ? settings_.companion->probe_pose() : std::nullopt);
  wants_moment_ = wants_moment_ || !was_busy;
}

Reply PictureRoom::news(bool is_live) {
  Reply reply;
  const bool is_shown = desk_.shown() != ShownImage::none;
  if (auto image = desk_.news()) {
    if (is_live && image->in_patient && settings_.companion->wants_images()) settings_.companion->show(*image);
    if (is_shown) reply.show.emplace_back(std::move(image));
  }
  ImageDesk::Report report = desk_.report();
  SessionStatus::Image now{to_string(desk_.shown()), std::move(report.problem), std::move(report.stage),
                           desk_.is_tracked() ? settings_.companion->name() : "page", std::move(report.probe_problem)};
  if (now == told_) return reply;
  if (!is_shown && settings_.companion && settings_.say && !now.problem.empty() && now.problem != told_.problem)
    settings_.say(settings_.companion->name() + " gets no pictures: " + now.problem);
  told_ = std::move(now);
  reply.is_urgent = true;
  return reply;
}

}  // namespace stylet::serve
