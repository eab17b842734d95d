// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "echo_field.hpp"

#include "stylet/imaging/moment.hpp"

#include <span>

namespace stylet {

/// How a thin metal rod or a track looks in ultrasound. Levels are stated, by what transrectal pictures show.
struct RodLook {
  float level_dB = 30.0F;            ///< of its near side, where the beam meets it at a right angle
  float rough_dB = -14.0F;           ///< of what its roughness reflects into all directions, relative to level_dB
  double specular_deg = 14.0;        ///< tilt from the right angle at which the mirror-like echo is 1/e
  int reverberations = 0;            ///< echoes between its sides behind its own
  double reverberation_mm = 1.0;     ///< their distance
  float reverberation_share = 0.5F;  ///< amplitude of each, relative to the one before
  float tail_share = 0.0F;           ///< comet tail: amplitude right behind the rod, relative to the rod
  float shade = 0.0F;                ///< share of the amplitude that does not get past the rod
};

RodLook needle_look(double diameter_mm);
RodLook seed_look(double diameter_mm);
RodLook spacer_look();  ///< of absorbable polymer between the seeds of a strand: fainter than metal, without a tail
RodLook track_look();

/// Adds the echoes of rods to a picture.
class RodEchoes {
 public:
  RodEchoes(int lines, int samples);

  void clear();
  /// Adds a rod along a line of points. What is beside the plane by more than the slice's thickness adds nothing.
  /// @param gain (lines × samples) share of the amplitude that comes back from each sample
  void add(std::span<const Vec3> centreline_mm, double diameter_mm, const RodLook& look, const UltrasoundBeams& beams,
           const BeamProfile& profile, const PointSpread& spread, std::span<const float> gain, EchoField& field);
  /// Adds the comet tails, and weakens what lies behind rods, on the lines that rods touch.
  /// @param pattern (lines × samples) complex noise that breaks the tails up, real and imaginary part
  void add_tails(std::span<const float> pattern, double sample_mm, EchoField& field) const;

 private:
  struct Source {
    float tail = 0.0F;
    float shade = 0.0F;
  };
  int lines_, samples_;
  std::vector<Source> sources_;           ///< (lines × samples)
  std::vector<std::uint8_t> is_touched_;  ///< (lines)
};

}  // namespace stylet
