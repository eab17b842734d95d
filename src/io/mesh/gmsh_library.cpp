// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/gmsh_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <type_traits>

namespace stylet::detail {

namespace {

/// @param flat dimension and number of each entity, alternating
GmshLibrary::DimTags pairs(const std::vector<int>& flat) {
  GmshLibrary::DimTags all;
  for (std::size_t i = 0; i + 1 < flat.size(); i += 2) all.emplace_back(flat[i], flat[i + 1]);
  return all;
}

}  // namespace

Result<const GmshLibrary*> GmshLibrary::get() {
  static const std::string name = fmt::format("libgmsh.so.{}.{}", GMSH_API_VERSION_MAJOR, GMSH_API_VERSION_MINOR);
  static const GmshLibrary library(dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL));
  if (!library.problem_.empty())
    return failure(name,
                   fmt::format("the library that reads gmsh and MEDIT meshes cannot be loaded ({})", library.problem_),
                   "Install gmsh, or convert the mesh to VTU");
  return &library;
}

GmshLibrary::GmshLibrary(void* loaded) : loaded_(loaded) {
  if (loaded != nullptr) return;
  const char* said = dlerror();
  problem_ = said != nullptr ? said : "no reason given";
}

template <class Function, class... Arguments>
auto GmshLibrary::call(const char* name, Arguments... arguments) const {
  auto* const function = reinterpret_cast<Function*>(dlsym(loaded_, name));
  if (function == nullptr) throw std::runtime_error(fmt::format("the library has no function {}", name));
  int error = 0;
  const auto check = [&error] {
    if (error != 0) throw std::runtime_error(fmt::format("error {}", error));
  };
  if constexpr (std::is_void_v<decltype(function(arguments..., &error))>) {
    function(arguments..., &error);
    check();
  } else {
    const auto result = function(arguments..., &error);
    check();
    return result;
  }
}

void GmshLibrary::free(void* data) const { reinterpret_cast<decltype(&gmshFree)>(dlsym(loaded_, "gmshFree"))(data); }

template <class T>
std::vector<T> GmshLibrary::taken(T* data, std::size_t size) const {
  std::vector<T> all(data, data + size);
  free(data);
  return all;
}

std::string GmshLibrary::taken(char* text) const {
  std::string all = text != nullptr ? text : "";
  free(text);
  return all;
}

void GmshLibrary::start() const {
  const auto set = [&](const char* option, double value) {
    call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", option, value);
  };
  call<decltype(gmshInitialize)>("gmshInitialize", 0, nullptr, 0);
  set("General.Terminal", 0);
  set("General.AbortOnError", 2);  // the functions report errors as return values
  set("General.NumThreads", 1);
  call<decltype(gmshLoggerStart)>("gmshLoggerStart");
}

void GmshLibrary::merge(const std::string& file) const { call<decltype(gmshMerge)>("gmshMerge", file.c_str()); }

bool GmshLibrary::has_failed() const {
  char** lines = nullptr;
  std::size_t count = 0;
  call<decltype(gmshLoggerGet)>("gmshLoggerGet", &lines, &count);
  bool failed = false;
  for (char* text : taken(lines, count)) failed = taken(text).starts_with("Error") || failed;
  return failed;
}

GmshLibrary::DimTags GmshLibrary::entities(int dimension) const {
  int* flat = nullptr;
  std::size_t size = 0;
  call<decltype(gmshModelGetEntities)>("gmshModelGetEntities", &flat, &size, dimension);
  return pairs(taken(flat, size));
}

GmshLibrary::DimTags GmshLibrary::physical_groups(int dimension) const {
  int* flat = nullptr;
  std::size_t size = 0;
  call<decltype(gmshModelGetPhysicalGroups)>("gmshModelGetPhysicalGroups", &flat, &size, dimension);
  return pairs(taken(flat, size));
}

