// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of VTU files with VTK: appended raw data; frame and unit are field data. Fields are written with single
// precision and nothing is compressed, because a run writes a file for each of its frames: zlib would take longer than
// all the rest.
#include "detail/vtk_messages.hpp"
#include "stylet/io/files.hpp"
#include "stylet/io/mesh_io.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>

namespace stylet {

namespace {

void add_text(vtkFieldData& fields, const char* name, const std::vector<std::string>& values) {
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& value : values) array->InsertNextValue(value);
  fields.AddArray(array);
}

/// @param columns required number of columns of each field: nodes or elements
Result<> add_fields(vtkDataSetAttributes& attributes, const std::vector<MeshField>& fields, Index columns,
                    const std::string& where) {
  for (const MeshField& field : fields) {
    const auto components = field.values.rows();
    if (field.values.cols() != columns || (components != 1 && components != 3 && components != 6)) {
      return failure(where,
                     fmt::format("the field '{}' has {} × {} values, 1, 3 or 6 × {} are expected", field.name,
                                 components, field.values.cols(), columns),
                     "Give one column per node or tetrahedron");
    }
    vtkNew<vtkFloatArray> array;
    array->SetName(field.name.c_str());
    array->SetNumberOfComponents(static_cast<int>(components));
    array->SetNumberOfTuples(columns);
    std::transform(field.values.data(), field.values.data() + field.values.size(), array->GetPointer(0),
                   [](double value) { return static_cast<float>(value); });
    attributes.AddArray(array);
  }
  return Ok{};
}

}  // namespace

Result<> write_vtu(const TetMesh& mesh, const std::filesystem::path& path, const std::vector<MeshField>& node_fields,
                   const std::vector<MeshField>& tet_fields) {
  detail::silence_vtk();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.node_count());
  for (Index a = 0; a < mesh.node_count(); ++a) points->SetPoint(a, mesh.nodes[a].data());

  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(mesh.tet_count(), 4 * static_cast<vtkIdType>(mesh.tet_count()));
  vtkNew<vtkIntArray> region;
  region->SetName("region");
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const std::array<vtkIdType, 4> ids{mesh.tets[t][0], mesh.tets[t][1], mesh.tets[t][2], mesh.tets[t][3]};
    cells->InsertNextCell(4, ids.data());
    region->InsertNextValue(mesh.tet_region[t]);
  }

  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  grid->SetCells(VTK_TETRA, cells);
  grid->GetCellData()->AddArray(region);
  if (Result<> r = add_fields(*grid->GetPointData(), node_fields, mesh.node_count(), path.string()); !r) return r;
  if (Result<> r = add_fields(*grid->GetCellData(), tet_fields, mesh.tet_count(), path.string()); !r) return r;
  add_text(*grid->GetFieldData(), "region_names", mesh.regions);
  add_text(*grid->GetFieldData(), "SPACE", {"LPS"});
  add_text(*grid->GetFieldData(), "UNITS", {"mm"});

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetWriteToOutputString(true);
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetIdTypeToInt32();
  if (writer->Write() != 1) return failure(path.string(), "VTK cannot make the file", "Use a smaller mesh");
  return write_whole_file(path, writer->GetOutputString());
}

}  // namespace stylet
