// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/model_cache.hpp"

#include "detail/file_kind.hpp"
#include "detail/input_file.hpp"
#include "detail/private_files.hpp"
#include "detail/text.hpp"
#include "model/build_id.hpp"
#include "model/digest.hpp"
#include "model/model_format.hpp"
#include "stylet/io/files.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace stylet {
namespace fs = std::filesystem;
using detail::Digest;

namespace {

constexpr std::size_t kPiece = 1 << 20;

Result<> add_file(Digest& digest, const fs::path& path) {
  if (Result<> readable = detail::check_input_file(path); !readable) return readable;
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(kPiece);
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    digest.add(std::span<const char>(piece).first(static_cast<std::size_t>(file.gcount())));
  }
  if (file.eof()) return Ok{};
  return failure(path.string(), "cannot be read", "Check the file and its permissions");
}

/// Whether a file refers to data in another file, or is one of several files that belong together. As in the readers,
/// the content decides on the format before the name does.
bool has_other_parts(const fs::path& path) {
  using detail::FileKind;
  const std::string ending = detail::lower(path.extension().string());
  if (ending == ".mhd" || ending == ".nhdr" || ending == ".node" || ending == ".ele") return true;
  const Result<FileKind> kind = detail::identify(path);
  if (!kind || (*kind != FileKind::nrrd && *kind != FileKind::metaimage)) return kind && *kind == FileKind::tetgen;
  std::ifstream file(path, std::ios::binary);
  while (const std::optional<detail::HeaderLine> line = detail::next_header_line(file)) {
    if (!line->whole) return true;  // no reader accepts such a line
    const auto separator = line->text.find_first_of(*kind == FileKind::nrrd ? ":" : "=:");
    const std::string key = detail::trimmed(line->text.substr(0, separator));
    const std::string value =
        separator == std::string::npos ? "" : detail::lower(detail::trimmed(line->text.substr(separator + 1)));
    if (*kind == FileKind::metaimage) {
      if (key == "ElementDataFile") return value != "local";
    } else {
      if (line->text.empty()) return false;  // the data begin after the empty line
      if (detail::lower(key) == "data file" || detail::lower(key) == "datafile") return true;
    }
  }
  return false;
}

/// Adds a file to the digest, or all files of a folder in the order of their names.
Result<> add_input(Digest& digest, const fs::path& path) {
  std::error_code code;
  if (!fs::is_directory(path, code)) return add_file(digest, path);
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator entry(path, code), end; !code && entry != end; entry.increment(code)) {
    if (entry->is_regular_file(code)) files.push_back(entry->path());
  }
  if (code) return failure(path.string(), "cannot be read: " + code.message(), "Check the folder and its permissions");
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    digest.add(file.lexically_relative(path).string());
    if (auto added = add_file(digest, file); !added) return added;
  }
  return Ok{};
}

}  // namespace

Result<std::string> model_key(const Scenario& scenario) {
  const std::string build = detail::build_id();
  if (build.empty()) {
    return failure("cache of models", "this program has no build id, which is part of the names of cached models",
                   "Link it with -Wl,--build-id=sha1");
  }
  Digest digest;
  digest.add(build);
  digest.add(to_toml(scenario));
  std::vector<fs::path> inputs;
  if (scenario.patient.source != "phantom") inputs.emplace_back(scenario.patient.source);
  for (const InsertionPlan& plan : scenario.insertions) {
    if (!plan.motion.empty()) inputs.emplace_back(plan.motion);
  }
  if (scenario.insertions.empty() && !scenario.plan.file.empty()) inputs.emplace_back(scenario.plan.file);
  for (const fs::path& input : inputs) {
    if (has_other_parts(input))
      return failure(input.string(), "its data are in several files, which the cache does not support",
                     "Convert it to one file, such as .mha or .nrrd");
    if (auto added = add_input(digest, input); !added) return added.error();
  }
  return digest.finish();
}

ModelCache::ModelCache(fs::path folder, std::vector<fs::path> others, std::uintmax_t most_bytes)
    : folder_(std::move(folder)), others_(std::move(others)), most_bytes_(most_bytes) {}

fs::path ModelCache::users_folder() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    const fs::path path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : fs::path();
  };
  if (const fs::path cache = folder("XDG_CACHE_HOME"); !cache.empty()) return cache / "stylet" / "models";
  if (const fs::path home = folder("HOME"); !home.empty()) return home / ".cache" / "stylet" / "models";
  return {};
}

std::optional<fs::path> ModelCache::find(const std::string& key) const {
  std::vector<fs::path> places = others_;
  if (!folder_.empty()) places.insert(places.begin(), folder_);
  for (const fs::path& place : places) {
    const fs::path file = place / (key + detail::kModelExtension);
    if (!is_model_file(file)) continue;
    std::error_code ignored;  // in a read-only folder the time cannot be set
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
    return file;
  }
  return std::nullopt;
}

Result<> ModelCache::keep(const Model& model, const std::string& key, std::span<const std::string> notes,
                          const Progress& progress) const {
  if (folder_.empty() || model.inverse()) return Ok{};
  const Eigen::Index entries = model.store()->blocks().size();
  if (static_cast<std::uintmax_t>(entries) / 2 * sizeof(double) > most_bytes_)
    return Ok{};  // too large, although only one triangle of the symmetric matrix is saved
  detail::make_private_folder(folder_);
  if (auto made = make_folder(folder_); !made) return made;  // says why there is none
  const fs::path file = folder_ / (key + detail::kModelExtension);
  if (auto saved = save_model(model, file, notes, progress); !saved) return saved;
  forget_oldest(file);
  return Ok{};
}

void ModelCache::forget_oldest(const fs::path& newest) const {
  struct Kept {
    fs::file_time_type used;
    fs::path file;
    std::uintmax_t bytes = 0;
  };
  std::vector<Kept> kept;
  std::uintmax_t total = 0;
  std::error_code code;  // files that another process removes in the meantime are ignored
  for (fs::directory_iterator entry(folder_, code), end; !code && entry != end; entry.increment(code)) {
    std::error_code gone;
    const Kept one{entry->last_write_time(gone), entry->path(), entry->file_size(gone)};
    if (gone || one.file.extension() != detail::kModelExtension) continue;
    total += one.bytes;
    if (one.file != newest) kept.push_back(one);
  }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& one : kept) {
    if (total <= most_bytes_) return;
    fs::remove(one.file, code);
    total -= one.bytes;
  }
}

}  // namespace stylet
