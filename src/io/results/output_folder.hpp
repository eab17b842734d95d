// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stylet::results {

/// Makes sure `folder` exists, with its parents, and that files can be created in it.
Result<> prepare_folder(const std::filesystem::path& folder);

/// Writes `content` as the file `path`, whole or not at all.
Result<> write_file(const std::filesystem::path& path, std::string_view content);

/// A file that is written in one go.
struct File {
  std::string name;
  std::string content;
};

/// Fills a folder with these files. A new folder appears whole or not at all; in one that exists the files are replaced
/// one by one, of which the last goes first and comes last: a folder that holds it is complete.
Result<> write_folder(const std::vector<File>& files, const std::filesystem::path& folder);

/// A text as a field of a CSV file, in quotation marks.
std::string csv_text(std::string_view text);

/// The error every writer of the result folder returns when the disk refuses: names the file and the system's reason.
Error write_error(const std::filesystem::path& path, const std::string& reason);

/// Removes a file of an earlier run, if it is there.
Result<> remove_earlier(const std::filesystem::path& path);

/// Removes files called `stem`_0123.`extension` with a number of `first` or more: frames of an earlier, longer run.
Result<> remove_series_from(const std::filesystem::path& folder, std::string_view stem, std::string_view extension,
                            std::size_t first);

/// "tissue_0012.vtu" for ("tissue", 12, ".vtu").
std::string series_name(std::string_view stem, std::size_t number, std::string_view extension);

}  // namespace stylet::results
