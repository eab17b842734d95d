// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "files.hpp"
#include "stylet/io/contours_io.hpp"

#include <functional>

namespace stylet::test {

/// A structure set of two organs without header and file ending, changed by DCMTK.
inline fs::path bare_file(const Folder& folder, E_TransferSyntax syntax, const std::function<void(DcmDataset&)>& change,
                          E_GrpLenEncoding group_length = EGL_withoutGL) {
  EXPECT_TRUE(write_rtstruct(two_organs(), folder / "case.dcm").ok());
  DcmFileFormat file;
  EXPECT_TRUE(file.loadFile((folder / "case.dcm").c_str()).good());
  file.loadAllDataIntoMemory();
  change(*file.getDataset());
  const fs::path bare = folder / "bare";
  EXPECT_TRUE(
      file.saveFile(bare.c_str(), syntax, EET_ExplicitLength, group_length, EPD_noChange, 0, 0, EWM_dataset).good());
  return bare;
}

}  // namespace stylet::test
