// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging_entries.hpp"

namespace stylet {

namespace {

using ImagingSlot = ScenarioSlot;

void describe_probe(ScenarioEntries& keys) {
  keys.choice("probe.kind",
              "ultrasound probe in the rectum; biplane = a rod with a transverse and a sagittal array; endfire = a rod "
              "whose array is in its end",
              [](auto& s, const ImagingSlot&) { return &s.probe.kind; });
  keys.number("probe.diameter_mm", "mm", 5, 40, "diameter of the probe",
              [](auto& s, const ImagingSlot&) { return &s.probe.diameter_mm; });
  keys.number("probe.balloon_mm", "mm", 0, 20, "thickness of the water between probe and rectal wall",
              [](auto& s, const ImagingSlot&) { return &s.probe.balloon_mm; });
  keys.number("probe.depth_mm", "mm", -1e4, 1e4, "LPS z of the transverse array, along the probe's axis",
              [](auto& s, const ImagingSlot&) { return &s.probe.depth_mm; },
              {.standard = "the middle of the gland", .example = "0"});
  keys.number("probe.step_mm", "mm", 0.1, 20, "motion of one click of the stepper",
              [](auto& s, const ImagingSlot&) { return &s.probe.step_mm; });
  keys.number("probe.lift_mm", "mm", -30, 30, "anterior motion of the probe from the middle of the rectum",
              [](auto& s, const ImagingSlot&) { return &s.probe.lift_mm; });
  keys.number("probe.tilt_deg", "degree", -30, 30,
              "rotation of the probe about a left-right axis at the anus; positive = its end goes anterior",
              [](auto& s, const ImagingSlot&) { return &s.probe.tilt_deg; });
  keys.number("probe.roll_deg", "degree", -180, 180,
              "rotation of the probe about its axis; positive = the sagittal picture turns to the patient's left",
              [](auto& s, const ImagingSlot&) { return &s.probe.roll_deg; });
  keys.boolean("probe.in_contours",
               "whether the contours were drawn with the probe at this place; then it displaces nothing here, and the "
               "tissue moves when the probe is moved away",
               [](auto& s, const ImagingSlot&) { return &s.probe.in_contours; });
}

void describe_ultrasound(ScenarioEntries& keys) {
  keys.choice("ultrasound.array", "array that makes the picture",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.array; });
  keys.number("ultrasound.frequency_MHz", "MHz", 1, 20, "centre frequency",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.frequency_MHz; });
  keys.number("ultrasound.depth_mm", "mm", 20, 200, "depth of the picture from the probe's surface",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.depth_mm; });
  keys.number("ultrasound.sector_deg", "degree", 20, 360, "angle of the transverse picture",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.sector_deg; });
  keys.number("ultrasound.length_mm", "mm", 20, 120, "length of the sagittal array",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.length_mm; });
  keys.integer("ultrasound.lines", 32, 1024, "number of lines of a picture",
               [](auto& s, const ImagingSlot&) { return &s.ultrasound.lines; });
  keys.integer("ultrasound.samples", 64, 4096, "number of samples along a line",
               [](auto& s, const ImagingSlot&) { return &s.ultrasound.samples; });
  keys.number("ultrasound.focus_mm", "mm", 5, 200, "depth of the focus from the probe's surface",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.focus_mm; });
  keys.number("ultrasound.elevation_mm", "mm", 0.5, 20,
              "full thickness of the slice that the picture shows, at the focus",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.elevation_mm; });
  keys.number("ultrasound.gain_dB", "dB", -60, 60, "gain",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.gain_dB; });
  keys.vector<4>("ultrasound.tgc_dB", "dB", -60, 60,
                 "time gain compensation: gain at four depths, from the probe's surface to the far end, linear between "
                 "them, in addition to the gain that compensates the attenuation of soft tissue",
                 [](auto& s, const ImagingSlot&) { return &s.ultrasound.tgc_dB; });
  keys.number("ultrasound.dynamic_range_dB", "dB", 20, 120, "range of echoes from black to white",
              [](auto& s, const ImagingSlot&) { return &s.ultrasound.dynamic_range_dB; });
  keys.integer("ultrasound.random", 0, 1000000, "seed of the speckle; the same seed gives the same picture",
               [](auto& s, const ImagingSlot&) { return &s.ultrasound.random; });
}

void describe_fluoroscopy(ScenarioEntries& keys) {
  keys.number("fluoroscopy.angle_deg", "degree", -180, 180,
              "angle of the C-arm about the patient's axis; positive = the detector goes to the patient's left",
              [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.angle_deg; });
  keys.number("fluoroscopy.cranial_deg", "degree", -60, 60, "angle of the C-arm; positive = the detector goes superior",
              [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.cranial_deg; });
  keys.number("fluoroscopy.energy_keV", "keV", 20, 150, "energy of the photons, as if all had the same",
              [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.energy_keV; });
  keys.number("fluoroscopy.source_mm", "mm", 500, 2000, "distance of source and detector",
              [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.source_mm; });
  keys.number("fluoroscopy.detector_mm", "mm", 50, 1000, "distance of detector and gland",
              [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.detector_mm; });
  keys.number("fluoroscopy.field_mm", "mm", 20, 600, "width of the square picture, measured at the gland",
              [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.field_mm; });
  keys.integer("fluoroscopy.pixels", 32, 4096, "number of pixels along a side",
               [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.pixels; });
  keys.number("fluoroscopy.bladder_iodine_mg_per_ml", "mg/ml", 0, 400, "contrast in the bladder; 0 = none",
              [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.bladder_iodine_mg_per_ml; });
  keys.boolean("fluoroscopy.catheter", "a catheter with contrast in the urethra",
               [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.catheter; });
  keys.integer("fluoroscopy.photons", 0, 100000000,
               "photons per pixel without a patient, which give the noise; 0 = no noise",
               [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.photons; });
  keys.integer("fluoroscopy.random", 0, 1000000, "seed of the noise",
               [](auto& s, const ImagingSlot&) { return &s.fluoroscopy.random; });
}

}  // namespace

void describe_imaging(ScenarioEntries& keys) {
  describe_probe(keys);
  describe_ultrasound(keys);
  describe_fluoroscopy(keys);
}

}  // namespace stylet
