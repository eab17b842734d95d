// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay.hpp"
#include "stylet/geom/locator.hpp"
#include "stylet/serve/implant_picture.hpp"

#include <optional>
#include <vector>

namespace stylet::serve {

/// The seeds of a replayed recording: which ones are in the tissue at its present moment, where they are, and their
/// dose as it was computed then. A seed moves as the recorded nodes of its element do, linearly between two recorded
/// frames. The recorded nodes have the needle's near field, but it is not recorded between them: beside the needle a
/// seed is shown some tenths of a millimetre from where the live page showed it.
class ReplayedSeeds {
 public:
  /// @param replay of a recording with an implant; it must outlive this object
  explicit ReplayedSeeds(const Replay& replay);

  /// The recorded plan. No needle is ready, since none can be chosen.
  [[nodiscard]] ShownPlan plan() const { return {recorded().plan}; }
  /// What had been carried out until the present moment; empty if it is the same as at the last call.
  [[nodiscard]] std::optional<LiveImplant> news();
  /// Where the seeds of the last news() are now.
  [[nodiscard]] LiveSeeds places() const;

 private:
  [[nodiscard]] const RecordedImplant& recorded() const { return *replay_.recording().implant; }

  const Replay& replay_;
  std::vector<MaterialPoint> at_;    ///< of the seed of each act, at rest; outside of the mesh without an element
  std::optional<std::size_t> acts_;  ///< number of acts at the last news()
  ImplantTally tally_;               ///< at the last news()
  std::vector<std::size_t> there_;   ///< the acts that say where the seeds that are there now rest
};

}  // namespace stylet::serve
