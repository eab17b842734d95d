// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// The content of a model file (HDF5, docs/models.md): a compiled model with scenario, mesh, recorded motions, and the
/// compliance of the needles' corridor, which takes long to compute. With it a simulation starts within seconds for any
/// size of mesh.
struct ModelFile {
  std::string version;             ///< version of the program that wrote the file
  std::string scenario_text;       ///< TOML, with all defaults filled in
  std::vector<std::string> notes;  ///< notes of the mesher
  TetMesh mesh;
  std::vector<std::vector<MotionSample>> motions;  ///< one per insertion; empty if the insertion follows the plan
  std::string element;                             ///< name of the finite element
  std::vector<Index> corridor;                     ///< numbers of the displacement nodes in the needles' corridor
  ModelCompliance compliance;
  std::string belongs_to;  ///< digest of the data from which the compliance was computed
};

/// Saves a model that has just been compiled. On error no incomplete file is left.
/// @param notes notes of the mesher, for reports
/// Errors: a model whose engine keeps the full inverse; a model that a simulation has extended beyond its corridor;
/// errors of the disk.
Result<> save_model(const Model& model, const std::filesystem::path& path, std::span<const std::string> notes = {},
                    const Progress& progress = {});

/// Reads a model file. Errors: no such file, not a model file, another version of the format, damaged (a digest is
/// checked).
Result<ModelFile> read_model_file(const std::filesystem::path& path, const Progress& progress = {});

/// Loads the model from a file, ready for a Simulation. Its stiffness is factorised only when it is needed: for
/// compliance beyond the corridor and for displacement fields of the whole mesh.
/// Errors: as read_model_file(); settings that change the data from which the compliance was computed.
/// @param settings as for read_scenario(), but not of [patient] and [mesh], since the file holds the finished mesh
Result<std::shared_ptr<const Model>> load_model(const std::filesystem::path& path, const Progress& progress = {},
                                                std::span<const std::string> settings = {});

/// Makes the model, as load_model() does, from a file that has been read.
/// @param path name of the file in messages
Result<std::shared_ptr<const Model>> compile_model(ModelFile file, const std::filesystem::path& path,
                                                   const Progress& progress = {},
                                                   std::span<const std::string> settings = {});

/// Checks settings for a model with a finished mesh: settings of [patient] and [mesh] are errors, because they would
/// have no effect.
/// @param settings as for read_scenario()
/// @param where name of the file with the mesh in messages
Result<> check_settings(std::span<const std::string> settings, const std::string& where);

/// True for an HDF5 file that is marked as a model; its data may still be damaged.
bool is_model_file(const std::filesystem::path& path);

/// True for a file for which is_model_file() is true, and for a file named like a model (.stylet) that is too damaged
/// to be recognised; read_model_file() reports its error.
bool is_meant_as_model(const std::filesystem::path& path);

/// True for any HDF5 file, by its first bytes.
bool is_hdf5_file(const std::filesystem::path& path);

}  // namespace stylet
