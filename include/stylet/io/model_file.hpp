// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// A compiled model in one file (HDF5, docs/models.md): scenario, mesh and recorded motions, and what takes long to
/// compute of them, the compliance of the needles' corridor. From it the first step is seconds away at any size of
/// mesh.

/// What is in a model file.
struct ModelFile {
  std::string version;             ///< of the program that wrote it
  std::string scenario_text;       ///< TOML, as resolved
  std::vector<std::string> notes;  ///< of the mesher
  TetMesh mesh;
  std::vector<std::vector<MotionSample>> motions;  ///< one per insertion, empty where the plan was followed
  std::string element;
  std::vector<Index> corridor;  ///< displacement nodes
  ModelCompliance compliance;
  std::string belongs_to;  ///< digest of what the compliance was computed from
};

/// Writes a model that has just been compiled; the file appears whole or not at all.
/// @param notes of the mesher, for reports
/// Errors: the full inverse of an engine is not saved; a model that a simulation has already grown beyond its corridor;
/// the disk's.
Result<> save_model(const Model& model, const std::filesystem::path& path, std::span<const std::string> notes = {},
                    const Progress& progress = {});

/// Reads a model file as it is. Errors: no such file, not a model file, of another version of the format, damaged (a
/// digest is checked).
Result<ModelFile> read_model_file(const std::filesystem::path& path, const Progress& progress = {});

/// The model in a file, ready for a Simulation. Its stiffness is factorised only when something needs it: compliance
/// beyond the corridor, whole displacement fields.
/// Errors: those of read_model_file(); settings that change what the compliance was computed from.
/// @param settings as of read_scenario(); none of [patient] and [mesh], whose outcome is in the file
Result<std::shared_ptr<const Model>> load_model(const std::filesystem::path& path, const Progress& progress = {},
                                                std::span<const std::string> settings = {});

/// The same of a file that has been read.
/// @param path for messages
Result<std::shared_ptr<const Model>> compile_model(ModelFile file, const std::filesystem::path& path,
                                                   const Progress& progress = {},
                                                   std::span<const std::string> settings = {});

/// Refuses settings of [patient] and [mesh] where the mesh is there already: they would do nothing.
/// @param settings as of read_scenario()
/// @param where the file with the mesh, for messages
Result<> check_settings(std::span<const std::string> settings, const std::string& where);

/// True for an HDF5 file that says it holds a model; what is in it may still be damaged.
bool is_model_file(const std::filesystem::path& path);

/// The same, and true also for a file that is too damaged to say what it holds but is named like a model (.stylet):
/// read_model_file() has the message for it.
bool is_meant_as_model(const std::filesystem::path& path);

/// True for any HDF5 file, by its first bytes.
bool is_hdf5_file(const std::filesystem::path& path);

}  // namespace stylet
