// SPDX-License-Identifier: GPL-3.0-or-later
// The gmsh library is loaded only when a file needs it: it depends on CAD libraries, and binding their symbols would
// take most of the time of `stylet --version`.
#pragma once

#include "stylet/core/result.hpp"

#include <gmshc.h>

#include <string>
#include <utility>
#include <vector>

namespace stylet::detail {

/// The functions of the gmsh library that the reader calls. They throw std::runtime_error if gmsh reports an error or
/// does not have a function.
class GmshLibrary {
 public:
  using DimTags = std::vector<std::pair<int, int>>;  ///< dimension and number of each entity or group
  struct Nodes {
    std::vector<std::size_t> tags;
    std::vector<double> coordinates;  ///< (3 × nodes) [file unit]
  };
  struct Elements {
    int type = 0;
    std::vector<std::size_t> tags, nodes;  ///< the nodes of each element are consecutive
  };
  struct ElementType {
    std::string name;
    int nodes = 0;
  };

  /// Numbers of elements that a file has beside its mesh ($ElementData).
  struct ElementData {
    std::string name;
    std::vector<std::size_t> tags;  ///< of the elements
    std::vector<double> values;     ///< one for each element; empty if they have several
  };

  /// The library, loaded by the first call. Failure: it is missing, or it is another version.
  static Result<const GmshLibrary*> get();

  /// Initialises gmsh without the user's configuration files, silent, with one thread and a log.
  void start() const;
  void merge(const std::string& file) const;
  /// Whether gmsh's log has an error. gmsh continues after errors.
  [[nodiscard]] bool has_failed() const;

  /// @param dimension −1: all
  [[nodiscard]] DimTags entities(int dimension) const;
  [[nodiscard]] DimTags physical_groups(int dimension) const;
  [[nodiscard]] std::vector<int> physical_groups_of(int dimension, int entity) const;
  [[nodiscard]] std::string physical_name(int dimension, int group) const;
  [[nodiscard]] Nodes nodes() const;
  [[nodiscard]] std::vector<Elements> elements(int dimension, int entity) const;
  [[nodiscard]] ElementType element_type(int type) const;
  /// All $ElementData of the file, each at its first step.
  [[nodiscard]] std::vector<ElementData> element_data() const;

 private:
  explicit GmshLibrary(void* loaded);

  /// Calls a function of the library, with a place for its error as the last argument.
  template <class Function, class... Arguments>
  auto call(const char* name, Arguments... arguments) const;
  void free(void* data) const;
  template <class T>
  std::vector<T> taken(T* data, std::size_t size) const;
  std::string taken(char* text) const;

  void* loaded_;         ///< null: the library could not be loaded
  std::string problem_;  ///< why not
};

}  // namespace stylet::detail
