# SPDX-License-Identifier: GPL-3.0-or-later
"""Small sound files of every format that the program reads, with the commands that read them."""
import gzip
import json
import struct
from dataclasses import dataclass
from pathlib import Path

import pydicom
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.uid import ExplicitVRLittleEndian, generate_uid

import full_disk
import mutators
import samples
from ending import run
from insert_case import BLOCK, FAST, block_mesh

QUICK = ("--set", "run.dt_ms=10", *FAST[2:])
IMPLANT = """\
[patient]
source = "block.msh"
regions = { tissue = "body", lump = "prostate" }
[fixed]
outer = "sides"
[needle]
length_mm = 100
[template]
centre_mm = [31, 32]
[plan]
file = "seeds.csv"
[procedure]
speed_mm_per_s = 100
pause_s = 0.1
drop_speed_mm_per_s = 50
retract_speed_mm_per_s = 100
[run]
dt_ms = 10
"""
SEEDS = """\
# source: i125_6711
# strength_U: 0.5
# prescription_Gy: 145
# template_origin_mm: 31 32 40.0
hole,retraction_mm,train
D4,5,S-1-S
"""
SOURCE = {"format": "stylet-source", "version": 1, "name": "mine", "title": "My seed", "isotope": "I-125",
          "citation": "a paper",
          "half_life_days": 59.4, "dose_rate_constant": 0.965, "active_length_mm": 3.0, "outer_length_mm": 4.5,
          "outer_diameter_mm": 0.8, "g": {"r_mm": [1, 5, 10, 50], "g_L": [1.055, 1.071, 1.0, 0.364]},
          "F": {"r_mm": [5, 10, 50], "theta_deg": [0, 30, 90],
                "values": [[None, 0.37, 0.55], [0.846, 0.834, 0.852], [1, 1, 1]]}}
PLAN_CSV = "# strength_U: 0.5\n# source: i125_6711\nx_mm,y_mm,z_mm,ax,ay,az\n0,0,0,0,0,1\n5,0,0,0,0,1\n"
FOUND = "x_mm,y_mm,z_mm,ax,ay,az\n31,32,35,0,0,1\n31.5,32,25,0,0.1,1\n"
POINTS = "x_mm,y_mm,z_mm\n0,0,0\n10,0,0\n0,5,20\n"
GOALS = "structure,metric,bound,citation\nprostate,D90_percent,>=100,ours\nrectum,D0.1cc_Gy,<200,ours\n"
DOSE = ("--step", "3", "--grid", "6")


@dataclass
class Base:
    """A sound file: its name, its mutator, and the commands that read it with how often each is taken. "FILE" stands
    for the mutant; files beside it have the names that commands and files say."""
    name: str
    mutate: object
    commands: list


def voxels(size=(12, 12, 8)):
    inside = lambda i, j, k: 2 < i < 9 and 2 < j < 9 and 1 < k < 6
    return bytes((1 + (i > 5)) * inside(i, j, k) for k in range(size[2]) for j in range(size[1])
                 for i in range(size[0]))


def nrrd():
    return (b"NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 12 12 8\n"
            b"space directions: (3,0,0) (0,3,0) (0,0,5)\nspace origin: (0,0,0)\nencoding: raw\n"
            b"Segment0_Name:=Prostate\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n\n" + voxels())


