// SPDX-License-Identifier: GPL-3.0-or-later
// Writers of dose grids: DICOM RTDOSE (DICOM PS3.3 A.18.3) and NRRD.
#include "detail/dicom_write.hpp"
#include "detail/memory_stream.hpp"
#include "dose/dose_bytes.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/files.hpp"

#include <fmt/format.h>
#include <teem/nrrd.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace stylet {

namespace {

namespace fs = std::filesystem;
using detail::Filler;
using detail::precise_decimal_string;

Result<> check_grid(const DoseGrid& grid, const std::string& where) {
  const bool sized = grid.size[0] > 0 && grid.size[1] > 0 && grid.size[2] > 0 && grid.dose_Gy.size() == grid.count();
  const bool finite = std::all_of(grid.dose_Gy.begin(), grid.dose_Gy.end(), [](float d) { return std::isfinite(d); });
  if (sized && finite) return Ok{};
  return failure(where, sized ? "the dose grid has a dose that is not finite" : "the dose grid has no points",
                 "Compute the dose on a grid first");
}

/// Text from which the identifiers of the file are derived.
std::string print_of_grid(const DoseGrid& grid, const std::string& plan, const PatientRecord& patient) {
  std::string text = fmt::format("{}\n{}\n{}{} {} {}\n", plan, version(), detail::print_of(patient), grid.size[0],
                                 grid.size[1], grid.size[2]);
  for (const Vec3& x : {grid.origin_mm, grid.spacing_mm, Vec3(grid.direction.col(0)), Vec3(grid.direction.col(1))})
    text += fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
  double sum = 0.0;
  for (std::size_t p = 0; p < grid.dose_Gy.size(); ++p)
    sum += static_cast<double>(grid.dose_Gy[p]) * static_cast<double>(p + 1);
  return text + fmt::format("{}", sum);
}

void fill_dose(Filler& fill, DcmDataset& data, const DoseGrid& grid, const std::string& plan,
               const PatientRecord& patient, const std::string& comment, double scaling) {
  const std::string print = print_of_grid(grid, plan, patient);
  detail::fill_common(fill, data, UID_RTDoseStorage, "RTDOSE", print, patient);
  fill.text(data, DCM_InstanceNumber, "1");
  const std::string& frame = patient.frame_of_reference.empty() ? grid.frame_of_reference : patient.frame_of_reference;
  fill.text(data, DCM_FrameOfReferenceUID, frame.empty() ? detail::derived_uid(print, "frame") : frame);
  fill.text(data, DCM_PositionReferenceIndicator, patient.position_reference);
  const auto vector = [](const Vec3& x) {
    return precise_decimal_string(x.x()) + "\\" + precise_decimal_string(x.y()) + "\\" + precise_decimal_string(x.z());
  };
  fill.text(data, DCM_ImagePositionPatient, vector(grid.origin_mm));
  fill.text(data, DCM_ImageOrientationPatient, vector(grid.direction.col(0)) + "\\" + vector(grid.direction.col(1)));
  fill.text(data, DCM_SliceThickness, precise_decimal_string(grid.spacing_mm.z()));
  fill.text(data, DCM_PixelSpacing,
            precise_decimal_string(grid.spacing_mm.y()) + "\\" + precise_decimal_string(grid.spacing_mm.x()));
  fill.text(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  fill.text(data, DCM_NumberOfFrames, std::to_string(grid.size[2]));
  fill.number(data, DCM_SamplesPerPixel, 1);
  fill.number(data, DCM_Rows, static_cast<Uint16>(grid.size[1]));
  fill.number(data, DCM_Columns, static_cast<Uint16>(grid.size[0]));
  fill.number(data, DCM_BitsAllocated, 32);
  fill.number(data, DCM_BitsStored, 32);
  fill.number(data, DCM_HighBit, 31);
  fill.number(data, DCM_PixelRepresentation, 0);
  fill.tag(data, DCM_FrameIncrementPointer, DCM_GridFrameOffsetVector);
  fill.text(data, DCM_DoseUnits, "GY");
  fill.text(data, DCM_DoseType, "PHYSICAL");
  if (!comment.empty()) fill.text(data, DCM_DoseComment, detail::short_text(comment, 64));
  fill.text(data, DCM_DoseSummationType, "PLAN");
  fill.text(data, DCM_TissueHeterogeneityCorrection, "WATER");
  fill.text(data, DCM_DoseGridScaling, precise_decimal_string(scaling));
  std::string offsets;
  for (Index k = 0; k < grid.size[2]; ++k)
    offsets += (k == 0 ? "" : "\\") + precise_decimal_string(k * grid.spacing_mm.z());
  fill.text(data, DCM_GridFrameOffsetVector, offsets);
  if (!plan.empty()) {
    DcmItem& reference = fill.new_item(data, DCM_ReferencedRTPlanSequence);
    fill.text(reference, DCM_ReferencedSOPClassUID, UID_RTPlanStorage);
    fill.text(reference, DCM_ReferencedSOPInstanceUID, plan);
  }
  std::vector<Uint16> words;
  words.reserve(2 * grid.dose_Gy.size());
  for (const float dose : grid.dose_Gy) {
    const auto number = static_cast<Uint32>(std::llround(std::max(0.0, static_cast<double>(dose)) / scaling));
    words.push_back(static_cast<Uint16>(number & 0xffffU));
    words.push_back(static_cast<Uint16>(number >> 16U));
  }
  fill.words(data, DCM_PixelData, words);
}

}  // namespace

Result<std::string> rtdose_bytes(const DoseGrid& grid, const std::string& plan_sop_instance, const std::string& where,
                                 const PatientRecord& patient, const std::string& comment) {
  if (Result<> good = check_grid(grid, where); !good) return good.error();
  if (grid.size[0] > 65535 || grid.size[1] > 65535)
    return failure(where, "a DICOM grid has at most 65535 rows and columns", "Use a coarser grid");
  constexpr double most = 4.0e9;  // below 2³², so that rounding cannot pass it
  const double highest = static_cast<double>(*std::max_element(grid.dose_Gy.begin(), grid.dose_Gy.end()));
  // The scaling is rounded to the digits that the file holds before doses are divided by it.
  const double scaling = std::stod(precise_decimal_string(std::max(highest, 1e-6) / most));
  DcmFileFormat file;
  Filler fill;
  fill_dose(fill, *file.getDataset(), grid, plan_sop_instance, patient, comment, scaling);
  return detail::dicom_bytes(file, fill, where, EXS_LittleEndianExplicit, "RT Dose");
}

Result<> write_rtdose(const DoseGrid& grid, const std::string& plan_sop_instance, const fs::path& path,
                      const PatientRecord& patient, const std::string& comment) {
  auto bytes = rtdose_bytes(grid, plan_sop_instance, path.string(), patient, comment);
  if (!bytes) return bytes.error();
  return write_whole_file(path, *bytes);
}

Result<std::string> dose_nrrd_bytes(const DoseGrid& grid, const std::string& where) {
  if (Result<> good = check_grid(grid, where); !good) return good.error();
  const std::unique_ptr<Nrrd, Nrrd* (*)(Nrrd*)> volume(nrrdNew(), nrrdNix);
  std::vector<float> doses = grid.dose_Gy;  // the library wants to be able to change them
  const std::size_t size[] = {static_cast<std::size_t>(grid.size[0]), static_cast<std::size_t>(grid.size[1]),
                              static_cast<std::size_t>(grid.size[2])};
  bool good = nrrdWrap_nva(volume.get(), doses.data(), nrrdTypeFloat, 3, size) == 0;
  double directions[NRRD_DIM_MAX][NRRD_SPACE_DIM_MAX] = {};
  double origin[NRRD_SPACE_DIM_MAX] = {};
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = grid.origin_mm[axis];
    for (int c = 0; c < 3; ++c) directions[axis][c] = grid.direction(c, axis) * grid.spacing_mm[axis];
  }
  good = good && nrrdSpaceSet(volume.get(), nrrdSpaceLeftPosteriorSuperior) == 0 &&
         nrrdSpaceOriginSet(volume.get(), origin) == 0;
  nrrdAxisInfoSet_nva(volume.get(), nrrdAxisInfoSpaceDirection, directions);
  good = good && nrrdKeyValueAdd(volume.get(), "quantity", "dose [Gy]") == 0;
  const std::unique_ptr<NrrdIoState, NrrdIoState* (*)(NrrdIoState*)> io(nrrdIoStateNew(), nrrdIoStateNix);
  io->encoding = nrrdEncodingGzip;
  io->format = nrrdFormatNRRD;
  const detail::MemoryStream memory;
  good = good && nrrdWrite(memory.stream(), volume.get(), io.get()) == 0;
  std::fclose(memory.stream());
  if (good) return memory.bytes();
  const std::unique_ptr<char, void (*)(void*)> why(biffGetDone(NRRD), std::free);
  return failure(where, fmt::format("the dose grid cannot be made ({})", why ? why.get() : "NRRD"),
                 "Use a coarser grid");
}

Result<> write_dose_nrrd(const DoseGrid& grid, const fs::path& path) {
  auto bytes = dose_nrrd_bytes(grid, path.string());
  if (!bytes) return bytes.error();
  return write_whole_file(path, *bytes);
}

}  // namespace stylet
