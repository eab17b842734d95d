// SPDX-License-Identifier: GPL-3.0-or-later
#include "paraview.hpp"

#include "detail/vtk_messages.hpp"
#include "output_folder.hpp"
#include "stylet/io/files.hpp"
#include "stylet/io/mesh_io.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataWriter.h>

namespace stylet::results {
namespace fs = std::filesystem;

namespace {

constexpr double kKilopascal = 1000;  // per MPa

/// A ParaView collection: the files of all frames with their times [s].
std::string collection(const std::vector<Frame>& frames, std::string_view stem, std::string_view extension) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (std::size_t f = 0; f < frames.size(); ++f) {
    xml += fmt::format("    <DataSet timestep=\"{:.6f}\" part=\"0\" file=\"{}\"/>\n", frames[f].time_s,
                       series_name(stem, f, extension));
  }
  return xml + "  </Collection>\n</VTKFile>\n";
}

/// An array of point data, with one column per point.
struct PointArray {
  const char* name;
  MatX values;
};

/// The text of a VTP file with the needle's points from base to tip as one line, then the contacts as single points;
/// empty if VTK cannot make it.
std::string needle_vtp(const Frame& frame, double diameter) {
  detail::silence_vtk();
  const auto shaft = static_cast<Eigen::Index>(frame.needle.size());
  const auto count = shaft + static_cast<Eigen::Index>(frame.contacts.size());
  PointArray arc{"arc_length_mm", MatX::Zero(1, count)}, radius{"radius_mm", MatX::Constant(1, count, diameter / 2)},
      tangent{"tangent", MatX::Zero(3, count)}, force{"force_N", MatX::Zero(3, count)};
  vtkNew<vtkUnsignedCharArray> kind;
  kind->SetName("contact");
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> line, dots;

  if (shaft > 0) line->InsertNextCell(static_cast<int>(shaft));
  double s = 0;
  for (Eigen::Index k = 0; k < shaft; ++k) {
    const auto at = [&](Eigen::Index i) -> const Vec3& { return frame.needle[static_cast<std::size_t>(i)]; };
    if (k > 0) s += (at(k) - at(k - 1)).norm();
    arc.values(0, k) = s;
    if (shaft > 1)
      tangent.values.col(k) = (at(std::min(k + 1, shaft - 1)) - at(std::max<Eigen::Index>(k - 1, 0))).normalized();
    line->InsertCellPoint(points->InsertNextPoint(at(k).data()));
    kind->InsertNextValue(0);
  }
  for (Eigen::Index c = 0; c < count - shaft; ++c) {
    const ContactView& contact = frame.contacts[static_cast<std::size_t>(c)];
    arc.values(0, shaft + c) = contact.s;
    force.values.col(shaft + c) = contact.force;
    const vtkIdType point = points->InsertNextPoint(contact.position.data());
    dots->InsertNextCell(1, &point);
    kind->InsertNextValue(contact.tip ? 3 : contact.sticking ? 2 : 1);
  }

  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(dots);
  data->SetLines(line);
  data->GetPointData()->AddArray(kind);
  for (const PointArray* source : {&arc, &radius, &tangent, &force}) {
    vtkNew<vtkDoubleArray> array;
    array->SetName(source->name);
    array->SetNumberOfComponents(static_cast<int>(source->values.rows()));
    array->SetNumberOfTuples(count);
    std::copy(source->values.data(), source->values.data() + source->values.size(), array->GetPointer(0));
    data->GetPointData()->AddArray(array);
  }
  vtkNew<vtkStringArray> space;  // 3D Slicer reads the patient frame from it
  space->SetName("SPACE");
  space->InsertNextValue("LPS");
  data->GetFieldData()->AddArray(space);

  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->SetWriteToOutputString(true);
  return writer->Write() == 1 ? writer->GetOutputString() : std::string();
}

}  // namespace

Result<> write_tissue(const RunRecording& run, const std::function<MatX(const VecX&)>& stress_of,
                      const fs::path& folder, const Progress& progress) {
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    const VecX& u = run.frames[f].displacement;
    const std::vector<MeshField> node_fields{{"displacement_mm", u.reshaped(3, u.size() / 3)}};
    std::vector<MeshField> tet_fields;
    if (stress_of) tet_fields.push_back({"stress_kPa", kKilopascal * stress_of(u)});
    if (auto done = write_vtu(run.mesh, folder / series_name("tissue", f, ".vtu"), node_fields, tet_fields); !done) {
      return done;
    }
    report(progress, "tissue files", static_cast<double>(f + 1) / static_cast<double>(run.frames.size()));
  }
  if (auto removed = remove_series_from(folder, "tissue", ".vtu", run.frames.size()); !removed) return removed;
  return write_whole_file(folder / "tissue.pvd", collection(run.frames, "tissue", ".vtu"));
}

Result<> write_needle(const RunRecording& run, std::size_t deepest, const fs::path& folder) {
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    const std::string vtp = needle_vtp(run.frames[f], run.info.needle_diameter_mm);
    const fs::path file = folder / series_name("needle", f, ".vtp");
    if (vtp.empty()) return failure(file.string(), "VTK cannot make the file", "Close other programs, then run again");
    if (auto done = write_whole_file(file, vtp); !done) return done;
    if (f != deepest) continue;
    if (auto done = write_whole_file(folder / "needle.vtp", vtp); !done) return done;
  }
  if (auto removed = remove_series_from(folder, "needle", ".vtp", run.frames.size()); !removed) return removed;
  return write_whole_file(folder / "needle.pvd", collection(run.frames, "needle", ".vtp"));
}

}  // namespace stylet::results