def metaimage():
    return (b"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
            b"CompressedData = False\n"
            b"TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 3 3 5\nDimSize = 12 12 8\n"
            b"ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + voxels())


def item(**values):
    dataset = Dataset()
    for name, value in values.items():
        setattr(dataset, name, value)
    return dataset


def segmentation(path):
    """A binary DICOM Segmentation of 8 frames."""
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.66.4"
    meta.MediaStorageSOPInstanceUID = generate_uid()
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    file = FileDataset(str(path), {}, file_meta=meta, preamble=bytes(128))
    file.is_little_endian, file.is_implicit_VR = True, False
    for name, value in {
            "SOPClassUID": meta.MediaStorageSOPClassUID, "SOPInstanceUID": meta.MediaStorageSOPInstanceUID,
                        "Modality": "SEG",
            "PatientName": "Test", "PatientID": "1", "StudyInstanceUID": generate_uid(),
                        "SeriesInstanceUID": generate_uid(),
            "FrameOfReferenceUID": generate_uid(), "InstanceNumber": 1, "ContentLabel": "SEG", "NumberOfFrames": 8,
                        "Rows": 12,
            "Columns": 12, "BitsAllocated": 1, "BitsStored": 1, "HighBit": 0, "SamplesPerPixel": 1,
                        "PixelRepresentation": 0,
            "PhotometricInterpretation": "MONOCHROME2", "SegmentationType": "BINARY",
                        "LossyImageCompression": "00"}.items():
        setattr(file, name, value)
    code = {"CodeValue": "41216001", "CodingSchemeDesignator": "SCT", "CodeMeaning": "Prostate"}
    file.SegmentSequence = [item(SegmentNumber=1, SegmentLabel="Prostate", SegmentAlgorithmType="MANUAL",
                                 SegmentedPropertyCategoryCodeSequence=[item(**code)],
                                 SegmentedPropertyTypeCodeSequence=[item(**code)])]
    file.SharedFunctionalGroupsSequence = [item(
        PixelMeasuresSequence=[item(PixelSpacing=[3, 3], SliceThickness=5, SpacingBetweenSlices=5)],
        PlaneOrientationSequence=[item(ImageOrientationPatient=[1, 0, 0, 0, 1, 0])],
        SegmentIdentificationSequence=[item(ReferencedSegmentNumber=1)])]
    file.PerFrameFunctionalGroupsSequence = [item(
        PlanePositionSequence=[item(ImagePositionPatient=[0, 0, 5 * k])],
        FrameContentSequence=[item(StackID="1", InStackPositionNumber=k + 1, DimensionIndexValues=[1, k + 1])])
                                             for k in range(8)]
    bits = [min(value, 1) for value in voxels()]
    file.PixelData = bytes(sum(bits[k + n] << n for n in range(8)) for k in range(0, len(bits), 8))
    file["PixelData"].VR = "OB"
    file.save_as(path)


def fewer_contours(source, path):
    """A structure set with a few contours of each structure, each of few points."""
    file = pydicom.dcmread(source)
    for roi in file.ROIContourSequence:
        contours = list(roi.ContourSequence)
        roi.ContourSequence = contours[::max(1, len(contours) // 4)]
    file.save_as(path)


def binary_stl():
    corners = [(0, 0, 0), (30, 0, 0), (0, 30, 0), (0, 0, 30)]
    triangles = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    return bytes(80) + struct.pack("<I", 4) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in corners[corner]), 0)
                                                       for triangle in triangles)


TETRAHEDRON = ("v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\n", "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
PLY = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
       "property list uchar int vertex_indices\nend_header\n0 0 0\n30 0 0\n0 30 0\n0 0 30\n"
       "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")


def done(arguments, folder):
    end = run(arguments, folder)
    if end.status != 0:
        raise RuntimeError(f"stylet {' '.join(map(str, arguments))}: {end.err}")


def write(folder):
    """Writes all files into a folder."""
    folder = Path(folder)
    block_mesh(folder / "block.msh")
    texts = {"block.toml": BLOCK, "implant.toml": IMPLANT, "seeds.csv": SEEDS, "source.json": json.dumps(SOURCE),
             "found.csv": FOUND,
             "points.csv": POINTS, "goals.csv": GOALS, "plan.json": json.dumps(full_disk.PLAN),
             "surface.obj": "".join(TETRAHEDRON),
             "surface.ply": PLY, "structures.json": json.dumps(samples.structure_set(samples.ball(14, gap=5.0))),
             "mesh.vtk": samples.vtk({"tissue": "1 1 1 2 2 2", "part": "1 1 3 3 3 3"}),
             "motion.toml": BLOCK.split("entry_mm")[0] +
             'motion = "motion.csv"\n', "plan.csv": PLAN_CSV}
    texts["motion.csv"] = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n" + "".join(
        f"{0.05 * k:.2f},31,32,{-120 + 5 * min(k, 16 - k)},1,0,0,0\n" for k in range(17))
    for name, content in texts.items():
        (folder / name).write_text(content, encoding="utf-8")
    samples.contour_json(folder / "gland.json")
    samples.nifti_mask(folder / "mask.nii.gz")
    (folder / "mask.nii").write_bytes(gzip.decompress((folder / "mask.nii.gz").read_bytes()))
    (folder / "mask.nrrd").write_bytes(nrrd())
    (folder / "mask.mha").write_bytes(metaimage())
    samples.stl_surface(folder / "text.stl")
    (folder / "binary.stl").write_bytes(binary_stl())
    (folder / "surface.glb").write_bytes(samples.glb("prostate"))
    segmentation(folder / "seg.dcm")
    done(("phantom", "-o", "phantom"), folder)
    fewer_contours(folder / "phantom/phantom.dcm", folder / "rtstruct.dcm")
    done(("dose", "plan.json", "--structures", "structures.json", "-o", "dose", *DOSE), folder)
    (folder / "dose/plan.dcm").rename(folder / "rtplan.dcm")
    (folder / "dose/dose.dcm").rename(folder / "rtdose.dcm")
    samples.tet_mesh(folder / "two.msh")
    done(("mesh", "two.msh", "-o", "mesh.vtu"), folder)
    done(("prepare", "block.toml", "-o", "block.stylet"), folder)
    done(("insert", "block.toml", "-o", "run", *QUICK), folder)
    (folder / "run/run.h5").rename(folder / "run.h5")
    done(("implant", "implant.toml", "-o", "implant"), folder)
    (folder / "implant/run.h5").rename(folder / "implant.h5")