std::vector<int> GmshLibrary::physical_groups_of(int dimension, int entity) const {
  int* groups = nullptr;
  std::size_t size = 0;
  call<decltype(gmshModelGetPhysicalGroupsForEntity)>("gmshModelGetPhysicalGroupsForEntity", dimension, entity, &groups,
                                                      &size);
  return taken(groups, size);
}

std::string GmshLibrary::physical_name(int dimension, int group) const {
  char* name = nullptr;
  call<decltype(gmshModelGetPhysicalName)>("gmshModelGetPhysicalName", dimension, group, &name);
  return taken(name);
}

GmshLibrary::Nodes GmshLibrary::nodes() const {
  std::size_t* tags = nullptr;
  double* coordinates = nullptr;
  double* parameters = nullptr;
  std::size_t count = 0, numbers = 0, parameter_count = 0;
  call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags, &count, &coordinates, &numbers, &parameters,
                                        &parameter_count, -1, -1, 0, 1);
  free(parameters);
  return {taken(tags, count), taken(coordinates, numbers)};
}

std::vector<GmshLibrary::Elements> GmshLibrary::elements(int dimension, int entity) const {
  int* types = nullptr;
  std::size_t **tags = nullptr, **nodes = nullptr;
  std::size_t *tag_counts = nullptr, *node_counts = nullptr;
  std::size_t type_count = 0, tag_lists = 0, node_lists = 0;
  call<decltype(gmshModelMeshGetElements)>("gmshModelMeshGetElements", &types, &type_count, &tags, &tag_counts,
                                           &tag_lists, &nodes, &node_counts, &node_lists, dimension, entity);
  std::vector<Elements> all;
  for (std::size_t k = 0; k < type_count; ++k)
    all.push_back({types[k], taken(tags[k], tag_counts[k]), taken(nodes[k], node_counts[k])});
  for (void* list : {static_cast<void*>(types), static_cast<void*>(tags), static_cast<void*>(tag_counts),
                     static_cast<void*>(nodes), static_cast<void*>(node_counts)})
    free(list);
  return all;
}

GmshLibrary::ElementType GmshLibrary::element_type(int type) const {
  char* name = nullptr;
  double* local = nullptr;
  std::size_t numbers = 0;
  int dimension = 0, order = 0, nodes = 0, primary = 0;
  call<decltype(gmshModelMeshGetElementProperties)>("gmshModelMeshGetElementProperties", type, &name, &dimension,
                                                    &order, &nodes, &local, &numbers, &primary);
  free(local);
  return {taken(name), nodes};
}

std::vector<GmshLibrary::ElementData> GmshLibrary::element_data() const {
  int* numbers = nullptr;
  std::size_t count = 0;
  call<decltype(gmshViewGetTags)>("gmshViewGetTags", &numbers, &count);
  std::vector<ElementData> all;
  for (const int view : taken(numbers, count)) {
    const int index = call<decltype(gmshViewGetIndex)>("gmshViewGetIndex", view);
    double step = 0.0;
    call<decltype(gmshOptionGetNumber)>("gmshOptionGetNumber", fmt::format("View[{}].TimeStep", index).c_str(), &step);
    char *kind = nullptr, *name = nullptr;
    std::size_t *tags = nullptr, tag_count = 0, value_count = 0;
    double *values = nullptr, time = 0.0;
    int components = 0;
    try {
      call<decltype(gmshViewGetHomogeneousModelData)>("gmshViewGetHomogeneousModelData", view, static_cast<int>(step),
                                                      &kind, &tags, &tag_count, &values, &value_count, &time,
                                                      &components);
    } catch (const std::runtime_error&) {
      continue;  // data of points outside the mesh
    }
    ElementData data{.name = {}, .tags = taken(tags, tag_count), .values = taken(values, value_count)};
    if (taken(kind) != "ElementData") continue;
    call<decltype(gmshOptionGetString)>("gmshOptionGetString", fmt::format("View[{}].Name", index).c_str(), &name);
    data.name = taken(name);
    if (components != 1 || data.values.size() != data.tags.size()) data.values.clear();
    all.push_back(std::move(data));
  }
  return all;
}

}  // namespace stylet::detail
