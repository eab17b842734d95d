// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the deformed patient that the server makes: ultrasound before scan conversion, and X-ray.

export type ShownImage = 'none' | 'transverse' | 'sagittal' | 'xray';
export type Place = [number, number, number];

/**
 * An ultrasound picture, line by line. In its plane, `right` and `up` are directions on the screen, and the array looks
 * up. The lines of a sector leave the origin at angles from −sector_deg/2 to +sector_deg/2, turning from up to right, and
 * begin at radius_mm. The lines of a linear array (sector_deg = 0) are parallel, from first_mm on, length_mm wide, to the
 * right, and begin radius_mm above the origin.
 */
export interface Ultrasound {
  modality: 'ultrasound';
  time_s: number;
  took_ms: number;                 // processor time of this picture
  array: 'transverse' | 'sagittal';
  radius_mm: number;
  depth_mm: number;                // length of a line
  focus_mm: number;                // from the start of a line
  sector_deg: number;
  first_mm: number;
  length_mm: number;
  range_dB: number;                // from the darkest to the brightest value
  origin_mm: Place;                // LPS
  right: Place;                    // unit vectors, LPS
  up: Place;
  probe: ProbeState;
}

/** Where the stepper holds the probe. */
export interface ProbeState {
  depth_mm: number;                // LPS z of the transverse array, along the probe
  lift_mm: number;
  tilt_deg: number;
  roll_deg: number;
  balloon_mm: number;
  step_mm: number;                 // of a click
  diameter_mm: number;
  tip_mm: Place;                   // LPS, the rounded end
  axis: Place;                     // LPS, towards the end
  force_N: number | null;          // of wall and gland on the probe; null: it does not press
}

export interface Xray {
  modality: 'xray';
  time_s: number;
  took_ms: number;
  angle_deg: number;
  cranial_deg: number;
  energy_keV: number;
  mm_per_pixel: number;            // at the gland
  probe: ProbeState | null;
}

export type ImageText = Ultrasound | Xray;
interface Pixels { rows: number; columns: number; pixels: Uint8Array }
export type LiveUltrasound = Ultrasound & Pixels;
export type LiveXray = Xray & Pixels;
export type LiveImage = LiveUltrasound | LiveXray;
