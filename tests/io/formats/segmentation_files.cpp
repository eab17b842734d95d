// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation_files.hpp"

#include <dcmtk/dcmfg/fgfracon.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmseg/segdoc.h>
#include <dcmtk/dcmseg/segment.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>

namespace stylet::test {

namespace {

void good(const OFCondition& status) {
  if (status.bad()) throw std::runtime_error(status.text());
}

OFString number(double value) { return fmt::format("{:.10g}", value).c_str(); }

/// Adds the functional groups that all frames share: orientation and spacing.
void add_shared(DcmSegmentation& seg, const Mask& frame) {
  const Vec3 r = frame.axes.col(0).normalized(), c = frame.axes.col(1).normalized();
  FGPixelMeasures measures;
  good(measures.setPixelSpacing(number(frame.axes.col(1).norm()) + "\\" + number(frame.axes.col(0).norm())));
  good(measures.setSliceThickness(number(frame.axes.col(2).norm())));
  good(seg.addForAllFrames(measures));
  FGPlaneOrientationPatient turn;
  good(turn.setImageOrientationPatient(number(r.x()), number(r.y()), number(r.z()), number(c.x()), number(c.y()),
                                       number(c.z())));
  good(seg.addForAllFrames(turn));
}

void add_slice(DcmSegmentation& seg, const Mask& frame, std::vector<Uint8> pixels, Uint16 segment, int k) {
  const Vec3 place = frame.origin + frame.axes * Vec3(0, 0, k);
  FGPlanePosPatient position;
  good(position.setImagePositionPatient(number(place.x()), number(place.y()), number(place.z())));
  FGFrameContent content;
  good(content.setStackID("1"));
  OFVector<FGBase*> groups;
  groups.push_back(&position);
  groups.push_back(&content);
  good(seg.addFrame(pixels.data(), segment, groups));
}

}  // namespace

fs::path write_seg(const fs::path& path, const Mask& frame, const std::vector<Drawn>& segments, int most,
                   const std::function<int(int, int, int)>& partial) {
  const IODGeneralEquipmentModule::EquipmentInfo equipment("Stylet", "test", "1", "1");
  const ContentIdentificationMacro identification("1", "SEG", "a segmentation", "Test^Stylet");
  DcmSegmentation* made = nullptr;
  const auto rows = static_cast<Uint16>(frame.size[1]), columns = static_cast<Uint16>(frame.size[0]);
  good(most == 0 ? DcmSegmentation::createBinarySegmentation(made, rows, columns, equipment, identification)
                 : DcmSegmentation::createFractionalSegmentation(made, rows, columns, DcmSegTypes::SFT_OCCUPANCY,
                                                                 static_cast<Uint16>(most), equipment, identification));
  const std::unique_ptr<DcmSegmentation> seg(made);
  add_shared(*seg, frame);
  for (const Drawn& drawn : segments) {
    DcmSegment* segment = nullptr;
    good(DcmSegment::create(segment, drawn.label.c_str(), CodeSequenceMacro("85756007", "SCT", "Tissue"),
                            CodeSequenceMacro("1", "99STYLET", drawn.meaning.c_str()), DcmSegTypes::SAT_MANUAL));
    Uint16 n = 0;
    good(seg->addSegment(segment, n));
    for (int k = frame.size[2] - 1; k >= 0; --k) {
      std::vector<Uint8> pixels;
      bool empty = true;
      for (int j = 0; j < frame.size[1]; ++j) {
        for (int i = 0; i < frame.size[0]; ++i) {
          const bool in = drawn.inside(i, j, k);
          pixels.push_back(static_cast<Uint8>(most == 0 ? static_cast<int>(in) : in ? partial(i, j, k) : 0));
          empty = empty && !in;
        }
      }
      if (!empty) add_slice(*seg, frame, pixels, n, k);
    }
  }
  seg->getSeries().setSeriesNumber("1");
  good(seg->getDimensions().addDimensionIndex(DCM_ReferencedSegmentNumber, "1.2.3.5", DCM_SegmentIdentificationSequence,
                                              "segment"));
  seg->getFrameOfReference().setFrameOfReferenceUID("1.2.3.4");
  seg->setCheckFGOnWrite(OFFalse);
  seg->setCheckDimensionsOnWrite(OFFalse);
  good(seg->saveFile(path.c_str()));
  return path;
}

fs::path edit_dicom(const fs::path& path, const std::function<void(DcmDataset&)>& change) {
  DcmFileFormat file;
  good(file.loadFile(path.c_str()));
  good(file.loadAllDataIntoMemory());
  change(*file.getDataset());
  good(file.saveFile(path.c_str(), EXS_LittleEndianExplicit));
  return path;
}

DcmItem& group_of_frame(DcmDataset& data, int frame, const DcmTagKey& group) {
  DcmItem* own = nullptr;
  DcmItem* item = nullptr;
  good(data.findAndGetSequenceItem(DCM_PerFrameFunctionalGroupsSequence, own, frame));
  good(own->findAndGetSequenceItem(group, item));
  return *item;
}

std::string layered_nrrd(const Mask& frame, const std::vector<std::vector<std::uint8_t>>& layers,
                         const std::string& keys) {
  std::string text = nrrd(frame);
  text.resize(text.size() - frame.labels.size() - 1);  // removes the data and the empty line before them
  text = replaced(text, "dimension: 3", "dimension: 4");
  text = replaced(text, "sizes: ", fmt::format("sizes: {} ", layers.size()));
  text = replaced(text, "space directions: (", "space directions: none (");
  text = replaced(text, "kinds: domain", "kinds: list domain");
  text += keys + "\n";
  for (std::size_t n = 0; n < frame.labels.size(); ++n) {
    for (const auto& layer : layers) text += static_cast<char>(layer[n]);
  }
  return text;
}

}  // namespace stylet::test
