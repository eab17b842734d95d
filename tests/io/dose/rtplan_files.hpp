// SPDX-License-Identifier: GPL-3.0-or-later
// RT Plans as planning systems write them, made for tests.
#pragma once

#include "stylet/core/types.hpp"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stylet::testing_files {

inline const DcmTagKey kOrientationTag(0x300a, 0x0412);

inline DcmItem& new_item(DcmItem& parent, const DcmTagKey& sequence) {
  DcmItem* item = nullptr;
  parent.findOrCreateSequenceItem(sequence, item, -2);
  return *item;
}

inline void put(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
  item.putAndInsertString(tag, value.c_str());
}

/// One control point.
struct Point {
  Vec3 at;
  double weight;
  std::optional<Vec3> axis{};
};

/// A plan under construction; save() writes it.
class RtplanFile {
 public:
  RtplanFile(const std::string& type, const std::string& technique, const std::string& isotope, double half_life_days,
             const std::string& strength) {
    DcmDataset& data = *file.getDataset();
    put(data, DCM_SOPClassUID, UID_RTPlanStorage);
    put(data, DCM_SOPInstanceUID, "1.2.3.4");
    put(data, DCM_Modality, "RTPLAN");
    put(data, DCM_FrameOfReferenceUID, "1.2.3");
    put(data, DCM_RTPlanLabel, "test");
    if (!type.empty()) put(data, DCM_BrachyTreatmentType, type);
    if (!technique.empty()) put(data, DCM_BrachyTreatmentTechnique, technique);
    source(1, isotope, half_life_days, strength);
  }

  void source(int number, const std::string& isotope, double half_life_days, const std::string& strength,
              const std::string& date = "20240102") {
    DcmItem& item = new_item(*file.getDataset(), DCM_SourceSequence);
    put(item, DCM_SourceNumber, std::to_string(number));
    put(item, DCM_SourceIsotopeName, isotope);
    put(item, DCM_SourceIsotopeHalfLife, fmt::format("{:g}", half_life_days));
    put(item, DCM_ActiveSourceLength, "3.0");
    if (!strength.empty()) put(item, DCM_ReferenceAirKermaRate, strength);
    put(item, DCM_SourceStrengthReferenceDate, date);
  }

  DcmItem& setup(const std::string& type, int number) {
    DcmItem& item = new_item(*file.getDataset(), DCM_ApplicationSetupSequence);
    put(item, DCM_ApplicationSetupType, type);
    put(item, DCM_ApplicationSetupNumber, std::to_string(number));
    return item;
  }

  static DcmItem& channel(DcmItem& setup, int number, double total_s, double last_weight,
                          const std::vector<Point>& points, int source = 1) {
    DcmItem& item = new_item(setup, DCM_ChannelSequence);
    put(item, DCM_ChannelNumber, std::to_string(number));
    put(item, DCM_ChannelTotalTime, fmt::format("{:.8g}", total_s));
    put(item, DCM_FinalCumulativeTimeWeight, fmt::format("{:.8g}", last_weight));
    put(item, DCM_ReferencedSourceNumber, std::to_string(source));
    int index = 0;
    for (const Point& point : points) {
      DcmItem& control = new_item(item, DCM_BrachyControlPointSequence);
      put(control, DCM_ControlPointIndex, std::to_string(index++));
      put(control, DCM_CumulativeTimeWeight, fmt::format("{:.8g}", point.weight));
      put(control, DCM_ControlPoint3DPosition,
          fmt::format("{:.6g}\\{:.6g}\\{:.6g}", point.at.x(), point.at.y(), point.at.z()));
      if (point.axis) {
        const Float32 axis[] = {static_cast<Float32>(point.axis->x()), static_cast<Float32>(point.axis->y()),
                                static_cast<Float32>(point.axis->z())};
        control.putAndInsertFloat32Array(kOrientationTag, axis, 3);
      }
    }
    return item;
  }

  std::filesystem::path save(const std::filesystem::path& path) {
    file.saveFile(path.c_str(), EXS_LittleEndianExplicit);
    return path;
  }

  DcmFileFormat file;
};

}  // namespace stylet::testing_files
