// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of VTU and legacy VTK unstructured grids with VTK.
#include "detail/text.hpp"
#include "detail/vtk_messages.hpp"
#include "mesh/raw_mesh.hpp"
#include "mesh/vtk_cells.hpp"
#include "mesh/vtk_hints.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>

namespace stylet::detail {

namespace {

/// Names of cell arrays with region numbers: first Stylet's own, then those of other programs.
constexpr std::array<const char*, 7> region_arrays{"region",    "Region",     "CellEntityIds", "gmsh:physical",
                                                   "medit:ref", "MaterialID", "label"};

/// The arrays of numbers of the cells, with their values at the tetrahedra.
void read_arrays(vtkUnstructuredGrid& grid, const std::vector<vtkIdType>& tet_cells, RawMesh& raw) {
  vtkCellData& data = *grid.GetCellData();
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data.GetArray(i);  // null: not of numbers
    if (array == nullptr || array->GetName() == nullptr) continue;
    CellArray& added = raw.arrays.emplace_back(CellArray{.name = array->GetName(), .values = {}, .names = {}});
    if (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != grid.GetNumberOfCells()) continue;
    added.values.reserve(tet_cells.size());
    for (const vtkIdType cell : tet_cells) added.values.push_back(array->GetComponent(cell, 0));
  }
  for (const char* name : region_arrays) {
    const auto own = std::find_if(raw.arrays.begin(), raw.arrays.end(), [&](const auto& a) { return a.name == name; });
    if (raw.own || own == raw.arrays.end()) continue;
    raw.own = static_cast<std::size_t>(own - raw.arrays.begin());
    auto* names = vtkStringArray::SafeDownCast(grid.GetFieldData()->GetAbstractArray("region_names"));
    for (vtkIdType n = 0; names != nullptr && n < names->GetNumberOfValues(); ++n)
      own->names[static_cast<int>(n)] = names->GetValue(n);
  }
  raw.cells.assign(tet_cells.begin(), tet_cells.end());
}

Result<RawMesh> to_raw(vtkUnstructuredGrid& grid, const std::string& source) {
  RawMesh raw;
  if (grid.GetPoints() == nullptr) return raw;
  if (grid.GetNumberOfPoints() > std::numeric_limits<Index>::max() ||
      grid.GetNumberOfCells() > std::numeric_limits<Index>::max()) {
    return input_error(source, "the mesh has more than 2 billion nodes or cells", "Use a coarser mesh");
  }
  raw.nodes.resize(static_cast<std::size_t>(grid.GetNumberOfPoints()));
  for (std::size_t a = 0; a < raw.nodes.size(); ++a) grid.GetPoint(static_cast<vtkIdType>(a), raw.nodes[a].data());
  raw.used_elsewhere.assign(raw.nodes.size(), false);
  std::vector<vtkIdType> tet_cells;
  for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    grid.GetCellPoints(c, count, ids);
    for (vtkIdType i = 0; i < count; ++i) {
      if (ids[i] < 0 || ids[i] >= grid.GetNumberOfPoints()) {
        return input_error(
            fmt::format("{}, cell {}", source, c),
            fmt::format("node number {} is out of range, expected 0 to {}", ids[i], grid.GetNumberOfPoints() - 1),
            "The file is damaged; export the mesh again");
      }
    }
    const int type = grid.GetCellType(c);
    const bool quadratic = type == VTK_QUADRATIC_TETRA && count == 10;
    if (quadratic || (type == VTK_TETRA && count == 4)) {
      raw.tets.push_back({static_cast<Index>(ids[0]), static_cast<Index>(ids[1]), static_cast<Index>(ids[2]),
                          static_cast<Index>(ids[3])});
      tet_cells.push_back(c);
      raw.quadratic = raw.quadratic || quadratic;
      for (vtkIdType i = 4; i < count; ++i) raw.used_elsewhere[ids[i]] = true;
      continue;
    }
    for (vtkIdType i = 0; i < count; ++i) raw.used_elsewhere[ids[i]] = true;
    const char* kind = vtkCellTypes::GetClassNameFromTypeId(type);
    ++raw.passed_over[fmt::format("cell(s) of type {}", kind == nullptr ? "unknown" : kind)];
  }
  read_arrays(grid, tet_cells, raw);
  return raw;
}

}  // namespace

Result<RawMesh> parse_vtk_mesh(const std::filesystem::path& path, bool xml) {
  const std::string source = path.string();
  const auto messages = VtkMessages::install();
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  std::string header;
  unsigned long error = 0;
  if (xml) {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    error = reader->GetErrorCode();
    grid = reader->GetOutput();
  } else {
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->ReadAllScalarsOn();
    if (!reader->IsFileUnstructuredGrid() && !messages->failed()) {
      return input_error(source, "this legacy VTK file holds no unstructured grid",
                         "Export the volume mesh as UNSTRUCTURED_GRID");
    }
    reader->Update();
    error = reader->GetErrorCode();
    grid = reader->GetOutput();
    if (reader->GetHeader() != nullptr) header = reader->GetHeader();
  }
  if (messages->failed() || error != 0 || grid == nullptr || !cells_are_whole(grid->GetCells())) {
    return input_error(source, "the VTK file cannot be read: its data end too early or do not fit their description",
                       "The file is truncated or damaged; copy or export it again");
  }
  Result<RawMesh> raw = to_raw(*grid, source);
  if (!raw) return raw;
  const VtkHints hints = vtk_hints(*grid, header);
  raw->ras = hints.ras;
  raw->unit_mm = hints.unit_mm;
  return raw;
}

}  // namespace stylet::detail
