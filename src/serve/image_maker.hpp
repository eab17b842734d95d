// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image_desk.hpp"
#include "stylet/probe/probe_place.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace stylet::serve {

/// Makes the pictures of an ImageDesk: holds the patient, the probe, the scanner and the X-ray unit. For one thread.
class ImageMaker {
 public:
  ImageMaker();
  ~ImageMaker();

  void open(ImageSubject patient);
  /// @param tables scenario whose tables of probe, ultrasound and X-ray count
  /// @param in_patient whether pictures get LiveImage::in_patient
  void set(ShownImage shown, const Scenario& tables, bool in_patient);
  /// Takes the state of the loop: the displacement is computed from the forces.
  /// @param needles_mm LPS, centrelines
  void take(double time_s, std::span<const TissueForce> forces, std::span<const std::vector<Vec3>> needles_mm,
            const std::vector<ShownSeed>& seeds);
  void take(Moment moment);

  /// Where the probe enters and rests. Errors: the patient has no place for a probe.
  Result<ProbeSeat> seat();
  /// The picture of the last moment. @param tell is told what is being prepared, since that takes seconds
  /// Errors: the patient has no place for a probe.
  Result<std::shared_ptr<const LiveImage>> make(const std::function<void(const std::string&)>& tell);
  /// Why the probe of a replay moves nothing in the picture, in a sentence; empty if it presses or if there is none.
  [[nodiscard]] const std::string& remark() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::serve
