// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stylet::results {

/// Creates `folder` and its parents if necessary, and checks that files can be created in it.
Result<> prepare_folder(const std::filesystem::path& folder);

/// Name and content of a file to write.
struct File {
  std::string name;
  std::string content;
};

/// Writes files into a folder. A new folder appears only when it is complete. In an existing folder the files are
/// replaced one by one; the last one of the list is removed first and written last, so a folder that has it is
/// complete.
Result<> write_folder(const std::vector<File>& files, const std::filesystem::path& folder);

/// A text as a quoted field of a CSV file.
std::string csv_text(std::string_view text);

/// Removes a file of an earlier run, if it exists.
Result<> remove_earlier(const std::filesystem::path& path);

/// Removes the files named `stem`_0123.`extension` with numbers from `first` on, which are frames of an earlier, longer
/// run.
Result<> remove_series_from(const std::filesystem::path& folder, std::string_view stem, std::string_view extension,
                            std::size_t first);

/// The name of a file of a series: "tissue_0012.vtu" for ("tissue", 12, ".vtu").
std::string series_name(std::string_view stem, std::size_t number, std::string_view extension);

}  // namespace stylet::results
