// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "outline.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// The organs of the demo patient, in mm and LPS (+x left, +y posterior, +z superior), with the origin at the centre of
/// the prostate. The patient is an adult man in lithotomy position. The body ends at the perineal skin and at the dome
/// of the bladder.
namespace stylet::phantom {

/// Sizes of one patient. The defaults are the reference patient (seed 0); other patients are drawn around them.
///
/// Sources of the numbers:
/// - gland volume: 37.4 ± 9.6 cc before implantation (149 patients, BMC Radiation Oncology 2013, 8:177), 49 cc (22–106)
///   and length 4.5 cm (3.1–6.0) after it (191 patients, Holmes et al. 2014). The reference patient has 40 cc, the
///   others 32–56 cc.
/// - shape of the sections: width about 1.35 × depth, filling 0.83–0.88 of the box around it; apex and base rounded as
///   in expert-drawn MR contours (Medical Segmentation Decathlon, task 5; Antonelli et al., Nat Commun 2022, 13:4128).
/// - urethra: 6–7 mm wide, as contoured with a catheter in place; curved anteriorly below the verumontanum.
/// - pubic bone: nearest point 4–6 mm (Visible Human Male, Browne & Schlehlein 2022, doi:10.48539/HBM893.QGJK.978) to
///   about 1 cm from the gland; subpubic angle of men 50–82° (obstetric textbooks).
/// - rectum: 25–35 mm across, 3–6 mm behind the gland; anal canal about 4 cm long.
/// - perineal skin: about 3 cm below the apex, so that a needle of 20 cm reaches the base through a template.
struct Sizes {
  double prostate_cc = 40.0;
  double prostate_width = 1.36;   ///< width / depth
  double prostate_length = 1.28;  ///< length / depth
  double prostate_hollow = 2.2;   ///< [mm] depth of the posterior concavity
  double urethra_diameter = 6.6;  ///< [mm]
  double bladder_cc = 120.0;
  double rectum_diameter = 30.0;  ///< [mm] mean of width and depth in the middle
  double rectum_gap = 4.0;        ///< [mm] between the gland's most posterior part and the rectum
  double retropubic_gap = 7.0;    ///< [mm] between gland and symphysis
  double subpubic_angle = 72.0;   ///< [deg]
  double skin_below_apex = 30.0;  ///< [mm]
  double body_width = 172.0;      ///< [mm]
  double body_depth = 142.0;      ///< [mm]
};

/// The sizes of the patient with a given seed.
Sizes sizes_of(std::uint64_t seed);

/// One structure: gives its outlines at any height between `low` and `high`.
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

/// The gland. Its half axes determine the positions of all other organs.
class Prostate : public Organ {
 public:
  Prostate(const Sizes& sizes, Random& random);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;

  /// y [mm] of the gland's anterior surface in the middle plane x = 0, without irregularities.
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
  /// y of the anterior wall [mm].
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
  double unit_;   ///< [mm] half length of the gland
  double front_;  ///< [mm] shift of the anterior wall
  double scale_;  ///< factor of the diameters
  Irregularity irregularity_;
};

class PubicArch : public Organ {
 public:
  PubicArch(const Sizes& sizes, const Prostate& prostate, Random& random);
  [[nodiscard]] std::vector<Outline> outlines(double z) const override;
  /// y of the posterior surface of the symphysis in the middle plane [mm]; below the lower end of the symphysis, the
  /// value there.
  [[nodiscard]] double back(double z) const;

  double symphysis_low = 0.0;  ///< [mm] z below which the arch consists of two rami

 private:
  [[nodiscard]] Outline symphysis(double z) const;
  [[nodiscard]] Outline ramus(double z, double side) const;
  double front_shift_;
  double spread_;  ///< tangent of half the subpubic angle
  double start_x_;
  Irregularity irregularity_;
};

/// Stiff band (puboprostatic ligaments) from the gland's anterior-inferior end to the arch; it overlaps both.
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
