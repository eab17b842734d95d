// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/kind_words.hpp"

namespace stylet::results {

void add_kind_words(Slots& slots, Implant implant) {
  struct Words {
    const char* slot;
    const char* permanent;
    const char* temporary;
  };
  static constexpr Words all[] = {
      {"words_errors_heading", "Errors of the seeds</h2>", "Errors of the dwell positions</h2>"},
      {"words_errors",
       "The error of a seed is the way from its planned place to the place where it rests with "
       "all needles out. The last three",
       "The error of a dwell position is the way from its planned place to the tissue in which "
       "it is at the delivery, by the place that this tissue has at rest. The last three"},
      {"words_extent", "third of the planned seeds’ extent.", "third of the planned dwell positions’ extent."},
      {"words_why", "Why the seeds do not lie where they were planned",
       "Why the dwell positions do not lie where they were planned"},
      {"words_add_up",
       "add up to the whole error of each seed. A cause can be large and still have a mean near "
       "zero along each axis, where it moves some seeds one way",
       "add up to the whole error of each dwell position. The part “planning to delivery” is "
       "the movement between the images of the plan and the delivery; the others are what these "
       "images show. A cause can be large and still have a mean near zero along each axis, "
       "where it moves some dwell positions one way"},
      {"words_mark", "Each mark is a seed. All", "Each mark is a dwell position. All"},
      {"words_see", "to see its seed and needle.", "to see its dwell position and catheter."},
      {"words_needles",
       "<h3>Needles</h3>\n    <p>The needles in the order in which they went in. The gland’s "
       "shift is its largest mean shift while the needle is in, the peak force the largest "
       "axial force on the hand, the deflection the largest distance of the tip from the "
       "straight line of the needle, and",
       "<h3>Catheters</h3>\n    <p>The catheters in the order in which they went in; all stay. "
       "The gland’s shift is its largest mean shift while the catheter is in the hand, the peak "
       "force the largest axial force on the hand, the deflection the largest distance of the "
       "tip from the straight line of the catheter, and"},
      {"words_sections",
       "and the seeds at rest within 2.5 mm of the plane. Open circles are the planned places, "
       "and a thin line joins each of them to its seed. The part of an error that is "
       "perpendicular to the plane does not show: an open circle without a seed belongs to a "
       "seed that rests further from the plane.",
       "and the dwell positions in the tissue at the delivery within 2.5 mm of the plane. Open "
       "circles are the planned places, and a thin line joins each of them to its dwell "
       "position. The part of an error that is perpendicular to the plane does not show: an "
       "open circle alone belongs to a dwell position that lies further from the plane. Where "
       "the page’s script says “seed” and “needle”, it means dwell position and catheter."},
      {"words_space",
       "seeds at rest, and an arrow from the planned place of each seed to the place where it "
       "rests.",
       "dwell positions at the delivery, and an arrow from the planned place of each of them to "
       "the tissue in which it is then."},
      {"words_seeds_heading", "<h2 id=\"seeds\">Seeds</h2>", "<h2 id=\"seeds\">Dwell positions</h2>"},
      {"words_seed_facts", "<h3>Seeds and oedema</h3>", "<h3>Dwell positions</h3>"},
      {"words_files", "The seeds with all places and causes are in",
       "The dwell positions with all places and causes are in"},
  };
  for (const Words& words : all) slots[words.slot] = implant == Implant::temporary ? words.temporary : words.permanent;
}

}  // namespace stylet::results
