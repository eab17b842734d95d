// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "echo_field.hpp"
#include "stylet/imaging/ultrasound_beams.hpp"
#include "ultrasound_artefacts.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// The grey values of a picture: artefacts of the machine are added to the power of its echoes, which is then
/// compressed to the range that a screen shows. Does not allocate after construction.
class EchoPicture {
 public:
  EchoPicture(const UltrasoundSettings& settings, bool with_artefacts);

  /// @param field after EchoField::blur()
  void compress(const UltrasoundBeams& beams, const UltrasoundSettings& settings, EchoField& field);

  [[nodiscard]] const UltrasoundBeams& beams() const { return beams_; }
  [[nodiscard]] const std::vector<std::uint8_t>& grey() const { return grey_; }
  /// (samples × lines)
  [[nodiscard]] const std::vector<float>& power() const { return power_; }
  [[nodiscard]] const UltrasoundArtefacts& artefacts() const { return artefacts_; }

 private:
  UltrasoundBeams beams_;  ///< of the last picture
  UltrasoundArtefacts artefacts_;
  bool with_artefacts_;
  std::vector<float> power_;        ///< (samples × lines)
  std::vector<std::uint8_t> grey_;  ///< (lines × samples)
};

}  // namespace stylet