def link(inputs, folder):
    """Puts the files that write() has written into a folder, as links."""
    for file in inputs.iterdir():
        if file.is_file():
            (folder / file.name).hardlink_to(file)


def bases(blocks):
    """All sound files that write() writes. blocks: gives the checked blocks of an HDF5 file, by its name."""
    info = ("info", "FILE")
    mesh = ("mesh", "FILE", "-o", "out.vtu")
    patient = [(8, info), (1, ("info", "FILE", "--scenario")), (1, (*mesh, "--preset", "paper"))]
    surface = [(8, info), (1, mesh)]
    dose = ("dose", "plan.json", "--structures", "structures.json", "-o", "out", *DOSE)
    plan = [(2, info), (3, ("dose", "FILE", "--source", "i125_6711", "-o", "out", *DOSE))]
    insert = ("insert", "FILE", "-o", "out", *QUICK)
    replay = [(6, info), (3, ("insert", "FILE", "-o", "out")), (2, ("image", "FILE", "-o", "out.png")),
              (1, ("serve", "FILE"))]
    return [
        Base("rtstruct.dcm", mutators.dicom, patient), Base("seg.dcm", mutators.dicom, patient),
        Base("rtplan.dcm", mutators.dicom,
             [*plan, (1, ("dose", "plan.json", "--patient-from", "FILE", "-o", "out", *DOSE)),
                                            (1, ("implant", "implant.toml", "--found", "FILE", "-o", "out"))]),
        Base("rtdose.dcm", mutators.dicom, [(2, info), (2, (*dose, "--compare", "FILE"))]),
        Base("gland.json", mutators.tree, patient), Base("structures.json", mutators.tree, [
            (2, info), (2, ("dose", "plan.json", "--structures", "FILE", "-o", "out", *DOSE))]),
        Base("mask.nii", mutators.raw, patient), Base("mask.nii.gz", mutators.zipped(mutators.raw), patient),
        Base("mask.nrrd", mutators.text, patient), Base("mask.mha", mutators.text, patient),
        Base("mesh.vtk", mutators.text, surface), Base("mesh.vtu", mutators.text, surface),
            Base("two.msh", mutators.text, surface),
        Base("text.stl", mutators.text, surface), Base("binary.stl", mutators.raw, surface),
            Base("surface.ply", mutators.text, surface),
        Base("surface.obj", mutators.text, surface), Base("surface.glb", mutators.raw, surface),
        Base("block.toml", mutators.text,
             [(6, insert), (2, ("prepare", "FILE", "-o", "out.stylet")), (1, ("serve", "FILE"))]),
        Base("implant.toml", mutators.text, [(1, ("implant", "FILE", "-o", "out"))]),
        Base("motion.csv", mutators.text, [(1, ("insert", "motion.toml", "-o", "out", *QUICK))]),
        Base("seeds.csv", mutators.text, [*plan, (2, ("implant", "implant.toml", "-o", "out"))]),
        Base("plan.csv", mutators.text, plan), Base("plan.json", mutators.tree, plan),
        Base("points.csv", mutators.text, [(1, (*dose, "--points", "FILE"))]),
        Base("goals.csv", mutators.text, [(1, (*dose, "--goals", "FILE"))]),
        Base("found.csv", mutators.text, [(1, ("implant", "implant.toml", "--found", "FILE", "-o", "out"))]),
        Base("source.json", mutators.tree,
             [(2, info), (2, ("dose", "plan.csv", "--source", "FILE", "-o", "out", *DOSE))]),
        Base("block.stylet", mutators.model(blocks("block.stylet")), [(3, info), (4, insert), (1, ("serve", "FILE"))]),
        Base("run.h5", mutators.hdf5(blocks("run.h5")), replay),
        Base("implant.h5", mutators.hdf5(blocks("implant.h5")), [(6, info), (1, ("serve", "FILE"))]),
    ]
