// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "h5.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/probe_move.hpp"
#include "stylet/sim/recording.hpp"

#include <array>
#include <limits>
#include <span>
#include <string>

/// The format of run.h5 (docs/results.md): row types shared by its writer and its reader.
namespace stylet::results {

inline constexpr int kRunFileVersion = 6;
inline constexpr int kFirstWithChecks = 4;  ///< first version of the format with checks
inline constexpr int kFirstWithSeeds = 5;   ///< first version of the format that may have the seeds of an implant
inline constexpr int kFirstWithProbe = 6;   ///< first version of the format with the moves of a probe
inline constexpr const char* kRunFileFormat = "stylet-run";
inline constexpr const char* kImplantFileFormat = "stylet-implant";  ///< of the run.h5 of an implant
/// Fill value of rows that have not reached the disk.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Every row has a check: the CRC-32 of its other columns in their order and, for a frame, of its displacement, needle
// points and contacts. A row with a wrong check has not reached the disk completely, or has been changed.

/// A row of /steps: the columns of forces.csv, the input of the step (dt_s and base), the number of steps at rest
/// before it, and its flags (Step::Flag). Files of version 1 have no dt_s and no base, files before version 3 no
/// rest_steps, files before version 4 no flags.
struct StepRow {
  double time_s = kMissing, dt_s = kMissing, base_depth_mm = kMissing;
  double base_x_mm = kMissing, base_y_mm = kMissing, base_z_mm = kMissing;
  double base_qw = kMissing, base_qx = kMissing, base_qy = kMissing, base_qz = kMissing;
  double force_axial_N = kMissing, force_sagittal_N = kMissing, force_lateral_N = kMissing;
  double torque_x_Nmm = kMissing, torque_y_Nmm = kMissing, torque_z_Nmm = kMissing;
  double tip_x_mm = kMissing, tip_y_mm = kMissing, tip_z_mm = kMissing;
  std::int8_t tip_state = 0;
  std::int32_t contacts = 0, sticking = 0, iterations = 0;
  double step_us = kMissing;
  std::int64_t rest_steps = 0;
  std::uint32_t flags = 0;
  std::uint32_t check = 0;
};
std::uint32_t check_of(const StepRow& row);
StepRow to_row(const Step& step);
Step from_row(const StepRow& row);
h5::Handle step_row_type();

/// A row of /frames/table. The frame's needle points and contacts are consecutive rows of their own datasets.
struct FrameRow {
  double time_s = kMissing, base_depth_mm = kMissing;
  std::array<char, 64> label{};
  std::int64_t needle_first = 0, needle_count = 0;
  std::int64_t contact_first = 0, contact_count = 0;
  std::uint32_t check = 0;
};
h5::Handle frame_row_type();

/// A row of /frames/contacts.
struct ContactRow {
  std::array<double, 3> position_mm{kMissing, kMissing, kMissing};
  std::array<double, 3> force_N{kMissing, kMissing, kMissing};
  double arc_length_mm = kMissing;
  std::int8_t sticking = 0, tip = 0;
};
/// The check of a frame. @param displacement (3n) @param needle, contacts of this frame
std::uint32_t check_of(const FrameRow& row, std::span<const float> displacement, std::span<const Vec3> needle,
                       std::span<const ContactRow> contacts);
ContactRow to_row(const ContactView& contact);
ContactView from_row(const ContactRow& row);
h5::Handle contact_row_type();

/// A row of /events.
struct EventRow {
  std::int8_t kind = 0;
  double time_s = kMissing, depth_mm = kMissing, force_N = kMissing;
  std::array<char, 128> region{};
  std::uint32_t check = 0;
};
std::uint32_t check_of(const EventRow& row);
EventRow to_row(const Event& event);
Event from_row(const EventRow& row);
h5::Handle event_row_type();

/// A row of /probe: where the stepper holds the probe from a moment on (ProbeSettings).
struct ProbeRow {
  double time_s = kMissing;
  double depth_mm = kMissing;  ///< NaN: the middle of the gland
  double lift_mm = 0.0, tilt_deg = 0.0, roll_deg = 0.0;
  double diameter_mm = 0.0, balloon_mm = 0.0;
  std::uint32_t check = 0;
};
std::uint32_t check_of(const ProbeRow& row);
ProbeRow to_row(const ProbeMove& move);
/// @param planned the probe of the scenario, which has the settings that are not recorded
ProbeMove from_row(const ProbeRow& row, const ProbeSettings& planned);
h5::Handle probe_row_type();

/// The row of /end, which the writer adds when it closes the file: the numbers of rows.
struct EndRow {
  std::int64_t steps = 0, frames = 0, events = 0;
  std::int64_t summary_bytes = 0;
  std::uint32_t summary_check = 0;   ///< CRC-32 of /summary_json
  std::int64_t acts = 0, doses = 0;  ///< of /implant; files before version 5 do not have them
  std::int64_t probe_moves = 0;      ///< files before version 6 do not have it
  std::uint32_t check = 0;
};
/// @param version of the file's format
std::uint32_t check_of(const EndRow& row, int version = kRunFileVersion);
std::uint32_t check_of(std::string_view summary);
h5::Handle end_row_type();

/// Columns of /parameters.
inline constexpr std::array kParameterColumns{"name", "value", "unit", "source"};

/// SHA-256 of all data that are known before the first step, without the attributes about the format.
std::string start_digest(const RunInfo& info, const TetMesh& mesh);

/// Copies a text into a field of fixed length; a text that is too long is cut between two UTF-8 characters.
template <std::size_t N>
void put_text(std::array<char, N>& field, const std::string& text) {
  std::size_t length = text.size();
  if (length > N) {
    length = N;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  }
  field.fill('\0');
  for (std::size_t k = 0; k < length; ++k) field[k] = text[k];
}
template <std::size_t N>
std::string get_text(const std::array<char, N>& field) {
  std::size_t length = 0;
  while (length < N && field[length] != '\0') ++length;
  return {field.data(), length};
}

}  // namespace stylet::results
