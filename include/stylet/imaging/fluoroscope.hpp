// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/imaging/grey_picture.hpp"
#include "stylet/imaging/moment.hpp"
#include "stylet/imaging/xray_geometry.hpp"

#include <memory>
#include <span>

namespace stylet {

/// A fluoroscope: an X-ray unit on a C-arm that shows the deformed patient, needles and seeds in a cone beam of photons
/// of one energy. Each ray is attenuated by exp(−Σ μ · length) over what it passes; scatter, the spectrum of a tube,
/// the size of the focal spot and the table are left out. Dense is dark.
///
/// Not a medical device: pictures for training and research.
class Fluoroscope {
 public:
  /// @param mesh not kept; regions have canonical names. The C-arm turns about the centre of the target (prostate, or
  ///   else a planning volume), or of the whole mesh without a target.
  /// Errors: a source or a detector that would be inside the patient.
  static Result<std::unique_ptr<Fluoroscope>> create(const TetMesh& mesh, const FluoroscopySettings& settings);
  ~Fluoroscope();
  Fluoroscope(const Fluoroscope&) = delete;
  Fluoroscope& operator=(const Fluoroscope&) = delete;

  /// Makes the picture of a moment. Does not allocate. The same settings and moment give the same bits; the noise
  /// depends on the seed and on the moment's time. The picture lies in the plane through the centre.
  /// @param moment displacement has a column for each node of the mesh
  const GreyPicture& expose(const Moment& moment);

  /// The picture of the last exposure.
  [[nodiscard]] const GreyPicture& picture() const;
  /// Share of the photons that came through in the last exposure, without noise and blur (pixels²), row by row.
  [[nodiscard]] std::span<const float> transmission() const;
  /// Optical depth that the detector saw in the last exposure (pixels²): −ln of its signal relative to air.
  [[nodiscard]] std::span<const float> optical_depth() const;
  [[nodiscard]] const XrayGeometry& geometry() const;
  [[nodiscard]] const FluoroscopySettings& settings() const;

 private:
  struct Parts;
  explicit Fluoroscope(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// Subtracts two pictures of one moment with different energies so that soft tissue vanishes (dual-energy subtraction):
/// ln-signal of the low energy less μ_low / μ_high times that of the high energy, μ of soft tissue. Bone, contrast and
/// metal stay.
/// Errors: pictures that differ in anything but the energy and the seed of their noise, or do not differ in energy.
Result<GreyPicture> without_soft_tissue(const Fluoroscope& low, const Fluoroscope& high);

}  // namespace stylet
