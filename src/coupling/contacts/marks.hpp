// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/tissue_response.hpp"
#include "stylet/coupling/insertion.hpp"

namespace stylet {

/// Lays marks on a track: places at which the shaft can have contacts. Each mark belongs to a point of
/// ContactCompliance.
class Marks {
 public:
  /// All arguments outlive the marks.
  Marks(const InsertionTissue& mesh, const CouplingSettings& settings, TissueResponse& tissue)
      : mesh_(mesh), settings_(settings), tissue_(tissue) {}

  /// Sets the next mark `ahead` [mm] beyond the end of the track.
  void go_on_from(const Track& track, double ahead) { next_xi_ = track.end_xi + ahead; }

  /// Lays marks along the piece of track that was just cut, from `from` [mm] LPS in element `from_tet`, at arc length
  /// from_xi, to the track's end.
  void lay(Track& track, const Vec3& from, double from_xi, Index from_tet, Step& step);

  enum class Outcome { there, dropped, refused };
  /// Adds a point for a mark without one: the mark is on an earlier track, whose points were reset, or its compliance
  /// was missing when it was laid. A mark whose point is a linear combination of those before it is removed from the
  /// track.
  /// @param number number of the mark on the track @param along unit vector LPS along the shaft
  Outcome represent(Track& track, std::size_t number, const Vec3& along, Step& step);

 private:
  [[nodiscard]] Placement placement() const;
  void lay_on_faces(Track& track, const Vec3& from, double from_xi, Index tet, Step& step);
  bool lay_one(Track& track, double xi, const Vec3& x, const MaterialPoint& at, Placement placement, const Vec3& travel,
               Step& step);
  [[nodiscard]] bool follows_from(int point, const Track& track, std::size_t marks) const;

  const InsertionTissue& mesh_;
  const CouplingSettings& settings_;
  TissueResponse& tissue_;
  double next_xi_ = 0.0;  ///< [mm] arc length at which the next mark may be laid
};

}  // namespace stylet
