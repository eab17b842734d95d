// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "outline.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// The demo patient's organs. Origin at the centre of the prostate; LPS: +x left, +y back, +z head; mm.
/// Adult man in lithotomy position; the block ends at the perineal skin below and at the dome of the bladder above.
namespace stylet::phantom {

/// Sizes of one patient. The defaults are the reference patient (seed 0); others are drawn around them.
///
/// Where the numbers come from:
/// - gland volume 37.4 ± 9.6 cc before implantation (149 patients, BMC Radiation Oncology 2013, 8:177); 49 cc (22–106)
///   and length 4.5 cm (3.1–6.0) after it (191 patients, Holmes et al. 2014). Reference 40 cc, drawn from 32–56 cc.
/// - shape of the sections: width about 1.35 × depth, filling 0.83–0.88 of the box around it, apex and base rounded, as
/// in
///   expert-drawn MR contours (Medical Segmentation Decathlon, task 5; Antonelli et al., Nat Commun 2022, 13:4128).
/// - urethra 6–7 mm wide, as contoured with a catheter in place; curved forward below the verumontanum.
/// - pubic bone 4–6 mm from the gland at the nearest point (Visible Human Male, Browne & Schlehlein 2022,
///   doi:10.48539/HBM893.QGJK.978) to about 1 cm; subpubic angle of men 50–82° (obstetric textbooks).
/// - rectum 25–35 mm across, 3–6 mm behind the gland; anal canal about 4 cm.
/// - perineal skin about 3 cm below the apex, so that a needle of 20 cm reaches the base through a template.
struct Sizes {
  double prostate_cc = 40.0;
  double prostate_width = 1.36;   ///< × depth
  double prostate_length = 1.28;  ///< × depth
  double prostate_hollow = 2.2;   ///< [mm] depth of the posterior concavity
  double urethra_diameter = 6.6;  ///< [mm]
  double bladder_cc = 120.0;
  double rectum_diameter = 30.0;  ///< [mm] mean of width and depth in the middle
  double rectum_gap = 4.0;        ///< [mm] behind the gland's most posterior part
  double retropubic_gap = 7.0;    ///< [mm] between gland and symphysis
  double subpubic_angle = 72.0;   ///< [deg]
  double skin_below_apex = 30.0;  ///< [mm]
  double body_width = 172.0;      ///< [mm]
  double body_depth = 142.0;      ///< [mm]
};

/// The sizes that belong to a seed.
Sizes sizes_of(std::uint64_t seed);

/// One structure: its outlines at any height between `low` and `high`.
class Organ {
 public:
  Organ(std::string organ_name, std::string dicom_type, std::array<int, 3> display_colour)
      : name(std::move(organ_name)), type(std::move(dicom_type)), colour(display_colour) {}
  virtual ~Organ() = default;
  Organ(const Organ&) = delete;
  Organ& operator=(const Organ&) = delete;

  [[nodiscard]] virtual std::vector<Outline> outlines(double z) const = 0;

  std::string name;
  std::string type;  ///< RT ROI interpreted type
  std::array<int, 3> colour;
  double low = 0.0;   ///< [mm] lowest slice
  double high = 0.0;  ///< [mm] highest slice
};

/// The gland. Its half axes place everything else.
class Prostate : public Organ {
 public:
  Prostate(const Sizes& sizes, Random& random);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;

  /// y of the gland's front and back in the middle plane x = 0, before irregularities [mm].
  [[nodiscard]] double front(double z) const;

  double half_width = 0.0;   ///< [mm] x
  double half_depth = 0.0;   ///< [mm] y
  double half_length = 0.0;  ///< [mm] z

 private:
  [[nodiscard]] Outline outline(double z) const;
  [[nodiscard]] double volume_cc() const;
  double hollow_;
  Irregularity irregularity_;
};

class Urethra : public Organ {
 public:
  Urethra(const Sizes& sizes, const Prostate& prostate);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;
  /// y of its front wall [mm].
  [[nodiscard]] double front(double z) const { return centre(z) - radius_; }

 private:
  [[nodiscard]] double centre(double z) const;
  double half_length_;
  double radius_;
};

class Bladder : public Organ {
 public:
  Bladder(const Sizes& sizes, const Prostate& prostate, Random& random);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;

 private:
  [[nodiscard]] Outline outline(double z) const;
  double scale_ = 1.0;
  Irregularity irregularity_;
};

class Rectum : public Organ {
 public:
  Rectum(const Sizes& sizes, const Prostate& prostate, Random& random);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;

 private:
  double unit_;   ///< [mm] the gland's half length
  double front_;  ///< [mm] shift of the anterior wall
  double scale_;  ///< of the diameters
  Irregularity irregularity_;
};

class PubicArch : public Organ {
 public:
  PubicArch(const Sizes& sizes, const Prostate& prostate, Random& random);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;
  /// y of the symphysis' back in the middle plane [mm]; below its lower end that of the lower end.
  [[nodiscard]] double back(double z) const;

  double symphysis_low = 0.0;  ///< [mm] z below which the arch is two rami

 private:
  [[nodiscard]] Outline symphysis(double z) const;
  [[nodiscard]] Outline ramus(double z, double side) const;
  double front_shift_;
  double spread_;  ///< tan of half the subpubic angle
  double start_x_;
  Irregularity irregularity_;
};

/// Stiff band (puboprostatic ligaments) from the gland's anterior-inferior end to the arch; overlaps both.
class Band : public Organ {
 public:
  Band(const Prostate& prostate, const Urethra& urethra, const PubicArch& arch);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;

 private:
  const Prostate& prostate_;
  const Urethra& urethra_;
  const PubicArch& arch_;
};

class Body : public Organ {
 public:
  Body(const Sizes& sizes, const Prostate& prostate, Random& random);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;

 private:
  double half_width_;
  double half_depth_;
  Irregularity irregularity_;
};

}  // namespace stylet::phantom
