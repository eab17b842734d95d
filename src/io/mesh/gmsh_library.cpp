// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/gmsh_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

namespace stylet::detail {

namespace {

void check(int error) {
  if (error != 0) throw std::runtime_error(fmt::format("error {}", error));
}

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
  if (!library.whole_)
    return failure(name, "the library that reads gmsh and MEDIT meshes lacks functions",
                   "Install the version of gmsh with which the program was built, or convert the mesh to VTU");
  return &library;
}

GmshLibrary::GmshLibrary(void* loaded) {
  if (loaded == nullptr) {
    const char* said = dlerror();
    problem_ = said != nullptr ? said : "no reason given";
    return;
  }
  const auto find = [&]<class F>(F& function, const char* name) {
    function = reinterpret_cast<F>(dlsym(loaded, name));
    whole_ = whole_ && function != nullptr;
  };
  find(free_, "gmshFree");
  find(initialize_, "gmshInitialize");
  find(set_number_, "gmshOptionSetNumber");
  find(logger_start_, "gmshLoggerStart");
  find(logger_get_, "gmshLoggerGet");
  find(merge_, "gmshMerge");
  find(entities_, "gmshModelGetEntities");
  find(groups_, "gmshModelGetPhysicalGroups");
  find(groups_of_, "gmshModelGetPhysicalGroupsForEntity");
  find(name_, "gmshModelGetPhysicalName");
  find(nodes_, "gmshModelMeshGetNodes");
  find(elements_, "gmshModelMeshGetElements");
  find(properties_, "gmshModelMeshGetElementProperties");
  find(get_string_, "gmshOptionGetString");
  find(get_number_, "gmshOptionGetNumber");
  find(views_, "gmshViewGetTags");
  find(view_index_, "gmshViewGetIndex");
  find(view_data_, "gmshViewGetHomogeneousModelData");
}

template <class T>
std::vector<T> GmshLibrary::taken(T* data, std::size_t size) const {
  std::vector<T> all(data, data + size);
  free_(data);
  return all;
}

std::string GmshLibrary::taken(char* text) const {
  std::string all = text != nullptr ? text : "";
  free_(text);
  return all;
}

void GmshLibrary::start() const {
  int error = 0;
  const auto set = [&](const char* option, double value) {
    set_number_(option, value, &error);
    check(error);
  };
  initialize_(0, nullptr, 0, &error);
  check(error);
  set("General.Terminal", 0);
  set("General.AbortOnError", 2);  // the functions report errors as return values
  set("General.NumThreads", 1);
  logger_start_(&error);
  check(error);
}

void GmshLibrary::merge(const std::string& file) const {
  int error = 0;
  merge_(file.c_str(), &error);
  check(error);
}

std::string GmshLibrary::first_error() const {
  char** lines = nullptr;
  std::size_t count = 0;
  int error = 0;
  logger_get_(&lines, &count, &error);
  check(error);
  std::string first;
  for (char* text : taken(lines, count)) {
    const std::string line = taken(text);
    if (!first.empty() || !line.starts_with("Error")) continue;
    first = line.substr(line.find(':') == std::string::npos ? 0 : line.find(':') + 2);
  }
  return first;
}

GmshLibrary::DimTags GmshLibrary::entities(int dimension) const {
  int* flat = nullptr;
  std::size_t size = 0;
  int error = 0;
  entities_(&flat, &size, dimension, &error);
  check(error);
  return pairs(taken(flat, size));
}

GmshLibrary::DimTags GmshLibrary::physical_groups(int dimension) const {
  int* flat = nullptr;
  std::size_t size = 0;
  int error = 0;
  groups_(&flat, &size, dimension, &error);
  check(error);
  return pairs(taken(flat, size));
}

std::vector<int> GmshLibrary::physical_groups_of(int dimension, int entity) const {
  int* groups = nullptr;
  std::size_t size = 0;
  int error = 0;
  groups_of_(dimension, entity, &groups, &size, &error);
  check(error);
  return taken(groups, size);
}

std::string GmshLibrary::physical_name(int dimension, int group) const {
  char* name = nullptr;
  int error = 0;
  name_(dimension, group, &name, &error);
  check(error);
  return taken(name);
}

GmshLibrary::Nodes GmshLibrary::nodes() const {
  std::size_t* tags = nullptr;
  double* coordinates = nullptr;
  double* parameters = nullptr;
  std::size_t count = 0, numbers = 0, parameter_count = 0;
  int error = 0;
  nodes_(&tags, &count, &coordinates, &numbers, &parameters, &parameter_count, -1, -1, 0, 1, &error);
  check(error);
  free_(parameters);
  return {taken(tags, count), taken(coordinates, numbers)};
}

std::vector<GmshLibrary::Elements> GmshLibrary::elements(int dimension, int entity) const {
  int* types = nullptr;
  std::size_t **tags = nullptr, **nodes = nullptr;
  std::size_t *tag_counts = nullptr, *node_counts = nullptr;
  std::size_t type_count = 0, tag_lists = 0, node_lists = 0;
  int error = 0;
  elements_(&types, &type_count, &tags, &tag_counts, &tag_lists, &nodes, &node_counts, &node_lists, dimension, entity,
            &error);
  check(error);
  std::vector<Elements> all;
  for (std::size_t k = 0; k < type_count; ++k)
    all.push_back({types[k], taken(tags[k], tag_counts[k]), taken(nodes[k], node_counts[k])});
  for (void* list : {static_cast<void*>(types), static_cast<void*>(tags), static_cast<void*>(tag_counts),
                     static_cast<void*>(nodes), static_cast<void*>(node_counts)})
    free_(list);
  return all;
}

GmshLibrary::ElementType GmshLibrary::element_type(int type) const {
  char* name = nullptr;
  double* local = nullptr;
  std::size_t numbers = 0;
  int dimension = 0, order = 0, nodes = 0, primary = 0, error = 0;
  properties_(type, &name, &dimension, &order, &nodes, &local, &numbers, &primary, &error);
  check(error);
  free_(local);
  return {taken(name), nodes};
}

std::vector<GmshLibrary::ElementData> GmshLibrary::element_data() const {
  int* numbers = nullptr;
  std::size_t count = 0;
  int error = 0;
  views_(&numbers, &count, &error);
  check(error);
  std::vector<ElementData> all;
  for (const int view : taken(numbers, count)) {
    const int index = view_index_(view, &error);
    check(error);
    double step = 0.0;
    get_number_(fmt::format("View[{}].TimeStep", index).c_str(), &step, &error);
    char *kind = nullptr, *name = nullptr;
    std::size_t *tags = nullptr, tag_count = 0, value_count = 0;
    double *values = nullptr, time = 0.0;
    int components = 0;
    view_data_(view, static_cast<int>(step), &kind, &tags, &tag_count, &values, &value_count, &time, &components,
               &error);
    if (error != 0) continue;  // data of points outside the mesh
    ElementData data{.name = {}, .tags = taken(tags, tag_count), .values = taken(values, value_count)};
    if (taken(kind) != "ElementData") continue;
    get_string_(fmt::format("View[{}].Name", index).c_str(), &name, &error);
    check(error);
    data.name = taken(name);
    if (components != 1 || data.values.size() != data.tags.size()) data.values.clear();
    all.push_back(std::move(data));
  }
  return all;
}

}  // namespace stylet::detail
